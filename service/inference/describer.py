"""From a request's segments to descriptors: what is unusable stays out, and is told."""

from dataclasses import dataclass

import numpy as np
from placecell_client.maps.compact_map import COORDINATE_LIMIT

from placecell.core.types import Float32, Float64, Int8, Int64
from placecell.descriptors.extractor import Extractor, Inputs
from service.api.schemas.recognition import Failed, ItemErrorOut
from service.core.cost import NOTHING, Cost, check_cost, cost_of_describing
from service.core.metrics import Metrics
from service.core.problems import Problem, ProblemError, title_of, type_of
from service.core.settings import Limits
from service.core.timing import Timing
from service.inference.batcher import Batcher
from service.inference.scan import Scan


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """Model inputs of a scan's segments.

    Attributes:
        inputs: of the usable segments.
        usable: int64 (rows,), their places in the request.
        centroids: float64 (rows, 3), metres, in the request's frame.
        failures: of the others, by place, why they cannot be used.
        cost: of describing them.
        dropped_points: of the request, that were not finite.
    """

    inputs: Inputs
    usable: Int64
    centroids: Float64
    failures: "dict[int, Failed]"
    cost: Cost
    dropped_points: int = 0


@dataclass(frozen=True, slots=True)
class Described:
    """Descriptors of those segments of a request that could be used.

    Attributes:
        rows: by index in the request, the row in the three arrays, or why there is none.
        codes: int8 (rows, code bytes).
        descriptors: float32 (rows, d).
        centroids: float64 (rows, 3), metres, in the request's frame.
    """

    rows: "tuple[int | Failed, ...]"
    codes: Int8
    descriptors: Float32
    centroids: Float64


class Describer:
    """One model at work: checks segments, brings them near the origin, has them described."""

    def __init__(self, extractor: Extractor, limits: Limits, metrics: Metrics) -> None:
        self.manifest = extractor.manifest
        self._extractor = extractor
        self._limits = limits
        self._batcher = Batcher(extractor, metrics, limits.batch)

    async def describe(self, prepared: Prepared, timing: Timing) -> Described:
        """Descriptors of a scan's segments, computed together with those of other requests.

        Raises:
            Problem: 422 if no descriptor is of use.
        """
        descriptors = await self._batcher.infer(prepared.inputs, timing)
        finite = np.isfinite(descriptors).all(axis=1)
        failures = prepared.failures | {
            int(place): _failed("not-describable", "The model's descriptor is not finite.")
            for place in prepared.usable[~finite]
        }
        if not finite.any():
            raise _none_usable(failures)
        rows = iter(range(len(descriptors)))
        count = len(prepared.failures) + len(descriptors)
        return Described(
            rows=tuple(
                failures[place] if place in failures else next(rows) for place in range(count)
            ),
            codes=self.manifest.quantizer.encode(descriptors[finite]),
            descriptors=descriptors[finite],
            centroids=prepared.centroids[finite],
        )

    def prepare(self, scan: Scan, timing: Timing, besides: Cost = NOTHING) -> Prepared:
        """Prepare the model inputs of a scan's segments.

        Args:
            scan: of a request.
            timing: of the request.
            besides: what else the request costs.

        Raises:
            Problem: 413 if there are too many, or they are too much work, 422 if none can be used.
        """
        self._check_amount(scan)
        failures = self._failures(scan)
        usable = [index for index in range(len(scan)) if index not in failures]
        if usable:
            origin = np.quantile(scan.sensors[usable], 0.5, axis=0, method="lower")
            distant = np.linalg.norm(scan.sensors - origin, axis=1) > self._limits.spread
            for index in np.flatnonzero(distant):
                failures.setdefault(int(index), self._apart())
            usable = [index for index in usable if index not in failures]
        if not usable:
            raise _none_usable(failures)
        near = scan.near(origin, np.array(usable))
        timing.lap("decode")
        cost = cost_of_describing(near.points, near.counts, self.manifest.neighborhood)
        check_cost(besides + cost, self._limits.cost_seconds)
        inputs = self._extractor.prepare(near, lap=timing.lap)
        timing.lap("voxelise")  # what is left of the steps before the network
        return Prepared(
            inputs=inputs,
            usable=np.array(usable),
            # Rounding must not take a mean beyond the points' own limit.
            centroids=np.clip(near.centroids() + origin, -COORDINATE_LIMIT, COORDINATE_LIMIT),
            failures=failures,
            cost=cost,
            dropped_points=int(scan.dropped.sum()),
        )

    def _check_amount(self, scan: Scan) -> None:
        points = len(scan.points) + int(scan.dropped.sum())
        for kind, amount, limit in (
            ("segments", len(scan), self._limits.segments),
            ("points", points, self._limits.points),
        ):
            if amount > limit:
                raise Problem(
                    413, f"too-many-{kind}", f"{amount} {kind} in a request; the limit is {limit}."
                )

    def _failures(self, scan: Scan) -> dict[int, Failed]:
        """By index, why a segment cannot be used."""
        limits = self._limits
        failures = {}
        measured = zip(
            scan.counts.tolist(), scan.dropped.tolist(), scan.reaches().tolist(), strict=True
        )
        for index, (count, dropped, reach) in enumerate(measured):
            if count < limits.min_points:
                left_out = f" besides {dropped} non-finite ones" if dropped else ""
                failures[index] = _failed(
                    "too-few-points",
                    f"{count} points{left_out}; a segment needs {limits.min_points} or more.",
                )
            elif count > limits.max_points:
                failures[index] = _failed(
                    "too-many-points",
                    f"{count} points; a segment has {limits.max_points} or fewer.",
                )
            elif reach > limits.reach:
                failures[index] = _failed(
                    "out-of-reach",
                    f"A point is more than {limits.reach:g} m from the sensor: "
                    "are both in one frame, and in metres?",
                )
        return failures

    def _apart(self) -> Failed:
        return _failed(
            "out-of-reach",
            f"The sensor is more than {self._limits.spread:g} m from those of the other segments.",
        )


def _failed(kind: str, detail: str) -> Failed:
    return Failed(error=ItemErrorOut(type=type_of(kind), title=title_of(kind), detail=detail))


def _none_usable(failures: dict[int, Failed]) -> Problem:
    errors = [
        ProblemError(pointer=f"/segments/{index}", detail=failures[index].error.detail)
        for index in sorted(failures)
    ]
    return Problem(
        422, "no-usable-segment", f"No segment can be used. First: {errors[0].detail}", errors
    )
