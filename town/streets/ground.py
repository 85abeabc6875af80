"""Ground mesh: carriageways, curbs and the raised blocks between them."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np

from placecell.core.types import Bool, Float64, Int64
from town.geometry.mesh import Mesh, Reflectance
from town.streets.plan import CURB_HEIGHT, StreetPlan
from town.streets.terrain import Terrain

GROUND_CELL = 2.0
"""Largest edge length of the mesh's cells, meters. The error of the hills is below 1 mm."""

CURB_WIDTH = 0.02
"""Horizontal width of a curb, meters: nearly vertical, but still a height field."""


@dataclass(frozen=True, slots=True)
class Ground:
    """Height field on a grid that has a line at both edges of every curb.

    The *regions* along an axis with n streets are the rim (0), block 0 (1), street 0 (2), block 1
    (3), and so on to the other rim (2n + 2).

    Attributes:
        terrain: terrain with the height of the ground.
        x, y: positions of the grid lines on the plan, ascending, meters.
        regions_x, regions_y: region of each line.
        raised: bool (2n + 3, 2m + 3), regions that are a curb higher than a carriageway.
    """

    terrain: Terrain
    x: Float64
    y: Float64
    regions_x: Int64
    regions_y: Int64
    raised: Bool

    @classmethod
    def of(cls, plan: StreetPlan, terrain: Terrain, raised: Bool | None = None) -> Self:
        """Build the ground of a town, with all streets of its plan unless `raised` is given."""
        spans_x, spans_y = plan.spans()
        x, y = grid_lines(spans_x), grid_lines(spans_y)
        if raised is None:
            raised = np.zeros((2 * len(spans_x) + 1, 2 * len(spans_y) + 1), dtype=bool)
            raised[1::2, 1::2] = True
        return cls(terrain, x, y, regions(x, spans_x), regions(y, spans_y), raised)

    def mesh(self, columns: slice = slice(None), rows: slice = slice(None)) -> Mesh:
        """Return the mesh of the ground or of a part of it.

        Args:
            columns, rows: lines of the grid. Parts with a common outer line join without a gap.
        """
        x, y = self.x[columns], self.y[rows]
        on_block = self.raised[np.ix_(self.regions_x[columns], self.regions_y[rows])]
        places = self.terrain.bend(np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1))
        height = self.terrain.height(places) + CURB_HEIGHT * on_block
        corners = np.concatenate([places, height[..., None]], axis=-1)
        cells = np.stack(
            [corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]], 2
        )
        paved = on_block[:-1, :-1] & on_block[1:, 1:]
        reflectance = np.where(paved, Reflectance.PAVING, Reflectance.ASPHALT)
        mesh = Mesh.of_quads(cells.reshape(-1, 4, 3), 0.0)
        return Mesh(mesh.triangles, np.repeat(reflectance.ravel(), 2).astype(np.float32))

    def tile(self, column: int, row: int) -> Mesh:
        """Return the mesh of block (column, row) and of the streets east and north of it."""
        return self.mesh(tile_lines(self.regions_x, column), tile_lines(self.regions_y, row))

    def boxes(self) -> Float64:
        """Return lowest and highest x and y of each tile, (columns, rows, 2, 2), town frame."""
        columns, rows = ((side - 1) // 2 for side in self.raised.shape)
        boxes = np.empty((columns, rows, 2, 2))
        for column, row in np.ndindex(columns, rows):
            x, y = (
                self.x[tile_lines(self.regions_x, column)],
                self.y[tile_lines(self.regions_y, row)],
            )
            places = self.terrain.bend(np.stack(np.meshgrid(x, y), axis=-1)).reshape(-1, 2)
            boxes[column, row] = places.min(axis=0), places.max(axis=0)
        return boxes


def grid_lines(spans: Float64) -> Float64:
    """Return grid lines at both edges of every curb and at most a cell apart between them."""
    edges = np.stack([spans[:, 0], spans[:, 0] + CURB_WIDTH,
                      spans[:, 1] - CURB_WIDTH, spans[:, 1]], axis=1).ravel()  # fmt: skip
    parts = [
        np.linspace(start, end, int(np.ceil((end - start) / GROUND_CELL)), endpoint=False)
        for start, end in pairwise(edges)
    ]
    return np.concatenate([*parts, edges[-1:]])


def regions(lines: Float64, spans: Float64) -> Int64:
    """Return the region of each line, (lines,). A curb's lower edge is part of the street."""
    starts, ends = spans[:, 0] + CURB_WIDTH, spans[:, 1] - CURB_WIDTH
    return np.searchsorted(starts, lines, side="right") + np.searchsorted(ends, lines, side="left")


def tile_lines(regions: Int64, block: int) -> slice:
    """Return the lines from a block's curb to the next block's, or to the end."""
    first, last = np.searchsorted(regions, [2 * block + 1, 2 * block + 3]) - 1
    return slice(int(first), int(last) + 1)
