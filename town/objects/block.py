"""Objects along a street: houses, gardens and street furniture of one side of a block."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from town.geometry.mesh import Mesh
from town.objects.furniture import (
    Furniture,
    advertising_column,
    bicycles,
    bollards,
    bus_shelter,
    cabinet,
    dustbins,
    fence,
    garden_wall,
    lamp_post,
    traffic_sign,
)
from town.objects.house import house
from town.objects.vegetation import bush, hedge, tree
from town.streets.plan import CURB_HEIGHT, Frontage
from town.streets.terrain import Terrain

LOT_DEPTH = 14.0
"""Distance of a side's last house from the corner, meters; the next side's first house is there."""

FURNITURE: tuple[tuple[str, Furniture, float], ...] = (
    ("tree", tree, 0.36),
    ("lamp post", lamp_post, 0.13),
    ("traffic sign", traffic_sign, 0.1),
    ("dustbins", dustbins, 0.1),
    ("cabinet", cabinet, 0.09),
    ("bicycles", bicycles, 0.08),
    ("bollards", bollards, 0.06),
    ("advertising column", advertising_column, 0.04),
    ("bus shelter", bus_shelter, 0.04),
)
"""Name, builder and share of each kind of street furniture."""


@dataclass(frozen=True, slots=True)
class SceneObject:
    """Object of the town.

    Attributes:
        kind: name of the kind, such as "house" or "parked car".
        mesh: mesh in the town frame.
    """

    kind: str
    mesh: Mesh


@dataclass(frozen=True, slots=True)
class Site:
    """Site of a frontage's objects.

    Attributes:
        frontage: frontage whose frame is used.
        terrain: terrain under the objects.
    """

    frontage: Frontage
    terrain: Terrain

    def place(self, kind: str, mesh: Mesh, x: float, y: float, turn: float = 0.0) -> SceneObject:
        """Place an object on the sidewalk at (x, y) of the frontage's frame, turned by radians."""
        spot, heading = self.frontage.on_plan(x, y), self.frontage.heading + turn
        return SceneObject(kind, self.terrain.place(mesh, spot, heading, lift=CURB_HEIGHT))


def furnish(
    frontage: Frontage, terrain: Terrain, rng: np.random.Generator
) -> Iterator[SceneObject]:
    """Yield the static objects along one side of a block."""
    pavement = float(rng.uniform(2.4, 3.6))
    gardens = bool(rng.random() < 0.5)
    site = Site(frontage, terrain)
    x = pavement + float(rng.uniform(0.0, 1.0))
    end = frontage.length - pavement - LOT_DEPTH
    while x < end - 6.0:
        width = min(float(rng.uniform(7.0, 15.0)), end - x)
        # With front gardens the houses are set back; otherwise they are at the sidewalk.
        setback = float(rng.uniform(2.0, 4.5)) if gardens else float(rng.uniform(0.0, 0.9))
        if rng.random() < 0.85:
            building = house(rng, width, depth=float(rng.uniform(7.5, 9.0)))
            turn = float(rng.uniform(-0.03, 0.03))
            yield site.place("house", building, x, pavement + setback, turn)
            if gardens:
                yield from garden(rng, (x, pavement), (width, setback), site)
        else:
            yield from garden(rng, (x, pavement), (width, 10.0), site)
        x += width + float(rng.uniform(0.8, 3.5))
    yield from curbside(rng, frontage.length, site)


def garden(
    rng: np.random.Generator, corner: tuple[float, float], size: tuple[float, float], site: Site
) -> Iterator[SceneObject]:
    """Yield bushes behind a boundary, and trees if the garden is deep.

    Args:
        rng: random number generator.
        corner: corner of the garden, x and y in the frontage's frame, meters.
        size: extent along the street and away from it, meters.
        site: site of the objects.
    """
    (x, y), (width, depth) = corner, size
    yield from boundary(rng, width, x, y, site)
    deep = depth > 5.0
    for _ in range(int(rng.integers(2, 5) if deep else rng.integers(0, 3))):
        along = x + float(rng.uniform(1, width - 1))
        across = y + float(rng.uniform(0.8, depth - 0.6))
        kind, grow = ("tree", tree) if deep and rng.random() < 0.6 else ("bush", bush)
        yield site.place(kind, grow(rng), along, across)


def boundary(
    rng: np.random.Generator, width: float, x: float, y: float, site: Site
) -> Iterator[SceneObject]:
    """Yield a garden's fence, hedge or wall along the sidewalk, with a gateway."""
    gate = float(rng.uniform(1.2, 3.2))
    before = float(rng.uniform(0.1, 0.9)) * (width - gate)
    kind = str(rng.choice(["fence", "hedge", "garden wall", "open"], p=[0.3, 0.35, 0.25, 0.1]))
    makers = {"fence": fence, "hedge": hedge, "garden wall": garden_wall}
    if kind == "open":
        return
    for start, length in ((0.0, before), (before + gate, width - before - gate)):
        if length > 1.0:
            yield site.place(kind, makers[kind](rng, length), x + start, y + 0.2)


def curbside(rng: np.random.Generator, length: float, site: Site) -> Iterator[SceneObject]:
    """Yield trees, posts, bins and other street furniture in a row behind the curb."""
    shares = np.array([share for _, _, share in FURNITURE])
    x = float(rng.uniform(2.0, 6.0))
    while x < length - 3.0:
        kind, make, _ = FURNITURE[int(rng.choice(len(FURNITURE), p=shares / shares.sum()))]
        yield site.place(kind, make(rng), x, float(rng.uniform(0.6, 0.9)))
        # The widest pieces are 5 m long.
        x += float(rng.uniform(5.5, 10.0))
