"""Region growing on Euclidean distance (paper III-A)."""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.parameters import Parameters
from placecell.core.types import Float32, Int64


def grow_regions(points: Float32, radius: float) -> Int64:
    """Label the connected regions of points. Points within the radius of each other are connected.

    Args:
        points: float32 (n, 3), meters.
        radius: largest distance of connected points, meters.

    Returns:
        int64 (n,), labels from 0, in the order of each region's first point.
    """
    if not len(points):
        return np.zeros(0, dtype=np.int64)
    cells = np.floor(points / radius).astype(np.int64)
    # One empty layer around, so that a neighbor's key never wraps into another column.
    cells -= cells.min(axis=0) - 1
    size = cells.max(axis=0) + 2
    keys = (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]
    order = np.argsort(keys, kind="stable")
    roots = _link(points[order], keys[order], int(size[1]), int(size[2]), radius * radius)
    # Roots are positions in the sorted order. Label each region by its first point instead.
    first = np.full(len(points), len(points), dtype=np.int64)
    np.minimum.at(first, roots, order)
    labels = np.empty(len(points), dtype=np.int64)
    labels[order] = first[roots]
    return np.unique(labels, return_inverse=True)[1].astype(np.int64)


@compiled
def _find(parent: Int64, index: int) -> int:
    while parent[index] != index:
        parent[index] = parent[parent[index]]
        index = parent[index]
    return index


@compiled
def _link(points: Float32, keys: Int64, rows: int, layers: int, squared_radius: float) -> Int64:
    """Return the root of each point's region: union-find over points sorted by cell."""
    count = len(points)
    parent = np.arange(count)
    for row_step in range(-1, 2):
        for column_step in range(-1, 2):
            step = (row_step * rows + column_step) * layers
            if step > 0:
                continue  # each pair of columns is visited once
            low = 0
            for index in range(count):
                lowest = keys[index] + step - 1
                while keys[low] < lowest:
                    low += 1
                other = low
                while other < index and keys[other] <= lowest + 2:
                    dx = points[index, 0] - points[other, 0]
                    dy = points[index, 1] - points[other, 1]
                    dz = points[index, 2] - points[other, 2]
                    if dx * dx + dy * dy + dz * dz <= squared_radius:
                        a = _find(parent, index)
                        b = _find(parent, other)
                        if a != b:
                            parent[max(a, b)] = min(a, b)
                    other += 1
    for index in range(count):
        parent[index] = _find(parent, index)
    return parent


def segment_indices(points: Float32, parameters: Parameters) -> list[Int64]:
    """Return the point indices of each region within the size limits, ordered by first point."""
    labels = grow_regions(points, parameters.growing_radius)
    counts = np.bincount(labels)
    ends = np.cumsum(counts)
    order = np.argsort(labels, kind="stable")
    wanted = (counts >= parameters.min_points) & (counts <= parameters.max_points)
    return [order[ends[label] - counts[label] : ends[label]] for label in np.flatnonzero(wanted)]
