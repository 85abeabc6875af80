"""Keyframes: the scans at which segments are extracted, chosen by distance."""

import numpy as np

from placecell.core.types import Float64


class Keyframes:
    """Chooses a keyframe whenever the robot is some meters away from the last one.

    A scan is chosen if the next one is expected to miss this distance by more. So a robot whose
    scans are 1.99 m apart makes a keyframe of each, not of every second one.

    The first keyframe comes after some scans, so that a robot that stands still is localized, too.
    A robot that drives fast makes it earlier, after the distance between two keyframes: its local
    map is not complete then, but often shows enough to localize. The noise of the odometry of a
    standing robot makes no keyframes.
    """

    def __init__(self, meters: float, first_scans: int) -> None:
        """Create the rule.

        Args:
            meters: distance between two keyframes, meters.
            first_scans: number of scans until the first keyframe of a robot that stands, and until
                the local map is complete.
        """
        self._meters = meters
        self._first_scans = first_scans
        self._scans = 0
        self._first: Float64 | None = None
        self._last: Float64 | None = None
        self._before: Float64 | None = None

    @property
    def is_complete(self) -> bool:
        """Whether the local map has scans enough for segments that are stored."""
        return self._scans >= self._first_scans

    def add(self, odom_pose: Float64) -> bool:
        """Take the pose of a scan, float64 (4, 4); return whether the scan is a keyframe."""
        self._scans += 1
        position = odom_pose[:3, 3]
        step = 0.0 if self._before is None else float(np.linalg.norm(position - self._before))
        self._before = position.copy()
        if self._first is None:
            self._first = position.copy()
        last = self._first if self._last is None else self._last
        chosen = float(np.linalg.norm(position - last)) + step / 2 >= self._meters
        if self._last is None:
            chosen = chosen or self.is_complete
        if chosen:
            self._last = position.copy()
        return chosen

    def expect(self) -> None:
        """Make the next scan a keyframe, after the first scans."""
        self._last = None

    def reset(self, odom_pose: Float64) -> None:
        """Begin anew after a jump, with the pose (4, 4) of the first scan of the new place."""
        self._scans = 1
        self._first = self._before = odom_pose[:3, 3].copy()
        self._last = None
