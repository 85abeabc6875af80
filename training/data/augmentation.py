"""Augmentation: what the same segment might have looked like (paper III-A: rotated copies).

Beyond the paper's rotations: cuts and missing points, for occlusion and sparser views.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, UInt8
from placecell.descriptors.voxels import voxelize


@dataclass(frozen=True, slots=True)
class Augmentation:
    """How far a copy may differ from the segment.

    Attributes:
        yaw: largest turn about z, either way, radians.
        cut_share: how many of the copies lose what lies beyond a random vertical plane.
        cut_most: the largest share of the segment's length, in the cut's direction, that it takes.
        drop_most: the largest share of points that go missing at random.
    """

    yaw: float = np.radians(20.0)
    cut_share: float = 0.4
    cut_most: float = 0.5
    drop_most: float = 0.4

    def copies(
        self, segments: Segments, parameters: Parameters, random: np.random.Generator
    ) -> tuple[UInt8, Float32]:
        """One altered copy of each segment, as the network's input (see `voxelize`)."""
        altered = self.segments(segments, random)
        return voxelize(altered, parameters, random.uniform(-self.yaw, self.yaw, len(segments)))

    def segments(
        self, segments: Segments, random: np.random.Generator, *, exactly: bool = False
    ) -> Segments:
        """The same segments with fewer points.

        Args:
            exactly: each loses what it may lose at most.
        """
        keep = self._keep(segments, random, exactly)
        counts = np.add.reduceat(keep, segments.starts, dtype=np.int64)
        return Segments(segments.points[keep], np.cumsum(counts), segments.sensors)

    def _keep(self, segments: Segments, random: np.random.Generator, exactly: bool) -> Bool:
        count = len(segments)
        counts = segments.counts
        # A cut takes the points beyond a share of the way along a random horizontal direction.
        bearing = random.uniform(0, 2 * np.pi, count)
        direction = np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
        along = np.einsum("ij,ij->i", segments.points[:, :2], np.repeat(direction, counts, axis=0))
        lowest = np.minimum.reduceat(along, segments.starts)
        highest = np.maximum.reduceat(along, segments.starts)
        cut = random.uniform(0, self.cut_most, count) * (random.random(count) < self.cut_share)
        if exactly:
            cut = np.full(count, self.cut_most)
        limit = highest - cut * (highest - lowest)
        stays = random.uniform(1 - self.drop_most, 1, count)
        if exactly:
            stays = np.full(count, 1 - self.drop_most)
        keep = (along <= np.repeat(limit, counts)) & (
            random.random(len(along)) < np.repeat(stays, counts)
        )
        # Never an empty segment: its first point stays.
        keep[segments.starts] = True
        return np.asarray(keep)
