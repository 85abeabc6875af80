"""Objects of a car park: masts, shelters of trolleys, machines, barriers, containers, carports.

The origin is the middle of the foot; z = 0 is the ground.
"""

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box, circle, loft, pole, prism


def light_mast(rng: np.random.Generator) -> Mesh:
    """Build a tall mast with two lamps on a concrete foot."""
    height, foot = float(rng.uniform(6.0, 9.0)), float(rng.uniform(0.25, 0.4))
    return Mesh.joined(
        [
            prism(circle(foot, 10), -0.3, float(rng.uniform(0.6, 1.0)), Reflectance.PAVING),
            pole(0, 0, float(rng.uniform(0.08, 0.13)), (0, height), Reflectance.METAL),
            box((-1.2, -0.15, height), (2.4, 0.3, 0.15), Reflectance.METAL),
        ]
    )


def trolley(rng: np.random.Generator) -> Mesh:  # noqa: ARG001
    """Build a shopping trolley: a basket of bars on wheels."""
    bars = [box((-0.45, y, 0.4), (0.9, 0.02, 0.5), Reflectance.METAL) for y in (-0.28, 0.26)]
    bars += [box((x, -0.28, 0.4), (0.02, 0.56, 0.5), Reflectance.METAL) for x in (-0.45, 0.43)]
    legs = [
        pole(x, y, 0.03, (0.0, 0.4), Reflectance.METAL) for x in (-0.4, 0.4) for y in (-0.22, 0.22)
    ]
    return Mesh.joined([*bars, *legs, box((0.43, -0.28, 0.95), (0.06, 0.56, 0.05),
                                          Reflectance.RUBBER)])  # fmt: skip


def trolley_shelter(rng: np.random.Generator) -> Mesh:
    """Build a curved roof on posts over one or two rows of trolleys."""
    deep, wide = float(rng.uniform(3.5, 5.0)), float(rng.uniform(2.0, 3.4))
    parts = [
        pole(x, y, 0.05, (-0.2, 2.2), Reflectance.METAL)
        for x in (-deep / 2, deep / 2)
        for y in (-wide / 2, wide / 2)
    ]
    parts += [
        box((-deep / 2, y, 0.6), (deep, 0.04, 0.5), Reflectance.METAL)
        for y in (-wide / 2, wide / 2)
    ]
    angles = np.linspace(0, np.pi, 7)
    arc = np.column_stack([wide / 2 * np.cos(angles), 2.2 + 0.5 * np.sin(angles)])
    ends = [np.insert(arc, 0, x, axis=1) for x in (-deep / 2, deep / 2)]
    parts.append(loft(ends[0], ends[1], Reflectance.PLASTER))
    for y in np.arange(-wide / 2 + 0.6, wide / 2 - 0.3, 0.9):
        row = range(int(rng.integers(2, 9)))
        parts += [trolley(rng).moved(deep / 2 - 0.6 - 0.35 * n, float(y)) for n in row]
    return Mesh.joined(parts)


def ticket_machine(rng: np.random.Generator) -> Mesh:
    """Build a ticket machine under a small roof, with a sign."""
    side = float(rng.uniform(0.5, 0.8))
    return Mesh.joined(
        [
            box((-side / 2, -side / 2, -0.2), (side, side, 1.9), Reflectance.METAL),
            box((-0.7, -0.7, 2.2), (1.4, 1.4, 0.12), Reflectance.ROOF),
            pole(0.6, 0.6, 0.05, (-0.2, 3.4), Reflectance.METAL),
            box((0.55, 0.3, 2.6), (0.05, 0.7, 0.7), Reflectance.SIGN),
        ]
    )


def barrier(rng: np.random.Generator) -> Mesh:
    """Build a barrier: a cabinet with a raised bar, between bollards."""
    raised = float(rng.uniform(0.9, 1.4))
    length = float(rng.uniform(2.5, 3.5))
    square = np.array([[0, -0.05, -0.06], [0, 0.05, -0.06], [0, 0.05, 0.06], [0, -0.05, 0.06]])
    end = np.array([length * np.cos(raised), 0, length * np.sin(raised)])
    return Mesh.joined(
        [
            box((-0.25, -0.25, -0.2), (0.5, 0.5, 1.3), Reflectance.SIGN),
            loft(square + (0, 0, 1.0), square + end + (0, 0, 1.0), Reflectance.SIGN),
            *(pole(x, 0.0, 0.08, (-0.2, 0.9), Reflectance.METAL) for x in (-0.8, 0.8)),
        ]
    )


def containers(rng: np.random.Generator) -> Mesh:
    """Build two to five recycling containers in a row."""
    parts, x = [], 0.0
    for _ in range(int(rng.integers(2, 6))):
        side, high = float(rng.uniform(1.2, 1.7)), float(rng.uniform(1.3, 1.9))
        outline = np.array([[0, 0], [side, 0], [side, side], [0, side]]) + (x, -side / 2)
        parts.append(prism(outline, 0.1, high, Reflectance.METAL, taper=0.85))
        parts.append(prism(outline, high, high + 0.2, Reflectance.METAL, taper=0.6))
        x += side + float(rng.uniform(0.1, 0.4))
    return Mesh.joined(parts).moved(x=-x / 2)


def charging_post(rng: np.random.Generator) -> Mesh:
    """Build a charging post with a plinth and a guard."""
    high = float(rng.uniform(1.3, 2.0))
    return Mesh.joined(
        [
            box((-0.25, -0.2, -0.2), (0.5, 0.4, high + 0.2), Reflectance.METAL),
            box((-0.4, -0.3, -0.2), (0.8, 0.6, 0.4), Reflectance.PAVING),
            *(pole(x, -0.5, 0.06, (-0.2, 0.8), Reflectance.SIGN) for x in (-0.4, 0.4)),
        ]
    )


def carport(rng: np.random.Generator, length: float) -> Mesh:
    """Build a sloping roof over one row of bays, on one row of branching posts, along x."""
    step, deep = float(rng.uniform(4.8, 7.6)), float(rng.uniform(4.6, 5.6))
    low, rise = float(rng.uniform(2.3, 2.7)), float(rng.uniform(0.3, 0.9))
    parts = []
    for x in np.arange(-length / 2 + 0.5, length / 2, step):
        at = float(x)
        parts.append(box((at - 0.12, -0.12, -0.3), (0.24, 0.24, low + 0.3), Reflectance.METAL))
        parts.append(box((at - 0.3, -0.3, -0.3), (0.6, 0.6, 0.9), Reflectance.PAVING))
        arm = np.array([[-0.06, 0, 0], [0.06, 0, 0], [0.06, 0, 0.15], [-0.06, 0, 0.15]])
        parts.append(loft(arm + (at, 0, low - 0.8), arm + (at, -deep / 2, low + 0.05),
                          Reflectance.METAL))  # fmt: skip
    sheet = np.array([[0, -deep / 2, low], [0, deep / 2, low + rise],
                      [0, deep / 2, low + rise + 0.1], [0, -deep / 2, low + 0.1]])  # fmt: skip
    ends = [sheet + (x, 0, 0) for x in (-length / 2, length / 2)]
    return Mesh.joined([*parts, loft(ends[0], ends[1], Reflectance.ROOF)])
