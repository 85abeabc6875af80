"""Guided matching: scores of hypotheses by near map segments."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.core.spatial import within
from placecell.core.types import Float64, Int64
from placecell.localization import Candidates, Hypothesis, LocalizationParameters, Pose, localize
from placecell.localization.guided_matching import CandidateSegments, match_guided

PARAMETERS = LocalizationParameters()
HERE = Pose.of_yaw(0.0, np.zeros(3))


class TableOfSegments:
    """`MapBoxes` without heights, with a table of match probabilities, [query, row]."""

    def __init__(self, centroids: Float64, match_probabilities: Float64) -> None:
        self.centroids = centroids
        self.looks = match_probabilities

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        rows = within(self.centroids, places, meters)
        return rows, np.asarray(self.centroids[rows])

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        return np.asarray(self.looks[queries, rows])

    def heights(self, rows: Int64) -> Float64:
        return np.full(len(rows), np.nan)


def grid(count: int) -> Float64:
    """Return places at distances of 10 m."""
    return np.asarray(np.arange(count)[:, None] * (10.0, 0.0, 0.0))


def elsewhere(centroids: Float64, believed: float) -> Candidates:
    """Return queries with one far candidate each, row 99."""
    shape = (len(centroids), 1)
    beliefs = np.full(shape, believed)
    return Candidates(centroids, np.full(shape, 99), np.full((*shape, 3), 1e4), beliefs)


def guess(pose: Pose = HERE) -> Hypothesis:
    """Return a hypothesis without a score."""
    nothing = np.zeros(0, dtype=np.int64)
    return Hypothesis(pose, np.eye(4), 0.0, nothing, nothing, np.zeros((0, 3)), np.zeros(0))


def score(
    centroids: Float64, there: TableOfSegments, pose: Pose = HERE, believed: float = 0.5
) -> float:
    return match_guided(guess(pose), elsewhere(centroids, believed), there, PARAMETERS).score


def worth(match_probabilities: float, believed: float = 0.5) -> float:
    """Return the weight of a pair whose query has another candidate; 0.01 is chance."""
    return float(np.log1p(match_probabilities / (match_probabilities + believed) / 0.01))


def test_values_match_those_by_hand() -> None:
    off = np.array([[0.0, 0, 0], [0.5, 0, 0], [0, 1.4, 0], [0, 0, 1.6]])
    there = TableOfSegments(grid(4) + off, np.diag([0.8, 0.4, 0.5, 1.0]))
    # Geman and McClure: 1 where they meet, a quarter at half a meter; nothing beyond 1.5 m.
    expected = worth(0.8) + worth(0.4) / 4 + worth(0.5) / (1 + 2.8**2) ** 2
    assert score(grid(4), there) == pytest.approx(expected)


def test_candidate_row_is_counted_once() -> None:
    beliefs = np.array([[0.6, 0.2]])
    rows = np.array([[0, 7]])
    places = np.array([[[0.0, 0, 0], [1e4, 0, 0]]])
    candidates = Candidates(grid(1), rows, places, beliefs)
    found = match_guided(
        guess(), candidates, TableOfSegments(grid(1), np.array([[0.6]])), PARAMETERS
    )
    assert found.score == pytest.approx(np.log1p(0.75 / 0.01))


def test_segment_similar_to_many_has_less_weight() -> None:
    there = TableOfSegments(grid(4), np.diag(np.full(4, 0.5)))
    for believed in (0.01, 0.3, 1.0):
        told = score(grid(4), there, believed=believed)
        assert told == pytest.approx(4 * worth(0.5, believed))


def test_each_segment_and_each_landmark_counts_once() -> None:
    # Two views of one thing, and two segments that both look like them.
    looks = np.array([[0.9, 0.6], [0.6, 0.9]])
    close = np.array([[0.0, 0, 0], [0.2, 0, 0]])
    assert score(close, TableOfSegments(close, looks)) == pytest.approx(worth(0.9))
    apart = np.array([[0.0, 0, 0], [1.2, 0, 0]])
    assert score(apart, TableOfSegments(apart, looks)) == pytest.approx(2 * worth(0.9))


def test_wrong_place_has_no_score() -> None:
    away = Pose.of_yaw(0.0, np.array([0.0, 500.0, 0.0]))
    assert score(grid(4), TableOfSegments(grid(4), np.ones((4, 4))), away) == 0.0


def test_segment_without_position_is_ignored() -> None:
    lost = grid(4)
    lost[2] = np.nan
    there = TableOfSegments(grid(4), np.diag(np.full(4, 0.5)))
    assert score(lost, there) == pytest.approx(3 * worth(0.5))


@given(st.integers(0, 10_000))
def test_robot_frame_makes_no_difference(seed: int) -> None:
    random = np.random.default_rng(seed)
    centroids = random.uniform(-30, 30, (20, 3))
    there = TableOfSegments(
        centroids + random.normal(0, 0.3, (20, 3)), random.uniform(0, 1, (20, 20))
    )
    pose = Pose.of_yaw(random.uniform(-3, 3), random.uniform(-100, 100, 3))
    order = random.permutation(20)
    seen = pose.inverse().apply(centroids)
    told = score(centroids, there)
    assert score(seen, there, pose) == pytest.approx(told)
    there.looks = there.looks[order]
    assert score(seen[order], there, pose) == pytest.approx(told)


@given(seed=st.integers(0, 2**32 - 1), strays=st.integers(0, 3))
def test_far_rows_change_no_score(seed: int, strays: int) -> None:
    random = np.random.default_rng(seed)
    centroids = random.uniform(-30, 30, (20, 3))
    centroids[:strays] += random.uniform(-5e3, 5e3, (strays, 3))
    rows = np.concatenate(
        [centroids + random.normal(0, 0.5, (20, 3)), random.uniform(-6e3, 6e3, (200, 3))]
    )
    there = TableOfSegments(rows, random.uniform(0, 1, (20, 220)))
    told = score(centroids, there)
    there.near = lambda *_: (np.arange(220), rows)  # type: ignore[method-assign]
    assert score(centroids, there) == told


def test_row_that_is_no_candidate_has_probability_0() -> None:
    rows = np.array([[7, 3], [3, 9]])
    places = grid(10)[rows]
    believed = np.array([[0.9, 0.2], [0.0, 0.7]])
    known = CandidateSegments(Candidates(grid(2), rows, places, believed))
    # Row 3 is a candidate of the first query; that of the second is not believed in.
    found, centroids = known.near(grid(10)[[3, 7]], 1.0)
    assert found.tolist() == [3, 7]
    np.testing.assert_array_equal(centroids, grid(10)[[3, 7]])
    asked = known.match_probabilities(np.array([0, 0, 0, 1, 1, 1]), np.array([3, 7, 9, 3, 7, 9]))
    assert asked.tolist() == [0.2, 0.9, 0.0, 0.0, 0.0, 0.7]


def test_right_place_among_similar_places_is_found_with_few_candidates() -> None:
    """In a street of identical houses most candidates belong to another street."""
    random = np.random.default_rng(4)
    things = random.uniform(-30, 30, (20, 3)) * (1, 1, 0.1)
    copy = Pose.of_yaw(np.pi, np.array([300.0, 0.0, 0.0])).apply(things[:12])
    rows = np.concatenate([things, copy])
    chosen = np.where(np.arange(20) < 12, 20 + np.arange(20), np.arange(20))[:, None]
    match_probabilities = np.full((20, 1), 0.8)
    candidates = Candidates(things, chosen, rows[chosen], match_probabilities)
    misled = localize(candidates)
    assert misled.best is not None
    assert misled.best.pose.translation[0] == pytest.approx(300.0, abs=0.1)
    looks = np.zeros((20, 32))
    looks[np.arange(20), np.arange(20)] = looks[np.arange(12), 20 + np.arange(12)] = 0.8
    found = localize(candidates, there=TableOfSegments(rows, looks))
    assert found.best is not None
    assert found.second is not None
    assert found.best.pose.translation == pytest.approx(np.zeros(3), abs=0.1)
    assert len(found.best) == 8
    # Twelve may be either, eight are themselves alone.
    assert found.best.score == pytest.approx(12 * worth(0.8, 0.8) + 8 * np.log1p(100))
    assert found.second.score == pytest.approx(12 * np.log1p(100))
