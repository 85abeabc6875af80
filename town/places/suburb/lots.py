"""Lots of the suburb: a boundary, a garden with plants, a house or a garage, and a driveway."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh
from town.objects.furniture import (
    bicycles,
    cabinet,
    dustbins,
    fence,
    garden_wall,
    lamp_post,
    traffic_sign,
)
from town.objects.house import house
from town.objects.park import shed
from town.objects.vegetation import bush, hedge, tree
from town.places.builder import Builder, Make
from town.places.place import Spot
from town.places.suburb.plants import (
    climbing,
    conifer,
    grown_hedge,
    old_tree,
    shrub,
    undergrowth,
)
from town.places.suburb.things import (
    bank,
    clutter,
    electric_post,
    garage,
    mesh_fence,
    trailer,
    used_car,
)

VERGE = 4.6
"""Distance of the objects of the verge from the middle of the road, meters."""

BOUNDARY = 5.6
"""Distance of a lot's boundary from the middle of the road, meters."""

ON_VERGE: tuple[tuple[str, Make, float], ...] = (
    ("tree", old_tree, 0.26),
    ("tree", tree, 0.12),
    ("lamp post", lamp_post, 0.1),
    ("electric post", electric_post, 0.1),
    ("traffic sign", traffic_sign, 0.14),
    ("dustbins", dustbins, 0.08),
    ("cabinet", cabinet, 0.07),
    ("undergrowth", undergrowth, 0.07),
    ("clutter", clutter, 0.03),
    ("bicycles", bicycles, 0.03),
)
"""Kind, builder and share of the objects of the verge."""

PLANTS: tuple[tuple[str, Make, float], ...] = (
    ("tree", old_tree, 0.22),
    ("tree", tree, 0.1),
    ("tree", conifer, 0.14),
    ("bush", shrub, 0.26),
    ("bush", bush, 0.1),
    ("undergrowth", undergrowth, 0.18),
)
"""Kind, builder and share of the plants of gardens and woods."""

BOUNDARIES = {
    "hedge": 0.12,
    "grown hedge": 0.16,
    "fence": 0.1,
    "mesh fence": 0.1,
    "overgrown fence": 0.24,
    "garden wall": 0.08,
    "overgrown wall": 0.06,
    "bank": 0.1,
    "open": 0.04,
}
"""Share of each kind of boundary."""

Long = Callable[[np.random.Generator, float], Mesh]
"""Function that builds an object of a length along x."""


@dataclass(frozen=True, slots=True)
class Side:
    """One side of a piece of road, along which lots lie.

    Attributes:
        builder: builder of the place.
        start: (2,), point on the middle of the road where the piece begins.
        heading: direction of the piece, radians; the lots are to its left.
        length: length of the piece, meters.
    """

    builder: Builder
    start: Float64
    heading: float
    length: float

    def at(self, along: float, away: float) -> tuple[float, float]:
        """Return the point at a distance along the piece and from the middle of the road."""
        cosine, sine = np.cos(self.heading), np.sin(self.heading)
        x = self.start[0] + along * cosine - away * sine
        y = self.start[1] + along * sine + away * cosine
        return float(x), float(y)

    def put(self, kind: str, mesh: Mesh, along: float, away: float) -> None:
        """Add an object along the piece, without a check of the ground."""
        x, y = self.at(along, away)
        self.builder.put(kind, mesh, x, y, self.heading)

    def stand(self, kind: str, make: Make, along: float, away: float, radius: float) -> bool:
        """Add an object whose street side faces the road, if its disk is free."""
        x, y = self.at(along, away)
        return self.builder.stand(kind, make, x, y, radius, self.heading)


def line_with_lots(side: Side) -> None:
    """Add lots along one side of a piece of road, and objects on its verge."""
    rng = side.builder.rng
    along = float(rng.uniform(0.0, 3.0))
    while along < side.length - 6.0:
        width = min(float(rng.uniform(9.0, 20.0)), side.length - along)
        if rng.random() < 0.6:
            add_lot(side, along, width)
        else:
            add_wood(side, along, width)
        along += width + float(rng.uniform(0.3, 2.0))
    add_verge(side)


def add_verge(side: Side) -> None:
    """Add parked cars at the curb, and trees, posts and boxes behind them."""
    rng = side.builder.rng
    parks = rng.random() < 0.5
    if not parks and rng.random() < 0.6:
        first = float(rng.uniform(0.0, 0.4)) * side.length
        length = float(rng.uniform(0.3, 0.6)) * side.length
        height = float(rng.uniform(0.35, 0.6))
        side.put(
            "bank", bank(rng, length, float(rng.uniform(0.9, 2.4)), height), first, VERGE - 0.4
        )
    along = float(rng.uniform(3.0, 8.0))
    while along < side.length - 3.0:
        if parks and rng.random() < 0.6:
            x, y = side.at(along, VERGE - 1.2)
            turn = side.heading + np.pi * float(rng.random() < 0.3)
            side.builder.offer(Spot("parked car", used_car, x, y, turn, 0.6, 0.2, 0.04), 0.9)
        kind, make = drawn(rng, ON_VERGE)
        stood = side.stand(kind, make, along + 2.9, VERGE + 0.3, 0.3)
        if stood and kind == "tree" and rng.random() < 0.4:
            side.put("undergrowth", undergrowth(rng), along + 2.9, VERGE + 0.4)
        along += float(rng.uniform(6.0, 14.0))


def add_lot(side: Side, along: float, width: float) -> None:
    """Add a lot: a boundary with a driveway, a house or a garage, a garden, and cars."""
    rng = side.builder.rng
    setback = float(rng.uniform(3.0, 9.0))
    drive = float(rng.uniform(2.8, 3.6))
    first = bool(rng.random() < 0.5)
    gate = along + (0.3 if first else width - drive - 0.3)
    add_boundary(side, along + (drive + 0.6 if first else 0.0), width - drive - 0.6)
    built = width - drive - 1.5
    if built > 6.0:
        depth = float(rng.uniform(7.5, 9.0))
        left = along + (drive + 1.0 if first else 0.2)
        x, y = side.at(left + built / 2, BOUNDARY + setback + depth / 2)
        mesh = house(rng, built, depth)
        size = (built, depth)
        if side.builder.block("house", mesh, size, x, y, side.heading, 0.5):
            for _ in range(int(rng.integers(1, 5))):
                # Plants grow against the wall.
                kind, make = drawn(rng, PLANTS[3:])
                place = left + float(rng.uniform(0.5, built - 0.5))
                side.put(kind, make(rng), place, BOUNDARY + setback - float(rng.uniform(0.3, 1.0)))
    if rng.random() < 0.5:
        mesh, deep = garage(rng, drive, 6.0), BOUNDARY + setback + float(rng.uniform(0.0, 4.0))
        x, y = side.at(gate + drive / 2, deep + 3.0)
        side.builder.block("garage", mesh, (drive, 6.0), x, y, side.heading, 0.2)
    x, y = side.at(gate + drive / 2, BOUNDARY + float(rng.uniform(2.2, 3.5)))
    kind, make = ("trailer", trailer) if rng.random() < 0.2 else ("parked car", used_car)
    turn = side.heading + np.pi / 2 * float(rng.choice([-1, 1]))
    side.builder.offer(Spot(kind, make, x, y, turn, 0.7, 0.3, 0.06), 1.0)
    for _ in range(int(rng.integers(1, 6))):
        kind, make = drawn(rng, PLANTS)
        place = along + float(rng.uniform(0.5, width - 0.5))
        side.stand(kind, make, place, BOUNDARY + float(rng.uniform(1.0, setback)), 0.5)
    for kind, make, chance in (
        ("dustbins", dustbins, 0.3), ("clutter", clutter, 0.3), ("shed", shed, 0.15),
    ):  # fmt: skip
        if rng.random() < chance:
            place = along + float(rng.uniform(0.5, width - 0.5))
            side.stand(kind, make, place, BOUNDARY + float(rng.uniform(1.0, 4.0)), 0.8)


def add_boundary(side: Side, along: float, length: float) -> None:
    """Add the boundary of a lot, of one kind or of several that grow together."""
    rng = side.builder.rng
    if length < 2.0:
        return
    kind = str(rng.choice(list(BOUNDARIES), p=list(BOUNDARIES.values())))
    away = BOUNDARY + float(rng.uniform(-0.2, 0.4))
    single: dict[str, Long] = {
        "hedge": hedge, "grown hedge": grown_hedge, "fence": fence, "mesh fence": mesh_fence,
        "garden wall": garden_wall,
    }  # fmt: skip
    if kind in single:
        named = {"grown hedge": "hedge", "mesh fence": "fence"}.get(kind, kind)
        side.put(named, single[kind](rng, length), along, away)
    elif kind == "overgrown fence":
        make = (fence, mesh_fence)[int(rng.integers(2))]
        side.put("fence", make(rng, length), along, away)
        if rng.random() < 0.5:
            behind = away + float(rng.uniform(0.1, 0.9))
            side.put("hedge", grown_hedge(rng, length), along, behind)
        else:
            side.put("hedge", climbing(rng, length, float(rng.uniform(0.8, 1.8))), along, away)
    elif kind == "overgrown wall":
        side.put("garden wall", garden_wall(rng, length), along, away)
        side.put("hedge", climbing(rng, length, float(rng.uniform(1.0, 2.0))), along, away)
    elif kind == "bank":
        add_bank(side, along, length)


def add_bank(side: Side, along: float, length: float) -> None:
    """Add a grass bank with what stands on it: a sign, a post, a fence or plants."""
    rng = side.builder.rng
    width, height = float(rng.uniform(1.5, 4.5)), float(rng.uniform(0.35, 0.8))
    away = VERGE + float(rng.uniform(0.2, 1.2))
    side.put("bank", bank(rng, length, width, height), along, away)
    for _ in range(int(rng.integers(0, 4))):
        kind, make = drawn(rng, PLANTS if rng.random() < 0.5 else ON_VERGE)
        place = along + float(rng.uniform(0.5, max(0.6, length - 0.5)))
        side.put(kind, make(rng), place, away + float(rng.uniform(0.2, 0.8)) * width)


def add_wood(side: Side, along: float, width: float) -> None:
    """Add a lot without a house: trees, shrubs and undergrowth, with or without a bank."""
    rng = side.builder.rng
    if rng.random() < 0.5:
        add_bank(side, along, width)
    elif rng.random() < 0.4:
        add_boundary(side, along, width)
    for _ in range(int(width * float(rng.uniform(0.6, 1.6)))):
        kind, make = drawn(rng, PLANTS)
        place = along + float(rng.uniform(0.0, width))
        side.stand(kind, make, place, BOUNDARY + float(rng.uniform(0.6, 14.0)), 0.5)


def drawn(rng: np.random.Generator, kinds: tuple[tuple[str, Make, float], ...]) -> tuple[str, Make]:
    """Draw a kind and its builder by their shares."""
    shares = np.array([share for _, _, share in kinds])
    kind, make, _ = kinds[int(rng.choice(len(kinds), p=shares / shares.sum()))]
    return kind, make
