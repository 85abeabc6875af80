"""The ground as a mesh: carriageways, kerbs, and the raised blocks between them."""

from itertools import pairwise

import numpy as np

from segments.types import Bool, Float64
from town.mesh import Mesh, Reflectance
from town.plan import KERB_HEIGHT, Plan
from town.terrain import Terrain

GROUND_CELL = 2.0
"""Largest edge of the mesh's cells, metres: the hills stay within a millimetre of it."""

KERB_WIDTH = 0.02
"""A kerb rises over this distance: all but upright, and still a height field."""


def ground_mesh(plan: Plan, terrain: Terrain) -> Mesh:
    """The town's ground."""
    spans_x, spans_y = plan.spans()
    x, y = grid_lines(spans_x), grid_lines(spans_y)
    places = terrain.bend(np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1))
    on_block = inside(x, spans_x)[:, None] & inside(y, spans_y)[None, :]
    height = terrain.height(places) + KERB_HEIGHT * on_block
    corners = np.concatenate([places, height[..., None]], axis=-1)
    cells = np.stack([corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]], 2)
    paved = on_block[:-1, :-1] & on_block[1:, 1:]
    reflectance = np.where(paved, Reflectance.PAVING, Reflectance.ASPHALT)
    mesh = Mesh.of_quads(cells.reshape(-1, 4, 3), 0.0)
    return Mesh(mesh.triangles, np.repeat(reflectance.ravel(), 2).astype(np.float32))


def grid_lines(spans: Float64) -> Float64:
    """Lines at both edges of every kerb, and between them at most a cell apart."""
    edges = np.stack([spans[:, 0], spans[:, 0] + KERB_WIDTH,
                      spans[:, 1] - KERB_WIDTH, spans[:, 1]], axis=1).ravel()  # fmt: skip
    parts = [
        np.linspace(start, end, int(np.ceil((end - start) / GROUND_CELL)), endpoint=False)
        for start, end in pairwise(edges)
    ]
    return np.concatenate([*parts, edges[-1:]])


def inside(lines: Float64, spans: Float64) -> Bool:
    """Which lines lie on a block's raised part."""
    low, high = spans[:, 0] + KERB_WIDTH, spans[:, 1] - KERB_WIDTH
    return np.asarray(((lines[:, None] >= low) & (lines[:, None] <= high)).any(axis=1))
