"""A town: streets on hilly ground, and everything that stands along them."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from town.geometry.mesh import Mesh
from town.geometry.scene import Scene, WholeTown
from town.objects.block import SceneObject, furnish
from town.objects.traffic import traffic
from town.streets.ground import Ground
from town.streets.plan import StreetPlan
from town.streets.terrain import Terrain


@dataclass(frozen=True, slots=True)
class Town:
    """What does not change between two drives.

    Town frame: meters, x and y level, z up.

    Attributes:
        seed: it follows from.
        plan: the streets.
        terrain: bends the plan and lifts the ground.
        ground: carriageways, curbs and blocks, in the town frame.
        objects: houses, trees, fences and so on.
    """

    seed: int
    plan: StreetPlan
    terrain: Terrain
    ground: Mesh
    objects: tuple[SceneObject, ...]

    @classmethod
    def build(cls, seed: int, streets: tuple[int, int] = (4, 4)) -> Self:
        """The town of this seed.

        Args:
            streets: how many run north-south and how many east-west, two or more each.

        Raises:
            ValueError: fewer than two streets a direction.
        """
        rng = np.random.default_rng([seed, 0])
        plan = StreetPlan.draw(rng, streets)
        terrain = Terrain.draw(rng)
        objects = [
            thing for frontage in plan.frontages() for thing in furnish(frontage, terrain, rng)
        ]
        return cls(seed, plan, terrain, Ground.of(plan, terrain).mesh(), tuple(objects))

    def traffic(self, seed: int) -> tuple[SceneObject, ...]:
        """Parked cars and people of one drive; another seed, another day."""
        return tuple(traffic(self.plan, self.terrain, seed))

    def mesh(self, traffic_seed: int) -> Mesh:
        """All that a ray can hit on one day, in the town frame."""
        things = self.objects + self.traffic(traffic_seed)
        return Mesh.joined([self.ground, *(thing.mesh for thing in things)])

    def scenes(self, traffic_seed: int, reach: float) -> WholeTown:  # noqa: ARG002
        """What a sensor can see on one day."""
        return WholeTown(Scene(self.mesh(traffic_seed)))
