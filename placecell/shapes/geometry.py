"""Geometry of decoded shapes: points and surfaces in the map's frame."""

import numpy as np

from placecell.core.types import Float32, Float64, Int64
from placecell.shapes.decoder import Shapes, turned

FACES = np.array(
    [
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
        [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
        [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
    ]
)
"""Corners of a voxel's faces toward +x, -x, +y, -y, +z and -z, counter-clockwise from outside."""

DIRECTIONS = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
"""Direction of each face of `FACES`."""


def points_of(shapes: Shapes) -> tuple[Float32, Int64]:
    """Return the centers of all occupied voxels in the map's frame.

    Args:
        shapes: decoded shapes.

    Returns:
        Points, float32 (points, 3), meters; and the segment of each point, int64 (points,),
        ascending.
    """
    owners, *cells = np.nonzero(shapes.occupancy)
    placed = _placed(shapes, owners, np.stack(cells, axis=1).astype(np.float64) + 0.5)
    return placed.astype(np.float32), owners.astype(np.int64)


def mesh_of(shapes: Shapes, index: int) -> tuple[Float32, Int64]:
    """Return the surface of one segment's occupied voxels, in the map's frame.

    Args:
        shapes: decoded shapes.
        index: index of the segment.

    Returns:
        Corners without duplicates, float32 (corners, 3), meters; and triangles, int64
        (triangles, 3), as indices of corners, counter-clockwise from outside.
    """
    filled = np.pad(shapes.occupancy[index], 1)
    cells = np.argwhere(shapes.occupancy[index])
    quads = []
    for corners, direction in zip(FACES, DIRECTIONS, strict=True):
        beside = cells + 1 + direction
        open_cells = cells[~filled[tuple(beside.T)]]
        quads.append(open_cells[:, None] + corners)
    faces = np.concatenate(quads).reshape(-1, 3)
    corners, numbers = np.unique(faces, axis=0, return_inverse=True)
    numbers = numbers.reshape(-1, 4)
    triangles = np.concatenate([numbers[:, [0, 1, 2]], numbers[:, [0, 2, 3]]])
    owners = np.full(len(corners), index)
    placed = _placed(shapes, owners, corners.astype(np.float64))
    return placed.astype(np.float32), triangles.astype(np.int64)


def _placed(shapes: Shapes, owners: Int64, cells: Float64) -> Float64:
    """Return places in the map's frame, (n, 3), of places in the grids, in voxels."""
    middle = np.array(shapes.occupancy.shape[1:]) / 2
    relative = (cells - middle) * shapes.voxel
    return np.asarray(shapes.centers[owners] + turned(relative, shapes.bearings[owners]))
