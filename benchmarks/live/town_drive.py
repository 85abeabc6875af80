"""Drives through a large town, simulated scan by scan, with kidnaps and a part without a map."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Float64
from town import City, Lidar, Odometry, Route
from town.drives.drive import levelled
from town.geometry.scene import Scenes
from town.sensing.lidar import SWEEP_SECONDS


@dataclass(frozen=True, slots=True)
class LiveScan:
    """Scan of a live drive.

    Attributes:
        points: float32 (n, 3), meters, in the sensor's frame.
        time: time of the scan, seconds.
        odom_pose: pose of the sensor by the odometry, float64 (4, 4).
        true_pose: true pose in the town frame, float64 (4, 4).
        leg: number of kidnaps before the scan.
    """

    points: Float32
    time: float
    odom_pose: Float64
    true_pose: Float64
    leg: int


@dataclass(frozen=True)
class TownDrive:
    """Robot that drives legs of a route; between two legs it is carried away.

    Attributes:
        city: the town.
        route: route of the robot.
        lidar: sensor.
        seed: seed of parked cars and noise.
        spacing: distance between two scans, meters.
        odometry: drift of the odometry; None for true poses.
    """

    city: City
    route: Route
    lidar: Lidar
    seed: int
    spacing: float
    odometry: Odometry | None = None

    def scans(self, legs: list[tuple[float, float]]) -> Iterator[LiveScan]:
        """Yield the scans of legs, each from one distance along the route to another, meters."""
        scenes = self.city.scenes(self.seed, self.lidar.max_range)
        carried: Float64 | None = None
        number = 0
        for leg, (first, last) in enumerate(legs):
            distances = np.arange(first, last, self.spacing)
            true = self.route.poses(distances, self.lidar.height)
            believed = true
            if self.odometry is not None:
                believed = self.odometry.poses(true, self.seed + leg)
                # The odometry goes on by one step while the robot is carried away.
                begun = np.eye(4) if carried is None else carried
                believed = begun @ np.linalg.inv(levelled(believed[0])) @ believed
            for distance, pose, odom_pose in zip(distances, true, believed, strict=True):
                points = self._scan(scenes, float(distance), pose, number)
                yield LiveScan(points, number * SWEEP_SECONDS, odom_pose, pose, leg)
                number += 1
            step = np.eye(4)
            step[0, 3] = self.spacing
            carried = levelled(believed[-1]) @ step

    def _scan(self, scenes: Scenes, distance: float, pose: Float64, number: int) -> Float32:
        rng = np.random.default_rng([self.seed, 77, number])
        sweep = self.route.poses(
            distance + self.spacing * self.lidar.sweep_times(), self.lidar.height
        )
        found = self.lidar.scan(scenes.around(pose[:2, 3]), sweep, pose, rng, 0.0)
        return np.ascontiguousarray(found[:, :3], dtype=np.float32)
