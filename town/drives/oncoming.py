"""Cars that come the other way while a robot drives: they smear in the accumulated scans."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh
from town.objects.car import car
from town.streets.route import Route

NEAR = 80.0
"""Cars farther from the sensor are left out, meters."""


@dataclass(frozen=True)
class Oncoming:
    """Cars on the other lane of a robot's route, each at its own even speed.

    A car stands still while the sensor sweeps over it. One that reaches the end of the lane begins
    anew.

    Attributes:
        lane: that they drive on.
        cars: their meshes, each in the car's frame.
        starts: (cars,) meters along the lane at time 0.
        speeds: (cars,) meters a second.
    """

    lane: Route
    cars: tuple[Mesh, ...]
    starts: Float64
    speeds: Float64

    @classmethod
    def draw(cls, route: Route, per_km: float, seed: int) -> Self:
        """Random cars.

        Args:
            route: of the robot.
            per_km: how many a kilometer of the lane, on average.

        Raises:
            ValueError: a negative number, or more than one every ten meters.
        """
        if not 0 <= per_km <= 100:
            raise ValueError(f"there can be 0 to 100 oncoming cars a kilometer, not {per_km}")
        rng = np.random.default_rng([seed, 9])
        lane = route.reversed()
        count = int(rng.poisson(per_km * lane.length() / 1000))
        return cls(
            lane,
            tuple(car(rng) for _ in range(count)),
            rng.uniform(0, lane.length(), size=count),
            rng.uniform(7.0, 14.0, size=count),
        )

    def around(self, place: Float64, time: float) -> Mesh:
        """The cars near a place (2,) of the town frame, at a time in seconds."""
        if not self.cars:
            return Mesh.joined([])
        along = (self.starts + time * self.speeds) % self.lane.length()
        poses = self.lane.poses(along, height=0.0)
        near = np.flatnonzero(np.linalg.norm(poses[:, :2, 3] - place, axis=1) < NEAR)
        return Mesh.joined(self.cars[index].transformed(poses[index]) for index in near)
