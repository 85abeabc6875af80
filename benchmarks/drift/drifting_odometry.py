"""Odometry whose errors wander: what a pose graph can correct, unlike one constant scale error."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from town.sensing.odometry import drifted

YAW_PER_PERCENT = 0.05
"""Deviation of the heading after one meter, degrees, for each percent of drift; it grows with the
square root of the distance."""

WANDERS = 100.0
"""Distance over which the scale error forgets its value, meters."""


@dataclass(frozen=True, slots=True)
class WanderingOdometry:
    """Error model: the scale error wanders (Gauss-Markov), and the heading is a random walk.

    Roll and pitch do not drift, because gravity is measured.

    Attributes:
        percent: standard deviation of the scale error, percent.
    """

    percent: float

    def poses(self, true: Float64, seed: int) -> Float64:
        """Return the estimated poses, (n, 4, 4); the first one is exact.

        Args:
            true: (n, 4, 4), true transforms from the sensor to a z-up world.
            seed: seed of the errors.
        """
        rng = np.random.default_rng([seed, 23])
        steps = np.diff(true[:, :3, 3], axis=0)
        meters = np.linalg.norm(steps, axis=1)
        keeps = np.exp(-meters / WANDERS)
        kicks = rng.standard_normal((len(steps), 2))
        errors = np.empty(len(steps))
        error = rng.standard_normal()
        for number, (keep, kick) in enumerate(zip(keeps, kicks[:, 0], strict=True)):
            error = keep * error + np.sqrt(1 - keep**2) * kick
            errors[number] = error
        scales = 1 + self.percent / 100 * errors
        turns = np.radians(YAW_PER_PERCENT * self.percent) * np.sqrt(meters) * kicks[:, 1]
        return drifted(true, scales, turns)
