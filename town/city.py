"""A large town: tens of kilometers of streets, of which only what is near the sensor is built."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from town.geometry.mesh import Mesh
from town.objects.block import SceneObject, Site, furnish, garden
from town.objects.terrace import Terrace
from town.objects.traffic import traffic_along
from town.streets.gap import gap_ends
from town.streets.ground import Ground
from town.streets.network import DESIGNS, OWN, Network
from town.streets.plan import Crossing, Frontage
from town.streets.planner import Planner
from town.streets.route import Route
from town.tiles import Tiles


@dataclass(frozen=True)
class City:
    """What does not change between two drives, in tiles: a block and two of its streets each.

    Each tile follows from the seed and its place alone, whatever was built before it. Town frame:
    meters, x and y level, z up.

    Attributes:
        seed: it follows from.
        network: the streets.
        terraces: designs of the rows of identical houses.
    """

    seed: int
    network: Network
    terraces: tuple[Terrace, ...]

    @classmethod
    def build(cls, seed: int, meters: float, look_alikes: float = 0.25) -> Self:
        """The large town of this seed.

        Args:
            meters: of streets in all; there are up to a street's length more, and half a kilometer
                at least.
            look_alikes: the share of the streets that identical houses line.

        Raises:
            ValueError: no number of meters that a town can have, or no share.
        """
        network = Network.draw(seed, meters, look_alikes)
        designs = [Terrace.draw(np.random.default_rng([seed, 5, n])) for n in range(DESIGNS)]
        return cls(seed, network, tuple(designs))

    @cached_property
    def planner(self) -> Planner:
        """Plans ways through the streets."""
        return Planner.of(self.network)

    @cached_property
    def ground(self) -> Ground:
        """Carriageways, curbs and blocks."""
        return Ground.of(self.network.plan, self.network.terrain, self.network.raised())

    def route(self, way: Sequence[Crossing], lane_offset: float = 1.6) -> Route:
        """The route along a way.

        Raises:
            ValueError: fewer than two crossings, some that no street joins, or a turn on the spot.
        """
        self.planner.arcs_of(way)
        return Route.over(self.network.plan, self.network.terrain, way, lane_offset)

    def tile(self, column: int, row: int, traffic_seed: int) -> Mesh:
        """All that a ray can hit on one day in a tile, in the town frame.

        Args:
            column, row: of its block.
            traffic_seed: another seed, another day: other cars are parked.
        """
        fixed = np.random.default_rng([self.seed, 6, column, row])
        today = np.random.default_rng([self.seed, 7, column, row, traffic_seed])
        things = [*self._standing(column, row, fixed), *self._traffic(column, row, today)]
        ground = self.ground.tile(column, row)
        return Mesh.joined([ground, *(thing.mesh for thing in things)])

    def scenes(self, traffic_seed: int, reach: float) -> Tiles:
        """What a sensor can see on one day, built as it comes near.

        Args:
            reach: how far the sensor sees, meters.
        """
        return Tiles(
            self.ground.boxes(), lambda column, row: self.tile(column, row, traffic_seed), reach
        )

    def designs_at(self, places: Float64) -> Int64:
        """Which identical houses stand in the street at each place of the town frame: (n,).

        Args:
            places: (n, 2), meters.
        """
        lines = list(self.network.lines())
        street = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
        _, nearest = cKDTree(np.concatenate(lines)).query(places)
        return np.asarray(self.network.designs[street[nearest]])

    def _sides(self, column: int, row: int) -> Iterator[Frontage]:
        for frontage in self.network.plan.block(column, row):
            if self.network.joins(*frontage.street):
                yield frontage

    def _standing(self, column: int, row: int, rng: np.random.Generator) -> Iterator[SceneObject]:
        terrain = self.network.terrain
        for frontage in self._sides(column, row):
            design = self.network.design(*frontage.street)
            if design == OWN:
                yield from furnish(frontage, terrain, rng)
            else:
                yield from self.terraces[design].furnish(frontage, terrain, rng)
        for frontage in gap_ends(self.network, column, row):
            yield from garden(
                rng, (0.5, 3.0), (frontage.length - 1.0, 10.0), Site(frontage, terrain)
            )

    def _traffic(self, column: int, row: int, rng: np.random.Generator) -> Iterator[SceneObject]:
        for frontage in self._sides(column, row):
            yield from traffic_along(frontage, self.network.terrain, rng)
