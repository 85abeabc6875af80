"""Local map: accumulated scans in a voxel grid (paper III-A, as in SegMatch)."""

from collections import OrderedDict

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.segments import means_by_key
from placecell.core.types import Float32, Float64
from placecell.datasets import Drive


def in_range(points: Float32, parameters: Parameters) -> Float32:
    """Return the points between minimum and maximum range, float32 (n, 3), in the sensor frame."""
    squared = np.einsum("ij,ij->i", points, points)
    keep = (squared >= parameters.min_range**2) & (squared <= parameters.max_range**2)
    return np.asarray(points[keep])


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

    Each scan is read and transformed to the world frame once. Scans before `first` are not used.
    """

    def __init__(self, drive: Drive, parameters: Parameters, first: int = 0) -> None:
        self.drive = drive
        self.parameters = parameters
        self.first = first
        self._moved: OrderedDict[int, Float32] = OrderedDict()

    def local_map(self, capture: int) -> Float32:
        """Return the local map at a capture, float32 (n, 3), meters, world frame.

        Args:
            capture: index of the capture's scan.
        """
        first = max(self.first, capture - self.parameters.accumulated_scans + 1)
        scans = [self._in_world(index) for index in range(first, capture + 1)]
        points = np.concatenate(scans)
        sensor = self.drive.poses[capture, :3, 3]
        offset = points[:, :2] - sensor[:2].astype(np.float32)
        near = np.einsum("ij,ij->i", offset, offset) <= self.parameters.local_map_radius**2
        return voxel_means(points[near], self.parameters.map_voxel)

    def _in_world(self, index: int) -> Float32:
        if index not in self._moved:
            points = in_range(self.drive.scan(index), self.parameters)
            self._moved[index] = transform(self.drive.poses[index], points)
            while len(self._moved) > self.parameters.accumulated_scans:
                self._moved.popitem(last=False)
        return self._moved[index]


def transform(pose: Float64, points: Float32) -> Float32:
    """Apply a rigid transform (4, 4) to points, float32 (n, 3)."""
    return (points @ pose[:3, :3].T.astype(np.float32) + pose[:3, 3]).astype(np.float32)
