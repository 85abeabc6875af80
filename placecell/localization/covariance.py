"""Covariance of a pose, from the residuals of its correspondences."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.types import Float64
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.refinement import kernel
from placecell.trajectories.covariance import cross, lever_arm


@dataclass(frozen=True, slots=True, eq=False)
class NormalEquations:
    """Normal equations of a registered pose, about the weighted mean of the segments.

    Attributes:
        jacobian: float64 (m, 3, d), change of each transformed point by the d parameters.
        weights: float64 (m,), weights of the kernel.
        information: float64 (d, d), J^T W J.
        leftover: float64 (m, 3), meters, transformed source points minus target points.
        variance: variance of a residual, square meters, with the inflation.
        middle: float64 (3,), meters, weighted mean of the turned source points.
        columns: indices of the parameters among dx, dy, dz, wx, wy, wz.
    """

    jacobian: Float64
    weights: Float64
    information: Float64
    leftover: Float64
    variance: float
    middle: Float64
    columns: list[int]

    @classmethod
    def of(
        cls,
        pose: Pose,
        source: Float64,
        target: Float64,
        parameters: LocalizationParameters,
        trust: Float64 | None = None,
    ) -> Self:
        """Build the equations of one correspondence or more (see `covariance_of`)."""
        columns = _columns(parameters)
        leftover = pose.apply(source) - target
        weights = kernel(np.linalg.norm(leftover, axis=1), parameters.kernel)
        if trust is not None:
            weights = weights * trust
        turned = source @ pose.rotation.T
        # About the centroid of the segments: the frame's origin may be a thousand km away.
        middle = weights @ turned / weights.sum()
        jacobian = np.zeros((len(source), 3, 6))
        jacobian[:, :, :3] = np.eye(3)
        jacobian[:, :, 3:] = -cross(turned - middle)
        jacobian = jacobian[:, :, columns]
        information = np.einsum("m,mij,mik->jk", weights, jacobian, jacobian)
        freedom = max(3 * weights.sum() - len(columns), 1.0)
        variance = weights @ (leftover**2).sum(axis=1) / freedom
        variance = max(variance, parameters.least_deviation**2) * parameters.inflation
        return cls(jacobian, weights, information, leftover, float(variance), middle, columns)

    @property
    def is_determined(self) -> bool:
        """Whether the correspondences determine the rotation.

        About the centroid, rotation and translation are uncorrelated. Segments in one point or on
        one line (a millimeter from it, on average) determine it by rounding errors only.
        """
        turns = np.linalg.eigvalsh(self.information[3:, 3:])
        return bool(turns[0] >= max(1e-6 * self.weights.sum(), 1e-12 * turns[-1]))

    def moved_by(self, targets: Float64) -> Float64:
        """Return the change of the pose, (d,), by displacements of the targets (m, 3)."""
        drawn = np.einsum("m,mij,mi->j", self.weights, self.jacobian, targets)
        return np.asarray(np.linalg.solve(self.information, drawn))


def _columns(parameters: LocalizationParameters) -> list[int]:
    return [0, 1, 2, 5] if parameters.model == "yaw" else list(range(6))


def covariance_of(
    pose: Pose,
    source: Float64,
    target: Float64,
    parameters: LocalizationParameters,
    common: Float64 | None = None,
    trust: Float64 | None = None,
) -> Float64:
    """Return the Gauss-Newton covariance of a registered pose, s^2 (J^T W J)^-1.

    It describes small changes d of the translation, meters, and w of the rotation, radians, along
    the axes of the target frame: `exp(w) rotation`, `translation + d`.

    Args:
        pose: registered pose.
        source: float64 (m, 3), meters, source points of the inliers.
        target: float64 (m, 3), meters, target points of the inliers.
        parameters: kernel, smallest deviation, inflation, and whether roll and pitch are fixed.
        common: float64 (m, 3), meters, displacements of the target points by one standard deviation
            of an error that they share. The residuals do not show it. None: there is none.
        trust: float64 (m,), factor of each correspondence's weight; None: 1.

    Returns:
        float64 (4, 4) for dx, dy, dz, wz with yaw only, otherwise float64 (6, 6) for dx, dy, dz,
        wx, wy, wz. The diagonal is infinite if the correspondences do not determine the pose.
    """
    columns = _columns(parameters)
    unknown = np.diag(np.full(len(columns), np.inf))
    if not len(source):
        return unknown
    equations = NormalEquations.of(pose, source, target, parameters, trust)
    if not equations.is_determined:
        return unknown
    covariance = equations.variance * np.linalg.inv(equations.information)
    if common is not None:
        moved = equations.moved_by(common)
        covariance = covariance + np.outer(moved, moved)
    carried = np.eye(6)
    carried[:3, 3:] = cross(equations.middle)
    carried = carried[np.ix_(columns, columns)]
    return np.asarray(carried @ covariance @ carried.T)


def common_error(
    pose: Pose,
    source: Float64,
    target: Float64,
    parameters: LocalizationParameters,
    common: Float64,
    trust: Float64 | None = None,
) -> tuple[float, float]:
    """Estimate an error that the target points share, from the residuals.

    With the prior N(0, 1) of the amount t, the targets are off by t times `common`. The pose
    follows the targets as far as it can, and only the rest is seen in the residuals.

    Args:
        pose: registered pose.
        source: float64 (m, 3), meters, source points of the inliers.
        target: float64 (m, 3), meters, target points of the inliers.
        parameters: see `covariance_of`.
        common: float64 (m, 3), meters, displacements by one standard deviation.
        trust: see `covariance_of`.

    Returns:
        Most probable amount, and its standard deviation, at most 1: without residuals that tell, 0
        and 1.
    """
    equations = NormalEquations.of(pose, source, target, parameters, trust)
    if not equations.is_determined:
        return 0.0, 1.0
    rest = common - equations.jacobian @ equations.moved_by(common)
    weights = equations.weights / equations.variance
    precision = 1.0 + float(weights @ (rest**2).sum(axis=1))
    amount = float(weights @ (rest * equations.leftover).sum(axis=1)) / precision
    return amount, precision**-0.5


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
