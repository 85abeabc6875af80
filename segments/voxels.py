"""Voxelisation: the network's input (paper III-A).

A fixed grid of fixed voxels, centred on the segment; points outside are dropped. (The paper also
says 'scaled to fit'; scaling each segment would lose its size, and 95% fit as they are.)
"""

import numpy as np

from segments.alignment import align
from segments.parameters import Parameters
from segments.segments import Segments
from segments.types import Float32, Float64, UInt8


def voxelise(
    segments: Segments, parameters: Parameters, yaw: Float64 | float = 0.0
) -> tuple[UInt8, Float32]:
    """Occupancy grids and extents of aligned segments.

    Args:
        segments: in a common z-up frame.
        yaw: turned by so many radians after alignment (augmentation).

    Returns:
        occupancy, uint8 (segments, *grid), 1 where a voxel holds a point; and extents, float32
        (segments, 3): edges in metres of each aligned segment's box, before points are dropped.
    """
    size = np.array(parameters.grid)
    occupancy = np.zeros((len(segments), *parameters.grid), dtype=np.uint8)
    if not len(segments):
        return occupancy, np.zeros((0, 3), dtype=np.float32)
    aligned = Segments(align(segments, yaw), segments.ends, segments.sensors)
    lowest, highest = aligned.bounds()
    middle = np.repeat((lowest + highest) / 2, segments.counts, axis=0)
    cells = np.floor((aligned.points - middle) / parameters.grid_voxel + size / 2).astype(np.int64)
    inside = ((cells >= 0) & (cells < size)).all(axis=1)
    occupancy[segments.owners[inside], cells[inside, 0], cells[inside, 1], cells[inside, 2]] = 1
    return occupancy, highest - lowest
