"""Removal of what is overhead in a building: ceilings, and walls above doors.

A building's ceiling and the walls above its doors join all rooms of a floor to one region, which is
too large for a segment. A capture is indoors if a large part of its local map is under a ceiling.
The ceiling is found as the ground is, upside down: the highest points, opened morphologically.
Elsewhere nothing is removed.
"""

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.types import Bool, Float32
from placecell.segmentation.ground import HeightGrid

ROUNDING = 0.1
"""Tolerance of the first test for a ceiling, meters: more than float32 rounds at 500 km."""


def is_overhead(points: Float32, parameters: Parameters, grid: HeightGrid | None = None) -> Bool:
    """Return whether each point of a local map is overhead in a building, bool (n,).

    Outdoors no point is.

    Args:
        points: float32 (n, 3), meters, z up within about 5 degrees.
        parameters: parameters of ground and ceiling.
        grid: height grid of the points, if there is one already.
    """
    if not len(points):
        return np.zeros(0, dtype=bool)
    grid = grid or HeightGrid.of(points, parameters)
    if not is_indoors(grid):
        return np.zeros(len(points), dtype=bool)
    return grid.above_ground(points) > parameters.door_height


def is_indoors(grid: HeightGrid) -> bool:
    """Return whether a large part of a local map is under a ceiling."""
    parameters = grid.parameters
    enough = parameters.ceiling_share * np.isfinite(grid.highest).sum()
    # Below a ceiling, the highest point is high above the ground. Mostly this tells the outdoors.
    lowest_touching = parameters.ceiling_lowest - parameters.ground_clearance - ROUNDING
    if (grid.highest - grid.ground > lowest_touching).sum() < enough:
        return False
    touching = grid.highest > grid.ceiling - parameters.ground_clearance
    height = grid.ceiling - grid.ground
    covered = (height > parameters.ceiling_lowest) & (height < parameters.ceiling_highest)
    return bool((touching & covered).sum() >= enough)
