"""Odometry: where a robot believes to be that adds up its own motion."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64

ODOMETRY_FILE = "poses_odometry.txt"


@dataclass(frozen=True, slots=True)
class Odometry:
    """How a robot's odometry errs.

    Headings drift as a random walk, and distances are all too long or too short by one share, drawn
    once a drive. Roll and pitch do not drift: the robot feels which way is down.

    Attributes:
        yaw: standard deviation of the heading after one meter, degrees; it grows with the root of
            the meters: 0.05 is half a degree after 100 m.
        scale: standard deviation of the share by which distances are off: 0.01 is one per cent.
    """

    yaw: float = 0.05
    scale: float = 0.01

    def __post_init__(self) -> None:
        """Refuse what is no deviation.

        Raises:
            ValueError: negative, not finite, or as large as the distances themselves.
        """
        if not (0 <= self.yaw <= 90 and 0 <= self.scale <= 0.3):
            raise ValueError(
                f"drift must be 0 to 90 degrees a root meter and a share of 0 to 0.3, "
                f"not {self.yaw} and {self.scale}"
            )

    def poses(self, true: Float64, seed: int) -> Float64:
        """Where the robot believes to be.

        Args:
            true: (n, 4, 4) sensor to a z-up world.
            seed: of the errors.

        Returns:
            (n, 4, 4), the first as it truly is.
        """
        rng = np.random.default_rng([seed, 8])
        steps = np.diff(true[:, :3, 3], axis=0)
        scale = 1 + self.scale * rng.standard_normal()
        meters = np.linalg.norm(steps, axis=1)
        turns = np.radians(self.yaw) * np.sqrt(meters) * rng.standard_normal(len(steps))
        astray = np.concatenate([[0.0], np.cumsum(turns)])
        turned = np.tile(np.eye(3), (len(true), 1, 1))
        turned[:, 0, 0] = turned[:, 1, 1] = np.cos(astray)
        turned[:, 1, 0] = np.sin(astray)
        turned[:, 0, 1] = -turned[:, 1, 0]
        believed = true.copy()
        believed[:, :3, :3] = turned @ true[:, :3, :3]
        moved = scale * np.einsum("nij,nj->ni", turned[:-1], steps)
        believed[1:, :3, 3] = true[0, :3, 3] + np.cumsum(moved, axis=0)
        return believed
