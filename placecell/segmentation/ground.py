"""Ground removal, which follows slopes and needs no sensor height.

A height grid of the lowest points is opened morphologically (Zhang et al. 2003, *A progressive
morphological filter for removing nonground measurements*). The opening of an inclined plane is the
plane itself, so slopes remain ground. Objects narrower than the window are removed.
"""

import numpy as np
from scipy import ndimage

from placecell.core.parameters import Parameters
from placecell.core.types import Bool, Float32, Int64


def is_ground(points: Float32, parameters: Parameters) -> Bool:
    """Return whether each point of a local map is ground, bool (n,).

    Args:
        points: float32 (n, 3), meters, z up within about 5 degrees.
        parameters: cell size, window and clearance.
    """
    if not len(points):
        return np.zeros(0, dtype=bool)
    cells = grid_cells(points, parameters)
    surface = ground_surface(lowest_in_cells(points[:, 2], cells), parameters)
    height = points[:, 2] - surface[cells[:, 0], cells[:, 1]]
    return np.asarray(height < parameters.ground_clearance)


def grid_cells(points: Float32, parameters: Parameters) -> Int64:
    """Return the row and column of each point's cell in the height grid, int64 (n, 2)."""
    cells = np.floor(points[:, :2] / parameters.ground_cell).astype(np.int64)
    return np.asarray(cells - cells.min(axis=0))


def lowest_in_cells(heights: Float32, cells: Int64) -> Float32:
    """Return the smallest height in each cell, float32 (rows, columns); infinite if empty.

    Args:
        heights: float32 (n,), meters.
        cells: int64 (n, 2), row and column of each height.
    """
    lowest = np.full(tuple(cells.max(axis=0) + 1), np.inf, dtype=np.float32)
    np.minimum.at(lowest, (cells[:, 0], cells[:, 1]), heights)
    return lowest


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
    padded = (
        np.pad(filled, 2 * reach, mode="reflect", reflect_type="odd")
        if min(filled.shape) > 2 * reach
        else np.pad(filled, 2 * reach, mode="edge")
    )
    eroded = lowest_in_disk(padded, reach)
    return -lowest_in_disk(-eroded, reach)


def lowest_in_disk(heights: Float32, reach: int) -> Float32:
    """Return the minimum over the disk around each cell, float32 (rows - 2 r, columns - 2 r).

    A disk is a union of runs, one a row. So the minimum over the disk is the minimum of one-way
    minima, each over a run of columns: some 60 passes over the grid in place of one comparison for
    each of the disk's 700 cells.

    Args:
        heights: float32 (rows, columns), more than 2 r each.
        reach: radius of the disk, cells.
    """
    rows, columns = (size - 2 * reach for size in heights.shape)
    lowest = np.full((rows, columns), np.inf, dtype=np.float32)
    run = heights[:, reach : reach + columns]
    for half in range(reach + 1):
        if half:
            left, right = reach - half, reach + half
            run = np.minimum(run, heights[:, left : left + columns])
            run = np.minimum(run, heights[:, right : right + columns])
        # The rows of the disk whose run is 2 half + 1 cells wide.
        for row in range(-reach, reach + 1):
            if half * half + row * row <= reach * reach < (half + 1) ** 2 + row * row:
                np.minimum(lowest, run[reach + row : reach + row + rows], out=lowest)
    return lowest
