"""Refinement: register a pose with all correspondences that are its inliers."""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.types import Float64, Int64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.registration import register

ROUNDS = 12
NARROWING = 0.8
"""Factor of the gate in each round."""


def refine(
    pose: Pose,
    found: Correspondences,
    parameters: LocalizationParameters,
    trust: Float64 | None = None,
) -> tuple[Pose, Int64]:
    """Register a pose with its inliers repeatedly, until they no longer change.

    Iteratively reweighted least squares with the kernel of Geman and McClure, whose weight is
    1 / (1 + (r/c)^2)^2, and a gate that narrows in each round, similar to graduated non-convexity
    (Yang et al. 2020).

    Args:
        pose: initial pose.
        found: correspondences.
        parameters: gates and kernel.
        trust: float64 (m,), factor of each correspondence's weight; None: 1.

    Returns:
        The pose, and the indices of its inliers, one to one, int64 (inliers,).
    """
    gate = parameters.wide_gate
    agreeing, distances = _inliers(pose, found, gate)
    for _ in range(ROUNDS):
        if not len(agreeing):
            break
        weights = kernel(distances, parameters.kernel)
        if trust is not None:
            weights = weights * trust[agreeing]
        pose = register(found.source[agreeing], found.target[agreeing], weights, parameters)
        before, last = agreeing, gate
        gate = max(parameters.gate, NARROWING * gate)
        agreeing, distances = _inliers(pose, found, gate)
        if gate == last and np.array_equal(before, agreeing):
            break
    return pose, agreeing


def residuals(pose: Pose, found: Correspondences) -> Float64:
    """Return the distance of each transformed query from its place, meters, float64 (m,)."""
    off = pose.apply(found.source) - found.target
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", off, off)))


def kernel(distances: Float64, scale: float) -> Float64:
    """Return the Geman-McClure weight of each distance: 1 at 0, and 0.25 at the scale."""
    return np.asarray((1 + (distances / scale) ** 2) ** -2)


def one_to_one(pose: Pose, found: Correspondences, gate: float) -> Int64:
    """Return the correspondences within the gate, the nearest of each query and of each place."""
    return _inliers(pose, found, gate)[0]


def _inliers(pose: Pose, found: Correspondences, gate: float) -> tuple[Int64, Float64]:
    """Return the correspondences of `one_to_one`, ascending, and their residuals."""
    distances = residuals(pose, found)
    near = np.flatnonzero(distances < gate)
    near = near[np.argsort(distances[near], kind="stable")]
    kept = np.sort(near[_first_pairs(found.queries[near], found.places[near])])
    return kept, distances[kept]


@compiled
def _first_pairs(queries: Int64, places: Int64) -> Int64:
    """Return the first pair of each query, and of these the first of each place, as indices."""
    seen, taken = set(queries[:0]), set(places[:0])
    kept = np.empty(len(queries), dtype=np.int64)
    count = 0
    for pair in range(len(queries)):
        if queries[pair] not in seen:
            seen.add(queries[pair])
            if places[pair] not in taken:
                taken.add(places[pair])
                kept[count] = pair
                count += 1
    return kept[:count]
