"""Town: streets on hilly ground and the objects along them."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.datasets.labels import GROUND
from town.geometry.mesh import Mesh
from town.geometry.scene import Scene, WholeTown
from town.objects.block import SceneObject, furnish
from town.objects.labels import all_of, labeled
from town.objects.traffic import traffic
from town.streets.ground import Ground
from town.streets.plan import StreetPlan
from town.streets.terrain import Terrain


@dataclass(frozen=True, slots=True)
class Town:
    """Static part of a town.

    Town frame: meters, x and y level, z up.

    Attributes:
        seed: seed of the town.
        plan: street plan.
        terrain: terrain that bends the plan and has the height of the ground.
        ground: carriageways, curbs and blocks, in the town frame.
        objects: houses, trees, fences and so on.
        other_cars: whether it is another day: cars are parked in the bays that are free on the
            first one, and in no other bay.
    """

    seed: int
    plan: StreetPlan
    terrain: Terrain
    ground: Mesh
    objects: tuple[SceneObject, ...]
    other_cars: bool = False

    @classmethod
    def build(cls, seed: int, streets: tuple[int, int] = (4, 4)) -> Self:
        """Build the town of a seed.

        Args:
            seed: seed of the town.
            streets: number of streets north-south and east-west, at least two each.

        Raises:
            ValueError: A direction has fewer than two streets.
        """
        rng = np.random.default_rng([seed, 0])
        plan = StreetPlan.draw(rng, streets)
        terrain = Terrain.draw(rng)
        objects = [
            thing for frontage in plan.frontages() for thing in furnish(frontage, terrain, rng)
        ]
        return cls(seed, plan, terrain, Ground.of(plan, terrain).mesh(), tuple(objects))

    def traffic(self, seed: int) -> tuple[SceneObject, ...]:
        """Return the parked cars and people of one drive."""
        return tuple(traffic(self.plan, self.terrain, seed, other_cars=self.other_cars))

    def mesh(self, traffic_seed: int) -> Mesh:
        """Return the mesh of the town with the parked cars of one drive, in the town frame."""
        things = self.objects + self.traffic(traffic_seed)
        return Mesh.joined([all_of(self.ground, GROUND), *map(labeled, things)])

    def scenes(self, traffic_seed: int, reach: float) -> WholeTown:  # noqa: ARG002
        """Return the scene of one drive."""
        return WholeTown(Scene(self.mesh(traffic_seed)))
