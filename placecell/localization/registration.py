"""The rigid transform that takes points to their places, in the least-squares sense."""

import numpy as np

from placecell.core.types import Float64
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose


def register(
    source: Float64, target: Float64, weights: Float64, parameters: LocalizationParameters
) -> Pose:
    """The transform of the wanted kind.

    Args:
        source: float64 (m, 3), one or more.
        target: float64 (m, 3).
        weights: float64 (m,), not negative, not all 0.
    """
    if parameters.model == "yaw":
        return register_yaw(source, target, weights)
    return register_se3(source, target, weights)


def register_yaw(source: Float64, target: Float64, weights: Float64) -> Pose:
    """Yaw and translation, in closed form.

    The sum of weights times target . R(yaw) source is a cos(yaw) + b sin(yaw) about the weighted
    means, and greatest where tan(yaw) = b / a (Horn 1987, section 5, in the plane).
    """
    here, there = _means(source, target, weights)
    (x, y, _), (u, v, _) = (source - here).T, (target - there).T
    yaw = float(np.arctan2(weights @ (x * v - y * u), weights @ (x * u + y * v)))
    turn = Pose.of_yaw(yaw, np.zeros(3))
    return Pose(turn.rotation, there - turn.apply(here))


def register_se3(source: Float64, target: Float64, weights: Float64) -> Pose:
    """All six degrees of freedom, from a singular value decomposition.

    Kabsch 1976; the sign that keeps a reflection out: Umeyama 1991, *Least-squares estimation of
    transformation parameters between two point patterns*, without scale.
    """
    here, there = _means(source, target, weights)
    u, _, vt = np.linalg.svd((target - there).T @ (weights[:, None] * (source - here)))
    sign = np.sign(np.linalg.det(u @ vt))
    rotation = u @ np.diag([1.0, 1.0, sign]) @ vt
    return Pose(rotation, there - rotation @ here)


def _means(source: Float64, target: Float64, weights: Float64) -> tuple[Float64, Float64]:
    shares = weights / weights.sum()
    return shares @ source, shares @ target
