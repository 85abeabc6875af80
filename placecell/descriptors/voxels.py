"""Voxelization: occupancy grids, the network's input (paper III-A).

The grid has a fixed size and is centered on the segment. Points outside are dropped. (The paper
also says "scaled to fit". Scaling would lose a segment's size, and 95% of the segments fit.)

Beyond the paper, a voxel can count how many of its eight parts hold points. Then small segments,
such as posts and bushes, keep more of their shape, and the network is as fast as before.
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
    """Return occupancy grids and extents of oriented segments.

    Args:
        segments: segments in one z-up frame.
        parameters: size of grid and voxels.
        yaw: additional rotation about z after orientation, radians (augmentation).

    Returns:
        Occupancy, uint8 (segments, *grid), number of parts of each voxel that hold a point
        (`Parameters.voxel_parts`); and extents, float32 (segments, 3), edge lengths in meters of
        each oriented segment's bounding box, before points are dropped.
    """
    return voxelize_oriented(orient(segments, yaw), segments.ends, parameters)


def voxelize_oriented(
    oriented: Float32, ends: Int64, parameters: Parameters
) -> tuple[UInt8, Float32]:
    """Return occupancy grids and extents (see `voxelize`) of segments that are oriented already.

    Args:
        oriented: float32 (n, 3), points of all segments (see `orient`).
        ends: int64 (segments,), end of each segment's points.
        parameters: size of grid and voxels.
    """
    occupancy = np.zeros((len(ends), *parameters.grid), dtype=np.uint8)
    extents = np.empty((len(ends), 3), dtype=np.float32)
    halved = parameters.voxel_parts == 2
    _fill(oriented, ends, np.float32(parameters.grid_voxel), halved, occupancy, extents)
    return occupancy, extents


@compiled
def _fill(
    oriented: Float32,
    ends: Int64,
    voxel: np.float32,
    halved: bool,
    occupancy: UInt8,
    extents: Float32,
) -> None:
    """Fill `occupancy` and `extents`. If `halved`, each voxel has 2 x 2 x 2 parts.

    `parts` holds the last segment with a point in each voxel, from 1, and 8 bits of its parts.

    Models are trained with this rounding: the box and the distance from its center in float32, the
    shift to the grid's corner in float64.
    """
    columns, rows, layers = occupancy.shape[1:]
    half_x, half_y, half_z = columns / 2, rows / 2, layers / 2
    half = np.float32(0.5)
    parts = np.zeros(occupancy.shape[1:] if halved else (0, 0, 0), dtype=np.int32)
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
            x = (oriented[point, 0] - middle_x) / voxel + half_x
            y = (oriented[point, 1] - middle_y) / voxel + half_y
            z = (oriented[point, 2] - middle_z) / voxel + half_z
            # Compared as floats, so that a NaN coordinate is outside.
            if not (0 <= x < columns and 0 <= y < rows and 0 <= z < layers):
                continue
            column, row, layer = int(x), int(y), int(z)
            if not halved:
                occupancy[segment, column, row, layer] = 1
                continue
            held = max(parts[column, row, layer], (segment + 1) << 8)
            eighth = 4 * int(x - column >= 0.5) + 2 * int(y - row >= 0.5) + int(z - layer >= 0.5)
            occupancy[segment, column, row, layer] += 1 - ((held >> eighth) & 1)
            parts[column, row, layer] = held | (1 << eighth)
        start = ends[segment]
