"""Things that are cast: cars, trees, signs, furniture, hedges, crowns and fences, at random.

The shapes follow what stands in streets: cars have rounded bodies and windows, trunks have limbs
and undergrowth, plates are on posts, hedges are porous boxes, and plants grow in fences.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from placecell.core.segment_classes import CLASSES
from placecell.core.types import Bool, Float64
from training.classes.casting import Thing

VEGETATION, POLE, VEHICLE, FENCE, SIGN, OTHER = (
    CLASSES.index(name) for name in ("vegetation", "pole", "vehicle", "fence", "sign", "other")
)

PROFILES = (
    # Hatchback, sedan, off-road car and van: position from front to rear (-1 to 1) and height.
    ((-1, 0.42), (-0.92, 0.55), (-0.45, 0.68), (-0.05, 0.98), (0.6, 0.98), (0.93, 0.68), (1, 0.45)),
    ((-1, 0.40), (-0.92, 0.54), (-0.40, 0.67), (-0.05, 0.98), (0.35, 0.98), (0.7, 0.7), (1, 0.5)),
    ((-1, 0.45), (-0.95, 0.58), (-0.50, 0.66), (-0.2, 0.97), (0.75, 0.98), (0.97, 0.7), (1, 0.45)),
    ((-1, 0.35), (-0.95, 0.45), (-0.75, 0.55), (-0.45, 0.97), (0.9, 1.0), (0.98, 0.9), (1, 0.5)),
)
"""Side profiles of cars: height over ground as a share of the height of the car."""

SIZES = (
    ((3.5, 4.3), (1.6, 1.8), (1.40, 1.6)),
    ((4.2, 4.9), (1.7, 1.9), (1.35, 1.5)),
    ((4.1, 4.8), (1.75, 1.95), (1.55, 1.85)),
    ((4.5, 5.6), (1.75, 2.1), (1.8, 2.5)),
)
"""Smallest and largest length, width and height of each profile, meters."""

SHARES = (0.35, 0.3, 0.2, 0.15)
"""Share of the cars with each profile."""


@dataclass(frozen=True, slots=True)
class CarBody:
    """Body of a car.

    Attributes:
        heading: direction of the rear, radians.
        half: half of the length and half of the width, meters.
        height: height, meters.
        profile: positions from front to rear and heights over ground, meters, (2, n).
        roundness: exponent of the superellipse of the outline; a large one has sharp corners.
        lean: how much narrower the roof is, as a share of the width.
    """

    heading: float
    half: tuple[float, float]
    height: float
    profile: Float64
    roundness: float
    lean: float
    kind: int = VEHICLE
    density: float = 1.0

    def contains(self, points: Float64) -> Bool:
        """Return which points, (..., 3), are inside, bool (...)."""
        x, y, z = turned(points, self.heading)
        y = np.abs(y)
        along = np.minimum(np.abs(x) / self.half[0], 1)
        belt = 0.6 * self.height
        narrower = 1 - self.lean * np.clip((z - belt) / (self.height - belt), 0, 1)
        side = self.half[1] * narrower * (1 - along**self.roundness) ** (1 / self.roundness)
        # The roof is lower at the sides.
        top = np.interp(x, self.profile[0], self.profile[1], left=-1.0, right=-1.0)
        top = top - 0.12 * self.height * (y / self.half[1]) ** 4
        return np.asarray((y < side) & (z < top) & (z > 0.2))


@dataclass(frozen=True, slots=True)
class Box:
    """Box that stands upright.

    Attributes:
        center: its center, meters.
        half: half of its edges, meters.
        heading: direction of its first edge, radians.
    """

    center: tuple[float, float, float]
    half: tuple[float, float, float]
    heading: float
    kind: int
    density: float = 1.0

    def contains(self, points: Float64) -> Bool:
        """Return which points, (..., 3), are inside, bool (...)."""
        x, y, z = turned(points - np.array(self.center), self.heading)
        a, b, c = self.half
        return np.asarray((np.abs(x) < a) & (np.abs(y) < b) & (np.abs(z) < c))


@dataclass(frozen=True, slots=True)
class Rod:
    """Rod with a thinner end.

    Attributes:
        start, end: its ends, meters.
        radii: radius at the start and at the end, meters.
    """

    start: tuple[float, float, float]
    end: tuple[float, float, float]
    radii: tuple[float, float]
    kind: int
    density: float = 1.0

    def contains(self, points: Float64) -> Bool:
        """Return which points, (..., 3), are inside, bool (...)."""
        start = np.array(self.start)
        axis = np.array(self.end) - start
        offset = points - start
        place = np.clip((offset @ axis) / (axis @ axis), 0, 1)
        away = offset - place[..., None] * axis
        radius = self.radii[0] + (self.radii[1] - self.radii[0]) * place
        return np.asarray((away * away).sum(axis=-1) < radius**2)


@dataclass(frozen=True, slots=True)
class Ball:
    """Ellipsoid, of leaves if its density is below 1.

    Attributes:
        center: its center, meters.
        half: half of its axes, meters.
    """

    center: tuple[float, float, float]
    half: tuple[float, float, float]
    kind: int
    density: float

    def contains(self, points: Float64) -> Bool:
        """Return which points, (..., 3), are inside, bool (...)."""
        scaled = (points - np.array(self.center)) / np.array(self.half)
        return np.asarray((scaled * scaled).sum(axis=-1) < 1)


def turned(points: Float64, heading: float) -> tuple[Float64, Float64, Float64]:
    """Return x, y and z of points, (..., 3), along axes of which the first has a heading."""
    cosine, sine = np.cos(heading), np.sin(heading)
    x, y = points[..., 0], points[..., 1]
    return x * cosine + y * sine, y * cosine - x * sine, points[..., 2]


def car(bearing: float, rng: np.random.Generator) -> Thing:
    """Return a car; half of the cars stand along the line of sight."""
    kind = int(rng.choice(len(PROFILES), p=SHARES))
    length, width, height = (float(rng.uniform(*each)) for each in SIZES[kind])
    profile = np.array(PROFILES[kind]).T.copy()
    profile[:, 1:-1] += rng.normal(0, 0.03, profile[:, 1:-1].shape)
    profile[0] = np.maximum.accumulate(profile[0]) * length / 2
    profile[1] *= height
    heading = float(rng.uniform(-np.pi, np.pi))
    if rng.random() < 0.5:
        heading = bearing + float(rng.choice((0.0, np.pi)) + rng.normal(0, 0.25))
    body = CarBody(
        heading,
        (length / 2, width / 2),
        height,
        profile,
        float(rng.uniform(2.5, 8)),
        float(rng.uniform(0.05, 0.3)),
    )
    return Thing([body], 3.0, height, (0.62 * height, 0.9 * height))


def tree(_: float, rng: np.random.Generator) -> Thing:
    """Return a trunk with limbs, and with leaves or undergrowth at times."""
    radius, top = float(rng.uniform(0.06, 0.45)), float(rng.uniform(2.5, 6))
    lean = rng.normal(0, 0.25, 2)
    parts: list[Rod | Ball] = []
    parts.append(Rod((0, 0, -0.2), (*lean.tolist(), top), (radius, radius * 0.6), POLE))
    for _limb in range(int(rng.integers(0, 7))):
        share = rng.uniform(0.25, 0.9)
        start = np.array([*(lean * share), top * share])
        angle, rise = rng.uniform(-np.pi, np.pi), np.radians(rng.uniform(15, 75))
        way = np.array([np.cos(angle) * np.cos(rise), np.sin(angle) * np.cos(rise), np.sin(rise)])
        end = start + way * rng.uniform(0.6, 3)
        thick = radius * rng.uniform(0.2, 0.6)
        parts.append(Rod(tuple(start.tolist()), tuple(end.tolist()), (thick, thick * 0.5), POLE))
    if rng.random() < 0.25:
        wide, high = rng.uniform(0.8, 2.5), rng.uniform(0.8, 2)
        center = (0.0, 0.0, float(rng.uniform(2.2, 4.5)))
        parts.append(Ball(center, (wide, wide, high), VEGETATION, rng.uniform(0.02, 0.3)))
    if rng.random() < 0.5:
        parts.append(undergrowth(rng))
    return Thing(parts, 2.6, 6.0)


def undergrowth(rng: np.random.Generator) -> Ball:
    """Return low plants around the origin."""
    x, y = rng.normal(0, 0.4, 2)
    a, b = rng.uniform(0.3, 1.5, 2)
    return Ball((x, y, 0.2), (a, b, rng.uniform(0.2, 0.7)), VEGETATION, rng.uniform(0.3, 0.8))


def post(bearing: float, rng: np.random.Generator) -> Thing:
    """Return a post, most of them with one to three plates, some with a cabinet or plants."""
    top, radius = float(rng.uniform(1.8, 4)), float(rng.uniform(0.03, 0.1))
    parts: list[Rod | Box | Ball] = []
    heading = bearing + np.pi / 2 + float(rng.normal(0, 0.5))
    height = top
    for _plate in range(int(rng.choice(4, p=(0.25, 0.4, 0.25, 0.1)))):
        half = float(rng.uniform(0.15, 0.5)), float(rng.uniform(0.12, 0.45))
        center = 0.0, 0.0, height - half[1]
        parts.append(Box(center, (half[0], 0.05, half[1]), heading, SIGN))
        height -= 2 * half[1] + 0.05
    parts.append(Rod((0, 0, -0.2), (0, 0, top), (radius, radius), POLE))
    if rng.random() < 0.15:
        parts.append(undergrowth(rng))
    if rng.random() < 0.15:
        parts += furniture(bearing, rng).parts  # type: ignore[arg-type]
    return Thing(parts, 2.0, top)


def furniture(bearing: float, rng: np.random.Generator) -> Thing:
    """Return a cabinet, a bin, a column, a bench or a table."""
    heading = bearing + float(rng.choice((0, np.pi / 2)) + rng.normal(0, 0.4))
    form = int(rng.integers(4))
    if form < 2:
        wide, deep = float(rng.uniform(0.25, 1.1)), float(rng.uniform(0.15, 0.5))
        high = float(rng.uniform(0.4, 1.2))
        parts: list[Box | Rod] = [Box((0, 0, high), (wide, deep, high), heading, OTHER)]
    elif form == 2:
        radius, high = float(rng.uniform(0.2, 0.7)), float(rng.uniform(0.7, 2.6))
        parts = [Rod((0, 0, 0), (0, 0, high), (radius, radius), OTHER)]
    else:
        wide, deep = float(rng.uniform(0.6, 1.4)), float(rng.uniform(0.2, 0.6))
        seat = float(rng.uniform(0.4, 0.8))
        back = -deep * np.sin(heading), deep * np.cos(heading), seat + 0.2
        parts = [
            Box((0, 0, seat), (wide, deep, 0.06), heading, OTHER),
            Box((0, 0, seat / 2), (wide * 0.8, 0.06, seat / 2), heading, OTHER),
            Box(back, (wide, 0.05, 0.3), heading, OTHER),
        ]
    return Thing(parts, 2.0, 2.7)


def hedge(_: float, rng: np.random.Generator) -> Thing:
    """Return a hedge, at times around a corner, or a few bushes."""
    heading, high = float(rng.uniform(-np.pi, np.pi)), float(rng.uniform(0.4, 1.3))
    thick = float(rng.uniform(0.2, 0.8))
    leaves = float(rng.uniform(0.25, 0.9))
    parts: list[Box | Ball] = []
    if rng.random() < 0.6:
        long = float(rng.uniform(0.5, 4))
        parts.append(Box((0, 0, high), (long, thick, high), heading, VEGETATION, leaves))
        if rng.random() < 0.4:
            center = long * np.cos(heading), long * np.sin(heading), high
            other = heading + np.pi / 2
            parts.append(Box(center, (long / 2, thick, high), other, VEGETATION, leaves))
    else:
        for _bush in range(int(rng.integers(1, 5))):
            x, y = rng.normal(0, 0.8, 2)
            a, b, c = rng.uniform(0.4, 1.5, 3)
            parts.append(Ball((x, y, 0.5 * c), (a, b, c), VEGETATION, leaves))
    return Thing(parts, 4.5, 2.8)


def crown(_: float, rng: np.random.Generator) -> Thing:
    """Return the lower side of crowns."""
    parts = []
    for _ball in range(int(rng.integers(1, 4))):
        x, y = rng.normal(0, 1.0, 2)
        a, c = rng.uniform(0.8, 3), rng.uniform(0.6, 2)
        low = rng.uniform(1.2, 2.4)
        parts.append(Ball((x, y, low + c), (a, a, c), VEGETATION, float(rng.uniform(0.1, 0.8))))
    return Thing(parts, 4.5, 5.0)


def fence(_: float, rng: np.random.Generator) -> Thing:
    """Return a fence of boards or a low wall, half of them with plants."""
    heading, high = float(rng.uniform(-np.pi, np.pi)), float(rng.uniform(0.4, 0.95))
    long = float(rng.uniform(1, 4))
    cosine, sine = np.cos(heading), np.sin(heading)
    parts: list[Box | Ball] = []
    if rng.random() < 0.35:
        thick = float(rng.uniform(0.08, 0.2))
        parts.append(Box((0, 0, high), (long, thick, high), heading, FENCE))
    else:
        share = float(rng.uniform(0.15, 0.8))
        parts.append(Box((0, 0, high), (long, 0.06, high), heading, FENCE, share))
        for place in np.arange(-long, long, rng.uniform(0.8, 2.5)):
            center = place * cosine, place * sine, high
            parts.append(Box(center, (0.07, 0.07, high * 1.05), heading, FENCE))
    if rng.random() < 0.6:
        leaves = float(rng.uniform(0.1, 0.7))
        for _plant in range(int(rng.integers(1, 5))):
            place, beside = rng.uniform(-long, long), rng.normal(0, 0.4)
            a, b, c = rng.uniform(0.3, 1.4), rng.uniform(0.2, 0.8), rng.uniform(0.2, 1.1)
            center = place * cosine - beside * sine, place * sine + beside * cosine, c * 0.6
            parts.append(Ball(center, (a, b, c), VEGETATION, leaves))
    return Thing(parts, 4.5, 2.2)


MAKERS: dict[str, Callable[[float, np.random.Generator], Thing]] = {
    "car": car,
    "tree": tree,
    "post": post,
    "furniture": furniture,
    "hedge": hedge,
    "crown": crown,
    "fence": fence,
}
"""Makers of things; each gets the bearing of the sensor, radians, and a random number generator."""
