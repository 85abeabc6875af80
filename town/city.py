"""Large town: tens of kilometers of streets. Only the part near the sensor is built."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from placecell.datasets.labels import GROUND
from town.geometry.mesh import Mesh
from town.objects.block import SceneObject, Site, furnish, garden
from town.objects.labels import all_of, labeled
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
    """Static part of a large town, in tiles. A tile is a block with two of its streets.

    The seed and the position determine a tile, whatever was built before. Town frame: meters, x and
    y level, z up.

    Attributes:
        seed: seed of the town.
        network: street network.
        terraces: designs of the rows of identical houses.
    """

    seed: int
    network: Network
    terraces: tuple[Terrace, ...]

    @classmethod
    def build(cls, seed: int, meters: float, look_alikes: float = 0.25) -> Self:
        """Build the large town of a seed.

        Args:
            seed: seed of the town.
            meters: total length of the streets, meters. The town has up to one street more, and at
                least 500 m.
            look_alikes: share of the streets that are lined by identical houses, 0 to 1.

        Raises:
            ValueError: `meters` or `look_alikes` is out of range.
        """
        network = Network.draw(seed, meters, look_alikes)
        designs = [Terrace.draw(np.random.default_rng([seed, 5, n])) for n in range(DESIGNS)]
        return cls(seed, network, tuple(designs))

    @cached_property
    def planner(self) -> Planner:
        """Planner of paths through the streets."""
        return Planner.of(self.network)

    @cached_property
    def ground(self) -> Ground:
        """Ground: carriageways, curbs and blocks."""
        return Ground.of(self.network.plan, self.network.terrain, self.network.raised())

    def route(self, way: Sequence[Crossing], lane_offset: float = 1.6) -> Route:
        """Return the route along a path of crossings.

        Args:
            way: crossings of the path.
            lane_offset: distance of the lane to the right of the center line, meters.

        Raises:
            ValueError: The path has fewer than two crossings, a gap, or a U-turn.
        """
        self.planner.arcs_of(way)
        return Route.over(self.network.plan, self.network.terrain, way, lane_offset)

    def tile(self, column: int, row: int, traffic_seed: int) -> Mesh:
        """Build the mesh of a tile with its parked cars, in the town frame.

        Args:
            column, row: column and row of the tile's block.
            traffic_seed: seed of the parked cars and people.
        """
        fixed = np.random.default_rng([self.seed, 6, column, row])
        today = np.random.default_rng([self.seed, 7, column, row, traffic_seed])
        things = [*self._standing(column, row, fixed), *self._traffic(column, row, today)]
        ground = all_of(self.ground.tile(column, row), GROUND)
        return Mesh.joined([ground, *map(labeled, things)])

    def scenes(self, traffic_seed: int, reach: float) -> Tiles:
        """Return the scenes of the town, built when the sensor comes near.

        Args:
            traffic_seed: seed of the parked cars and people.
            reach: range of the sensor, meters.
        """
        return Tiles(
            self.ground.boxes(), lambda column, row: self.tile(column, row, traffic_seed), reach
        )

    def designs_at(self, places: Float64) -> Int64:
        """Return the design of the houses in the street at each place, (n,).

        Args:
            places: (n, 2), meters, town frame.
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
