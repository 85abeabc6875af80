"""Live odometry: poses while the scans come, without a look at later ones."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.odometry.deskew import SensorMotion, deskew
from placecell.odometry.ground_plane import NoGroundError, find_common_ground
from placecell.odometry.leveling import leveling_of
from placecell.odometry.scan_odometry import (
    USUAL_PERIOD,
    OdometrySettings,
    ScanOdometry,
    rotated,
)
from placecell.sources.scan import LidarScan

LEVELING_SCANS = 20
"""Number of scans in which the ground is sought before the first pose is given."""


@dataclass(frozen=True, slots=True)
class PosedScan:
    """Scan with its pose.

    Attributes:
        points: float32 (n, 3), meters, in the sensor's frame, deskewed.
        time: time of the scan, seconds.
        pose: pose of the sensor in the odometry frame, z up, float64 (4, 4).
        covariance: covariance of the pose, of x, y, z and the rotations about the frame's axes,
            float64 (6, 6); None if it is not known.
    """

    points: Float32
    time: float
    pose: Float64
    covariance: Float64 | None = None


class LiveOdometry:
    """Odometry from scans alone: KISS-ICP, with z of its frame turned up by the ground.

    The first scans are held back until the direction of up is known; each later scan gives its pose
    at once.
    """

    def __init__(self, use_times: bool = True) -> None:
        """Create the odometry.

        Args:
            use_times: deskew scans whose points have times.
        """
        self._use_times = use_times
        self._odometry: ScanOdometry | None = None
        self._level: Float64 | None = None
        self._held: list[PosedScan] = []
        self._last: float | None = None

    def add(self, scan: LidarScan) -> list[PosedScan]:
        """Take the next scan; return the scans whose poses are known now, in their order.

        Raises:
            DriveError: KISS-ICP is not installed.
        """
        time = self._time_of(scan.stamp)
        if self._odometry is None:
            if not len(scan.points):
                return []  # The first scan with points tells the range of the sensor.
            self._odometry = ScanOdometry(OdometrySettings.of_points([scan.points], True))
        if not self._use_times:
            scan = replace(scan, times=None)
        before = (self._odometry.stamps[-1:], self._odometry.poses[-1:])
        pose = self._odometry.add(scan, time)
        points = scan.points
        if scan.times is not None and before[0]:
            motion = SensorMotion(np.array([*before[0], time]), np.array([*before[1], pose]))
            points = deskew(points, scan.times, time, motion)
        posed = PosedScan(points, time, pose)
        if self._level is not None:
            return [replace(posed, pose=self._level @ pose)]
        self._held.append(posed)
        return self.flush() if len(self._held) == LEVELING_SCANS else []

    def flush(self) -> list[PosedScan]:
        """Return the scans that are held back: no further ones come, or enough were seen."""
        held, self._held = self._held, []
        if not held:
            return []
        self._level = level = level_of(held)
        return [replace(each, pose=level @ each.pose) for each in held]

    def _time_of(self, stamp: float) -> float:
        """Return the time of a scan; unknown and repeated ones are 0.1 s after the last."""
        last = self._last
        if last is None:
            self._last = stamp if np.isfinite(stamp) else 0.0
        elif not np.isfinite(stamp) or stamp <= last:
            self._last = last + USUAL_PERIOD
        else:
            self._last = stamp
        return self._last


def level_of(scans: list[PosedScan]) -> Float64:
    """Return the transform (4, 4) that turns z of the odometry up, by the ground in some scans."""
    clouds = [rotated(each.points, each.pose) for each in scans if len(each.points)]
    try:
        return leveling_of(find_common_ground(clouds).up)
    except NoGroundError:
        return np.eye(4)


def posed_scans(scans: Iterator[LidarScan], use_times: bool = True) -> Iterator[PosedScan]:
    """Yield scans with their poses, as a robot would get them."""
    odometry = LiveOdometry(use_times)
    for scan in scans:
        yield from odometry.add(scan)
    yield from odometry.flush()
