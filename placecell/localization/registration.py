"""Registration: the least-squares rigid transform between corresponding points."""

import numpy as np

from placecell.core.types import Float64
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose


def register(
    source: Float64, target: Float64, weights: Float64, parameters: LocalizationParameters
) -> Pose:
    """Return the weighted least-squares transform with the degrees of freedom of `parameters`.

    Args:
        source: float64 (m, 3), m > 0, points of the source frame.
        target: float64 (m, 3), the same points in the target frame.
        weights: float64 (m,), not negative, not all 0.
        parameters: `model` says whether roll and pitch are fixed.
    """
    if parameters.model == "yaw":
        return register_yaw(source, target, weights)
    return register_se3(source, target, weights)


def register_yaw(source: Float64, target: Float64, weights: Float64) -> Pose:
    """Return yaw and translation in closed form.

    About the weighted means, the weighted sum of target . R(yaw) source is
    a cos(yaw) + b sin(yaw). It is largest at tan(yaw) = b / a (Horn 1987, section 5, in the plane).
    """
    here, there = _means(source, target, weights)
    (x, y, _), (u, v, _) = (source - here).T, (target - there).T
    yaw = float(np.arctan2(weights @ (x * v - y * u), weights @ (x * u + y * v)))
    turn = Pose.of_yaw(yaw, np.zeros(3))
    return Pose(turn.rotation, there - turn.apply(here))


def register_se3(source: Float64, target: Float64, weights: Float64) -> Pose:
    """Return all six degrees of freedom by singular value decomposition.

    Source: Kabsch 1976. The sign that prevents a reflection is from Umeyama 1991, *Least-squares
    estimation of transformation parameters between two point patterns*, here without scale.
    """
    here, there = _means(source, target, weights)
    u, _, vt = np.linalg.svd((target - there).T @ (weights[:, None] * (source - here)))
    sign = np.sign(np.linalg.det(u @ vt))
    rotation = u @ np.diag([1.0, 1.0, sign]) @ vt
    return Pose(rotation, there - rotation @ here)


def _means(source: Float64, target: Float64, weights: Float64) -> tuple[Float64, Float64]:
    shares = weights / weights.sum()
    return shares @ source, shares @ target
