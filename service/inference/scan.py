"""Scan: the segments of one request as arrays, before they are described."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from placecell.core.jit import compiled
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """Segments of one request, in float64: a float32 resolves 0.5 m at coordinates of 5,000 km.

    Attributes:
        points: points of all segments, one segment after the other, float64 (n, 3), meters, in the
            request's frame.
        counts: points of each segment, int64 (segments,); may be 0.
        sensors: sensor position of each segment at capture, float64 (segments, 3), meters, in the
            same frame.
        dropped: points of each segment that were not finite and were left out, int64 (segments,).
    """

    points: Float64
    counts: Int64
    sensors: Float64
    dropped: Int64

    def __len__(self) -> int:
        return len(self.counts)

    @classmethod
    def from_clouds(cls, clouds: Sequence[ArrayLike], sensors: ArrayLike) -> Self:
        """Build a scan from one point cloud per segment.

        Args:
            clouds: points of each segment, (n, 3), meters, in one z-up frame.
            sensors: sensor position of each segment, (segments, 3), or one for all, (3,).

        Raises:
            ValueError: there is no cloud, or an array has another shape.
        """
        arrays = [_as_floats(cloud).reshape(-1, 3) for cloud in clouds]
        if not arrays:
            raise ValueError("a scan needs one segment or more")
        counts = np.array([len(cloud) for cloud in arrays], dtype=np.int64)
        positions = np.broadcast_to(np.asarray(sensors, np.float64), (len(arrays), 3))
        points = np.concatenate(arrays, dtype=np.float64)
        return cls.from_points(points, counts, np.array(positions))

    @classmethod
    def from_points(cls, points: Float64, counts: Int64, sensors: Float64) -> Self:
        """Build a scan from the points of all segments; points that are not finite are left out."""
        dropped = np.zeros(len(counts), dtype=np.int64)
        # Over rows, `all` takes ten times as long, and nearly all scans are finite.
        if not np.isfinite(points).all():
            is_finite = np.isfinite(points).all(axis=1)
            owners = np.repeat(np.arange(len(counts)), counts)
            dropped = np.bincount(owners[~is_finite], minlength=len(counts))
            points, counts = points[is_finite], counts - dropped
        return cls(points, counts, sensors, dropped)

    def ranges(self) -> Float64:
        """Return each segment's distance from sensor to farthest point, meters, (segments,)."""
        ranges = np.zeros(len(self))
        _ranges(np.ascontiguousarray(self.points), self.counts, self.sensors, ranges)
        return ranges

    def relative_to(self, origin: Float64, chosen: Int64) -> Segments:
        """Return the chosen segments in float32, relative to a nearby origin (3,)."""
        points = np.empty((len(self.points), 3), dtype=np.float32)
        np.subtract(self.points, origin, out=points, casting="same_kind")
        segments = Segments(
            points,
            np.cumsum(self.counts),
            (self.sensors - origin).astype(np.float32),
        )
        return segments if len(chosen) == len(self) else segments.take(chosen)


def _as_floats(cloud: ArrayLike) -> Float32 | Float64:
    """Return float32 points as they are, all others as float64."""
    if isinstance(cloud, np.ndarray) and cloud.dtype == np.float32:
        return cloud
    return np.asarray(cloud, dtype=np.float64)


@compiled
def _ranges(points: Float64, counts: Int64, sensors: Float64, ranges: Float64) -> None:
    """Fill the distance from the sensor to the farthest point of each segment, (segments,)."""
    first = 0
    for segment in range(len(counts)):
        farthest = 0.0
        for point in range(first, first + counts[segment]):
            x = points[point, 0] - sensors[segment, 0]
            y = points[point, 1] - sensors[segment, 1]
            z = points[point, 2] - sensors[segment, 2]
            farthest = max(farthest, x * x + y * y + z * z)
        ranges[segment] = np.sqrt(farthest)
        first += counts[segment]
