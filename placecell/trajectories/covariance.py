"""Covariances of poses, of x, y, z and the rotations about the axes of the poses' world."""

import numpy as np
from numpy.typing import ArrayLike

from placecell.core.types import Float64

PLANAR = np.ix_([0, 1, 5], [0, 1, 5])
"""Entries of x, y and the heading."""
ROUNDING = 1e-9
"""Largest negative share of the largest eigenvalue that rounding explains."""


def stated_covariance(values: ArrayLike) -> Float64 | None:
    """Return the covariance that a message states; None if it cannot be used.

    Many drivers leave it at zeros, and -1 means unknown. Planar odometry states nothing of height,
    roll and pitch, so only x, y and the heading must have a positive definite covariance.

    Args:
        values: 36 numbers, row by row: m^2, m rad and rad^2.

    Returns:
        Covariance, symmetric and positive semidefinite, float64 (6, 6).
    """
    found = np.asarray(values, dtype=np.float64).reshape(6, 6)
    if not np.isfinite(found).all():
        return None
    found = (found + found.T) / 2
    own = np.linalg.eigvalsh(found)
    if own[0] < -ROUNDING * own[-1] or np.linalg.eigvalsh(found[PLANAR])[0] <= 0:
        return None
    return np.asarray(found)


def lever_arm(offset: Float64) -> Float64:
    """Return the matrix J that carries a covariance C to a point beside it as J C J^T.

    Args:
        offset: position of the point minus that of the pose, (..., 3), meters, in the poses' world.

    Returns:
        float64 (..., 6, 6).
    """
    carried = np.tile(np.eye(6), (*offset.shape[:-1], 1, 1))
    carried[..., :3, 3:] = -cross(offset)
    return carried


def mounted(covariances: Float64, poses: Float64, mount: Float64) -> Float64:
    """Return the covariances of a sensor from those of the robot, float64 (..., 6, 6).

    Args:
        covariances: of the robot's poses, (..., 6, 6).
        poses: the robot's poses, (..., 4, 4).
        mount: pose of the sensor on the robot, (4, 4).
    """
    arm = lever_arm(poses[..., :3, :3] @ mount[:3, 3])
    return np.asarray(arm @ covariances @ arm.swapaxes(-1, -2))


def interpolate_covariances(at: Float64, stamps: Float64, covariances: Float64) -> Float64:
    """Return the covariances at times, float64 (n, 6, 6).

    An error grows little from one pose to the next, so a covariance is linear between them.

    Args:
        at: times, (n,), seconds; those outside of `stamps` get the nearest covariance.
        stamps: times of the covariances, (m,), seconds, ascending without repetitions.
        covariances: (m, 6, 6), m > 0.
    """
    if len(stamps) == 1:
        return np.repeat(covariances, len(at), axis=0)
    after = np.clip(np.searchsorted(stamps, at), 1, len(stamps) - 1)
    share = (at - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
    share = np.clip(share, 0.0, 1.0)[:, None, None]
    return np.asarray((1 - share) * covariances[after - 1] + share * covariances[after])


def cross(vectors: Float64) -> Float64:
    """Return the cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    nothing = np.zeros_like(x)
    rows = [[nothing, -z, y], [z, nothing, -x], [-y, x, nothing]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
