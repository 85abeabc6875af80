"""Poses between the poses of a trajectory: linear positions, spherical linear rotations."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from placecell.core.types import Bool, Float64

SAME = 1e-3
"""Largest difference of two times that are taken as the same moment, seconds: half a centimeter at
5 m/s; files state times with three decimals or more."""


def lies_between(at: Float64, stamps: Float64, largest_gap: float) -> Bool:
    """Return whether each time lies between two poses that are close enough, bool (n,).

    No time is between at the first pose itself.

    Args:
        at: times, float64 (n,), seconds.
        stamps: times of the poses, ascending, seconds.
        largest_gap: largest time between the two poses, seconds.
    """
    if len(stamps) < 2:
        return np.zeros(len(at), dtype=bool)
    after = np.searchsorted(stamps, at)
    inside = (after > 0) & (after < len(stamps))
    after = np.clip(after, 1, len(stamps) - 1)
    # Times of nanoseconds since 1970 have steps of 256 ns as float64.
    return np.asarray(inside & (stamps[after] - stamps[after - 1] <= largest_gap + 1e-6))


def nearest(at: Float64, stamps: Float64) -> tuple[Float64, np.ndarray]:
    """Return the time from each moment to the nearest pose, and the pose's index."""
    after = np.clip(np.searchsorted(stamps, at), 1, max(len(stamps) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(stamps) - 1)
    take_after = np.abs(stamps[after] - at) < np.abs(at - stamps[before])
    index = np.where(take_after, after, before)
    return np.abs(stamps[index] - at), index


def interpolate(at: Float64, stamps: Float64, poses: Float64) -> Float64:
    """Interpolate poses at times between them, float64 (n, 4, 4).

    Args:
        at: times, each within the first and the last of `stamps`.
        stamps: times of the poses, ascending without repetitions, two or more.
        poses: (m, 4, 4).
    """
    found = np.tile(np.eye(4), (len(at), 1, 1))
    if not len(at):
        return found
    found[:, :3, :3] = Slerp(stamps, Rotation.from_matrix(poses[:, :3, :3]))(at).as_matrix()
    for axis in range(3):
        found[:, axis, 3] = np.interp(at, stamps, poses[:, axis, 3])
    return found
