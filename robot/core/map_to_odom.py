"""Correction `map -> odom`: where the odometry frame lies in the map."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64


@dataclass(frozen=True, slots=True, eq=False)
class MapToOdom:
    """Transform from the odometry frame into the map's frame, with its uncertainty.

    Attributes:
        transform: pose of the odometry frame in the map, float64 (4, 4).
        covariance: covariance of the robot's pose in the map, float64 (6, 6): x, y, z and the
            rotations about the map's axes; square meters and square radians. It holds at the
            robot's position, so it grows with the distance since the last fix.
        map: name of the map.
        time: time of the scan that it holds for, seconds.
    """

    transform: Float64
    covariance: Float64
    map: str
    time: float

    def pose(self, odom_pose: Float64) -> Float64:
        """Return the pose in the map of a pose in the odometry frame, float64 (4, 4)."""
        return np.asarray(self.transform @ odom_pose)
