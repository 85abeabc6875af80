"""Place: a site beside the streets, with what stands there and what moves between two drives."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from placecell.datasets.labels import GROUND
from town.geometry.mesh import Mesh
from town.geometry.scene import Scene, WholeTown
from town.objects.block import SceneObject
from town.objects.labels import all_of, labeled
from town.streets.terrain import Terrain


@dataclass(frozen=True, slots=True)
class Spot:
    """Spot of an object that differs between two drives, such as a parking bay.

    Attributes:
        kind: name of the object's kind.
        make: function that builds the object; its origin is the middle of its foot.
        x, y: position, town frame, meters.
        heading: direction of the object's x axis, radians.
        chance: probability that an object stands here during a drive.
        shift: largest displacement along x and y, meters.
        turn: standard deviation of the heading, radians.
        base: height of the object's foot above the ground, meters.
    """

    kind: str
    make: Callable[[np.random.Generator], Mesh]
    x: float
    y: float
    heading: float = 0.0
    chance: float = 0.5
    shift: float = 0.2
    turn: float = 0.05
    base: float = 0.0


@dataclass(frozen=True, slots=True)
class Place:
    """Static part of a place and the spots of its movable objects.

    Town frame: meters, x and y level, z up.

    Attributes:
        seed: seed of the place.
        terrain: terrain with the height of the ground.
        ground: mesh of the ground.
        objects: static objects.
        spots: spots of the movable objects.
        floor: number of the floor; 0 outdoors.
        other_cars: whether it is another day: movable objects stand at the spots that are empty on
            the first one, and at no other spot.
    """

    seed: int
    terrain: Terrain
    ground: Mesh
    objects: tuple[SceneObject, ...]
    spots: tuple[Spot, ...]
    floor: int = 0
    other_cars: bool = False

    def movables(self, traffic_seed: int) -> Iterable[SceneObject]:
        """Yield the movable objects of one drive."""
        rng = np.random.default_rng([self.seed, 21, self.floor, traffic_seed])
        other_day = np.random.default_rng([self.seed, 31, self.floor, traffic_seed])
        for spot in self.spots:
            # The first day draws the same numbers, whichever day it is.
            standing = self._stand(spot, rng) if rng.random() < spot.chance else None
            if self.other_cars:
                standing = None if standing else self._stand(spot, other_day)
            if standing:
                yield standing

    def _stand(self, spot: Spot, rng: np.random.Generator) -> SceneObject:
        x, y = np.add((spot.x, spot.y), rng.uniform(-spot.shift, spot.shift, size=2))
        mesh = spot.make(rng)
        heading = spot.heading + spot.turn * float(rng.standard_normal())
        height = float(self.terrain.height(np.array([x, y]))) + spot.base
        return SceneObject(spot.kind, mesh.moved(x, y, height, heading))

    def mesh(self, traffic_seed: int) -> Mesh:
        """Return the mesh of the place with the movable objects of one drive, in the town frame."""
        things = [*self.objects, *self.movables(traffic_seed)]
        return Mesh.joined([all_of(self.ground, GROUND), *map(labeled, things)])

    def scenes(self, traffic_seed: int, reach: float) -> WholeTown:  # noqa: ARG002
        """Return the scene of one drive."""
        return WholeTown(Scene(self.mesh(traffic_seed)))
