"""Rows of identical houses, which make similar places."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from town.geometry.mesh import Mesh
from town.objects.block import LOT_DEPTH, SceneObject, Site, boundary, curbside
from town.objects.house import house
from town.streets.plan import Frontage
from town.streets.terrain import Terrain


@dataclass(frozen=True, slots=True)
class Terrace:
    """Design of a row of identical houses.

    Attributes:
        house: mesh of the house in its own frame (see `town.objects.house`).
        width: width of the house along the street, meters.
        gap: distance to the next house, meters.
        setback: distance of the front from the sidewalk, meters.
        pavement: width of the sidewalk, meters.
    """

    house: Mesh
    width: float
    gap: float
    setback: float
    pavement: float

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        """Draw a random design."""
        width = float(rng.uniform(8.0, 12.0))
        return cls(
            house=house(rng, width, depth=float(rng.uniform(7.5, 9.0))),
            width=width,
            gap=float(rng.uniform(1.0, 2.5)),
            setback=float(rng.uniform(0.4, 3.5)),
            pavement=float(rng.uniform(2.4, 3.6)),
        )

    def furnish(
        self, frontage: Frontage, terrain: Terrain, rng: np.random.Generator
    ) -> Iterator[SceneObject]:
        """Yield the objects of the row along one side of a block.

        The houses are identical and evenly spaced. Hedges, fences and street furniture differ.
        """
        site = Site(frontage, terrain)
        x = self.pavement + 1.0
        while x + self.width < frontage.length - self.pavement - LOT_DEPTH:
            yield site.place("house", self.house, x, self.pavement + self.setback)
            if self.setback > 2.0:
                yield from boundary(rng, self.width, x, self.pavement, site)
            x += self.width + self.gap
        yield from curbside(rng, frontage.length, site)
