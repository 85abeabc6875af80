"""Consensus: sets of submap poses that put the whole map in the same place.

Source: pairwise consistency of Mangelson et al. 2018, *Pairwise consistent measurement set
maximization for robust multi-robot map merging*. Here a set holds the poses that are consistent
with the best seed, instead of the largest clique: right poses are all consistent with each other.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Bool, Float64, Int64
from placecell.localization import Pose
from placecell.localization.registration import register
from placecell.map_alignment.parameters import AlignmentParameters

LEVER = np.concatenate([np.zeros((1, 3)), 10.0 * np.eye(3)])
"""Points relative to a submap's center, meters. They represent a pose when poses are averaged."""


@dataclass(frozen=True, slots=True, eq=False)
class SubmapPose:
    """Pose hypothesis of one submap.

    Attributes:
        submap: number of the submap.
        middle: float64 (3,), meters, mean centroid of the submap in its own map's frame.
        pose: transform from that frame to the other map's.
        score: score of the hypothesis.
    """

    submap: int
    middle: Float64
    pose: Pose
    score: float


def consensus(
    guesses: Sequence[SubmapPose], parameters: AlignmentParameters
) -> list[list[SubmapPose]]:
    """Return sets of consistent submap poses, the set with the highest score first.

    Each set holds the poses that are consistent with the best remaining seed. A submap counts once
    in a set, by its best pose.
    """
    if not guesses:
        return []
    graph = agreement(guesses, parameters)
    scores = np.array([each.score for each in guesses])
    submaps = np.array([each.submap for each in guesses])
    left = np.ones(len(guesses), dtype=bool)
    sets: list[list[SubmapPose]] = []
    while left.any() and len(sets) < parameters.alignments:
        worth = [_best_of_each(scores, submaps, row & left).sum() for row in graph]
        seed = int(np.where(left, worth, -np.inf).argmax())
        members = np.flatnonzero(_best_of_each(scores, submaps, graph[seed] & left))
        sets.append([guesses[index] for index in members.tolist()])
        left &= ~graph[seed]
    return sets


def agreement(guesses: Sequence[SubmapPose], parameters: AlignmentParameters) -> Bool:
    """Return whether each two poses put the map in the same place, symmetric, bool (g, g)."""
    middles = np.array([each.middle for each in guesses])
    # [i, j]: image of the center of submap j under pose i.
    put = np.stack([each.pose.apply(middles) for each in guesses])
    own = np.einsum("iij->ij", put)
    off = np.linalg.norm(put - own, axis=2)
    between = np.linalg.norm(middles[:, None] - middles, axis=2)
    near = np.maximum(off, off.T) <= parameters.apart + parameters.slack * between
    yaws = np.array([each.pose.yaw for each in guesses])
    turn = np.abs((yaws[:, None] - yaws + np.pi) % (2 * np.pi) - np.pi)
    return np.asarray(near & (turn <= np.radians(parameters.apart_yaw)))


def common_pose(guesses: Sequence[SubmapPose], parameters: AlignmentParameters) -> Pose:
    """Return the weighted least-squares mean of poses, weighted by their scores."""
    source = np.concatenate([each.middle + LEVER for each in guesses])
    target = np.concatenate([each.pose.apply(each.middle + LEVER) for each in guesses])
    weights = np.repeat([each.score for each in guesses], len(LEVER))
    return register(source, target, weights, parameters.local)


def _best_of_each(scores: Float64, submaps: Int64, chosen: Bool) -> Float64:
    """Return the scores, with 0 for poses that are not chosen or not the best of their submap."""
    rows = np.flatnonzero(chosen)
    rows = rows[np.lexsort((rows, -scores[rows], submaps[rows]))]
    best = rows[np.unique(submaps[rows], return_index=True)[1]]
    kept = np.zeros(len(scores))
    kept[best] = scores[best]
    return kept
