"""Odometry: poses of a robot that integrates its own motion, with drift."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64

ODOMETRY_FILE = "poses_odometry.txt"


@dataclass(frozen=True, slots=True)
class Odometry:
    """Error model of a robot's odometry.

    The heading drifts as a random walk. All distances of a drive have one random scale error. Roll
    and pitch do not drift, because gravity is measured.

    Attributes:
        yaw: standard deviation of the heading after one meter, degrees. It grows with the square
            root of the distance: 0.05 gives 0.5 degrees after 100 m.
        scale: standard deviation of the scale error: 0.01 is one percent.
    """

    yaw: float = 0.05
    scale: float = 0.01

    def __post_init__(self) -> None:
        """Check the standard deviations.

        Raises:
            ValueError: A value is out of range.
        """
        if not (0 <= self.yaw <= 90 and 0 <= self.scale <= 0.3):
            raise ValueError(
                f"Invalid drift: expected a yaw of 0 to 90 degrees and a scale of 0 to 0.3, "
                f"not {self.yaw} and {self.scale}"
            )

    def poses(self, true: Float64, seed: int) -> Float64:
        """Return the estimated poses.

        Args:
            true: (n, 4, 4), true transforms from the sensor to a z-up world.
            seed: seed of the errors.

        Returns:
            Estimated poses, (n, 4, 4). The first one is exact.
        """
        rng = np.random.default_rng([seed, 8])
        steps = np.diff(true[:, :3, 3], axis=0)
        scales = np.full(len(steps), 1 + self.scale * rng.standard_normal())
        meters = np.linalg.norm(steps, axis=1)
        turns = np.radians(self.yaw) * np.sqrt(meters) * rng.standard_normal(len(steps))
        return drifted(true, scales, turns)


def drifted(true: Float64, scales: Float64, turns: Float64) -> Float64:
    """Integrate a motion with errors in each step.

    Args:
        true: (n, 4, 4), true transforms from the sensor to a z-up world.
        scales: (n - 1,), factor of the length of each step.
        turns: (n - 1,), error of the heading in each step, radians.

    Returns:
        Estimated poses, (n, 4, 4). The first one is exact.
    """
    steps = np.diff(true[:, :3, 3], axis=0)
    astray = np.concatenate([[0.0], np.cumsum(turns)])
    turned = np.tile(np.eye(3), (len(true), 1, 1))
    turned[:, 0, 0] = turned[:, 1, 1] = np.cos(astray)
    turned[:, 1, 0] = np.sin(astray)
    turned[:, 0, 1] = -turned[:, 1, 0]
    believed = true.copy()
    believed[:, :3, :3] = turned @ true[:, :3, :3]
    moved = scales[:, None] * np.einsum("nij,nj->ni", turned[:-1], steps)
    believed[1:, :3, 3] = true[0, :3, 3] + np.cumsum(moved, axis=0)
    return believed
