"""Candidates between robots: right if its centroid lies within 1.5 m of the query's."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from evaluation.poses.robot import Answer
from placecell.core.types import Bool, Float64

RIGHT_METERS = 1.5
CUTS = (1, 5, 25)
BETTER_THAN_CHANCE = 3.0


@dataclass(frozen=True, slots=True)
class Score:
    """How many queries were answered rightly.

    Attributes:
        queries: all of them.
        findable: those with a segment of the map within 1.5 m at all.
        chance: the share of the findable ones that a random candidate would be right for.
        right: by cut, the share of the findable ones with a right candidate among the first so
            many; empty if none was findable.
        first_is_right: bool (queries,).
    """

    queries: int
    findable: int
    chance: float
    right: dict[int, float]
    first_is_right: Bool

    @property
    def recognized(self) -> bool:
        """Whether first candidates are right far more often than by chance."""
        return bool(self.right) and self.right[1] > BETTER_THAN_CHANCE * self.chance


def score(answers: Sequence[Answer], map_centroids: Float64, to_common: Float64) -> Score:
    """Compare the answers with the true places.

    Args:
        map_centroids: of the map's segments, float64 (n, 3), in the map's frame.
        to_common: transform (4, 4) from the map's frame to the common one.
    """
    truth = cKDTree(in_frame(to_common, map_centroids))
    around = np.array(
        [len(truth.query_ball_point(answer.centroid, RIGHT_METERS)) for answer in answers]
    )
    findable = around > 0
    chance = float(around[findable].mean() / len(map_centroids)) if findable.any() else 0.0
    ranks = np.array([first_right(answer, to_common) for answer in answers])
    right = {cut: float((ranks[findable] < cut).mean()) for cut in CUTS} if findable.any() else {}
    return Score(len(answers), int(findable.sum()), chance, right, ranks == 0)


def first_right(answer: Answer, to_common: Float64) -> float:
    """Rank of the first right candidate, from 0; infinite if there is none."""
    offsets = in_frame(to_common, answer.candidates) - answer.centroid
    right = np.flatnonzero(np.linalg.norm(offsets, axis=1) <= RIGHT_METERS)
    return float(right[0]) if len(right) else np.inf


def in_frame(transform: Float64, points: Float64) -> Float64:
    """Points (n, 3) moved by a rigid transform (4, 4)."""
    return np.asarray(points @ transform[:3, :3].T + transform[:3, 3])
