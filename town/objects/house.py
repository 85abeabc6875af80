"""Houses: walls in relief, a roof, and annexes.

Frame of a house: x along its front, y = 0 at the front and positive into the house, z = 0 at the
sidewalk. A car's LiDAR sees little above 3 m, so most of the variety is below.
"""

from collections.abc import Iterator

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box, loft, pole, relief
from town.objects.annexes import ANNEXES

FOUNDATION = 1.0
"""Depth of the walls in the ground, meters, so that no wall floats on a slope."""


def house(rng: np.random.Generator, width: float, depth: float) -> Mesh:
    """Build a house with a front, two flanks, a plain back and a gabled roof.

    Args:
        rng: random number generator.
        width: extent along the street, meters.
        depth: extent away from the street, meters.
    """
    storeys = int(rng.integers(1, 4))
    height = 0.5 + storeys * float(rng.uniform(2.7, 3.2))
    plaster = float(rng.choice([Reflectance.PLASTER, Reflectance.BRICK]) * rng.uniform(0.8, 1.3))
    front = wall(rng, width, height, plaster, rich=True)
    left = wall(rng, depth, height, plaster, rich=False).moved(0, depth, 0, -np.pi / 2)
    right = wall(rng, depth, height, plaster, rich=False).moved(width, 0, 0, np.pi / 2)
    back = box((0, depth - 0.1, -FOUNDATION), (width, 0.1, height + FOUNDATION), plaster)
    parts = [front, left, right, back, roof(rng, width, depth, height)]
    return Mesh.joined([*parts, *annexes(rng, width, height)])


def wall(
    rng: np.random.Generator, width: float, height: float, reflectance: float, rich: bool
) -> Mesh:
    """Build a wall of bays: windows, doors, bay windows, niches and pilasters.

    Args:
        rng: random number generator.
        width, height: size of the wall, meters.
        reflectance: reflectance of the wall.
        rich: true for a front; a flank has fewer openings and no projections.
    """
    plinth, sill = rng.uniform(0.35, 0.8), rng.uniform(0.9, 1.3)
    lintel = sill + rng.uniform(1.1, 1.6)
    floor = max(lintel + 0.3, 3.0)
    rows = [-FOUNDATION, plinth, sill, lintel, floor]
    while rows[-1] + 2.7 < height:
        base = rows[-1]
        rows += [base + 0.9, base + 2.2, base + 2.7]
    up = np.array([*rows, max(height, rows[-1] + 0.3)])
    along, depth, glass = [0.0], [], []
    kinds = ["window", "window", "door", "projection", "garage", "shop", "recess", "blank"]
    chances = [0.2, 0.1, 0.18, 0.16, 0.1, 0.1, 0.1, 0.06] if rich else \
        [0.25, 0.1, 0.08, 0, 0, 0, 0.07, 0.5]  # fmt: skip
    while along[-1] < width - 1e-6:
        bay = min(rng.uniform(1.8, 3.8), width - along[-1])
        if width - along[-1] - bay < 1.5:
            bay = width - along[-1]
        opening = rng.uniform(0.5, 0.75) * bay
        edge = along[-1] + rng.uniform(0.2, 0.8) * (bay - opening)
        along += [edge, edge + opening, along[-1] + bay]
        columns, panes = bay_cells(rng, str(rng.choice(kinds, p=chances)), up)
        depth += columns
        glass += panes
    # The outermost strips are in the wall's plane, so that the corners of a house meet.
    depth[0], depth[-1] = np.zeros(len(up) - 1), np.zeros(len(up) - 1)
    surface = np.where(np.array(glass), Reflectance.GLASS, reflectance)
    return relief(np.array(along), up, np.array(depth), surface)


def bay_cells(
    rng: np.random.Generator, kind: str, up: Float64
) -> tuple[list[Float64], list[Float64]]:
    """Return the cells of one bay in three columns (beside, opening, beside).

    Returns:
        Protrusion of the cells, meters, and 1 for glass or 0; three arrays (rows,) each.
    """
    rows = len(up) - 1
    base = np.zeros(rows)
    opening = np.zeros(rows)
    glass = np.zeros(rows)
    upper = np.arange(5, rows - 1, 3)  # the window rows of the storeys above
    upper = upper[upper < rows]
    opening[upper], glass[upper] = -rng.uniform(0.1, 0.25), 1
    if kind == "window":
        opening[2], glass[2] = -rng.uniform(0.1, 0.35), 1
    elif kind == "door":
        opening[:3] = -rng.uniform(0.3, 1.2)
    elif kind == "garage":
        opening[:3] = -rng.uniform(0.15, 0.6)
    elif kind == "shop":
        opening[1:3], glass[1:3] = -rng.uniform(0.2, 0.6), 1
        opening[0] = rng.uniform(0.0, 0.3)
    elif kind == "recess":
        base[:] = opening[:] = -rng.uniform(0.4, 1.6)
    elif kind == "projection":
        out = rng.uniform(0.4, 1.4)
        opening[:] = out
        base[:] = rng.choice([0.0, out])
        opening[2] -= 0.12
    if rng.random() < 0.3:
        base = base + rng.uniform(0.1, 0.3)  # pilasters
    return [base, opening, base], [np.zeros(rows), glass, np.zeros(rows)]


def roof(rng: np.random.Generator, width: float, depth: float, height: float) -> Mesh:
    """Build a gabled roof with overhanging eaves, with or without dormers."""
    rise, eaves = rng.uniform(1.5, 4.0), rng.uniform(0.2, 0.6)
    outline = np.array([[-eaves, height], [depth + eaves, height], [depth / 2, height + rise]])
    gables = [np.insert(outline, 0, x, axis=1) for x in (0.0, width)]
    parts = [loft(gables[0], gables[1], Reflectance.ROOF)]
    for x in np.arange(1.5, width - 2.5, rng.uniform(3.0, 6.0)):
        if rng.random() < 0.5:
            size = (1.6, depth / 2, rise * 0.7)
            parts.append(box((float(x), 0.3, height), size, Reflectance.ROOF))
    return Mesh.joined(parts)


def annexes(rng: np.random.Generator, width: float, height: float) -> Iterator[Mesh]:
    """Yield drainpipes and two to four annexes."""
    for x in (0.15, width - 0.15):
        if rng.random() < 0.5:
            yield pole(x, -0.12, 0.07, (-FOUNDATION, height), Reflectance.METAL)
    for _ in range(int(rng.integers(2, 5))):
        make = ANNEXES[int(rng.integers(len(ANNEXES)))]
        yield make(rng).moved(x=float(rng.uniform(0.5, max(0.6, width - 3.0))))
