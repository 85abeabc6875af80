"""Builder of a place: keeps the paths free and objects apart while it adds them."""

from collections.abc import Callable

import numpy as np
from scipy.spatial.distance import cdist

from placecell.core.types import Float64
from town.geometry.mesh import Mesh, Reflectance
from town.objects.block import SceneObject
from town.places.place import Place, Spot
from town.streets.terrain import Terrain

Make = Callable[[np.random.Generator], Mesh]
"""Function that builds an object; its origin is the middle of its foot."""

Area = tuple[float, float, float, float]
"""Lowest x and y and highest x and y of an area, meters."""

GROUND_CELL = 2.0
"""Edge length of the ground mesh's cells, meters."""

TRIES = 12
"""Number of positions that are tried for an object."""


class Builder:
    """Adds objects to free ground of a place.

    Free ground is a set of disks: what is added takes a disk, or several.
    """

    def __init__(self, seed: int, terrain: Terrain, rng: np.random.Generator) -> None:
        self.rng = rng
        self.terrain = terrain
        self._seed = seed
        self._objects = list[SceneObject]()
        self._spots = list[Spot]()
        self._taken = np.zeros((0, 2))
        self._radii = np.zeros(0)

    def take(self, places: Float64, radius: float) -> None:
        """Take disks about places (n, 2), such as the points of a path, meters."""
        self._taken = np.concatenate([self._taken, places])
        self._radii = np.concatenate([self._radii, np.full(len(places), radius)])

    def is_free(self, places: Float64, radius: float) -> bool:
        """Return whether all disks about places (n, 2) are free."""
        reach = radius + float(self._radii.max(initial=0.0))
        low, high = places.min(axis=0) - reach, places.max(axis=0) + reach
        near = ((self._taken > low) & (self._taken < high)).all(axis=1)
        apart = cdist(places, self._taken[near])
        return bool((apart > self._radii[near] + radius).all())

    def put(self, kind: str, mesh: Mesh, x: float, y: float, heading: float = 0.0,
            base: float = 0.0) -> None:  # fmt: skip
        """Add a static object upright at (x, y), without a check of the ground."""
        height = float(self.terrain.height(np.array([x, y]))) + base
        self._objects.append(SceneObject(kind, mesh.moved(x, y, height, heading)))

    def stand(self, kind: str, make: Make, x: float, y: float, radius: float,
              heading: float | None = None) -> bool:  # fmt: skip
        """Add a static object if its disk is free, and return whether it was added.

        Args:
            kind: name of the object's kind.
            make: function that builds the object.
            x, y: position, meters.
            radius: radius of the object, meters.
            heading: direction of its x axis, radians; None for a random one.
        """
        if not self.is_free(np.array([[x, y]]), radius):
            return False
        turned = float(self.rng.uniform(0, 2 * np.pi)) if heading is None else heading
        self.put(kind, make(self.rng), x, y, turned)
        self.take(np.array([[x, y]]), radius)
        return True

    def scatter(self, kind: str, make: Make, count: int, radius: float, area: Area) -> None:
        """Add up to `count` static objects at random positions of an area."""
        for _ in range(count):
            for _ in range(TRIES):
                x, y = self._anywhere(area)
                if self.stand(kind, make, x, y, radius):
                    break

    def offer(self, spot: Spot, radius: float) -> bool:
        """Add a spot of a movable object if its disk is free, and return whether it was added."""
        where = np.array([[spot.x, spot.y]])
        if not self.is_free(where, radius):
            return False
        self._spots.append(spot)
        self.take(where, radius)
        return True

    def sprinkle(self, kind: str, make: Make, count: int, radius: float, area: Area,
                 chance: float = 0.4) -> None:  # fmt: skip
        """Add up to `count` spots of movable objects at random positions of an area."""
        for _ in range(count):
            for _ in range(TRIES):
                x, y = self._anywhere(area)
                turn = float(self.rng.uniform(0, 2 * np.pi))
                if self.offer(Spot(kind, make, x, y, turn, chance, 0.3, 1.0), radius + 0.3):
                    break

    def block(self, kind: str, mesh: Mesh, size: tuple[float, float], x: float, y: float,
              heading: float, margin: float) -> bool:  # fmt: skip
        """Add a long object, whose frame has one corner at the origin, if its ground is free.

        Args:
            kind: name of the object's kind.
            mesh: mesh in the object's frame, x along its front, y into it.
            size: extent along x and y, meters.
            x, y: position of the middle, meters.
            heading: direction of its x axis, radians.
            margin: free ground around it, meters.
        """
        within = filled(size, 0.7)
        along = np.array([np.cos(heading), np.sin(heading)])
        turn = np.stack([along, [-along[1], along[0]]])
        disks = (within - np.divide(size, 2)) @ turn + (x, y)
        if not self.is_free(disks, 0.5 + margin):
            return False
        corner = np.array([x, y]) - np.divide(size, 2) @ turn
        self.put(kind, mesh, float(corner[0]), float(corner[1]), heading)
        self.take(disks, 0.5)
        return True

    def place(self, ground: Mesh, floor: int = 0) -> Place:
        """Return the place that was built."""
        return Place(
            self._seed, self.terrain, ground, tuple(self._objects), tuple(self._spots), floor
        )

    def open_ground(self, area: Area, margin: float = 70.0) -> Mesh:
        """Return the mesh of the open ground of an area and around it, such as a lawn."""
        low, high = np.array(area[:2]) - margin, np.array(area[2:]) + margin
        x, y = (np.arange(a, b + GROUND_CELL, GROUND_CELL) for a, b in zip(low, high, strict=True))
        places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
        corners = np.concatenate([places, self.terrain.height(places)[..., None]], axis=-1)
        cells = np.stack(
            [corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]], axis=2
        )
        return Mesh.of_quads(cells.reshape(-1, 4, 3), Reflectance.PAVING)

    def _anywhere(self, area: Area) -> tuple[float, float]:
        x, y = self.rng.uniform(area[:2], area[2:])
        return float(x), float(y)


def filled(size: tuple[float, float], step: float) -> Float64:
    """Return points that fill a rectangle from the origin, (n, 2), at most `step` meters apart."""
    x, y = (np.linspace(0, side, int(side / step) + 2) for side in size)
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def span(points: Float64) -> Area:
    """Return the area of points (n, 2)."""
    low, high = points.min(axis=0), points.max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
