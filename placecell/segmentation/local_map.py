"""Local map: accumulated scans in a voxel grid (paper III-A, as in SegMatch)."""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.parameters import Parameters
from placecell.core.segments import means_by_key
from placecell.core.types import Float32, Float64
from placecell.datasets import Drive
from placecell.segmentation.voxel_map import VoxelMap

PART = 16_384
"""Number of points that are transformed at once: a matrix library starts no threads for so few,
which would take longer than the product."""


def in_range(points: Float32, parameters: Parameters) -> Float32:
    """Return the points between minimum and maximum range, float32 (n, 3), in the sensor frame."""
    bounds = np.float32(parameters.min_range**2), np.float32(parameters.max_range**2)
    return _in_range(np.ascontiguousarray(points), *bounds)


@compiled
def _in_range(points: Float32, lowest: np.float32, highest: np.float32) -> Float32:
    """Return the points whose squared distance is within the bounds, float32 (n, 3)."""
    kept = np.empty(points.shape, np.float32)
    count = 0
    for point in range(len(points)):
        x, y, z = points[point, 0], points[point, 1], points[point, 2]
        squared = x * x + y * y + z * z
        # Written so, the point is copied without a branch.
        kept[count, 0], kept[count, 1], kept[count, 2] = x, y, z
        count += int((squared >= lowest) & (squared <= highest))
    return kept[:count]


def voxel_means(points: Float32, voxel: float) -> Float32:
    """Return the mean point of each occupied voxel. The grid is aligned with the world frame.

    Args:
        points: float32 (n, 3), meters, world frame.
        voxel: edge length, meters.

    Returns:
        float32 (voxels, 3), ordered by voxel.
    """
    if not len(points):
        return np.zeros((0, 3), dtype=np.float32)
    cells = np.floor(points / voxel).astype(np.int64)
    cells -= cells.min(axis=0)
    size = cells.max(axis=0) + 1
    keys = (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]
    return means_by_key(points, keys)[0].astype(np.float32)


class Accumulator:
    """Accumulator of scans into local maps of a drive's captures.

    Each scan is read and transformed to the world frame once, if captures ascend. Scans before
    `first` are not used.
    """

    def __init__(self, drive: Drive, parameters: Parameters, first: int = 0) -> None:
        self.drive = drive
        self.parameters = parameters
        self.first = first
        self._map = VoxelMap(
            parameters.map_voxel, parameters.local_map_radius, parameters.accumulated_scans
        )
        self._next = first

    def local_map(self, capture: int) -> Float32:
        """Return the local map at a capture, float32 (n, 3), meters, world frame.

        Args:
            capture: index of the capture's scan.
        """
        first = max(self.first, capture - self.parameters.accumulated_scans + 1)
        if not first <= self._next <= capture + 1:
            self._map.clear()
            self._next = first
        while self._next <= capture:
            pose = self.drive.poses[self._next]
            points = in_range(self.drive.scan(self._next), self.parameters)
            self._map.add(transform(pose, points), pose[:3, 3])
            self._next += 1
        return self._map.means.copy()


def transform(pose: Float64, points: Float32) -> Float32:
    """Apply a rigid transform (4, 4) to points, float32 (n, 3)."""
    rotation, translation = pose[:3, :3].T.astype(np.float32), pose[:3, 3]
    moved = np.empty((len(points), 3), dtype=np.float32)
    for first in range(0, len(points), PART):
        part = slice(first, first + PART)
        moved[part] = points[part] @ rotation + translation
    return moved
