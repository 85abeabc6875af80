"""Tiles of a large town near the sensor, built when they come into reach."""

from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh
from town.geometry.scene import Scene

CELL = 80.0
"""Edge length of the square that one scene serves, meters."""

SLACK = 15.0
"""Margin of a scene, meters: objects may extend beyond their tile, and the sensor moves."""

KEPT_TILES = 96
KEPT_SCENES = 3
"""Number of scenes that are kept, for a drive back and forth across cell borders."""


class Tiles:
    """Scenes of the tiles around a sensor; the last few are kept.

    The memory depends on the sensor's range, not on the size of the town.
    """

    def __init__(self, boxes: Float64, build: Callable[[int, int], Mesh], reach: float) -> None:
        """Create the scenes without building a tile.

        Args:
            boxes: (columns, rows, 2, 2), lowest and highest x and y of each tile, town frame.
            build: function that builds the tile of a column and row.
            reach: range of the sensor, meters.
        """
        self._tile = lru_cache(KEPT_TILES)(build)
        self._scene = lru_cache(KEPT_SCENES)(partial(scene_of_cell, boxes, self._tile, reach))

    def around(self, place: Float64) -> Scene:
        """Return a scene with everything in range of a sensor at a place (2,) of the town frame."""
        column, row = np.floor(place / CELL).astype(int).tolist()
        return self._scene(column, row)

    def built(self) -> int:
        """Return the number of tiles that were built so far, with repetitions."""
        return self._tile.cache_info().misses


def scene_of_cell(
    boxes: Float64, tile: Callable[[int, int], Mesh], reach: float, column: int, row: int
) -> Scene:
    """Build the scene of one square: all tiles within reach of any place in it.

    Args:
        boxes, tile, reach: see `Tiles`.
        column, row: column and row of the square.
    """
    low = CELL * np.array([column, row])
    gaps = np.maximum(low - boxes[:, :, 1], boxes[:, :, 0] - (low + CELL))
    distance = np.linalg.norm(np.maximum(gaps, 0), axis=2)
    near = np.argwhere(distance <= reach + SLACK).tolist()
    return Scene(Mesh.joined(tile(*place) for place in near))
