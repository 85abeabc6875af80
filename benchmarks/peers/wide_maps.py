"""Wide local maps: all returns up to 100 m over a length of travel, for peers made for them.

Our segmentation accumulates the last ten scans within 40 m. MapClosures and KISS-SLAM are made for
local maps of 100 m of travel, KISS-Matcher's loops for submaps of eleven keyframes at 1.5 m. A
query's local map reaches back only: it holds nothing that the robot has not yet seen. A local map
of the map reaches back and ahead. Both end where the stretch ends.
"""

from collections import OrderedDict
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Float64, Int64
from placecell.datasets import Drive
from placecell.segmentation.local_map import transform, voxel_means

SCAN_SPACING = 0.5
"""Least distance between two scans of a wide local map, meters; the capture's own scan counts."""

VOXEL = 0.2
"""Voxel size of wide local maps, meters. It is below the voxel sizes that the peers use."""

MIN_RANGE = 3.0
"""Returns nearer to the sensor are the vehicle itself, meters."""


@dataclass(frozen=True, slots=True)
class WideMaps:
    """Kind of wide local maps.

    Attributes:
        length: distance of travel that a local map covers, meters.
        reach: largest distance of a return from its sensor, meters.
        apart: least distance between two local maps of the map, meters; 0: one per capture.
    """

    length: float
    reach: float
    apart: float


WIDE = {
    "submap": WideMaps(length=16.5, reach=100.0, apart=0.0),
    "long": WideMaps(length=100.0, reach=100.0, apart=10.0),
}
"""Kinds of wide local maps: KISS-Matcher's submap, and the local map of MapClosures."""


class WideAccumulator:
    """Accumulator of scans into wide local maps of one stretch of a drive."""

    def __init__(self, drive: Drive, scans: range, kind: WideMaps) -> None:
        self.drive = drive
        self.scans = scans
        self.kind = kind
        self.along = traveled(drive.poses)
        self._moved: OrderedDict[int, Float32] = OrderedDict()

    def local_map(self, capture: int, *, ahead: bool) -> Float32:
        """Return the wide local map at a capture, float32 (n, 3), meters, world frame.

        Args:
            capture: index of the capture's scan.
            ahead: whether the local map also holds scans after the capture, as in a map.
        """
        chosen = self.scans_of(capture, ahead=ahead)
        return voxel_means(np.concatenate([self._in_world(scan) for scan in chosen]), VOXEL)

    def scans_of(self, capture: int, *, ahead: bool) -> list[int]:
        """Return the scans of the local map at a capture, in order."""
        here, length = self.along[capture], self.kind.length
        first, last = (here - length / 2, here + length / 2) if ahead else (here - length, here)
        chosen = [capture]
        for scan in range(capture - 1, self.scans.start - 1, -1):
            if self.along[scan] < first:
                break
            if self.along[chosen[-1]] - self.along[scan] >= SCAN_SPACING:
                chosen.append(scan)
        chosen.reverse()
        for scan in range(capture + 1, self.scans.stop) if ahead else ():
            if self.along[scan] > last:
                break
            if self.along[scan] - self.along[chosen[-1]] >= SCAN_SPACING:
                chosen.append(scan)
        return chosen

    def _in_world(self, scan: int) -> Float32:
        if scan not in self._moved:
            points = self.drive.scan(scan)
            squared = np.einsum("ij,ij->i", points, points)
            points = points[(squared >= MIN_RANGE**2) & (squared <= self.kind.reach**2)]
            self._moved[scan] = voxel_means(transform(self.drive.poses[scan], points), VOXEL)
            while len(self._moved) > 2 * self.kind.length / SCAN_SPACING:
                self._moved.popitem(last=False)
        return self._moved[scan]


def traveled(poses: Float64) -> Float64:
    """Return the distance of travel at each pose, float64 (n,), meters."""
    steps = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def apart_from(positions: Float64, meters: float) -> Int64:
    """Return the indices of positions at least `meters` of travel after the one chosen before.

    The last position is chosen as well, so that the local maps cover the whole stretch.

    Args:
        positions: distance of travel at each position, float64 (n,), ascending.
        meters: least distance.
    """
    chosen = [0]
    for index in range(1, len(positions)):
        if positions[index] - positions[chosen[-1]] >= meters:
            chosen.append(index)
    if chosen[-1] != len(positions) - 1:
        chosen.append(len(positions) - 1)
    return np.array(chosen)
