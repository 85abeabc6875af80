"""Voxelisation: the network's input (paper III-A).

A fixed grid of fixed voxels, centered on the segment; points outside are dropped. (The paper also
says 'scaled to fit'; scaling each segment would lose its size, and 95% fit as they are.)
"""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.parameters import Parameters
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64, UInt8
from placecell.descriptors.orientation import orient


def voxelize(
    segments: Segments, parameters: Parameters, yaw: Float64 | float = 0.0
) -> tuple[UInt8, Float32]:
    """Occupancy grids and extents of aligned segments.

    Args:
        segments: in a common z-up frame.
        yaw: turned by so many radians after alignment (augmentation).

    Returns:
        occupancy, uint8 (segments, *grid), 1 where a voxel holds a point; and extents, float32
        (segments, 3): edges in meters of each aligned segment's box, before points are dropped.
    """
    return voxelize_oriented(orient(segments, yaw), segments.ends, parameters)


def voxelize_oriented(
    oriented: Float32, ends: Int64, parameters: Parameters
) -> tuple[UInt8, Float32]:
    """The same of segments that are aligned already: points, float32 (n, 3), and their ends."""
    occupancy = np.zeros((len(ends), *parameters.grid), dtype=np.uint8)
    extents = np.empty((len(ends), 3), dtype=np.float32)
    _fill(oriented, ends, np.float32(parameters.grid_voxel), occupancy, extents)
    return occupancy, extents


@compiled
def _fill(
    oriented: Float32, ends: Int64, voxel: np.float32, occupancy: UInt8, extents: Float32
) -> None:
    """Mark the voxels that hold a point.

    Models are trained on these roundings: box and distance from its middle in float32, the shift to
    the grid's corner in float64.
    """
    columns, rows, layers = occupancy.shape[1:]
    half_x, half_y, half_z = columns / 2, rows / 2, layers / 2
    half = np.float32(0.5)
    start = 0
    for segment in range(len(ends)):
        low_x = high_x = oriented[start, 0]
        low_y = high_y = oriented[start, 1]
        low_z = high_z = oriented[start, 2]
        for point in range(start + 1, ends[segment]):
            x, y, z = oriented[point, 0], oriented[point, 1], oriented[point, 2]
            low_x, high_x = min(low_x, x), max(high_x, x)
            low_y, high_y = min(low_y, y), max(high_y, y)
            low_z, high_z = min(low_z, z), max(high_z, z)
        extents[segment, 0] = high_x - low_x
        extents[segment, 1] = high_y - low_y
        extents[segment, 2] = high_z - low_z
        middle_x = (low_x + high_x) * half
        middle_y = (low_y + high_y) * half
        middle_z = (low_z + high_z) * half
        for point in range(start, ends[segment]):
            x = np.floor((oriented[point, 0] - middle_x) / voxel + half_x)
            y = np.floor((oriented[point, 1] - middle_y) / voxel + half_y)
            z = np.floor((oriented[point, 2] - middle_z) / voxel + half_z)
            # Compared as floats: a coordinate that is no number is outside.
            if 0 <= x < columns and 0 <= y < rows and 0 <= z < layers:
                occupancy[segment, int(x), int(y), int(z)] = 1
        start = ends[segment]
