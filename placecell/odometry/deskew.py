"""Deskewing: the points of a sweep, moved to where the sensor was at the scan's time.

A moving sensor measures each point from another place. The sensor's velocity is taken as constant
between two poses.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float32, Float64

KNOTS = 65
"""Moments of a sweep for which poses are computed; between them, points move linearly. A sensor
that turns by 20 degrees in a sweep is off by 0.2 mm at 50 m."""
FARTHEST = 1.0
"""Largest time from a point to the nearest pose, seconds."""


@dataclass(frozen=True, slots=True, eq=False)
class SensorMotion:
    """Poses of the sensor over time.

    Attributes:
        stamps: float64 (n,), seconds, ascending without repetitions; n is 2 or more.
        poses: float64 (n, 4, 4), sensor to world.
    """

    stamps: Float64
    poses: Float64

    @classmethod
    def of(cls, stamps: Float64 | None, poses: Float64) -> "SensorMotion | None":
        """Return the motion, or None if there are no two poses with ascending times."""
        if stamps is None or len(stamps) < 2 or not (np.diff(stamps) > 0).all():
            return None
        return cls(stamps, poses)

    def covers(self, first: float, last: float) -> bool:
        """Return whether poses are close enough in time to all moments from first to last."""
        return bool(self.stamps[0] - first <= FARTHEST and last - self.stamps[-1] <= FARTHEST)

    def at(self, times: Float64) -> Float64:
        """Return the pose at each time, float64 (k, 4, 4).

        The velocity between two poses is constant; before the first pose and after the last it is
        that of the nearest two.
        """
        before = np.clip(np.searchsorted(self.stamps, times, side="right") - 1, 0, None)
        before = np.minimum(before, len(self.stamps) - 2)
        first, second = self.poses[before], self.poses[before + 1]
        start = self.stamps[before]
        share = (times - start) / (self.stamps[before + 1] - start)
        turned = Rotation.from_matrix(first[:, :3, :3]).inv() * Rotation.from_matrix(
            second[:, :3, :3]
        )
        turn = Rotation.from_rotvec(share[:, None] * turned.as_rotvec()).as_matrix()
        found = np.tile(np.eye(4), (len(times), 1, 1))
        found[:, :3, :3] = first[:, :3, :3] @ turn
        found[:, :3, 3] = first[:, :3, 3] + share[:, None] * (second[:, :3, 3] - first[:, :3, 3])
        return found


def deskew(points: Float32, times: Float64, stamp: float, motion: SensorMotion) -> Float32:
    """Move each point to the sensor's frame at the scan's time.

    Args:
        points: float32 (n, 3), meters, each in the sensor's frame at its own time.
        times: float64 (n,), time of each point relative to the scan's, seconds.
        stamp: time of the scan, seconds.
        motion: poses of the sensor.

    Returns:
        float32 (n, 3), meters.
    """
    if not len(points):
        return points
    knots = np.linspace(times.min(), times.max(), KNOTS)
    at_scan = motion.at(np.array([stamp]))[0]
    moved = np.linalg.inv(at_scan) @ motion.at(stamp + knots)
    found = np.empty((len(points), 3))
    for row in range(3):
        terms = [np.interp(times, knots, moved[:, row, column]) for column in range(4)]
        found[:, row] = terms[3]
        for column in range(3):
            found[:, row] += terms[column] * points[:, column]
    return found.astype(np.float32)
