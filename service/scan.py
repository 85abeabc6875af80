"""A request's segments, before anything is done with them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from segments.segments import Segments
from segments.types import Float64, Int64
from service.packed_schemas import PackedSegment
from service.schemas import Point, SegmentIn


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """The segments of a request, whichever encoding they came in.

    In float64: a float32 is 0.5 m coarse at map coordinates of 5,000 km.

    Attributes:
        points: of the segments, one after the other, float64 (n, 3), metres, in the request's
            frame.
        counts: int64 (segments,), points of each; a segment may have none.
        sensors: float64 (segments, 3), metres, the same frame: where the sensor was at capture.
    """

    points: Float64
    counts: Int64
    sensors: Float64

    def __len__(self) -> int:
        return len(self.counts)

    @classmethod
    def of(
        cls, segments: Sequence[SegmentIn] | Sequence[PackedSegment], origin: Point | None
    ) -> Self:
        """From a request's segments, relative to its origin if it has one."""
        shift = np.array(origin or (0.0, 0.0, 0.0))
        clouds = [np.asarray(each.points).reshape(-1, 3) for each in segments]
        return cls(
            np.concatenate(clouds, dtype=np.float64) + shift,
            np.array([len(cloud) for cloud in clouds]),
            np.array([each.sensor for each in segments], np.float64) + shift,
        )

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
