"""How uncertain a pose is, from what its correspondences leave over."""

import numpy as np

from placecell.core.types import Float64
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.refinement import kernel


def covariance_of(
    pose: Pose, source: Float64, target: Float64, parameters: LocalizationParameters
) -> Float64:
    """Covariance of a registered pose: s^2 (J^T W J)^-1, the Gauss-Newton one of its residuals.

    Of small changes d of the translation, meters, and w of the rotation, radians, both along the
    axes of the frame that the pose leads to: `exp(w) rotation`, `translation + d`. With yaw alone,
    float64 (4, 4): dx, dy, dz, wz; otherwise float64 (6, 6): dx, dy, dz, wx, wy, wz.

    Args:
        source: float64 (m, 3), of the correspondences that agree, meters.
        target: float64 (m, 3).

    Returns:
        Infinite on the diagonal where the correspondences determine nothing.
    """
    columns = [0, 1, 2, 5] if parameters.model == "yaw" else list(range(6))
    unknown = np.diag(np.full(len(columns), np.inf))
    if not len(source):
        return unknown
    leftover = pose.apply(source) - target
    weights = kernel(np.linalg.norm(leftover, axis=1), parameters.kernel)
    turned = source @ pose.rotation.T
    # About the middle of the segments first: the frame's origin may be a thousand kilometers off.
    middle = weights @ turned / weights.sum()
    jacobian = np.zeros((len(source), 3, 6))
    jacobian[:, :, :3] = np.eye(3)
    jacobian[:, :, 3:] = -cross(turned - middle)
    jacobian = jacobian[:, :, columns]
    information = np.einsum("m,mij,mik->jk", weights, jacobian, jacobian)
    freedom = max(3 * weights.sum() - len(columns), 1.0)
    variance = weights @ (leftover**2).sum(axis=1) / freedom
    variance = max(variance, parameters.least_deviation**2) * parameters.inflation
    # About the middle, turns and shifts do not mix. Of turns nothing is known, but for rounding, if
    # the segments lie in one point, or on the axis of one: a millimeter from it, on average.
    turns = np.linalg.eigvalsh(information[3:, 3:])
    if turns[0] < max(1e-6 * weights.sum(), 1e-12 * turns[-1]):
        return unknown
    carried = np.eye(6)
    carried[:3, 3:] = cross(middle)
    carried = carried[np.ix_(columns, columns)]
    return np.asarray(carried @ (variance * np.linalg.inv(information)) @ carried.T)


def at_point(covariance: Float64, pose: Pose, point: Float64) -> Float64:
    """The same uncertainty, told of where the pose takes a point instead of the frame's origin.

    Args:
        covariance: float64 (4, 4) or (6, 6), as above.
        point: (3,), meters, in the robot's frame.

    Returns:
        Of the point's place, meters, and the rotation, in the same order.
    """
    columns = [0, 1, 2, 5] if len(covariance) == 4 else list(range(6))
    moved = np.eye(6)
    moved[:3, 3:] = -cross(pose.rotation @ point)
    moved = moved[np.ix_(columns, columns)]
    return np.asarray(moved @ covariance @ moved.T)


def rotation_deviation(covariance: Float64) -> float:
    """Standard deviation of the rotation about its worst axis, radians."""
    block = covariance[3:, 3:]
    if not np.isfinite(block).all():
        return float("inf")
    return float(np.sqrt(np.linalg.eigvalsh(block)[-1]))


def cross(vectors: Float64) -> Float64:
    """The matrices (..., 3, 3) that take the cross product with vectors (..., 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    nothing = np.zeros_like(x)
    rows = [[nothing, -z, y], [z, nothing, -x], [-y, x, nothing]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
