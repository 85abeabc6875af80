"""Furniture of open ground: seats, tables, play equipment, sheds and sculptures.

The origin is the middle of the foot; z = 0 is the ground.
"""

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import blob, box, circle, loft, pole, prism


def bench(rng: np.random.Generator) -> Mesh:
    """Build a bench with a back and two cheeks."""
    wide = float(rng.uniform(1.4, 2.4))
    return Mesh.joined(
        [
            box((-wide / 2, -0.25, 0.38), (wide, 0.45, 0.08), Reflectance.WOOD),
            box((-wide / 2, 0.2, 0.45), (wide, 0.06, 0.45), Reflectance.WOOD),
            *(box((x, -0.25, -0.2), (0.1, 0.5, 0.85), Reflectance.PAVING)
              for x in (-wide / 2, wide / 2 - 0.1)),
        ]
    )  # fmt: skip


def picnic_table(rng: np.random.Generator) -> Mesh:
    """Build a table between two benches."""
    wide = float(rng.uniform(1.6, 2.2))
    boards = [(-0.35, 0.72, 0.7), (-0.85, 0.42, 0.3), (0.55, 0.42, 0.3)]
    parts = [box((-wide / 2, y, z), (wide, deep, 0.06), Reflectance.WOOD) for y, z, deep in boards]
    parts += [
        box((x, -0.7, -0.1), (0.08, 1.4, 0.8), Reflectance.WOOD) for x in (-0.35 * wide, 0.3 * wide)
    ]
    return Mesh.joined(parts)


def sculpture(rng: np.random.Generator) -> Mesh:
    """Build a sculpture of stacked shapes on a plinth."""
    side, base = float(rng.uniform(0.6, 1.4)), float(rng.uniform(0.4, 1.3))
    parts = [box((-side / 2, -side / 2, -0.3), (side, side, base + 0.3), Reflectance.PAVING)]
    z = base
    for _ in range(int(rng.integers(1, 4))):
        radii = rng.uniform(0.25, 0.7, size=3)
        shape = (float(radii[0]), float(radii[1]), float(radii[2]))
        aside = rng.uniform(-0.15, 0.15, size=2)
        middle = (float(aside[0]), float(aside[1]), z + shape[2] * 0.8)
        parts.append(blob(rng, middle, shape, Reflectance.METAL))
        z += 1.4 * shape[2]
    return Mesh.joined(parts)


def notice_board(rng: np.random.Generator) -> Mesh:
    """Build a board on two posts, with or without a small roof."""
    wide, high = float(rng.uniform(1.0, 2.4)), float(rng.uniform(1.7, 2.3))
    parts = [pole(x, 0, 0.05, (-0.3, high), Reflectance.METAL) for x in (-wide / 2, wide / 2)]
    parts.append(box((-wide / 2, -0.04, 0.8), (wide, 0.08, high - 0.9), Reflectance.SIGN))
    if rng.random() < 0.5:
        parts.append(box((-wide / 2 - 0.2, -0.35, high), (wide + 0.4, 0.7, 0.1), Reflectance.ROOF))
    return Mesh.joined(parts)


def shed(rng: np.random.Generator) -> Mesh:
    """Build a hut with a door recess and a gabled or a sloping roof."""
    wide, deep = float(rng.uniform(1.8, 4.0)), float(rng.uniform(1.6, 3.0))
    high, rise = float(rng.uniform(1.9, 2.5)), float(rng.uniform(0.3, 1.2))
    door = float(rng.uniform(0.2, 0.6)) * (wide - 1.0)
    front = [(-wide / 2, door), (-wide / 2 + door + 0.9, wide - door - 0.9)]
    parts = [box((x, -deep / 2, -0.2), (w, 0.15, high + 0.2), Reflectance.WOOD) for x, w in front]
    parts.append(
        box((-wide / 2, -deep / 2 + 0.15, -0.2), (wide, deep - 0.15, high + 0.2), Reflectance.WOOD)
    )
    ridge = float(rng.choice([0.0, deep / 2]))
    outline = np.array([[-deep / 2 - 0.3, high], [deep / 2 + 0.3, high], [ridge, high + rise]])
    ends = [np.insert(outline, 0, x, axis=1) for x in (-wide / 2 - 0.2, wide / 2 + 0.2)]
    return Mesh.joined([*parts, loft(ends[0], ends[1], Reflectance.ROOF)])


def pergola(rng: np.random.Generator) -> Mesh:
    """Build two rows of posts with beams and slats on top."""
    bays, step = int(rng.integers(2, 5)), float(rng.uniform(1.8, 2.6))
    wide, high = float(rng.uniform(2.2, 3.2)), float(rng.uniform(2.3, 2.8))
    length = bays * step
    parts = [
        pole(-length / 2 + step * n, y, 0.08, (-0.3, high), Reflectance.WOOD)
        for n in range(bays + 1)
        for y in (-wide / 2, wide / 2)
    ]
    parts += [
        box((-length / 2 - 0.3, y - 0.06, high), (length + 0.6, 0.12, 0.2), Reflectance.WOOD)
        for y in (-wide / 2, wide / 2)
    ]
    parts += [
        box((float(x), -wide / 2 - 0.3, high + 0.2), (0.08, wide + 0.6, 0.12), Reflectance.WOOD)
        for x in np.arange(-length / 2, length / 2, 0.5)
    ]
    return Mesh.joined(parts)


def swing(rng: np.random.Generator) -> Mesh:
    """Build a swing: two A-frames, a beam, and seats."""
    wide, high = float(rng.uniform(2.5, 4.5)), float(rng.uniform(2.0, 2.5))
    parts = []
    for x in (-wide / 2, wide / 2):
        for y in (-0.9, 0.9):
            foot = np.column_stack([circle(0.07, 6) + (x, y), np.zeros(6)])
            top = np.column_stack([circle(0.07, 6) + (x, 0.0), np.full(6, high)])
            parts.append(loft(foot, top, Reflectance.WOOD))
    parts.append(box((-wide / 2, -0.06, high - 0.06), (wide, 0.12, 0.12), Reflectance.WOOD))
    for x in np.arange(-wide / 2 + 0.8, wide / 2 - 0.4, 1.1):
        parts.append(box((float(x) - 0.25, -0.1, 0.5), (0.5, 0.2, 0.05), Reflectance.RUBBER))
        parts += [
            pole(float(x) + side, 0, 0.02, (0.5, high), Reflectance.METAL) for side in (-0.22, 0.22)
        ]
    return Mesh.joined(parts)


def slide(rng: np.random.Generator) -> Mesh:
    """Build a slide: a tower with a roof, a ladder and a chute."""
    deck, run = float(rng.uniform(1.1, 1.8)), float(rng.uniform(2.0, 3.2))
    parts = [
        pole(x, y, 0.06, (-0.2, deck + 1.6), Reflectance.WOOD)
        for x in (-0.5, 0.5)
        for y in (-0.5, 0.5)
    ]
    parts.append(box((-0.5, -0.5, deck), (1.0, 1.0, 0.08), Reflectance.WOOD))
    parts.append(box((-0.5, -0.5, deck), (1.0, 0.05, 0.8), Reflectance.WOOD))
    square = np.array([[-0.7, -0.7], [0.7, -0.7], [0.7, 0.7], [-0.7, 0.7]])
    parts.append(prism(square, deck + 1.6, deck + 2.3, Reflectance.ROOF, taper=0.05))
    chute = np.array([[0, -0.3, 0], [0, 0.3, 0], [0, 0.3, 0.12], [0, -0.3, 0.12]])
    parts.append(loft(chute + (0.5, 0, deck), chute + (0.5 + run, 0, 0.1), Reflectance.METAL))
    parts += [
        box((-0.9 + 0.1 * n, -0.3, deck * n / 4), (0.08, 0.6, 0.06), Reflectance.WOOD)
        for n in range(4)
    ]
    return Mesh.joined(parts)


def flower_bed(rng: np.random.Generator) -> Mesh:
    """Build a raised bed with plants."""
    wide, deep = float(rng.uniform(1.2, 4.0)), float(rng.uniform(0.9, 1.6))
    high = float(rng.uniform(0.4, 0.8))
    parts = [box((-wide / 2, -deep / 2, -0.2), (wide, deep, high + 0.2), Reflectance.WOOD)]
    for x in np.arange(-wide / 2 + 0.3, wide / 2 - 0.2, 0.5):
        radii = rng.uniform(0.2, 0.45, size=3)
        middle = (float(x), float(rng.uniform(-0.2, 0.2)), high + 0.6 * float(radii[2]))
        parts.append(
            blob(rng, middle, (float(radii[0]), float(radii[1]), float(radii[2])),
                 Reflectance.LEAVES)
        )  # fmt: skip
    return Mesh.joined(parts)


def fountain(rng: np.random.Generator) -> Mesh:
    """Build a round basin with a column."""
    radius, high = float(rng.uniform(1.4, 3.0)), float(rng.uniform(1.2, 2.6))
    return Mesh.joined(
        [
            prism(circle(radius, 12), -0.2, float(rng.uniform(0.45, 0.8)), Reflectance.PAVING),
            prism(circle(0.25, 8), 0.0, high, Reflectance.PAVING),
            prism(circle(0.5 * radius, 12), 0.6 * high, 0.6 * high + 0.15, Reflectance.PAVING),
        ]
    )


def chairs_and_table(rng: np.random.Generator) -> Mesh:
    """Build a small round table with one to four chairs around it, as people left them."""
    parts = [
        prism(circle(0.4, 8), 0.7, 0.74, Reflectance.WOOD),
        pole(0, 0, 0.05, (0, 0.7), Reflectance.METAL),
    ]
    for n in range(int(rng.integers(1, 5))):
        angle = np.pi / 2 * n + float(rng.normal(scale=0.3))
        seat = Mesh.joined(
            [
                box((0.5, -0.22, 0.4), (0.42, 0.44, 0.06), Reflectance.WOOD),
                box((0.88, -0.22, 0.4), (0.05, 0.44, 0.5), Reflectance.WOOD),
                *(pole(x, y, 0.03, (0, 0.42), Reflectance.METAL)
                  for x in (0.55, 0.88) for y in (-0.18, 0.18)),
            ]
        )  # fmt: skip
        parts.append(seat.moved(heading=angle))
    return Mesh.joined(parts)
