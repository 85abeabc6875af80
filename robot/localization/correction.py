"""Correction of the odometry by fixes: a filter with a jump guard."""

from collections import deque
from typing import Literal

import numpy as np

from placecell.core.types import Float64
from robot.core.map_to_odom import MapToOdom
from robot.core.settings import DriftRates
from robot.core.status import Fix
from robot.localization.rigid import difference, inverse, moved_by

Verdict = Literal["first", "confirmed", "jump", "contradicts", "unconfirmed"]
"""How a fix relates to the pose: the first pose, an agreeing one, a pose elsewhere that several
fixes agree on, one that contradicts the pose, and one that waits for another to agree."""

RIGHT_METERS = 1.0
"""Largest error of a right pose, as the service's probability means it, meters."""
RIGHT_RADIANS = float(np.radians(3.0))
"""Largest error of a right pose, radians."""
SIGMAS = 3.0
"""Standard deviations within which a fix agrees with the pose."""
CANDIDATES = 6
"""Number of fixes that are remembered until one of them is confirmed."""


class Correction:
    """Where the odometry frame lies in the map, from the fixes so far.

    A fix that agrees with the pose corrects it, weighted by both covariances. Any other fix is kept
    as a candidate, and the pose jumps only if a second fix from another place agrees with it.

    Attributes:
        transform: transform from the odometry frame into the map, float64 (4, 4); None before the
            first confirmed fix.
    """

    def __init__(self, rates: DriftRates | None = None) -> None:
        self.transform: Float64 | None = None
        self._rates = rates or DriftRates()
        self._covariance = np.zeros((6, 6))
        self._meters = 0.0
        self._map = ""
        self._candidates: deque[tuple[Fix, Float64]] = deque(maxlen=CANDIDATES)

    def reset(self) -> None:
        """Forget the pose and all candidates."""
        self.transform = None
        self._candidates.clear()

    def place(self, fix: Fix, transform: Float64) -> None:
        """Take a fix as the pose, without another one that agrees."""
        self.transform = transform.copy()
        self._covariance, self._meters, self._map = fix.covariance, fix.meters, fix.map
        self._candidates.clear()

    def guess(self, fix: Fix, transform: Float64) -> None:
        """Keep a pose as a candidate: one fix that agrees confirms it."""
        self._candidates.append((fix, transform))

    def follow(self, moved: Float64) -> None:
        """Move the pose with the map, whose place around the robot was corrected.

        Args:
            moved: transform (4, 4) from the earlier version of the map to the later one.
        """
        if self.transform is not None:
            self.transform = moved @ self.transform
        self._candidates.clear()

    def add(self, fix: Fix, transform: Float64) -> Verdict:
        """Take a fix.

        Args:
            fix: pose of the sensor in the map at the scan of the request.
            transform: the same as transform from the odometry frame into the map, (4, 4).
        """
        if self.transform is not None and fix.map == self._map:
            odom_pose = inverse(transform) @ fix.pose
            expected = self.transform @ odom_pose
            grown = self._rates.grown(self._covariance, abs(fix.meters - self._meters))
            step = difference(fix.pose, expected)
            if agree(step, grown + fix.covariance):
                self._correct(fix, odom_pose, expected, grown, step)
                return "confirmed"
        for before, other in reversed(self._candidates):
            driven = abs(fix.meters - before.meters)
            if before.map != fix.map or driven == 0:
                continue
            expected = other @ inverse(transform) @ fix.pose
            allowed = self._rates.grown(before.covariance, driven) + fix.covariance
            if agree(difference(fix.pose, expected), allowed):
                verdict: Verdict = "first" if self.transform is None else "jump"
                self.place(fix, transform)
                return verdict
        self._candidates.append((fix, transform))
        return "unconfirmed" if self.transform is None else "contradicts"

    def at(self, time: float, meters: float) -> MapToOdom | None:
        """Return the correction after a distance; None before the first confirmed fix.

        Args:
            time: time of the scan, seconds.
            meters: distance driven until the scan.
        """
        if self.transform is None:
            return None
        grown = self._rates.grown(self._covariance, abs(meters - self._meters))
        return MapToOdom(self.transform, grown, self._map, time)

    def _correct(
        self, fix: Fix, odom_pose: Float64, expected: Float64, grown: Float64, step: Float64
    ) -> None:
        gain = grown @ np.linalg.inv(grown + fix.covariance)
        pose = moved_by(expected, gain @ step)
        self.transform = pose @ inverse(odom_pose)
        left = np.eye(6) - gain
        # Joseph's form stays symmetric and positive.
        self._covariance = left @ grown @ left.T + gain @ fix.covariance @ gain.T
        self._meters = fix.meters
        self._candidates.clear()


def agree(step: Float64, covariance: Float64) -> bool:
    """Return whether a difference of two poses is within their tolerance.

    Args:
        step: translation and rotation vector, (6,).
        covariance: covariance of the difference, (6, 6).
    """
    meters = max(RIGHT_METERS, SIGMAS * float(np.sqrt(max(covariance[0, 0], covariance[1, 1]))))
    radians = max(RIGHT_RADIANS, SIGMAS * float(np.sqrt(covariance[5, 5])))
    height = max(RIGHT_METERS, SIGMAS * float(np.sqrt(covariance[2, 2])))
    return bool(
        np.linalg.norm(step[:2]) <= meters and abs(step[2]) <= height and abs(step[5]) <= radians
    )
