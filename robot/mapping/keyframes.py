"""Keyframes: the scans at which segments are extracted, chosen by distance."""

import numpy as np

from placecell.core.types import Float64


class Keyframes:
    """Chooses a keyframe whenever the robot is some meters away from the last one.

    The first keyframe comes after some scans, so that a robot that stands still is localized, too.
    The noise of the odometry of a standing robot makes no keyframes.
    """

    def __init__(self, meters: float, first_scans: int) -> None:
        """Create the rule.

        Args:
            meters: distance between two keyframes, meters.
            first_scans: number of scans until the first keyframe.
        """
        self._meters = meters
        self._first_scans = first_scans
        self._scans = 0
        self._last: Float64 | None = None

    def add(self, odom_pose: Float64) -> bool:
        """Take the pose of a scan, float64 (4, 4); return whether the scan is a keyframe."""
        self._scans += 1
        position = odom_pose[:3, 3]
        if self._last is None:
            chosen = self._scans >= self._first_scans
        else:
            chosen = bool(np.linalg.norm(position - self._last) >= self._meters)
        if chosen:
            self._last = position.copy()
        return chosen

    def expect(self) -> None:
        """Make the next scan a keyframe, after the first scans."""
        self._last = None

    def reset(self) -> None:
        """Begin anew, after a jump."""
        self._scans = 0
        self._last = None
