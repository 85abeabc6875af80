"""Segments: the point clouds of many segments, stored in columns."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from placecell.core.jit import compiled
from placecell.core.types import Float32, Float64, Int64, UInt8


def means_by_key(points: Float32, keys: Int64) -> tuple[Float64, Int64]:
    """Return the mean of the points that share a key, for each key in ascending order.

    Args:
        points: float32 (n, 3).
        keys: int64 (n,), none negative.

    Returns:
        Means, float64 (keys, 3), and the index of each key's first point, int64 (keys,).
    """
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    sums = np.add.reduceat(points[order].astype(np.float64), first, axis=0)
    counts = np.diff(first, append=len(order))
    return sums / counts[:, None], order[first]


@dataclass(frozen=True)
class Segments:
    """Point clouds of segments, concatenated.

    Attributes:
        points: float32 (points, 3), meters, in one z-up frame.
        ends: int64 (segments,): segment i holds points ends[i - 1] to ends[i] - 1.
        sensors: float32 (segments, 3), meters, sensor position at capture in the same frame.
    """

    points: Float32
    ends: Int64
    sensors: Float32

    def __len__(self) -> int:
        return len(self.ends)

    def __repr__(self) -> str:
        return f"Segments({len(self):,} segments, {len(self.points):,} points)"

    @classmethod
    def of(cls, clouds: Sequence[Float32], sensors: Float32 | Float64) -> "Segments":
        """Build segments from one cloud (n, 3) each and the sensor positions (segments, 3)."""
        counts = np.array([len(cloud) for cloud in clouds], dtype=np.int64)
        points = np.concatenate(clouds) if len(clouds) else np.zeros((0, 3))
        return cls(
            points=np.ascontiguousarray(points, dtype=np.float32),
            ends=np.cumsum(counts, dtype=np.int64),
            sensors=np.ascontiguousarray(sensors, dtype=np.float32).reshape(-1, 3),
        )

    @classmethod
    def concatenate(cls, parts: "Sequence[Segments]") -> "Segments":
        """Concatenate several sets of segments."""
        if not parts:
            return cls.of([], np.zeros((0, 3)))
        shifts = np.cumsum([0] + [len(part.points) for part in parts[:-1]])
        return cls(
            np.concatenate([part.points for part in parts]),
            np.concatenate([part.ends + shift for part, shift in zip(parts, shifts, strict=True)]),
            np.concatenate([part.sensors for part in parts]),
        )

    @property
    def starts(self) -> Int64:
        """Index of each segment's first point, int64 (segments,)."""
        return np.concatenate([np.zeros(1, dtype=np.int64), self.ends])[:-1]

    @property
    def counts(self) -> Int64:
        """Number of points of each segment, int64 (segments,)."""
        return self.ends - self.starts

    @property
    def owners(self) -> Int64:
        """Index of the segment of each point, int64 (points,)."""
        return np.repeat(np.arange(len(self)), self.counts)

    def cloud(self, index: int) -> Float32:
        """Return the points of one segment, float32 (n, 3)."""
        return self.points[self.ends[index - 1] if index else 0 : self.ends[index]]

    def take(self, indices: Int64 | Sequence[int]) -> "Segments":
        """Return the segments at these indices, in this order.

        Raises:
            TypeError: `indices` is a mask.
        """
        chosen = np.asarray(indices)
        if chosen.dtype == bool:
            raise TypeError("take indices, not a mask: use numpy.flatnonzero")
        chosen = chosen.astype(np.int64)
        counts = self.counts[chosen]
        ends = np.cumsum(counts, dtype=np.int64)
        within = np.arange(counts.sum()) - np.repeat(ends - counts, counts)
        rows = np.repeat(self.starts[chosen], counts) + within
        return Segments(self.points[rows], ends, self.sensors[chosen])

    def check_ends(self) -> None:
        """Check that `ends` divides the points, before compiled code reads them unchecked.

        Raises:
            ValueError: A segment has no points, or a point belongs to no segment.
        """
        total = self.ends[-1] if len(self) else 0
        if total != len(self.points) or (self.counts <= 0).any():
            raise ValueError(f"ends do not divide the {len(self.points)} points into segments")

    def centroids(self) -> Float64:
        """Return the mean of each segment's points, float64 (segments, 3), meters.

        The means are computed once; do not change the array.
        """
        return self._means

    @cached_property
    def _means(self) -> Float64:
        means = np.empty((len(self), 3))
        self.check_ends()
        _centroids(np.ascontiguousarray(self.points), self.ends, means)
        return means

    def bounds(self) -> tuple[Float32, Float32]:
        """Return the lowest and highest corners of each bounding box, float32 (segments, 3)."""
        if not len(self):
            return np.zeros((0, 3), np.float32), np.zeros((0, 3), np.float32)
        return (
            np.minimum.reduceat(self.points, self.starts, axis=0),
            np.maximum.reduceat(self.points, self.starts, axis=0),
        )


@compiled
def _centroids(points: Float32, ends: Int64, centroids: Float64) -> None:
    start = 0
    for segment in range(len(ends)):
        x = y = z = 0.0
        for point in range(start, ends[segment]):
            x += points[point, 0]
            y += points[point, 1]
            z += points[point, 2]
        count = ends[segment] - start
        centroids[segment, 0] = x / count
        centroids[segment, 1] = y / count
        centroids[segment, 2] = z / count
        start = ends[segment]


def stored_extents(sides: Float32 | Float64) -> UInt8:
    """Return sides of boxes as a map stores them: decimeters, rounded up, 1 to 255.

    Args:
        sides: lengths in meters, any shape.
    """
    return np.ceil(10 * sides).clip(1, 255).astype(np.uint8)
