"""Street furniture, fences and garden walls.

The origin is the middle of the foot; fences and walls begin at x = 0 and extend along x. z = 0 is
the ground. The street is in the direction of -y.
"""

from collections.abc import Callable

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box, circle, pole, prism

Furniture = Callable[[np.random.Generator], Mesh]
"""Function that builds one piece."""


def lamp_post(rng: np.random.Generator) -> Mesh:
    """Build a lamp post with a thick foot and an arm over the street."""
    height = float(rng.uniform(4.0, 7.0))
    return Mesh.joined(
        [
            pole(0, 0, float(rng.uniform(0.07, 0.1)), (0, height), Reflectance.METAL),
            pole(0, 0, float(rng.uniform(0.12, 0.2)), (-0.3, 1.1), Reflectance.METAL),
            box((-0.15, -1.4, height), (0.3, 1.5, 0.15), Reflectance.METAL),
        ]
    )


def traffic_sign(rng: np.random.Generator) -> Mesh:
    """Build a post with one to three signs that face along the street."""
    parts = [pole(0, 0, 0.04, (-0.3, 3.2), Reflectance.METAL)]
    top = 3.2
    for _ in range(int(rng.integers(1, 4))):
        size = float(rng.uniform(0.45, 0.9))
        parts.append(box((-0.05, -size / 2, top - size), (0.02, size, size), Reflectance.SIGN))
        top -= size + 0.05
    return Mesh.joined(parts)


def dustbins(rng: np.random.Generator) -> Mesh:
    """Build one to four wheeled bins side by side."""
    parts, x = [], 0.0
    for _ in range(int(rng.integers(1, 5))):
        wide, high = float(rng.uniform(0.5, 1.3)), float(rng.uniform(1.0, 1.4))
        outline = np.array([[0, 0], [wide, 0], [wide, 0.7], [0, 0.7]])
        parts.append(prism(np.add(outline, (x, 0)), 0.05, high, Reflectance.WOOD, taper=1.12))
        x += wide + float(rng.uniform(0.1, 0.2))
    return Mesh.joined(parts)


def cabinet(rng: np.random.Generator) -> Mesh:
    """Build a row of one to three switch boxes."""
    parts, x = [], 0.0
    for _ in range(int(rng.integers(1, 4))):
        size = (float(rng.uniform(0.5, 1.3)), 0.4, float(rng.uniform(0.9, 1.6)))
        parts.append(box((x, 0, -0.2), size, Reflectance.METAL))
        x += size[0] + 0.03
    return Mesh.joined(parts)


def bus_shelter(rng: np.random.Generator) -> Mesh:
    """Build a roof on three walls, partly of glass, with a bench and a poster."""
    wide, deep = float(rng.uniform(2.5, 5.0)), float(rng.uniform(1.2, 1.6))
    return Mesh.joined(
        [
            box((0, deep, 0.2), (wide, 0.05, 2.1), Reflectance.GLASS),
            box((0, deep, -0.2), (wide, 0.07, 0.75), Reflectance.METAL),
            box((0, 0.3, -0.2), (0.12, deep - 0.3, 2.5), Reflectance.SIGN),
            pole(wide, 0.2, 0.06, (-0.2, 2.3), Reflectance.METAL),
            pole(wide, deep, 0.06, (-0.2, 2.3), Reflectance.METAL),
            box((-0.2, 0, 2.3), (wide + 0.4, deep + 0.2, 0.2), Reflectance.METAL),
            box((0.6, deep - 0.5, 0.45), (wide - 1.2, 0.4, 0.08), Reflectance.WOOD),
        ]
    )


def advertising_column(rng: np.random.Generator) -> Mesh:
    """Build a thick round column with a rim."""
    radius = float(rng.uniform(0.45, 0.7))
    return Mesh.joined(
        [
            prism(circle(radius, 12), -0.2, 2.7, Reflectance.PLASTER),
            prism(circle(radius + 0.15, 12), 2.7, 3.0, Reflectance.METAL),
            prism(circle(radius + 0.1, 12), -0.2, 0.4, Reflectance.PAVING),
        ]
    )


def bicycles(rng: np.random.Generator) -> Mesh:
    """Build bicycles in a rack from thin upright discs and bars."""
    parts = []
    for number in range(int(rng.integers(2, 7))):
        x = 0.5 * number + float(rng.uniform(-0.1, 0.1))
        tilt = float(rng.uniform(-0.3, 0.3))
        bike = [box((-0.02, y, 0.05), (0.04, 0.6, 0.6), Reflectance.RUBBER) for y in (-0.9, 0.2)]
        bike.append(box((-0.03, -0.5, 0.55), (0.06, 0.9, 0.35), Reflectance.METAL))
        bike.append(box((-0.25, -0.5, 0.95), (0.5, 0.06, 0.08), Reflectance.METAL))
        parts.append(Mesh.joined(bike).moved(x, 0.6, 0, tilt))
    return Mesh.joined(parts)


def bollards(rng: np.random.Generator) -> Mesh:
    """Build a row of thick bollards."""
    count, step = int(rng.integers(3, 7)), float(rng.uniform(0.35, 0.5))
    radius, height = float(rng.uniform(0.1, 0.18)), float(rng.uniform(0.8, 1.1))
    return Mesh.joined(
        [pole(step * i, 0, radius, (-0.2, height), Reflectance.PAVING) for i in range(count)]
    )


def fence(rng: np.random.Generator, length: float) -> Mesh:
    """Build a fence of posts and pales, or of posts and rails."""
    height, step = float(rng.uniform(0.9, 1.7)), float(rng.uniform(1.6, 2.4))
    thick = float(rng.uniform(0.05, 0.12))
    parts = [
        box((float(x), -thick, -0.3), (2 * thick, 2 * thick, height + 0.4), Reflectance.WOOD)
        for x in np.arange(0, length, step)
    ]
    if rng.random() < 0.5:
        rails = np.arange(0.3, height, float(rng.uniform(0.25, 0.4)))
        size = (length, 0.04, 0.12)
        parts += [box((0, -0.02, float(z)), size, Reflectance.WOOD) for z in rails]
    else:
        pales = np.arange(0, length, float(rng.uniform(0.14, 0.25)))
        size = (0.09, 0.04, height - 0.1)
        parts += [box((float(x), -0.02, 0.1), size, Reflectance.WOOD) for x in pales]
    return Mesh.joined(parts)


def garden_wall(rng: np.random.Generator, length: float) -> Mesh:
    """Build a wall with pillars, whose height changes in steps."""
    parts, x, height = [], 0.0, float(rng.uniform(0.8, 1.8))
    while x < length:
        run = min(float(rng.uniform(2.0, 4.0)), length - x)
        parts.append(box((x, -0.12, -0.5), (run, 0.24, height + 0.5), Reflectance.BRICK))
        if rng.random() < 0.6:
            parts.append(box((x, -0.25, -0.5), (0.5, 0.5, height + 0.8), Reflectance.BRICK))
        height = float(np.clip(height + rng.uniform(-0.25, 0.25), 0.7, 2.0))
        x += run
    return Mesh.joined(parts)
