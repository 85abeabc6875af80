"""Gravity: the direction of up by an IMU.

An accelerometer measures the acceleration of its body and the reaction to gravity. The mean over
some seconds, in the world of the odometry, is gravity's reaction plus the change of velocity over
the time; the odometry knows that change. So the robot need not stand still. The mean is believed if
it has the size of gravity, and if both halves of the time give the same direction.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from placecell.odometry.deskew import SensorMotion
from placecell.sources.imu import GRAVITY, ImuSamples

SHORTEST = 0.5
"""Shortest time over which accelerations are averaged, seconds."""
FEWEST = 20
"""Fewest measurements."""
LARGEST_ERROR = 0.3
"""Largest difference of the mean from gravity, m/s^2: the bias of low-cost IMUs is smaller."""
LARGEST_ANGLE = 2.0
"""Largest angle between the directions of up of both halves of the time, degrees."""
LARGEST_RATE = 0.05
"""Largest mean angular velocity of a robot that stands, rad/s: the bias of gyroscopes."""
OPPOSITE = 120.0
"""Angle to the mean acceleration from which an orientation is one with z down, degrees."""


class NotLevelError(ValueError):
    """The IMU does not tell up; the message says why."""


@dataclass(frozen=True, slots=True)
class Gravity:
    """Up by an IMU.

    Attributes:
        up: direction of up in the world of the poses, unit vector, float64 (3,).
        how: how it was found, for the user.
    """

    up: Float64
    how: str

    @property
    def tilt_deg(self) -> float:
        """Angle between up and the world's z axis, degrees."""
        return angle_deg(self.up, np.array([0.0, 0.0, 1.0]))


def find_gravity(imu: ImuSamples, motion: SensorMotion | None) -> Gravity:
    """Find up in the world of the poses.

    Args:
        imu: measurements of the first seconds.
        motion: poses of the LiDAR in these seconds; None: it is taken to stand still.

    Raises:
        NotLevelError: the IMU does not tell up.
    """
    if motion is not None:
        # The velocity at both ends needs a pose before and after.
        imu = imu.between(float(motion.stamps[1]), float(motion.stamps[-2]))
    seconds = float(np.ptp(imu.stamps)) if len(imu) else 0.0
    if len(imu) < FEWEST or seconds < SHORTEST:
        raise NotLevelError(
            f"{imu.topic!r} has {len(imu)} measurements in {seconds:.1f} s of the first scans; "
            f"expected {FEWEST} in {SHORTEST} s"
        )
    rate = float(np.linalg.norm(imu.rates.mean(axis=0)))
    if motion is None and rate > LARGEST_RATE:
        raise NotLevelError(f"the robot turns at {rate:.2f} rad/s; expected a robot that stands")
    turns = np.tile(np.eye(3), (len(imu), 1, 1))
    if motion is not None:
        turns = motion.at(imu.stamps)[:, :3, :3]
    forces = np.einsum("nij,nj->ni", turns, imu.accelerations)
    try:
        up = mean_force(imu.stamps, forces, motion)
        return Gravity(up, f"{len(imu)} accelerations of {imu.topic!r} in {seconds:.1f} s")
    except NotLevelError as error:
        if imu.ups is None:
            raise
        ups = np.einsum("nij,nj->ni", turns, imu.ups)
        up = unit(ups.mean(axis=0))
        apart = angle_deg(*(unit(half.mean(axis=0)) for half in np.array_split(ups, 2)))
        if apart > LARGEST_ANGLE:
            raise NotLevelError(f"{error}; its orientations turn by {apart:.1f} degrees") from error
        if angle_deg(up, unit(forces.mean(axis=0))) > OPPOSITE:
            up = -up  # Worlds of north, east and down have z down.
        return Gravity(up, f"{len(imu)} orientations of {imu.topic!r} in {seconds:.1f} s ({error})")


def mean_force(stamps: Float64, forces: Float64, motion: SensorMotion | None) -> Float64:
    """Return up by the mean specific force in the world.

    Raises:
        NotLevelError: the mean is not gravity, or it changes.
    """
    halves = [
        mean_of(stamps[half], forces[half], motion)
        for half in np.array_split(np.arange(len(stamps)), 2)
    ]
    mean = mean_of(stamps, forces, motion)
    size = float(np.linalg.norm(mean))
    if abs(size - GRAVITY) > LARGEST_ERROR:
        raise NotLevelError(
            f"the mean acceleration is {size:.2f} m/s^2; expected {GRAVITY:.2f} m/s^2 of a robot "
            "that stands or whose motion is known"
        )
    apart = angle_deg(*(unit(half) for half in halves))
    if apart > LARGEST_ANGLE:
        raise NotLevelError(
            f"the mean acceleration turns by {apart:.1f} degrees; expected a robot that stands or "
            "whose motion is known"
        )
    return unit(mean)


def mean_of(stamps: Float64, forces: Float64, motion: SensorMotion | None) -> Float64:
    """Return the mean force less the change of velocity over the time, m/s^2."""
    mean = forces.mean(axis=0)
    if motion is None:
        return np.asarray(mean)
    first, last = velocity(motion, stamps[0]), velocity(motion, stamps[-1])
    return np.asarray(mean - (last - first) / (stamps[-1] - stamps[0]))


def velocity(motion: SensorMotion, time: float) -> Float64:
    """Return the velocity at a time, by the poses around it, m/s."""
    step = float(np.median(np.diff(motion.stamps)))
    before, after = motion.at(np.array([time - step, time + step]))
    return np.asarray((after[:3, 3] - before[:3, 3]) / (2 * step))


def unit(vector: Float64) -> Float64:
    """Return a vector of length 1 in the same direction."""
    return np.asarray(vector / max(float(np.linalg.norm(vector)), 1e-12))


def angle_deg(one: Float64, other: Float64) -> float:
    """Return the angle between two unit vectors, degrees."""
    return float(np.degrees(np.arccos(np.clip(one @ other, -1.0, 1.0))))
