"""Covariance of a pose, from the residuals of its correspondences."""

import numpy as np

from placecell.core.types import Float64
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.refinement import kernel
from placecell.trajectories.covariance import cross, lever_arm


def covariance_of(
    pose: Pose, source: Float64, target: Float64, parameters: LocalizationParameters
) -> Float64:
    """Return the Gauss-Newton covariance of a registered pose, s^2 (J^T W J)^-1.

    It describes small changes d of the translation, meters, and w of the rotation, radians, along
    the axes of the target frame: `exp(w) rotation`, `translation + d`.

    Args:
        pose: registered pose.
        source: float64 (m, 3), meters, source points of the inliers.
        target: float64 (m, 3), meters, target points of the inliers.
        parameters: kernel, smallest deviation, inflation, and whether roll and pitch are fixed.

    Returns:
        float64 (4, 4) for dx, dy, dz, wz with yaw only, otherwise float64 (6, 6) for dx, dy, dz,
        wx, wy, wz. The diagonal is infinite if the correspondences do not determine the pose.
    """
    columns = [0, 1, 2, 5] if parameters.model == "yaw" else list(range(6))
    unknown = np.diag(np.full(len(columns), np.inf))
    if not len(source):
        return unknown
    leftover = pose.apply(source) - target
    weights = kernel(np.linalg.norm(leftover, axis=1), parameters.kernel)
    turned = source @ pose.rotation.T
    # First about the centroid of the segments: the frame's origin may be a thousand km away.
    middle = weights @ turned / weights.sum()
    jacobian = np.zeros((len(source), 3, 6))
    jacobian[:, :, :3] = np.eye(3)
    jacobian[:, :, 3:] = -cross(turned - middle)
    jacobian = jacobian[:, :, columns]
    information = np.einsum("m,mij,mik->jk", weights, jacobian, jacobian)
    freedom = max(3 * weights.sum() - len(columns), 1.0)
    variance = weights @ (leftover**2).sum(axis=1) / freedom
    variance = max(variance, parameters.least_deviation**2) * parameters.inflation
    # About the centroid, rotation and translation are uncorrelated. Segments in one point or on one
    # line (a millimeter from it, on average) do not determine the rotation, except for rounding.
    turns = np.linalg.eigvalsh(information[3:, 3:])
    if turns[0] < max(1e-6 * weights.sum(), 1e-12 * turns[-1]):
        return unknown
    carried = np.eye(6)
    carried[:3, 3:] = cross(middle)
    carried = carried[np.ix_(columns, columns)]
    return np.asarray(carried @ (variance * np.linalg.inv(information)) @ carried.T)


def at_point(covariance: Float64, pose: Pose, point: Float64) -> Float64:
    """Return the covariance for the position of a point instead of the frame's origin.

    Args:
        covariance: float64 (4, 4) or (6, 6) (see `covariance_of`).
        pose: pose of the covariance.
        point: (3,), meters, in the robot's frame.

    Returns:
        Covariance of the transformed point, meters, and the rotation, in the same order.
    """
    columns = [0, 1, 2, 5] if len(covariance) == 4 else list(range(6))
    moved = lever_arm(pose.rotation @ point)[np.ix_(columns, columns)]
    return np.asarray(moved @ covariance @ moved.T)


def rotation_deviation(covariance: Float64) -> float:
    """Return the standard deviation of the rotation about its least certain axis, radians."""
    block = covariance[3:, 3:]
    if not np.isfinite(block).all():
        return float("inf")
    return float(np.sqrt(np.linalg.eigvalsh(block)[-1]))
