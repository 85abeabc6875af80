"""Removal of what is overhead in a building: ceilings, and walls above doors.

A building's ceiling and the walls above its doors join all rooms of a floor to one region, which is
too large for a segment. A capture is indoors if a large part of its local map is under a ceiling.
The ceiling is found as the ground is, upside down: the highest points, opened morphologically.
Elsewhere nothing is removed.
"""

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.types import Bool, Float32
from placecell.segmentation.ground import grid_cells, ground_surface, lowest_in_cells


def is_overhead(points: Float32, parameters: Parameters) -> Bool:
    """Return whether each point of a local map is overhead in a building, bool (n,).

    Outdoors no point is.

    Args:
        points: float32 (n, 3), meters, z up within about 5 degrees.
        parameters: parameters of ground and ceiling.
    """
    outdoors = np.zeros(len(points), dtype=bool)
    if not len(points):
        return outdoors
    cells = grid_cells(points, parameters)
    highest = -lowest_in_cells(-points[:, 2], cells)
    enough = parameters.ceiling_share * np.isfinite(highest).sum()
    ceiling = -ground_surface(-highest, parameters)
    touching = highest > ceiling - parameters.ground_clearance
    if touching.sum() < enough:
        return outdoors
    ground = ground_surface(lowest_in_cells(points[:, 2], cells), parameters)
    height = ceiling - ground
    covered = (height > parameters.ceiling_lowest) & (height < parameters.ceiling_highest)
    if (touching & covered).sum() < enough:
        return outdoors
    above = points[:, 2] - ground[cells[:, 0], cells[:, 1]]
    return np.asarray(above > parameters.door_height)
