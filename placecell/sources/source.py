"""Interface of all sources of scans."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar

from placecell.core.types import Float64
from placecell.sources.imu import ImuSamples
from placecell.sources.scan import LidarScan
from placecell.trajectories.trajectory import Trajectory


class ScanSource(ABC):
    """A sequence of scans in files of one format.

    Attributes:
        format: name of the format, such as "ROS 2 bag"; docs and `placecell inspect` show it.
        path: file or folder of the source.
        stamps: time of each scan, float64 (scans,), seconds, not descending; NaN if unknown.
        frame: name of the sensor's coordinate frame; "" if the files do not state one.
        fields: names of the values of each point in the files, in their order.
    """

    format: ClassVar[str]

    path: Path
    stamps: Float64
    frame: str = ""
    fields: Sequence[str] = ()

    @classmethod
    @abstractmethod
    def recognizes(cls, path: Path) -> bool:
        """Return whether the file or folder has this format, told by its content."""

    @property
    def title(self) -> str:
        """Name of the source in recordings and reports."""
        return self.path.stem if self.path.is_file() else self.path.name

    def __len__(self) -> int:
        return len(self.stamps)

    @abstractmethod
    def scan(self, index: int) -> LidarScan:
        """Read a scan.

        Raises:
            DriveError: the scan is damaged; the message names the file and what to do.
        """

    @abstractmethod
    def scan_hash(self, index: int) -> str:
        """Return a scan's identity: the SHA-256 of its content, shortened to 16 hex digits."""

    def trajectory(self) -> Trajectory | None:
        """Return the poses in the source's own files; None if it has none.

        The poses are those of the sensor, if the files tell where it is mounted; else those of the
        frame `Trajectory.frame`.

        Raises:
            DriveError: the poses are damaged.
        """
        return None

    def imu(self, first: float, last: float) -> ImuSamples | None:  # noqa: ARG002
        """Return what an IMU measured between two stamps, seconds; None if there is none.

        Raises:
            DriveError: the measurements are damaged.
        """
        return None

    def notes(self) -> Sequence[str]:
        """Return remarks about odd content that was found so far, for the user."""
        return ()
