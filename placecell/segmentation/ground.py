"""Ground removal, which follows slopes and needs no sensor height.

A height grid of the lowest points is opened morphologically (Zhang et al. 2003, *A progressive
morphological filter for removing nonground measurements*). The opening of an inclined plane is the
plane itself, so slopes remain ground. Objects narrower than the window are removed.
"""

import numpy as np
from scipy import ndimage

from placecell.core.parameters import Parameters
from placecell.core.types import Bool, Float32


def is_ground(points: Float32, parameters: Parameters) -> Bool:
    """Return whether each point of a local map is ground, bool (n,).

    Args:
        points: float32 (n, 3), meters, z up within about 5 degrees.
        parameters: cell size, window and clearance.
    """
    if not len(points):
        return np.zeros(0, dtype=bool)
    cells = np.floor(points[:, :2] / parameters.ground_cell).astype(np.int64)
    cells -= cells.min(axis=0)
    lowest = np.full(tuple(cells.max(axis=0) + 1), np.inf, dtype=np.float32)
    np.minimum.at(lowest, (cells[:, 0], cells[:, 1]), points[:, 2])
    surface = ground_surface(lowest, parameters)
    height = points[:, 2] - surface[cells[:, 0], cells[:, 1]]
    return np.asarray(height < parameters.ground_clearance)


def ground_surface(lowest: Float32, parameters: Parameters) -> Float32:
    """Return the ground height of each cell, float32 (rows, columns), meters.

    Args:
        lowest: float32 (rows, columns), lowest point of each cell; infinite in an empty cell.
        parameters: cell size, window and clearance.
    """
    empty = ~np.isfinite(lowest)
    nearest = ndimage.distance_transform_edt(empty, return_distances=False, return_indices=True)
    filled = lowest[tuple(nearest)]
    # A reflection below the ground would lower the whole window. So a cell much lower than the
    # third lowest of the 25 cells around it is raised to that height.
    third_lowest = ndimage.rank_filter(filled, rank=2, size=5, mode="nearest")
    filled = np.where(filled < third_lowest - parameters.ground_clearance, third_lowest, filled)
    reach = round(parameters.ground_window / parameters.ground_cell / 2)
    disk = np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) <= reach
    padded = (
        np.pad(filled, 2 * reach, mode="reflect", reflect_type="odd")
        if min(filled.shape) > 2 * reach
        else np.pad(filled, 2 * reach, mode="edge")
    )
    opened = ndimage.grey_opening(padded, footprint=disk)
    inner = opened[2 * reach : -2 * reach, 2 * reach : -2 * reach]
    return np.asarray(inner, dtype=np.float32)
