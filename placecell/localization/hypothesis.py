"""Pose hypotheses: search for poses of the robot that many correspondences support."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64, Int64
from placecell.localization.clique import heaviest_clique
from placecell.localization.consistency import consistent
from placecell.localization.correspondences import Correspondences
from placecell.localization.covariance import common_error, covariance_of, rotation_deviation
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.refinement import refine, residuals
from placecell.localization.registration import register
from placecell.localization.viewpoint import SHIFT, UNCERTAINTY, trust_of


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis:
    """Pose of the robot's frame in the map's frame, with its inlier segments.

    Attributes:
        pose: transform from the robot's frame to the map's.
        covariance: float64 (4, 4) or (6, 6), see `covariance_of`.
        score: sum of the inliers' weights.
        queries: int64 (inliers,), ascending, indices of the candidates' queries.
        rows: int64 (inliers,), matched row of the map.
        source: float64 (inliers, 3), meters, the queries' centroids in the robot's frame.
        residuals: float64 (inliers,), meters.
        worth: float64 (n,), part of the score of each query; None before guided matching.
        similarity: float64 (n,), how similar each counterpart is,
            up to a bound; 0 without a counterpart. Used to compare maps (`joint`).
    """

    pose: Pose
    covariance: Float64
    score: float
    queries: Int64
    rows: Int64
    source: Float64
    residuals: Float64
    worth: Float64 | None = None
    similarity: Float64 | None = None

    def __len__(self) -> int:
        return len(self.queries)

    @property
    def rotation_deviation(self) -> float:
        """Standard deviation of the rotation about its least certain axis, radians."""
        return rotation_deviation(self.covariance)


def find_hypotheses(
    found: Correspondences, parameters: LocalizationParameters, guesses: Sequence[Pose] = ()
) -> list[Hypothesis]:
    """Find pose hypotheses at different places, best first.

    After each hypothesis, its correspondences are removed and the rest is searched again.

    Args:
        found: correspondences of queries and places.
        parameters: limits and tolerances.
        guesses: additional poses to refine.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    hypotheses = [_grown(pose, found, parameters) for pose in guesses]
    graph = consistent(found, parameters)
    left = np.ones(len(found), dtype=bool)
    effort = parameters.effort
    token = current()
    for _ in range(parameters.hypotheses):
        token.check()
        # The first place matters most. What a search leaves is for the next ones.
        clique, steps = heaviest_clique(graph, found.weights, found.queries, left, effort // 2)
        effort = max(effort - steps, 0)
        if len(clique) < parameters.least_segments:
            break
        agreeing = found.take(clique)
        pose = register(agreeing.source, agreeing.target, agreeing.weights, parameters)
        # Refined with all correspondences, including those of better hypotheses.
        hypothesis = _grown(pose, found, parameters)
        left[clique] = False
        left &= residuals(hypothesis.pose, found) >= parameters.apart
        hypotheses.append(hypothesis)
    return distinct(hypotheses, parameters)


def _grown(pose: Pose, found: Correspondences, parameters: LocalizationParameters) -> Hypothesis:
    """Refine a pose with all correspondences and return the hypothesis."""
    pose, support = refine(pose, found, parameters)
    agreeing = found.take(support[np.argsort(found.queries[support])])
    return Hypothesis(
        pose=pose,
        covariance=covariance_of(pose, agreeing.source, agreeing.target, parameters),
        score=float(agreeing.weights.sum()),
        queries=agreeing.queries,
        rows=agreeing.rows,
        source=agreeing.source,
        residuals=residuals(pose, agreeing),
    )


def seen_by_robot(
    hypothesis: Hypothesis, found: Correspondences, parameters: LocalizationParameters
) -> Hypothesis:
    """Refine a hypothesis with the centroids that the robot would see (see `view_shifts`).

    Only the pose, its covariance and its inliers change, not the scores. The covariance includes
    the error of the shift, which all inliers share, so that their residuals do not show it.

    Args:
        hypothesis: hypothesis of these correspondences.
        found: correspondences; without the positions of the sensors, the hypothesis stays.
        parameters: gates, kernel and limits.
    """
    if found.sensor is None or found.captures is None:
        return hypothesis
    # Most correspondences are of other places.
    reach = parameters.wide_gate + 2 * SHIFT
    found = found.take(np.flatnonzero(residuals(hypothesis.pose, found) < reach))
    seen = found.seen_at(hypothesis.pose)
    shifts = seen.target - found.target
    common, trust = UNCERTAINTY * shifts, trust_of(shifts)
    pose, support = refine(hypothesis.pose, seen, parameters, trust)
    if len(support) < parameters.least_segments:
        return hypothesis
    # How large the shift is here, as far as the residuals show it.
    amount, deviation = common_error(
        pose,
        seen.source[support],
        seen.target[support],
        parameters,
        common[support],
        trust[support],
    )
    seen = replace(seen, target=seen.target + max(amount, -1 / UNCERTAINTY) * common)
    pose, support = refine(pose, seen, parameters, trust)
    support = support[np.argsort(found.queries[support])]
    agreeing = seen.take(support)
    if len(agreeing) < parameters.least_segments:
        return hypothesis
    refined = replace(
        hypothesis,
        pose=pose,
        covariance=covariance_of(
            pose,
            agreeing.source,
            agreeing.target,
            parameters,
            deviation * common[support],
            trust[support],
        ),
        queries=agreeing.queries,
        rows=agreeing.rows,
        source=agreeing.source,
        residuals=residuals(pose, agreeing),
    )
    is_determined = np.degrees(refined.rotation_deviation) <= parameters.undetermined_yaw
    middle = hypothesis.source.mean(axis=0)
    is_same = same_place(pose, hypothesis.pose, middle, parameters)
    return refined if is_determined and is_same else hypothesis


def distinct(
    hypotheses: Sequence[Hypothesis], parameters: LocalizationParameters
) -> list[Hypothesis]:
    """Sort hypotheses, best first; drop those with too few inliers or at a better one's place."""
    kept: list[Hypothesis] = []
    for one in sorted(hypotheses, key=lambda each: -each.score):
        if len(one) >= parameters.least_segments and not any(
            same_place(one.pose, other.pose, one.source.mean(axis=0), parameters) for other in kept
        ):
            kept.append(one)
    return kept


def same_place(one: Pose, other: Pose, at: Float64, parameters: LocalizationParameters) -> bool:
    """Return whether two poses put a point (3,) of the robot's frame in the same place."""
    # Most pairs are apart: their angle is not needed.
    if np.linalg.norm(one.apply(at) - other.apply(at)) >= parameters.apart:
        return False
    _, angle = one.difference(other, at)
    return bool(np.degrees(angle) < parameters.apart_yaw)
