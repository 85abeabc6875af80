"""A request's segments, before anything is done with them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np
from numpy.typing import ArrayLike
from placecell_client.maps.compact_map import COORDINATE_LIMIT

from placecell.core.segments import Segments
from placecell.core.types import Float64, Int64
from service.api.schemas.recognition import Point
from service.core.problems import Problem, ProblemError


class HasPoints(Protocol):
    """A segment of a request, in any encoding."""

    @property
    def points(self) -> ArrayLike:
        """Return the points, (n, 3)."""

    @property
    def sensor(self) -> Point:
        """Return the sensor position."""


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """Segments of a request, in any encoding, as float64 arrays.

    In float64: a float32 is 0.5 m coarse at map coordinates of 5,000 km.

    Attributes:
        points: of the segments, one after the other, float64 (n, 3), metres, in the request's
            frame.
        counts: int64 (segments,), points of each; a segment may have none.
        sensors: float64 (segments, 3), metres, the same frame: where the sensor was at capture.
        dropped: int64 (segments,), points of each that were not finite and were left out.
    """

    points: Float64
    counts: Int64
    sensors: Float64
    dropped: Int64

    def __len__(self) -> int:
        return len(self.counts)

    @classmethod
    def of(cls, segments: Sequence[HasPoints], origin: Point | None) -> Self:
        """Build from a request's segments, relative to its origin if it has one.

        Raises:
            Problem: 422 if a point or sensor is too far from the frame's origin.
        """
        shift = np.array(origin or (0.0, 0.0, 0.0))
        clouds = [np.asarray(each.points).reshape(-1, 3) for each in segments]
        counts = np.array([len(cloud) for cloud in clouds])
        points = np.concatenate(clouds, dtype=np.float64)
        sensors = np.array([each.sensor for each in segments], np.float64)
        dropped = np.zeros(len(clouds), dtype=np.int64)
        good = np.isfinite(points).all(axis=1)
        if origin is not None:
            points += shift
            sensors += shift
            _check_sums(points, sensors, counts)
        if not good.all():
            owners = np.repeat(np.arange(len(clouds)), counts)
            dropped = np.bincount(owners[~good], minlength=len(clouds))
            points, counts = points[good], counts - dropped
        return cls(points, counts, sensors, dropped)

    def reaches(self) -> Float64:
        """Of each segment, metres from its sensor to its farthest point, float64 (segments,)."""
        apart = self.points - np.repeat(self.sensors, self.counts, axis=0)
        squared = np.einsum("ij,ij->i", apart, apart)
        some = self.counts > 0
        starts = (np.cumsum(self.counts) - self.counts)[some]
        found = np.zeros(len(self))
        found[some] = np.sqrt(np.maximum.reduceat(squared, starts)) if len(starts) else 0.0
        return found

    def near(self, origin: Float64, chosen: Int64) -> Segments:
        """Some of the segments, relative to a point that is not far from them."""
        every = Segments(
            (self.points - origin).astype(np.float32),
            np.cumsum(self.counts),
            (self.sensors - origin).astype(np.float32),
        )
        return every if len(chosen) == len(self) else every.take(chosen)


def _check_sums(points: Float64, sensors: Float64, counts: Int64) -> None:
    """Refuse coordinates that exceed the limit only with the origin added.

    Raises:
        Problem: 422 with the first place.
    """
    far = np.abs(points) > COORDINATE_LIMIT  # not where a point is NaN
    if far.any():
        row, axis = np.argwhere(far)[0].tolist()
        segment = int(np.searchsorted(np.cumsum(counts), row, side="right"))
        point = row - int(counts[:segment].sum())
        raise _too_far(f"/segments/{segment}/points/{point}/{axis}", float(points[row, axis]))
    far = np.abs(sensors) > COORDINATE_LIMIT
    if far.any():
        segment, axis = np.argwhere(far)[0].tolist()
        raise _too_far(f"/segments/{segment}/sensor/{axis}", float(sensors[segment, axis]))


def _too_far(pointer: str, value: float) -> Problem:
    detail = (
        f"The coordinate plus the origin is {value:g} m; the limit is {COORDINATE_LIMIT:g} m. "
        "Check that the origin belongs to these coordinates."
    )
    return Problem(
        422,
        "invalid-request",
        f"{pointer}: {detail}",
        [ProblemError(pointer=pointer, detail=detail)],
    )
