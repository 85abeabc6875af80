"""Cars and people: objects that differ between two drives.

Frame of a car: x ahead, origin in the middle on the ground. Frame of a person: origin at the feet.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import blob, box, circle, loft, pole


@dataclass(frozen=True, slots=True)
class CarKind:
    """Proportions of a car body.

    Attributes:
        length, width, height: size, meters.
        waist: height of the lower body's upper edge, meters.
        cabin: rear and front of the cabin's base, rear and front of its roof, as shares of the
            length from the rear.
    """

    length: float
    width: float
    height: float
    waist: float
    cabin: tuple[float, float, float, float]


HATCHBACK = CarKind(4.0, 1.75, 1.48, 0.9, (0.02, 0.76, 0.1, 0.56))
SALOON = CarKind(4.7, 1.82, 1.44, 0.9, (0.14, 0.74, 0.28, 0.58))
ESTATE = CarKind(4.75, 1.83, 1.5, 0.92, (0.01, 0.75, 0.06, 0.58))
OFF_ROADER = CarKind(4.5, 1.88, 1.75, 1.05, (0.01, 0.76, 0.04, 0.6))
VAN = CarKind(5.2, 1.98, 2.1, 1.1, (0.0, 0.88, 0.01, 0.72))
TRUCK = CarKind(5.8, 2.1, 2.7, 1.0, (0.0, 0.66, 0.0, 0.66))
KINDS = (HATCHBACK, SALOON, ESTATE, OFF_ROADER, VAN, TRUCK)
SHARES = (0.3, 0.18, 0.2, 0.14, 0.12, 0.06)


def car(rng: np.random.Generator) -> Mesh:
    """Build a parked car of a random kind, with proportions that vary by a few percent."""
    kind = KINDS[int(rng.choice(len(KINDS), p=SHARES))]
    length, width, height = np.array([kind.length, kind.width, kind.height]) * rng.uniform(
        0.94, 1.04, size=3
    )
    waist, half = kind.waist, width / 2
    paint = float(rng.uniform(0.2, 0.9))
    nose = waist - float(rng.uniform(0.1, 0.25))
    shares = np.array([0, 1, 1, 0.85, 0.7, 0])
    heights = np.array([0.25, 0.25, nose - 0.1, waist - 0.03, waist, waist])
    body = np.stack([shares * length, heights], axis=1)
    foot = [kind.cabin[0] * length, kind.cabin[1] * length]
    top = [kind.cabin[2] * length, kind.cabin[3] * length]
    cabin = np.array([[foot[0], waist], [foot[1], waist], [top[1], height], [top[0], height]])
    solid = paint if kind in (VAN, TRUCK) else Reflectance.GLASS * 2
    parts = [
        side_loft(body, half, half, paint),
        side_loft(cabin, half - 0.05, half - (0.05 if kind is TRUCK else 0.22), solid),
        box((top[0], -half + 0.22, height - 0.06), (top[1] - top[0], width - 0.44, 0.08), paint),
    ]
    if kind is TRUCK:
        parts.append(box((0.7 * length, -half + 0.05, 0.4), (0.27 * length, width - 0.1, 1.7),
                         paint))  # fmt: skip
    wheel = circle(0.32, 10)
    for x in (0.18 * length, 0.8 * length):
        for y in (-half - 0.01, half - 0.19):
            rings = [
                np.column_stack([wheel[:, 0] + x, np.full(10, side), wheel[:, 1] + 0.32])
                for side in (y, y + 0.2)
            ]
            parts.append(loft(rings[0], rings[1], Reflectance.RUBBER))
    mirrors = [
        box((foot[1] - 0.35, y, waist), (0.15, 0.18, 0.15), paint) for y in (-half - 0.18, half)
    ]
    return Mesh.joined(parts + mirrors).moved(x=-length / 2)


def side_loft(profile: Float64, half_below: float, half_above: float, reflectance: float) -> Mesh:
    """Extrude a side view (n, 2), x and z, to both sides.

    Args:
        profile: (n, 2), side view, meters.
        half_below, half_above: half of the width at the lower and at the upper edge, meters.
        reflectance: reflectance of all faces.
    """
    low, high = profile[:, 1].min(), profile[:, 1].max()
    share = (profile[:, 1] - low) / (high - low)
    half = half_below + share * (half_above - half_below)
    left = np.column_stack([profile[:, 0], half, profile[:, 1]])
    return loft(left, left * (1, -1, 1), reflectance)


def person(rng: np.random.Generator) -> Mesh:
    """Build a standing or walking person."""
    height, stride = float(rng.uniform(1.55, 1.9)), float(rng.uniform(0.0, 0.25))
    hip = 0.5 * height
    legs = [
        pole(x, y, 0.09, (0, hip), Reflectance.CLOTH) for x, y in ((stride, 0.1), (-stride, -0.1))
    ]
    trunk = blob(rng, (0, 0, hip + 0.17 * height), (0.18, 0.26, 0.2 * height), Reflectance.CLOTH)
    head = blob(rng, (0.02, 0, 0.93 * height), (0.11, 0.1, 0.13), Reflectance.CLOTH)
    return Mesh.joined([*legs, trunk, head])
