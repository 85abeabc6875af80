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
    """Return the matrix J that carries a covariance C to a point beside as J C J^T, float64 (6, 6).

    Args:
        offset: position of the point minus that of the pose, (3,), meters, in the poses' world.
    """
    carried = np.eye(6)
    carried[:3, 3:] = -cross(offset)
    return carried


def cross(vectors: Float64) -> Float64:
    """Return the cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    nothing = np.zeros_like(x)
    rows = [[nothing, -z, y], [z, nothing, -x], [-y, x, nothing]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
