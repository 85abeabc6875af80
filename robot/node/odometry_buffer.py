"""Poses of the odometry of the last seconds, for the times of scans."""

from bisect import bisect_left
from collections import deque

import numpy as np

from placecell.core.types import Float64
from placecell.odometry.deskew import SensorMotion
from placecell.trajectories.covariance import interpolate_covariances
from placecell.trajectories.interpolation import SAME, interpolate
from placecell.trajectories.scan_poses import LARGEST_GAP
from robot.node.messages import StampedTransform

KEPT_SECONDS = 10.0
JUMP_SECONDS = 1.0
"""Step back in time that is a restart of the clock, and not a late message."""


class OdometryBuffer:
    """Poses of the robot's base in the odometry frame over the last seconds."""

    def __init__(self) -> None:
        self._stamps: deque[float] = deque()
        self._poses: deque[Float64] = deque()
        self._covariances: deque[Float64 | None] = deque()
        self.last: StampedTransform | None = None

    def __len__(self) -> int:
        return len(self._stamps)

    @property
    def newest(self) -> float | None:
        """Time of the newest pose, seconds."""
        return self._stamps[-1] if self._stamps else None

    def add(self, transform: StampedTransform) -> bool:
        """Add a pose; return whether the clock was restarted, so that older poses are gone."""
        time = transform.stamp_ns * 1e-9
        restarted = self.newest is not None and time < self.newest - JUMP_SECONDS
        if restarted:
            self._stamps.clear()
            self._poses.clear()
            self._covariances.clear()
        if self.newest is not None and time <= self.newest:
            return False  # repeated, or late
        self.last = transform
        self._stamps.append(time)
        self._poses.append(transform.pose)
        self._covariances.append(transform.covariance)
        while self._stamps[0] < time - KEPT_SECONDS:
            self._stamps.popleft()
            self._poses.popleft()
            self._covariances.popleft()
        return restarted

    def is_before(self, time: float) -> bool:
        """Return whether the buffer may still get the pose at a time: it lies ahead."""
        return self.newest is None or self.newest < time - SAME

    def at(self, time: float) -> Float64 | None:
        """Return the pose at a time, float64 (4, 4).

        None if the time lies outside the poses, or in a gap of more than 0.5 s between two.
        """
        if not self._stamps:
            return None
        after = bisect_left(self._stamps, time)
        for index in (after - 1, after):
            if 0 <= index < len(self._stamps) and abs(self._stamps[index] - time) <= SAME:
                return self._poses[index]
        if not 0 < after < len(self._stamps):
            return None
        stamps = np.array([self._stamps[after - 1], self._stamps[after]])
        if stamps[1] - stamps[0] > LARGEST_GAP:
            return None
        poses = np.stack([self._poses[after - 1], self._poses[after]])
        pose: Float64 = interpolate(np.array([time]), stamps, poses)[0]
        return pose

    def covariance_at(self, time: float) -> Float64 | None:
        """Return the covariance of the pose at a time, float64 (6, 6); None if it is not known."""
        after = bisect_left(self._stamps, time)
        near = range(max(0, after - 1), min(len(self._stamps), after + 1))
        found = [self._covariances[index] for index in near]
        known = [each for each in found if each is not None]
        if not known or len(known) < len(found):
            return None
        stamps = np.array([self._stamps[index] for index in near])
        return np.asarray(interpolate_covariances(np.array([time]), stamps, np.stack(known))[0])

    def motion(self, first: float, last: float, mount: Float64) -> SensorMotion | None:
        """Return the sensor's motion from a time to another; None without two poses.

        Args:
            first: time of the first point, seconds.
            last: time of the last point, seconds.
            mount: pose of the sensor on the robot's base, float64 (4, 4).
        """
        begin = max(0, bisect_left(self._stamps, first) - 1)
        end = min(len(self._stamps), bisect_left(self._stamps, last) + 1)
        begin = max(0, min(begin, end - 2))
        stamps = np.array([self._stamps[index] for index in range(begin, end)])
        if len(stamps) < 2:
            return None
        poses = np.stack([self._poses[index] for index in range(begin, end)])
        return SensorMotion.of(stamps, np.asarray(poses @ mount))
