"""Oncoming cars during a drive: they leave a trail in the accumulated scans."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh
from town.objects.car import car
from town.objects.labels import all_of
from town.streets.route import Route

NEAR = 80.0
"""Largest distance of a simulated car from the sensor, meters."""


MOVING_CAR = 252
"""Label of the cars (`placecell.datasets.labels`)."""


@dataclass(frozen=True)
class Oncoming:
    """Cars on the opposite lane of a robot's route, each with its own constant speed.

    A car does not move during a sweep. At the end of the lane a car starts again.

    Attributes:
        lane: lane of the cars.
        cars: mesh of each car in its own frame.
        starts: (cars,), position along the lane at time 0, meters.
        speeds: (cars,), meters per second.
    """

    lane: Route
    cars: tuple[Mesh, ...]
    starts: Float64
    speeds: Float64

    @classmethod
    def draw(cls, route: Route, per_km: float, seed: int) -> Self:
        """Draw random cars.

        Args:
            route: route of the robot.
            per_km: mean number of cars per kilometer of the lane, 0 to 100.
            seed: seed of the cars.

        Raises:
            ValueError: `per_km` is out of range.
        """
        if not 0 <= per_km <= 100:
            raise ValueError(
                f"Invalid number of oncoming cars per kilometer: expected 0 to 100, not {per_km}"
            )
        rng = np.random.default_rng([seed, 9])
        lane = route.reversed()
        count = int(rng.poisson(per_km * lane.length() / 1000))
        return cls(
            lane,
            tuple(all_of(car(rng), MOVING_CAR) for _ in range(count)),
            rng.uniform(0, lane.length(), size=count),
            rng.uniform(7.0, 14.0, size=count),
        )

    def around(self, place: Float64, time: float) -> Mesh:
        """Return the cars near a place (2,) of the town frame at a time, seconds."""
        if not self.cars:
            return Mesh.joined([])
        along = (self.starts + time * self.speeds) % self.lane.length()
        poses = self.lane.poses(along, height=0.0)
        near = np.flatnonzero(np.linalg.norm(poses[:, :2, 3] - place, axis=1) < NEAR)
        return Mesh.joined(self.cars[index].transformed(poses[index]) for index in near)
