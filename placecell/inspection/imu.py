"""IMU of a source: what it tells about the direction of up."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from placecell.inspection.ground import SensorMount
from placecell.inspection.problem import SourceProblem
from placecell.inspection.subject import Subject
from placecell.odometry.deskew import SensorMotion
from placecell.odometry.gravity import Gravity, NotLevelError, angle_deg, find_gravity
from placecell.odometry.leveling import FIRST_SECONDS
from placecell.sources.errors import DriveError
from placecell.sources.imu import ImuSamples
from placecell.trajectories.scan_poses import ScanPoses

STANDING_SECONDS = 2.0
"""Time from the first scan in which a robot without poses is expected to stand, seconds."""
LARGEST_DIFFERENCE = 8.0
"""Largest usual angle between up by the IMU and by the ground, degrees: streets slope."""


@dataclass(frozen=True, slots=True)
class SourceImu:
    """Findings on the IMU of a source.

    Attributes:
        samples: measurements at the first scans.
        gravity: up in the frame of the first scan; None if the IMU does not tell it.
        reason: why it does not.
    """

    samples: ImuSamples
    gravity: Gravity | None
    reason: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return the findings as JSON values."""
        return {
            "topic": self.samples.topic,
            "rate_hz": round(self.samples.rate_hz, 2),
            "mount": self.samples.how,
            "orientation": self.samples.ups is not None,
            "tilt_deg": None if self.gravity is None else round(self.gravity.tilt_deg, 2),
            "reason": self.reason or None,
        }


def read_source_imu(subject: Subject, poses: ScanPoses | None) -> SourceImu | None:
    """Read the IMU at the first scans; None if there is none.

    Args:
        subject: the source.
        poses: poses of its scans; without them, the robot is expected to stand at the start.
    """
    stamps = subject.stamps[np.isfinite(subject.stamps)]
    if not len(stamps):
        return None
    motion = first_motion(poses)
    start = float(stamps.min()) if motion is None else float(motion.stamps[0])
    end = start + STANDING_SECONDS if motion is None else float(motion.stamps[-1])
    try:
        samples = subject.imu(start, end)
    except DriveError:  # `subject.problems` has it: the poses come from the same transforms.
        return None
    if samples is None:
        return None
    try:
        return SourceImu(samples, find_gravity(samples.between(start, end), motion))
    except NotLevelError as error:
        return SourceImu(samples, None, str(error))


def first_motion(poses: ScanPoses | None) -> SensorMotion | None:
    """Return the motion of the first seconds in the frame of the first scan with a pose."""
    if poses is None or poses.stamps is None or not len(poses.stamps):
        return None
    count = int(np.searchsorted(poses.stamps, poses.stamps[0] + FIRST_SECONDS))
    moved = np.linalg.inv(poses.poses[0]) @ poses.poses[:count]
    return SensorMotion.of(poses.stamps[:count], moved) if count > 3 else None


def imu_problems(imu: SourceImu | None, mount: SensorMount) -> Iterator[SourceProblem]:
    """Find an IMU that does not tell up, or another up than the ground."""
    if imu is None:
        return
    if imu.gravity is None:
        yield SourceProblem(
            "info",
            f"The IMU does not tell up: {imu.reason}",
            "Odometry is leveled by the ground. Let the robot stand for 2 s at the start of a "
            "recording.",
        )
        return
    if mount.ground is None:
        return
    apart = angle_deg(imu.gravity.up, mount.ground.up)
    if apart > LARGEST_DIFFERENCE:
        yield SourceProblem(
            "warning",
            f"Up by the IMU and up by the ground differ by {apart:.0f} degrees; the IMU is mounted "
            f"by {imu.samples.how}",
            "Check the transform between LiDAR and IMU in /tf_static. No action is needed if the "
            "robot starts on a ramp.",
        )
