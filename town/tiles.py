"""What is near the sensor: tiles of a large town, built when they come into reach."""

from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh
from town.geometry.scene import Scene

CELL = 80.0
"""A scene serves a square of this edge, meters."""

SLACK = 15.0
"""What stands in a tile may jut out of it, and a sensor moves while it sweeps: meters."""

KEPT_TILES = 96
KEPT_SCENES = 3
"""As many as a drive back and forth across a border of two cells needs."""


class Tiles:
    """Scenes of the tiles around a sensor, the last few of them kept.

    Memory is bounded by what is near, and not by the town.
    """

    def __init__(self, boxes: Float64, build: Callable[[int, int], Mesh], reach: float) -> None:
        """Nothing is built yet.

        Args:
            boxes: (columns, rows, 2, 2): lowest and highest x and y of each tile, town frame.
            build: makes the tile of a column and row.
            reach: how far the sensor sees, meters.
        """
        self._tile = lru_cache(KEPT_TILES)(build)
        self._scene = lru_cache(KEPT_SCENES)(partial(scene_of_cell, boxes, self._tile, reach))

    def around(self, place: Float64) -> Scene:
        """A scene that holds all that a sensor at this place (2,) can reach, town frame."""
        column, row = np.floor(place / CELL).astype(int).tolist()
        return self._scene(column, row)

    def built(self) -> int:
        """How many tiles have been built so far, again and again counted."""
        return self._tile.cache_info().misses


def scene_of_cell(
    boxes: Float64, tile: Callable[[int, int], Mesh], reach: float, column: int, row: int
) -> Scene:
    """The scene of one square, of the tiles that can be reached from anywhere in it.

    Args:
        boxes, tile, reach: as `Tiles` has them.
        column, row: of the square.
    """
    low = CELL * np.array([column, row])
    gaps = np.maximum(low - boxes[:, :, 1], boxes[:, :, 0] - (low + CELL))
    distance = np.linalg.norm(np.maximum(gaps, 0), axis=2)
    near = np.argwhere(distance <= reach + SLACK).tolist()
    return Scene(Mesh.joined(tile(*place) for place in near))
