"""Large buildings that stand alone: institutes, halls and shops with flat roofs.

Frame: x along the front, y = 0 at the front and positive into the building, z = 0 at the ground.
"""

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box, pole, prism
from town.objects.annexes import planter, stairs, wall_unit
from town.objects.house import FOUNDATION, wall

OUT = 3.0
"""Largest extent of a portico, a canopy or a staircase before the walls, meters."""


def large_building(rng: np.random.Generator, width: float, depth: float) -> Mesh:
    """Build a building with windows on all sides, a flat roof, and parts before its walls.

    Args:
        rng: random number generator.
        width, depth: size, meters.
    """
    storeys = int(rng.integers(1, 5))
    height = 0.6 + storeys * float(rng.uniform(3.0, 3.9))
    surface = float(rng.choice([Reflectance.PLASTER, Reflectance.BRICK]) * rng.uniform(0.7, 1.3))
    rich = bool(rng.random() < 0.7)
    sides = [
        wall(rng, width, height, surface, rich=rich),
        wall(rng, depth, height, surface, rich=False).moved(width, 0, 0, np.pi / 2),
        wall(rng, width, height, surface, rich=rich).moved(width, depth, 0, np.pi),
        wall(rng, depth, height, surface, rich=False).moved(0, depth, 0, -np.pi / 2),
    ]
    roof = box((-0.3, -0.3, height), (width + 0.6, depth + 0.6, 0.5), Reflectance.ROOF)
    parts = [*sides, roof]
    for turned in (False, True):
        before = Mesh.joined([*entrance(rng, width, height), *beside(rng, width)])
        parts.append(before.moved(width, depth, 0, np.pi) if turned else before)
    return Mesh.joined(parts)


def entrance(rng: np.random.Generator, width: float, height: float) -> list[Mesh]:
    """Build what stands before the front: a portico, a canopy, or an open staircase."""
    x = float(rng.uniform(0.15, 0.6)) * width
    out = float(rng.uniform(1.6, OUT))
    style = str(rng.choice(["portico", "canopy", "staircase", "none"], p=[0.3, 0.3, 0.2, 0.2]))
    if style == "portico":
        wide = min(float(rng.uniform(6.0, 16.0)), width - x)
        step, thick = float(rng.uniform(2.2, 4.0)), float(rng.uniform(0.2, 0.4))
        posts = [
            prism(np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * thick + (float(at), -out),
                  -FOUNDATION, 3.1, Reflectance.PLASTER)
            for at in np.arange(x, x + wide, step)
        ]  # fmt: skip
        return [*posts, box((x - 0.3, -out, 3.1), (wide + 0.6, out, 0.5), Reflectance.PLASTER)]
    if style == "canopy":
        wide = float(rng.uniform(2.5, 5.0))
        posts = [pole(at, -out, 0.09, (-FOUNDATION, 2.7), Reflectance.METAL)
                 for at in (x, x + wide)]  # fmt: skip
        cover = box((x - 0.3, -out - 0.2, 2.7), (wide + 0.6, out + 0.2, 0.2), Reflectance.METAL)
        return [*posts, cover, stairs(rng).moved(x=x + 0.4)]
    if style == "staircase":
        run = float(rng.uniform(3.0, 5.0))
        flights = [
            box((x + run * n / 8, -1.5, 0.35 * n), (run / 8 + 0.05, 1.5, 0.1), Reflectance.METAL)
            for n in range(min(8, int(height / 0.35)))
        ]
        posts = [pole(x + run, y, 0.08, (-FOUNDATION, 3.0), Reflectance.METAL)
                 for y in (-1.4, -0.1)]  # fmt: skip
        return [*flights, *posts]
    return []


def beside(rng: np.random.Generator, width: float) -> list[Mesh]:
    """Build flower boxes, air conditioners and buttresses along the front."""
    parts = []
    for _ in range(int(rng.integers(1, 2 + int(width / 8)))):
        make = (planter, wall_unit)[int(rng.integers(2))]
        parts.append(make(rng).moved(x=float(rng.uniform(0.5, max(0.6, width - 3.0)))))
    if rng.random() < 0.3:
        step, out = float(rng.uniform(4.0, 7.0)), float(rng.uniform(0.3, 0.9))
        parts += [
            box((float(x), -out, -FOUNDATION), (0.5, out, FOUNDATION + 3.5), Reflectance.PLASTER)
            for x in np.arange(1.0, width - 1.0, step)
        ]
    return parts
