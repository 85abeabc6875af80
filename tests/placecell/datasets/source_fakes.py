"""A source of scans in memory."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.sources import DriveError, LidarScan, ScanSource
from placecell.trajectories.trajectory import Trajectory


class MemorySource(ScanSource):
    """Scans in memory, with or without poses of their own."""

    format = "memory"

    def __init__(
        self,
        scans: Sequence[object],
        stamps: Sequence[float] | None = None,
        own: Trajectory | None = None,
        times: Sequence[Float64] | None = None,
        frame: str = "lidar",
        path: Path = Path("memory.bag"),
    ) -> None:
        self.path = path
        self.frame = frame
        self.fields = ("x", "y", "z")
        self.points: list[Float32] = [np.asarray(scan, np.float32).reshape(-1, 3) for scan in scans]
        self.stamps = np.full(len(scans), np.nan) if stamps is None else np.asarray(stamps, float)
        self.own = own
        self.times = times
        self.damaged: set[int] = set()

    @classmethod
    def recognizes(cls, path: Path) -> bool:
        return False

    def scan(self, index: int) -> LidarScan:
        if index in self.damaged:
            raise DriveError(f"{self.path}: scan {index} is damaged")
        times = None if self.times is None else self.times[index]
        return LidarScan.of(self.points[index], times, float(self.stamps[index]))

    def scan_hash(self, index: int) -> str:
        return f"{index:016x}"

    def trajectory(self) -> Trajectory | None:
        return self.own

    def notes(self) -> Sequence[str]:
        return ("a remark",)
