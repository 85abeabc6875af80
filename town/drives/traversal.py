"""Traversal: the poses of a drive, to compare it with another drive."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.types import Float64
from town.drives.drive import levelled, scan_distances
from town.sensing.lidar import HDL_64E
from town.streets.route import Route


@dataclass(frozen=True, slots=True)
class Traversal:
    """Poses of a simulated or planned drive.

    Attributes:
        poses: (n, 4, 4), sensor to town.
        origin: (4, 4), the drive's world to town.
    """

    poses: Float64
    origin: Float64

    @classmethod
    def of(cls, route: Route, scans: int, spacing: float, height: float = HDL_64E.height) -> Self:
        """Return the traversal of the drive that `write_drive` writes for these arguments."""
        poses = route.poses(scan_distances(scans, spacing), height)
        return cls(poses, levelled(poses[0]))

    @property
    def places(self) -> Float64:
        """Sensor positions in the town frame, (n, 2), meters."""
        return np.asarray(self.poses[:, :2, 3])

    def scans_in(self, meters: float) -> int:
        """Return the number of scans of a stretch of this length, meters.

        Raises:
            ValueError: The drive is shorter.
        """
        driven = np.linalg.norm(np.diff(self.places, axis=0), axis=1).sum()
        if not 0 < meters <= driven:
            raise ValueError(f"a drive of {driven:.0f} m has no stretch of {meters} m")
        return max(1, round(meters / float(driven) * (len(self.poses) - 1)))
