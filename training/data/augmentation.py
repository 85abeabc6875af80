"""Augmentation: altered copies of segments (paper III-A: rotated copies).

Beyond the paper's rotations, copies lose parts and points, as under occlusion and in sparser views.
They can also lose stripes of elevation, as in the scans of a sensor with fewer beams.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Float64, UInt8
from placecell.descriptors.voxels import voxelize

BEAM_SPACING = (0.8, 4.0)
"""Smallest and largest spacing of the simulated beams, degrees of elevation."""

BEAM_WIDTH = (0.2, 0.6)
"""Smallest and largest share of the spacing that a beam covers.

A capture accumulates scans of a moving sensor, so its beams are wider than those of one scan.
"""

FEWEST_POINTS = 20
"""Segments that would keep fewer points than this keep all of them."""


@dataclass(frozen=True, slots=True)
class Augmentation:
    """Augmentation: largest differences between a copy and its segment.

    Attributes:
        yaw: largest rotation about z in either direction, radians.
        cut_share: share of the copies that lose all points beyond a random vertical plane, 0 to 1.
        cut_most: largest share of the segment's length, along the cut's direction, that is lost.
        drop_most: largest share of points that are dropped at random, 0 to 1.
        beam_share: share of the copies that keep only the points on a few beams, 0 to 1.
    """

    yaw: float = np.radians(20.0)
    cut_share: float = 0.4
    cut_most: float = 0.5
    drop_most: float = 0.4
    beam_share: float = 0.0

    def copies(
        self, segments: Segments, parameters: Parameters, random: np.random.Generator
    ) -> tuple[UInt8, Float32]:
        """Return an altered copy of each segment as input of the network; see `voxelize`."""
        altered = self.segments(segments, random)
        return voxelize(altered, parameters, random.uniform(-self.yaw, self.yaw, len(segments)))

    def segments(
        self, segments: Segments, random: np.random.Generator, *, exactly: bool = False
    ) -> Segments:
        """Return the segments with fewer points.

        Args:
            segments: segments to alter.
            random: random generator.
            exactly: True if each segment loses the largest allowed share.
        """
        keep = self._keep(segments, random, exactly)
        counts = np.add.reduceat(keep, segments.starts, dtype=np.int64)
        return Segments(segments.points[keep], np.cumsum(counts), segments.sensors)

    def _keep(self, segments: Segments, random: np.random.Generator, exactly: bool) -> Bool:
        count = len(segments)
        counts = segments.counts
        # A cut removes the points beyond some share of the length along a horizontal direction.
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
        if self.beam_share > 0:
            keep &= self._on_beams(segments, random)
        # The first point always stays, so that no segment becomes empty.
        keep[segments.starts] = True
        return np.asarray(keep)

    def _on_beams(self, segments: Segments, random: np.random.Generator) -> Bool:
        """Return which points lie on the beams of a sensor with fewer beams, bool (points,).

        All points of a segment do if its copy is not thinned.
        """
        count, owners = len(segments), segments.owners
        closest, farthest = BEAM_SPACING
        spacing = np.exp(random.uniform(np.log(closest), np.log(farthest), count))
        width, phase = random.uniform(*BEAM_WIDTH, count), random.random(count)
        thinned = random.random(count) < self.beam_share
        on_beam = (elevations(segments) / spacing[owners] + phase[owners]) % 1 < width[owners]
        thinned &= np.bincount(owners[on_beam], minlength=count) >= FEWEST_POINTS
        return np.asarray(on_beam | ~thinned[owners])


def elevations(segments: Segments) -> Float64:
    """Return the elevation of each point above the sensor's horizon, degrees, float64 (points,)."""
    offsets = (segments.points - segments.sensors[segments.owners]).astype(np.float64)
    return np.degrees(np.arctan2(offsets[:, 2], np.hypot(offsets[:, 0], offsets[:, 1])))
