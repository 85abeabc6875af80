"""Score of matches between robots: a candidate within 1.5 m of the query is right."""

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
    """Shares of queries with right candidates.

    Attributes:
        queries: number of queries.
        findable: number of queries with a map segment within 1.5 m.
        chance: probability that a random candidate of a findable query is right.
        right: for each cut k, the share of findable queries with a right candidate among the first
            k; empty if no query is findable.
        first_is_right: bool (queries,), whether the first candidate is right.
    """

    queries: int
    findable: int
    chance: float
    right: dict[int, float]
    first_is_right: Bool

    @property
    def recognized(self) -> bool:
        """Return whether first candidates are right far more often than by chance."""
        return bool(self.right) and self.right[1] > BETTER_THAN_CHANCE * self.chance


def score(answers: Sequence[Answer], map_centroids: Float64, to_common: Float64) -> Score:
    """Compare candidates with the true positions.

    Args:
        answers: candidates of each query.
        map_centroids: float64 (n, 3), segment centroids of the map, in its frame.
        to_common: transform (4, 4) from the map's frame to the common frame.
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
    """Return the rank of the first right candidate, from 0; infinite if there is none."""
    offsets = in_frame(to_common, answer.candidates) - answer.centroid
    right = np.flatnonzero(np.linalg.norm(offsets, axis=1) <= RIGHT_METERS)
    return float(right[0]) if len(right) else np.inf


def in_frame(transform: Float64, points: Float64) -> Float64:
    """Return points (n, 3) transformed by a rigid transform (4, 4)."""
    return np.asarray(points @ transform[:3, :3].T + transform[:3, 3])
