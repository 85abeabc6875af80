"""Measurements of an IMU, in the axes of the LiDAR."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64

GRAVITY = 9.80665
"""Acceleration of gravity, m/s^2."""


@dataclass(frozen=True, slots=True, eq=False)
class ImuSamples:
    """Measurements of an IMU.

    Attributes:
        topic: where they come from, for messages.
        stamps: time of each, float64 (n,), seconds, ascending, on the clock of the scans.
        accelerations: specific force, float64 (n, 3), m/s^2: at rest it points up.
        rates: angular velocity, float64 (n, 3), rad/s.
        ups: direction of up by the orientation that the driver estimates, float64 (n, 3), unit
            vectors; None if there is no orientation.
        mount: pose of the IMU in the LiDAR's frame, float64 (4, 4). The other attributes are in the
            axes of the LiDAR already.
        how: how the mount was found.
    """

    topic: str
    stamps: Float64
    accelerations: Float64
    rates: Float64
    ups: Float64 | None
    mount: Float64
    how: str

    def __len__(self) -> int:
        return len(self.stamps)

    @property
    def rate_hz(self) -> float:
        """Return measurements a second; 0 for fewer than two."""
        seconds = float(self.stamps[-1] - self.stamps[0]) if len(self) > 1 else 0.0
        return (len(self) - 1) / seconds if seconds > 0 else 0.0

    def between(self, first: float, last: float) -> "ImuSamples":
        """Return the measurements of a span of time."""
        chosen = slice(*np.searchsorted(self.stamps, [first, last]))
        return ImuSamples(
            self.topic,
            self.stamps[chosen],
            self.accelerations[chosen],
            self.rates[chosen],
            None if self.ups is None else self.ups[chosen],
            self.mount,
            self.how,
        )
