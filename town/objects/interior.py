"""Interior of buildings: cupboards, desks, racks, machines, chairs, boxes.

The origin is the middle of the foot; z = 0 is the floor. What stands at a wall has the wall in the
direction of +y.
"""

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import blob, box, circle, pole, prism


def cupboard(rng: np.random.Generator) -> Mesh:
    """Build one to three cupboards of different heights, with plinths and handles."""
    parts, x = [], 0.0
    for _ in range(int(rng.integers(1, 4))):
        wide, high = float(rng.uniform(0.5, 1.1)), float(rng.choice([0.9, 1.3, 1.8, 2.1]))
        deep = float(rng.uniform(0.3, 0.45))
        parts.append(box((x, 0.22 - deep, 0.06), (wide, deep, high), Reflectance.WOOD))
        parts.append(
            box((x + wide / 2, 0.18 - deep, 0.5 * high), (0.04, 0.04, 0.2), Reflectance.METAL)
        )
        x += wide + float(rng.choice([0.0, 0.05, 0.3]))
    return Mesh.joined(parts).moved(x=-x / 2)


def open_shelves(rng: np.random.Generator) -> Mesh:
    """Build open shelves with files and boxes on the boards."""
    wide, high = float(rng.uniform(0.9, 2.2)), float(rng.uniform(1.3, 2.1))
    deep = float(rng.uniform(0.3, 0.42))
    parts = [
        box((x, 0.22 - deep, 0), (0.04, deep, high), Reflectance.WOOD)
        for x in (-wide / 2, wide / 2 - 0.04)
    ]
    for z in np.arange(0.1, high, float(rng.uniform(0.32, 0.45))):
        parts.append(box((-wide / 2, 0.22 - deep, float(z)), (wide, deep, 0.03), Reflectance.WOOD))
        parts += goods(rng, wide, 0.22 - deep, deep, float(z) + 0.03, 0.3)
    return Mesh.joined(parts)


def goods(
    rng: np.random.Generator, wide: float, front: float, deep: float, base: float, high: float
) -> list[Mesh]:
    """Build boxes side by side on a board, with gaps.

    Args:
        rng: random number generator.
        wide: length of the board along x, about x = 0, meters.
        front: y of the board's front, meters.
        deep: depth of the board, meters.
        base: height of the board, meters.
        high: largest height of a box, meters.
    """
    parts = []
    x = -wide / 2 + 0.03
    while x < wide / 2 - 0.15:
        run = min(float(rng.uniform(0.12, 0.3 + high)), wide / 2 - x)
        if rng.random() < 0.75:
            back = float(rng.uniform(0.0, 0.4)) * deep
            size = (run, deep - back, high * float(rng.uniform(0.5, 1.0)))
            parts.append(box((x, front + back, base), size, float(rng.uniform(0.2, 0.7))))
        x += run + float(rng.choice([0.0, 0.05, 0.2]))
    return parts


def radiator(rng: np.random.Generator) -> Mesh:
    """Build a radiator of ribs."""
    wide, high = float(rng.uniform(0.8, 2.0)), float(rng.uniform(0.5, 0.9))
    base = float(rng.uniform(0.1, 0.2))
    return Mesh.joined(
        box((float(x), 0.06, base), (0.06, 0.14, high), Reflectance.METAL)
        for x in np.arange(-wide / 2, wide / 2, 0.1)
    )


def vending_machine(rng: np.random.Generator) -> Mesh:
    """Build one or two vending machines with a recessed slot."""
    parts = []
    for n in range(int(rng.integers(1, 3))):
        high = float(rng.uniform(1.6, 2.0))
        x = 0.85 * n - 0.4
        parts += [
            box((x, -0.15, 0), (0.8, 0.37, 0.5), Reflectance.METAL),
            box((x, -0.05, 0.5), (0.8, 0.27, 0.3), Reflectance.METAL),
            box((x, -0.15, 0.8), (0.8, 0.37, high - 0.8), Reflectance.SIGN),
        ]
    return Mesh.joined(parts)


def copier(rng: np.random.Generator) -> Mesh:
    """Build a copier with trays and a lid."""
    wide = float(rng.uniform(0.6, 1.1))
    return Mesh.joined(
        [
            box((-wide / 2, -0.25, 0.1), (wide, 0.47, 0.8), Reflectance.PLASTER),
            box((-wide / 2 - 0.3, -0.15, 0.6), (0.3, 0.35, 0.08), Reflectance.PLASTER),
            box((-wide / 2, -0.2, 0.95), (wide, 0.4, 0.15), Reflectance.RUBBER * 2),
        ]
    )


def bench_seat(rng: np.random.Generator) -> Mesh:
    """Build a row of two to five seats on a beam."""
    count = int(rng.integers(2, 6))
    parts = [box((-0.3 * count, 0.0, 0.3), (0.6 * count, 0.08, 0.08), Reflectance.METAL)]
    for n in range(count):
        x = 0.6 * n - 0.3 * count
        parts.append(box((x + 0.05, -0.22, 0.42), (0.5, 0.42, 0.06), Reflectance.WOOD))
        parts.append(box((x + 0.05, 0.14, 0.45), (0.5, 0.06, 0.42), Reflectance.WOOD))
    parts += [box((x, -0.2, 0), (0.06, 0.4, 0.4), Reflectance.METAL)
              for x in (-0.28 * count, 0.28 * count - 0.06)]  # fmt: skip
    return Mesh.joined(parts)


def pot_plant(rng: np.random.Generator) -> Mesh:
    """Build a plant in a pot, knee-high to man-high."""
    radius, high = float(rng.uniform(0.15, 0.25)), float(rng.uniform(0.6, 1.7))
    parts = [prism(circle(radius), 0, 0.4, Reflectance.BRICK, taper=1.2)]
    for _ in range(int(rng.integers(2, 5))):
        aside = rng.uniform(-0.1, 0.1, size=2)
        size = float(rng.uniform(0.12, 0.24))
        middle = (float(aside[0]), float(aside[1]), float(rng.uniform(0.5, high)))
        parts.append(blob(rng, middle, (size, size, 1.4 * size), Reflectance.LEAVES))
    return Mesh.joined([*parts, pole(0, 0, 0.03, (0.3, high), Reflectance.BARK)])


def waste_bins(rng: np.random.Generator) -> Mesh:
    """Build one to four bins for sorted waste."""
    count, side = int(rng.integers(1, 5)), float(rng.uniform(0.3, 0.42))
    parts = []
    for n in range(count):
        outline = np.array([[0, 0], [side, 0], [side, side], [0, side]])
        outline = outline + ((n - count / 2) * (side + 0.05), 0.2 - side)
        parts.append(prism(outline, 0.02, float(rng.uniform(0.6, 0.95)), Reflectance.METAL))
    return Mesh.joined(parts)


def pilaster(rng: np.random.Generator) -> Mesh:
    """Build a pillar that stands out of the wall, up to the ceiling."""
    wide, deep = float(rng.uniform(0.3, 0.6)), float(rng.uniform(0.15, 0.4))
    return box((-wide / 2, 0.22 - deep, 0), (wide, deep, 2.75), Reflectance.PLASTER)


def hydrant(rng: np.random.Generator) -> Mesh:
    """Build a cabinet of a fire hose, with or without an extinguisher beside it."""
    parts = [box((-0.4, 0.02, 0.7), (0.8, 0.2, 0.8), Reflectance.SIGN)]
    if rng.random() < 0.6:
        parts.append(pole(0.65, 0.08, 0.09, (0.5, 1.1), Reflectance.SIGN))
    return Mesh.joined(parts)


def coat_rack(rng: np.random.Generator) -> Mesh:
    """Build a board with hanging coats above a shoe rack."""
    wide = float(rng.uniform(1.0, 2.4))
    parts = [
        box((-wide / 2, 0.12, 1.6), (wide, 0.1, 0.1), Reflectance.WOOD),
        box((-wide / 2, -0.08, 0.3), (wide, 0.3, 0.04), Reflectance.WOOD),
    ]
    for x in np.arange(-wide / 2 + 0.15, wide / 2, 0.22):
        if rng.random() < 0.6:
            size = (0.1, 0.13, float(rng.uniform(0.3, 0.45)))
            parts.append(blob(rng, (float(x), 0.05, 1.25), size, Reflectance.CLOTH))
    return Mesh.joined(parts)


def chair(rng: np.random.Generator) -> Mesh:
    """Build a chair with four legs, or an office chair on a star."""
    high = float(rng.uniform(0.42, 0.5))
    parts = [
        box((-0.22, -0.22, high - 0.04), (0.44, 0.44, 0.06), Reflectance.CLOTH),
        box((-0.22, 0.18, high), (0.44, 0.05, float(rng.uniform(0.4, 0.6))), Reflectance.CLOTH),
    ]
    if rng.random() < 0.5:
        parts += [
            pole(x, y, 0.03, (0, high), Reflectance.METAL) for x in (-0.2, 0.2) for y in (-0.2, 0.2)
        ]
    else:
        parts.append(pole(0, 0, 0.05, (0.05, high), Reflectance.METAL))
        parts.append(prism(circle(0.28, 5), 0.02, 0.1, Reflectance.RUBBER * 2))
    return Mesh.joined(parts)


def desk(rng: np.random.Generator) -> Mesh:
    """Build a desk with a screen, a drawer unit and a chair, or two desks face to face."""
    wide, deep = float(rng.uniform(1.2, 1.8)), float(rng.uniform(0.7, 0.9))
    one = Mesh.joined(
        [
            box((-wide / 2, -deep, 0.7), (wide, deep, 0.04), Reflectance.WOOD),
            box((-wide / 2, -deep, 0), (0.04, deep, 0.7), Reflectance.WOOD),
            box((wide / 2 - 0.45, -deep + 0.1, 0.05), (0.42, deep - 0.2, 0.6), Reflectance.WOOD),
            box((-0.3, -0.3, 0.85), (0.6, 0.05, 0.36), Reflectance.RUBBER * 2),
            chair(rng).moved(0.0, -deep - 0.3, 0, np.pi + float(rng.normal(scale=0.4))),
        ]
    )
    if rng.random() < 0.5:
        screen = box((-wide / 2, -0.02, 0.6), (wide, 0.04, 0.7), Reflectance.CLOTH)
        return Mesh.joined([one, one.moved(heading=np.pi), screen])
    return one.moved(y=deep / 2)


def meeting_table(rng: np.random.Generator) -> Mesh:
    """Build a long table with chairs on both sides."""
    wide, deep = float(rng.uniform(1.6, 3.2)), float(rng.uniform(0.8, 1.2))
    parts = [
        box((-wide / 2, -deep / 2, 0.7), (wide, deep, 0.05), Reflectance.WOOD),
        *(box((x, -deep / 2 + 0.1, 0), (0.08, deep - 0.2, 0.7), Reflectance.WOOD)
          for x in (-wide / 2 + 0.2, wide / 2 - 0.28)),
    ]  # fmt: skip
    for x in np.arange(-wide / 2 + 0.4, wide / 2 - 0.2, 0.7):
        for side in (-1.0, 1.0):
            if rng.random() < 0.8:
                turn = (0.0 if side > 0 else np.pi) + float(rng.normal(scale=0.2))
                parts.append(chair(rng).moved(float(x), side * (deep / 2 + 0.3), 0, turn))
    return Mesh.joined(parts)


def rack(rng: np.random.Generator, length: float, height: float) -> Mesh:
    """Build a pallet rack along x: uprights, beams, and goods on pallets.

    Args:
        rng: random number generator.
        length: length, meters.
        height: height of the uprights, meters.
    """
    deep, bays = 1.0, max(1, round(length / 2.7))
    step = length / bays
    parts = [
        box((-length / 2 + step * n - 0.05, y, 0), (0.1, 0.1, height), Reflectance.METAL)
        for n in range(bays + 1)
        for y in (-deep / 2, deep / 2 - 0.1)
    ]
    levels = np.arange(0.0, height - 0.6, float(rng.uniform(1.2, 1.6)))
    for level in levels:
        if level > 0:
            parts += [
                box((-length / 2, y, float(level)), (length, 0.06, 0.12), Reflectance.SIGN)
                for y in (-deep / 2, deep / 2 - 0.06)
            ]
        for n in range(bays):
            for share in (0.28, 0.72):
                if rng.random() < 0.75:
                    x = -length / 2 + step * (n + share)
                    parts.append(pallet(rng).moved(x=x, z=float(level) + 0.12 * (level > 0)))
    return Mesh.joined(parts)


def pallet(rng: np.random.Generator) -> Mesh:
    """Build a pallet with boxes, a barrel pair, sacks, or nothing on it."""
    parts = [
        box((-0.5, y, 0), (1.0, 0.12, 0.14), Reflectance.WOOD) for y in (-0.4, -0.06, 0.28)
    ] + [box((-0.5, -0.4, 0.12), (1.0, 0.8, 0.03), Reflectance.WOOD)]
    kind = str(rng.choice(["boxes", "drums", "sacks", "crate", "empty"], p=[0.4, 0.2, 0.15, 0.2,
                                                                          0.05]))  # fmt: skip
    if kind == "boxes":
        base = 0.15
        for _ in range(int(rng.integers(1, 4))):
            high = float(rng.uniform(0.2, 0.4))
            parts += goods(rng, 0.95, -0.38, 0.76, base, high)
            base += high
    elif kind == "drums":
        for x in (-0.25, 0.25):
            if rng.random() < 0.85:
                high = float(rng.uniform(0.7, 1.0))
                parts.append(prism(circle(0.23, 10) + (x, 0.0), 0.15, high, Reflectance.METAL))
    elif kind == "sacks":
        for n in range(int(rng.integers(1, 4))):
            parts.append(blob(rng, (0, 0, 0.28 + 0.22 * n), (0.45, 0.36, 0.18), Reflectance.CLOTH))
    elif kind == "crate":
        high = float(rng.uniform(0.5, 0.95))
        parts += [
            box((-0.5, y, 0.15), (1.0, 0.04, high), Reflectance.METAL) for y in (-0.4, 0.36)
        ] + [box((x, -0.4, 0.15), (0.04, 0.8, high), Reflectance.METAL) for x in (-0.5, 0.46)]
    return Mesh.joined(parts)


def bookcase(rng: np.random.Generator, length: float, height: float) -> Mesh:
    """Build a double bookcase along x, with books on both sides.

    Args:
        rng: random number generator.
        length: length, meters.
        height: height, meters.
    """
    parts = [box((-length / 2, -0.02, 0), (length, 0.04, height), Reflectance.WOOD)]
    parts += [
        box((float(x), -0.3, 0), (0.04, 0.6, height), Reflectance.WOOD)
        for x in np.linspace(-length / 2, length / 2 - 0.04, max(2, round(length)))
    ]
    for z in np.arange(0.08, height, 0.36):
        parts.append(box((-length / 2, -0.3, float(z)), (length, 0.6, 0.03), Reflectance.WOOD))
        for front in (-0.28, 0.04):
            parts += goods(rng, length, front, 0.24, float(z) + 0.03, 0.28)
    return Mesh.joined(parts)


def machine(rng: np.random.Generator) -> Mesh:
    """Build a machine: a bed, a housing, a column, a control box and a guard."""
    wide, deep = float(rng.uniform(1.0, 2.6)), float(rng.uniform(0.8, 1.5))
    bed = float(rng.uniform(0.5, 1.0))
    parts = [box((-wide / 2, -deep / 2, 0), (wide, deep, bed), Reflectance.METAL)]
    x = float(rng.uniform(-0.5, 0.1)) * wide
    size = (float(rng.uniform(0.3, 0.7)) * wide, 0.8 * deep, float(rng.uniform(0.4, 1.3)))
    parts.append(box((x, -0.4 * deep, bed), size, Reflectance.METAL))
    if rng.random() < 0.6:
        top = float(rng.uniform(1.4, 2.3))
        parts.append(pole(-0.4 * wide, 0.3 * deep, 0.12, (bed, top), Reflectance.METAL))
        parts.append(box((-0.45 * wide, -0.3 * deep, top), (0.4, 0.7 * deep, 0.3),
                         Reflectance.METAL))  # fmt: skip
    parts.append(pole(wide / 2 + 0.3, -0.2, 0.04, (0, 1.1), Reflectance.METAL))
    parts.append(box((wide / 2 + 0.1, -0.35, 1.1), (0.4, 0.3, 0.4), Reflectance.SIGN))
    return Mesh.joined(parts)


def workbench(rng: np.random.Generator) -> Mesh:
    """Build a workbench with a vice, drawers and things on it."""
    wide = float(rng.uniform(1.5, 2.6))
    parts = [
        box((-wide / 2, -0.35, 0.8), (wide, 0.7, 0.07), Reflectance.WOOD),
        box((-wide / 2, -0.3, 0), (0.5, 0.6, 0.8), Reflectance.METAL),
        *(box((wide / 2 - 0.1, y, 0), (0.08, 0.08, 0.8), Reflectance.METAL) for y in (-0.3, 0.22)),
        *goods(rng, wide, -0.2, 0.4, 0.87, 0.4),
    ]
    if rng.random() < 0.5:
        parts.append(box((-wide / 2, 0.3, 0.9), (wide, 0.05, 0.9), Reflectance.METAL))
    return Mesh.joined(parts)


def partition(rng: np.random.Generator) -> Mesh:
    """Build a free-standing screen of two or three panels at angles."""
    parts, place, turn = [], np.zeros(2), 0.0
    high = float(rng.uniform(1.3, 1.8))
    for _ in range(int(rng.integers(2, 4))):
        wide = float(rng.uniform(0.8, 1.4))
        panel = box((0, -0.04, 0.1), (wide, 0.08, high), Reflectance.CLOTH)
        parts.append(panel.moved(float(place[0]), float(place[1]), 0, turn))
        place = place + wide * np.array([np.cos(turn), np.sin(turn)])
        turn += float(rng.choice([-1.2, -0.5, 0.5, 1.2]))
    middle = place / 2
    return Mesh.joined(parts).moved(-float(middle[0]), -float(middle[1]))


def counter(rng: np.random.Generator) -> Mesh:
    """Build a reception counter with a raised front and a screen."""
    wide = float(rng.uniform(2.0, 3.6))
    return Mesh.joined(
        [
            box((-wide / 2, -0.4, 0), (wide, 0.15, 1.1), Reflectance.WOOD),
            box((-wide / 2, -0.4, 0.72), (wide, 0.8, 0.05), Reflectance.WOOD),
            box((-wide / 2, -0.4, 0), (0.15, 1.4, 1.1), Reflectance.WOOD),
            box((0.1, 0.0, 0.8), (0.5, 0.05, 0.4), Reflectance.RUBBER * 2),
            chair(rng).moved(y=0.8, heading=float(rng.normal(scale=0.4))),
        ]
    )


def sofa_group(rng: np.random.Generator) -> Mesh:
    """Build one or two sofas at a low table."""
    wide = float(rng.uniform(1.4, 2.2))
    sofa = Mesh.joined(
        [
            box((-wide / 2, 0.5, 0.1), (wide, 0.75, 0.32), Reflectance.CLOTH),
            box((-wide / 2, 1.1, 0.1), (wide, 0.18, 0.7), Reflectance.CLOTH),
            *(box((x, 0.5, 0.1), (0.16, 0.75, 0.5), Reflectance.CLOTH)
              for x in (-wide / 2, wide / 2 - 0.16)),
        ]
    )  # fmt: skip
    parts = [sofa, box((-0.5, -0.3, 0.36), (1.0, 0.6, 0.05), Reflectance.WOOD)]
    if rng.random() < 0.6:
        parts.append(sofa.moved(heading=float(rng.choice([np.pi, np.pi / 2]))))
    return Mesh.joined(parts)


def carton_stack(rng: np.random.Generator) -> Mesh:
    """Build cartons on top of each other, not quite straight."""
    parts, z = [], 0.0
    for _ in range(int(rng.integers(1, 5))):
        size = rng.uniform(0.25, 0.6, size=3)
        side = (float(size[0]), float(size[1]), float(size[2]))
        carton = box((-side[0] / 2, -side[1] / 2, z), side, Reflectance.WOOD)
        parts.append(carton.moved(heading=float(rng.normal(scale=0.2))))
        z += side[2]
    return Mesh.joined(parts)


def hand_cart(rng: np.random.Generator) -> Mesh:
    """Build a cart with two or three decks and a handle, partly loaded."""
    wide, deep = float(rng.uniform(0.7, 1.0)), 0.5
    parts = [
        pole(x, y, 0.025, (0.1, 1.0), Reflectance.METAL)
        for x in (-wide / 2, wide / 2)
        for y in (-deep / 2, deep / 2)
    ]
    for z in (0.2, 0.55, 0.9)[: int(rng.integers(2, 4))]:
        parts.append(box((-wide / 2, -deep / 2, z), (wide, deep, 0.03), Reflectance.METAL))
        parts += goods(rng, wide, -deep / 2, deep, z + 0.03, 0.25)
    return Mesh.joined(parts)


def pallet_truck(rng: np.random.Generator) -> Mesh:
    """Build a stacker: a mast with forks, a battery box and a handle."""
    mast = float(rng.uniform(1.7, 2.3))
    return Mesh.joined(
        [
            *(box((0.0, y, 0.05), (1.1, 0.16, 0.08), Reflectance.METAL) for y in (-0.3, 0.14)),
            box((-0.5, -0.35, 0.1), (0.5, 0.7, 0.9), Reflectance.SIGN),
            *(box((-0.05, y, 0.0), (0.1, 0.08, mast), Reflectance.METAL) for y in (-0.3, 0.22)),
            pole(-0.65, 0, 0.05, (0.6, 1.2), Reflectance.RUBBER * 2),
        ]
    )
