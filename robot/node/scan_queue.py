"""Bounded queue of scans that wait for the odometry; the newest scan wins."""

from collections import deque
from dataclasses import dataclass

from placecell.core.types import Float64
from placecell.sources.bags.pointcloud2 import PointCloud2
from robot.node.odometry_buffer import OdometryBuffer


@dataclass(frozen=True, slots=True, eq=False)
class WaitingScan:
    """Scan with the time at which it arrived, on the node's monotonic clock, seconds."""

    cloud: PointCloud2
    arrived: float

    @property
    def time(self) -> float:
        """Time of the scan, seconds."""
        return self.cloud.stamp_ns * 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class PairedScan:
    """Scan with the pose of the robot's base in the odometry frame.

    Attributes:
        scan: the scan.
        odom_pose: the pose, float64 (4, 4).
        covariance: its covariance, float64 (6, 6); None if it is not known.
    """

    scan: WaitingScan
    odom_pose: Float64
    covariance: Float64 | None = None


class ScanQueue:
    """Scans that wait for the odometry at their time.

    Attributes:
        late: number of scans that were dropped because a newer one was there.
        unpaired: number of scans that were dropped because no odometry came in time.
    """

    def __init__(self, capacity: int, wait: float) -> None:
        """Create an empty queue.

        Args:
            capacity: largest number of waiting scans.
            wait: longest wait for the odometry, seconds.
        """
        self._waiting: deque[WaitingScan] = deque()
        self._capacity = capacity
        self._wait = wait
        self.late = 0
        self.unpaired = 0

    def __len__(self) -> int:
        return len(self._waiting)

    def clear(self) -> None:
        """Drop all scans: their clock was restarted."""
        self._waiting.clear()

    def add(self, scan: WaitingScan) -> None:
        """Add a scan; drop the oldest one if the queue is full."""
        self._waiting.append(scan)
        if len(self._waiting) > self._capacity:
            self._waiting.popleft()
            self.late += 1

    def take(self, odometry: OdometryBuffer, now: float) -> PairedScan | None:
        """Return the newest scan that has a pose, and drop those before it; None: wait.

        Args:
            odometry: poses of the odometry.
            now: time on the node's monotonic clock, seconds.
        """
        for index in reversed(range(len(self._waiting))):
            scan = self._waiting[index]
            pose = odometry.at(scan.time)
            if pose is not None:
                for _ in range(index + 1):
                    self._waiting.popleft()
                self.late += index
                return PairedScan(scan, pose, odometry.covariance_at(scan.time))
        before = len(self._waiting)
        self._waiting = deque(
            scan
            for scan in self._waiting
            if odometry.is_before(scan.time) and now - scan.arrived <= self._wait
        )
        self.unpaired += before - len(self._waiting)
        return None
