"""Rigid transforms: differences, small corrections, and covariances between map and robot."""

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.localization import Pose
from placecell.localization.covariance import at_point


def difference(pose: Float64, other: Float64) -> Float64:
    """Return how a pose differs from another: translation and rotation vector, float64 (6,).

    Both are along the axes of the common frame, in meters and radians.
    """
    turned = Rotation.from_matrix(pose[:3, :3] @ other[:3, :3].T).as_rotvec()
    return np.concatenate([pose[:3, 3] - other[:3, 3], turned])


def moved_by(pose: Float64, step: Float64) -> Float64:
    """Return a pose changed by a difference, float64 (4, 4)."""
    moved = pose.copy()
    moved[:3, :3] = Rotation.from_rotvec(step[3:]).as_matrix() @ pose[:3, :3]
    moved[:3, 3] = pose[:3, 3] + step[:3]
    return moved


def inverse(pose: Float64) -> Float64:
    """Return the inverse of a rigid transform, float64 (4, 4)."""
    found = np.eye(4)
    found[:3, :3] = pose[:3, :3].T
    found[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return found


def covariance_at_sensor(
    covariance: Float64, transform: Float64, odom_position: Float64, floor: Float64
) -> Float64:
    """Return the covariance of the sensor's pose, from that of the odometry frame's origin.

    Args:
        covariance: covariance at the origin of the odometry frame, along the map's axes: (4, 4) for
            x, y, z and yaw, or (6, 6) for x, y, z and the rotations about the axes.
        transform: transform from the odometry frame into the map, (4, 4).
        odom_position: position of the sensor in the odometry frame, (3,), meters.
        floor: standard deviations of each of the six values that are added, (6,).

    Returns:
        float64 (6, 6): x, y, z and the rotations about the map's axes.
    """
    full = np.zeros((6, 6))
    if covariance.shape == (4, 4):
        chosen = np.ix_([0, 1, 2, 5], [0, 1, 2, 5])
        full[chosen] = covariance
    else:
        full[:] = covariance
    there = at_point(full, Pose.of_matrix(transform), odom_position)
    return np.asarray(there + np.diag(floor**2))
