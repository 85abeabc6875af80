"""Ground removal, which follows slopes and needs no sensor height.

A height grid of the lowest points is opened morphologically (Zhang et al. 2003, *A progressive
morphological filter for removing nonground measurements*). The opening of an inclined plane is the
plane itself, so slopes remain ground. Objects narrower than the window are removed.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import ndimage

from placecell.core.jit import compiled
from placecell.core.parameters import Parameters
from placecell.core.types import Bool, Float32, Int64


def is_ground(points: Float32, parameters: Parameters, grid: "HeightGrid | None" = None) -> Bool:
    """Return whether each point of a local map is ground, bool (n,).

    Args:
        points: float32 (n, 3), meters, z up within about 5 degrees.
        parameters: cell size, window and clearance.
        grid: height grid of the points, if there is one already.
    """
    if not len(points):
        return np.zeros(0, dtype=bool)
    grid = grid or HeightGrid.of(points, parameters)
    return grid.above_ground(points) < parameters.ground_clearance


@dataclass(frozen=True, eq=False)
class HeightGrid:
    """Heights of a local map in cells, seen from above, with the surfaces below and above.

    Attributes:
        parameters: cell size, window and clearance.
        cells: int64 (n,), cell of each point, counted row by row.
        lowest: float32 (rows, columns), height of the lowest point in each cell, meters; infinite
            if there is none.
        highest: float32 (rows, columns), height of the highest point in each cell, meters; minus
            infinite if there is none.
    """

    parameters: Parameters
    cells: Int64
    lowest: Float32
    highest: Float32

    @classmethod
    def of(cls, points: Float32, parameters: Parameters) -> "HeightGrid":
        """Return the height grid of a local map.

        Args:
            points: float32 (n, 3), meters; at least one.
            parameters: cell size, window and clearance.
        """
        cells, lowest, highest = _height_grid(
            np.ascontiguousarray(points), np.float32(parameters.ground_cell)
        )
        return cls(parameters, cells, lowest, highest)

    @cached_property
    def ground(self) -> Float32:
        """Ground height of each cell, float32 (rows, columns), meters."""
        return surface_below(self.lowest.ravel()[self._nearest], self.parameters)

    @cached_property
    def ceiling(self) -> Float32:
        """Height of the surface above each cell, float32 (rows, columns), meters."""
        return -surface_below(-self.highest.ravel()[self._nearest], self.parameters)

    @cached_property
    def _nearest(self) -> Int64:
        """Nearest cell with a point of each cell, int64 (rows, columns)."""
        row, column = ndimage.distance_transform_edt(
            ~np.isfinite(self.lowest), return_distances=False, return_indices=True
        )
        return np.asarray(row.astype(np.int64) * self.lowest.shape[1] + column)

    def above_ground(self, points: Float32) -> Float32:
        """Return the height of each of the grid's points above the ground, float32 (n,)."""
        return np.asarray(points[:, 2] - self.ground.ravel()[self.cells])


@compiled
def _height_grid(points: Float32, size: np.float32) -> tuple[Int64, Float32, Float32]:
    """Return the cell of each point, and the lowest and the highest height in each cell."""
    count = len(points)
    rows, columns = np.empty(count, np.int64), np.empty(count, np.int64)
    for point in range(count):
        rows[point] = np.int64(np.floor(points[point, 0] / size))
        columns[point] = np.int64(np.floor(points[point, 1] / size))
    row, column = rows.min(), columns.min()
    height, width = rows.max() - row + 1, columns.max() - column + 1
    lowest = np.full(height * width, np.inf, np.float32)
    highest = np.full(height * width, -np.inf, np.float32)
    for point in range(count):
        cell = (rows[point] - row) * width + columns[point] - column
        rows[point] = cell
        lowest[cell] = min(lowest[cell], points[point, 2])
        highest[cell] = max(highest[cell], points[point, 2])
    return rows, lowest.reshape((height, width)), highest.reshape((height, width))


def surface_below(filled: Float32, parameters: Parameters) -> Float32:
    """Return the surface below the lowest points, float32 (rows, columns), meters.

    Args:
        filled: float32 (rows, columns), lowest point of each cell, or of the nearest cell that has
            points.
        parameters: cell size, window and clearance.
    """
    # A reflection below the ground would lower the whole window. So a cell much lower than the
    # third lowest of the 25 cells around it is raised to that height.
    third_lowest = third_lowest_around(filled)
    filled = np.where(filled < third_lowest - parameters.ground_clearance, third_lowest, filled)
    reach = round(parameters.ground_window / parameters.ground_cell / 2)
    padded = (
        np.pad(filled, 2 * reach, mode="reflect", reflect_type="odd")
        if min(filled.shape) > 2 * reach
        else np.pad(filled, 2 * reach, mode="edge")
    )
    eroded = lowest_in_disk(padded, reach)
    return -lowest_in_disk(-eroded, reach)


@compiled
def third_lowest_around(heights: Float32) -> Float32:
    """Return the third lowest height of the 25 cells around each cell, float32 (rows, columns).

    Cells beyond the border have the height of the nearest cell.

    Args:
        heights: float32 (rows, columns).
    """
    rows, columns = heights.shape
    third = np.empty((rows, columns), np.float32)
    for row in range(rows):
        for column in range(columns):
            a = b = c = np.float32(np.inf)  # the three lowest
            for i in range(row - 2, row + 3):
                for j in range(column - 2, column + 3):
                    height = heights[min(max(i, 0), rows - 1), min(max(j, 0), columns - 1)]
                    c = min(c, max(b, height))
                    b = min(b, max(a, height))
                    a = min(a, height)
            third[row, column] = c
    return third


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
