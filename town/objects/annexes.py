"""Annexes: objects on a house front or in front of it.

Frame: x along the front, y = 0 at the front and negative before it, z = 0 at the sidewalk.
"""

from collections.abc import Callable

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box, loft, pole

Annexe = Callable[[np.random.Generator], Mesh]
"""Function that builds one annex, beginning at x = 0."""


def stairs(rng: np.random.Generator) -> Mesh:
    """Build steps to a raised door, between two side walls."""
    run, wide = float(rng.uniform(0.25, 0.35)), float(rng.uniform(1.2, 2.4))
    steps = int(rng.integers(2, 6))
    treads = [
        box((0, -run * (steps - n), 0.18 * n), (wide, run * (steps - n), 0.18), Reflectance.PAVING)
        for n in range(steps)
    ]
    cheek = (0.15, run * steps, 0.18 * steps + 0.6)
    cheeks = [box((x, -cheek[1], -0.5), cheek, Reflectance.PLASTER) for x in (0, wide - 0.15)]
    return Mesh.joined(treads + cheeks)


def porch(rng: np.random.Generator) -> Mesh:
    """Build a roof on two posts."""
    wide, out = float(rng.uniform(1.8, 3.0)), float(rng.uniform(0.9, 1.6))
    posts = [pole(x, -out, 0.12, (-0.5, 2.6), Reflectance.WOOD) for x in (0, wide)]
    cover = box((-0.2, -out - 0.2, 2.6), (wide + 0.4, out + 0.2, 0.25), Reflectance.ROOF)
    return Mesh.joined([*posts, cover])


def balcony(rng: np.random.Generator) -> Mesh:
    """Build a balcony of the upper floor with a solid parapet, with or without posts."""
    wide, out = float(rng.uniform(2.0, 3.0)), float(rng.uniform(0.8, 1.5))
    parts = [box((0, -out, 2.6), (wide, out, 1.1), Reflectance.PLASTER)]
    if rng.random() < 0.5:
        parts += [
            pole(x, 0.1 - out, 0.1, (-0.5, 2.6), Reflectance.METAL) for x in (0.1, wide - 0.1)
        ]
    return Mesh.joined(parts)


def planter(rng: np.random.Generator) -> Mesh:
    """Build a flower box."""
    size = (float(rng.uniform(0.6, 2.5)), 0.5, float(rng.uniform(0.5, 1.1)))
    return box((0, -0.5, -0.2), size, Reflectance.WOOD)


def cellar(rng: np.random.Generator) -> Mesh:
    """Build a low block over cellar stairs."""
    size = (float(rng.uniform(1.0, 2.0)), float(rng.uniform(0.6, 1.3)), 1.3)
    return box((0, -size[1], -0.5), size, Reflectance.BRICK)


def awning(rng: np.random.Generator) -> Mesh:
    """Build an awning over a shop window, sloping to the street."""
    wide, out = float(rng.uniform(2.0, 3.0)), float(rng.uniform(0.8, 1.6))
    cloth = np.array([[0, 0, 2.3], [wide, 0, 2.3], [wide, -out, 2.1], [0, -out, 2.1]])
    return loft(cloth, np.add(cloth, (0, 0, 0.1)), Reflectance.CLOTH)


def wall_unit(rng: np.random.Generator) -> Mesh:
    """Build a meter box or an air conditioner on the wall."""
    size = (float(rng.uniform(0.6, 1.2)), 0.4, float(rng.uniform(0.5, 1.0)))
    return box((0, -0.4, float(rng.uniform(0.2, 1.8))), size, Reflectance.METAL)


ANNEXES: tuple[Annexe, ...] = (stairs, porch, balcony, planter, cellar, awning, wall_unit)
