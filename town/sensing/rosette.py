"""Simulated solid-state LiDAR with a non-repeating rosette pattern, modeled on the Livox Avia."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32
from town.sensing.lidar import SWEEP_SECONDS, Lidar


@dataclass(frozen=True, slots=True)
class Rosette(Lidar):
    """Sensor that looks ahead and steers its lasers by two rotating prisms (Risley prisms).

    Each prism deflects the lasers by half of `half_view`, in the direction of its own rotation. By
    the default speeds the pattern repeats after 300 scans, so each scan draws other lines.
    `elevations` are the angles between the parallel lasers and the axis, and `columns` is the
    number of shots of each laser in a scan.

    Attributes:
        half_view: largest deflection of a laser from its own axis, degrees.
        speeds: speeds of the two prisms, revolutions per minute; the signs are the directions.
    """

    half_view: float = 35.2
    speeds: tuple[float, float] = (7294.0, -4664.0)

    def directions(self, time: float = 0.0) -> Float32:
        """Return the beam directions of a scan: unit vectors, sensor frame.

        Args:
            time: time of the middle of the scan, seconds.

        Returns:
            float32 (columns, lasers, 3).
        """
        seconds = time + SWEEP_SECONDS * self.sweep_times()
        angles = 2 * np.pi / 60 * seconds[:, None] * np.array(self.speeds)
        deflected = np.radians(self.half_view) / 2 * np.exp(1j * angles).sum(axis=1)
        view = deflected[:, None] + 1j * np.radians(self.elevations)
        # The deflection is an angle from the axis ahead: x of the complex number left, y up.
        off = np.abs(view)
        sideways = np.sinc(off / np.pi)
        return np.stack([np.cos(off), sideways * view.real, sideways * view.imag], axis=-1).astype(
            np.float32
        )
