"""Describer: turns the segments of a scan into descriptors, with one model.

Segments that cannot be described are left out, each with the reason.
"""

from dataclasses import dataclass, replace
from typing import Self

import anyio.to_thread
import numpy as np
from placecell_client.maps.compact_map import COORDINATE_LIMIT

from placecell.core.segment_classes import UNKNOWN, ClassFilter, class_names
from placecell.core.types import Float32, Float64, Int8, Int64, UInt8
from placecell.descriptors.extractor import Extractor, Inputs, network_inputs
from placecell.descriptors.manifest import Manifest
from service.core.cost import NOTHING, Cost, check_cost, cost_of_describing
from service.core.metrics import Metrics
from service.core.problems import Problem, ProblemError
from service.core.settings import Limits
from service.core.timing import Timing
from service.inference.batcher import Batcher
from service.inference.scan import Scan


@dataclass(frozen=True, slots=True)
class SegmentError:
    """Reason why one segment of a request has no descriptor.

    Attributes:
        kind: kind of problem, such as `too-few-points`.
        detail: what is wrong with the segment.
    """

    kind: str
    detail: str


@dataclass(frozen=True, slots=True, eq=False)
class PreparedScan:
    """Scan prepared for one model.

    Attributes:
        inputs: the network's inputs, one row per usable segment.
        usable: indices of these segments in the scan, int64 (rows,).
        centroids: their centroids, float64 (rows, 3), meters, in the request's frame.
        heights: heights of their boxes, float64 (rows,), meters.
        errors: reason for each other segment, by index in the scan.
        cost: cost of describing the segments.
        dropped_points: points of the scan that were not finite and were left out.
        classified: whether the request needs the classes of the segments, and the model tells them.
    """

    inputs: Inputs
    usable: Int64
    centroids: Float64
    heights: Float64
    errors: dict[int, SegmentError]
    cost: Cost
    dropped_points: int = 0
    classified: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Descriptors:
    """Descriptors of n segments, made by one model.

    Attributes:
        model_id: id of the model.
        codes: stored form of the descriptors, int8 (n, code bytes); 0 where there is an error.
        values: descriptors before quantization, float32 (n, d), NaN where there is an error; None
            if only codes are known.
        centroids: centroids of the segments, float64 (n, 3), meters, in the request's frame, NaN
            where there is an error; None if they are not known.
        errors: reason for each segment without a descriptor, by index.
        dropped_points: points of the request that were not finite and were left out.
        classes: class of each segment as `segment_classes` packs it, uint8 (n,); None if the model
            has no semantic head, or the request states no classes.
        heights: heights of the segments' boxes, float64 (n,), meters, NaN where there is an error;
            None if they are not known.
    """

    model_id: str
    codes: Int8
    values: Float32 | None
    centroids: Float64 | None
    errors: dict[int, SegmentError]
    dropped_points: int = 0
    classes: UInt8 | None = None
    heights: Float64 | None = None

    def __len__(self) -> int:
        return len(self.codes)

    def __repr__(self) -> str:
        return f"Descriptors({len(self):,} segments, {len(self.errors)} errors, {self.model_id})"

    @property
    def usable(self) -> Int64:
        """Return the indices of the segments that have a descriptor, int64, ascending."""
        has_descriptor = np.ones(len(self), dtype=bool)
        has_descriptor[list(self.errors)] = False
        return np.flatnonzero(has_descriptor)

    def searched(self, wanted: ClassFilter | None) -> Self:
        """Return the descriptors without the segments of classes that a request leaves out."""
        if wanted is None or self.classes is None:
            return self
        left_out = np.flatnonzero(~wanted.keeps_query(self.classes))
        names = class_names(self.classes[left_out])
        errors = {
            index: SegmentError(
                "ignored-class", f"The segment has the class {name}, which the request leaves out."
            )
            for index, name in zip(left_out.tolist(), names, strict=True)
        }
        return replace(self, errors=errors | self.errors)

    @classmethod
    def of_usable(
        cls,
        manifest: Manifest,
        values: Float32,
        centroids: Float64,
        errors: dict[int, SegmentError],
        dropped_points: int,
        classes: UInt8 | None = None,
        heights: Float64 | None = None,
    ) -> Self:
        """Build from the segments that have a descriptor, in order, and the errors of the others.

        Args:
            manifest: manifest of the model.
            values: descriptors, float32 (rows, d).
            centroids: float64 (rows, 3).
            errors: by index of the segment.
            dropped_points: points that were left out.
            classes: uint8 (rows,).
            heights: float64 (rows,).
        """
        codes = manifest.quantizer.encode(values)
        if errors:
            count = len(values) + len(errors)
            usable = np.setdiff1d(np.arange(count), list(errors))
            codes = _spread(codes, usable, count, 0)
            values = _spread(values, usable, count, np.nan)
            centroids = _spread(centroids, usable, count, np.nan)
            classes = None if classes is None else _spread(classes, usable, count, UNKNOWN)
            heights = None if heights is None else _spread(heights, usable, count, np.nan)
        return cls(
            manifest.model_id, codes, values, centroids, errors, dropped_points, classes, heights
        )


class Describer:
    """Describes the segments of scans with one model."""

    def __init__(self, extractor: Extractor, limits: Limits, metrics: Metrics) -> None:
        self.manifest = extractor.manifest
        self._extractor = extractor
        self._limits = limits
        self._batcher = Batcher(extractor, metrics, limits.batch)

    def prepare(
        self, scan: Scan, timing: Timing, besides: Cost = NOTHING, classified: bool = True
    ) -> PreparedScan:
        """Prepare the network's inputs for the segments of a scan.

        Args:
            scan: the segments.
            timing: stopwatch of the request.
            besides: cost of the request's other work.
            classified: whether the request needs the classes of the segments.

        Raises:
            Problem: 413 if there are too many segments or points, or they are too much work; 422 if
                no segment can be described.
        """
        self._check_amount(scan)
        errors = self._errors(scan)
        usable = [index for index in range(len(scan)) if index not in errors]
        if usable:
            origin = np.quantile(scan.sensors[usable], 0.5, axis=0, method="lower")
            is_distant = np.linalg.norm(scan.sensors - origin, axis=1) > self._limits.spread
            for index in np.flatnonzero(is_distant).tolist():
                errors.setdefault(index, self._distant_sensor())
            usable = [index for index in usable if index not in errors]
        if not usable:
            raise _none_usable(errors)
        segments = scan.relative_to(origin, np.array(usable))
        timing.lap("decode")
        cost = cost_of_describing(segments.points, segments.counts, self.manifest.neighborhood)
        check_cost(besides + cost, self._limits.cost_seconds)
        inputs = self._extractor.prepare(segments, lap=timing.lap, classified=classified)
        timing.lap("voxelise")  # the rest of the steps before the network
        # Rounding must not move a centroid beyond the limit of the points' coordinates.
        centroids = np.clip(segments.centroids() + origin, -COORDINATE_LIMIT, COORDINATE_LIMIT)
        low, high = segments.bounds()
        return PreparedScan(
            inputs=inputs,
            usable=np.array(usable),
            centroids=centroids,
            heights=(high - low)[:, 2].astype(np.float64),
            errors=errors,
            cost=cost,
            dropped_points=int(scan.dropped.sum()),
            classified=classified and self._extractor.has_classes,
        )

    async def describe(self, prepared: PreparedScan, timing: Timing) -> Descriptors:
        """Describe a prepared scan, in batches with the segments of other requests.

        Raises:
            Problem: 422 if no descriptor is finite.
        """
        values = await self._batcher.infer(network_inputs(prepared.inputs), timing)
        if not prepared.classified:
            return self._described(prepared, values, None)
        classes = await anyio.to_thread.run_sync(self._extractor.classify, prepared.inputs, values)
        timing.lap("infer")
        return self._described(prepared, values, classes)

    def describe_alone(self, prepared: PreparedScan) -> Descriptors:
        """Describe a prepared scan in this thread, without an event loop; raises as `describe`."""
        inputs, classes = prepared.inputs, None
        values = self._extractor.infer(inputs)
        if prepared.classified:
            classes = self._extractor.classify(inputs, values)
        return self._described(prepared, values, classes)

    def _described(
        self, prepared: PreparedScan, values: Float32, classes: UInt8 | None
    ) -> Descriptors:
        is_finite = np.isfinite(values).all(axis=1)
        errors = prepared.errors | {
            index: SegmentError("not-describable", "The model's descriptor is not finite.")
            for index in prepared.usable[~is_finite].tolist()
        }
        if not is_finite.any():
            raise _none_usable(errors)
        return Descriptors.of_usable(
            manifest=self.manifest,
            values=values[is_finite],
            centroids=prepared.centroids[is_finite],
            errors=errors,
            dropped_points=prepared.dropped_points,
            classes=None if classes is None else classes[is_finite],
            heights=prepared.heights[is_finite],
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

    def _errors(self, scan: Scan) -> dict[int, SegmentError]:
        """Return the reason for each segment that cannot be described, by index."""
        limits = self._limits
        errors = {}
        measured = zip(
            scan.counts.tolist(), scan.dropped.tolist(), scan.ranges().tolist(), strict=True
        )
        for index, (count, dropped, distance) in enumerate(measured):
            if count < limits.min_points:
                left_out = f" and {dropped} non-finite points" if dropped else ""
                errors[index] = SegmentError(
                    "too-few-points",
                    f"The segment has {count} points{left_out}; "
                    f"the minimum is {limits.min_points}.",
                )
            elif count > limits.max_points:
                errors[index] = SegmentError(
                    "too-many-points",
                    f"The segment has {count} points; the maximum is {limits.max_points}.",
                )
            elif distance > limits.reach:
                errors[index] = SegmentError(
                    "out-of-reach",
                    f"A point is more than {limits.reach:g} m from the sensor. Check that points "
                    "and sensor are in one frame and in meters.",
                )
        return errors

    def _distant_sensor(self) -> SegmentError:
        return SegmentError(
            "out-of-reach",
            f"The sensor is more than {self._limits.spread:g} m from the sensors of the other "
            "segments.",
        )


def _spread(rows: np.ndarray, at: Int64, count: int, empty: float) -> np.ndarray:
    """Return an array of `count` rows with these rows at some indices and `empty` elsewhere."""
    spread = np.full((count, *rows.shape[1:]), empty, dtype=rows.dtype)
    spread[at] = rows
    return spread


def _none_usable(errors: dict[int, SegmentError]) -> Problem:
    listed = [
        ProblemError(pointer=f"/segments/{index}", detail=errors[index].detail)
        for index in sorted(errors)
    ]
    return Problem(
        422,
        "no-usable-segment",
        f"No segment can be described. The first reason: {listed[0].detail}",
        listed,
    )
