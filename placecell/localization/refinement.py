"""From the pose of a clique to the pose of all that agrees with it."""

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.registration import register

ROUNDS = 12
NARROWING = 0.8
"""Of the gate, each round."""


def refine(
    pose: Pose, found: Correspondences, parameters: LocalizationParameters
) -> tuple[Pose, Int64]:
    """Register anew with what lies near, until nothing changes.

    Iteratively reweighted least squares with the kernel of Geman and McClure, whose weight is
    1 / (1 + (r/c)^2)^2, behind a gate that narrows round by round: graduated non-convexity in the
    spirit of Yang et al. 2020.

    Returns:
        The pose, and the correspondences that agree with it, one to one, int64 (inliers,).
    """
    gate = parameters.wide_gate
    agreeing = one_to_one(pose, found, gate)
    for _ in range(ROUNDS):
        if not len(agreeing):
            break
        weights = kernel(residuals(pose, found.take(agreeing)), parameters.kernel)
        pose = register(found.source[agreeing], found.target[agreeing], weights, parameters)
        before, last = agreeing, gate
        gate = max(parameters.gate, NARROWING * gate)
        agreeing = one_to_one(pose, found, gate)
        if gate == last and np.array_equal(before, agreeing):
            break
    return pose, agreeing


def residuals(pose: Pose, found: Correspondences) -> Float64:
    """Meters from where the pose takes each query to its place, float64 (m,)."""
    return np.asarray(np.linalg.norm(pose.apply(found.source) - found.target, axis=1))


def kernel(distances: Float64, scale: float) -> Float64:
    """Weights of residuals, 1 at 0, a quarter at the scale."""
    return np.asarray((1 + (distances / scale) ** 2) ** -2)


def one_to_one(pose: Pose, found: Correspondences, gate: float) -> Int64:
    """Correspondences within the gate: of each query the nearest, of each place the nearest."""
    distances = residuals(pose, found)
    near = np.flatnonzero(distances < gate)
    near = near[np.argsort(distances[near], kind="stable")]
    for owners in (found.queries, found.places):
        near = near[np.sort(np.unique(owners[near], return_index=True)[1])]
    return np.sort(near)
