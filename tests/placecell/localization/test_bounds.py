"""The work from candidates to a pose is bounded, however segments and candidates are arranged."""

import importlib

import numpy as np
import pytest

from benchmarks.localization.hard_queries import HARD_QUERIES, HardQuery
from placecell.core.spatial import within
from placecell.core.types import Bool, Float64, Int64, UInt64
from placecell.localization import Candidates, LocalizationParameters, localize
from placecell.localization.clique import heaviest_clique

QUERIES, K = 120, 25
PARAMETERS = LocalizationParameters(hypotheses=6)


class CountingMap:
    """`MapBoxes` that counts the compared pairs. All pairs are equally similar."""

    def __init__(self, centroids: Float64) -> None:
        self.centroids = centroids
        self.most_pairs = 0

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        rows = within(self.centroids, places, meters)
        return rows, np.asarray(self.centroids[rows])

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        self.most_pairs = max(self.most_pairs, len(rows))
        return np.full(len(queries), 0.5)

    def heights(self, rows: Int64) -> Float64:
        return np.full(len(rows), np.nan)


def candidates_of(query: HardQuery) -> Candidates:
    probabilities = np.full(query.rows.shape, 0.5)
    return Candidates(query.centroids, query.rows, query.map_centroids[query.rows], probabilities)


@pytest.mark.parametrize("name", HARD_QUERIES)
def test_steps_of_a_hard_query_stay_within_the_effort(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    spent, efforts, sizes = [], [], []

    def counting(
        graph: UInt64, weights: Float64, queries: Int64, left: Bool, effort: int
    ) -> tuple[Int64, int]:
        found, steps = heaviest_clique(graph, weights, queries, left, effort)
        spent.append(steps)
        efforts.append(effort)
        sizes.append(len(weights))
        return found, steps

    monkeypatch.setattr(
        importlib.import_module("placecell.localization.hypothesis"), "heaviest_clique", counting
    )
    query = HARD_QUERIES[name](QUERIES, K, np.random.default_rng(0))
    there = CountingMap(query.map_centroids)
    found = localize(candidates_of(query), PARAMETERS, there=there)

    assert len(found.hypotheses) <= PARAMETERS.hypotheses
    assert max(sizes) <= min(PARAMETERS.most, QUERIES * K)
    # The vertex at which the effort ends is still finished: its neighbors, some words each.
    words = -(-max(sizes) // 64)
    last = max(sizes) * (words + 2 * QUERIES)
    assert all(steps <= effort + 2 * last for steps, effort in zip(spent, efforts, strict=True))
    assert sum(spent) <= PARAMETERS.effort + 2 * last
    assert there.most_pairs <= QUERIES * PARAMETERS.most_views


@pytest.mark.parametrize("name", ["line", "grid"])
def test_equal_poses_everywhere_are_ambiguous(name: str) -> None:
    query = HARD_QUERIES[name](QUERIES, K, np.random.default_rng(0))
    found = localize(candidates_of(query), there=CountingMap(query.map_centroids))
    assert found.reason == "ambiguous"
    assert len(found.hypotheses) > 1


def test_ordinary_query_is_localized() -> None:
    query = HARD_QUERIES["street"](QUERIES, K, np.random.default_rng(0))
    found = localize(candidates_of(query), there=CountingMap(query.map_centroids))
    assert found.best is not None
    assert np.degrees(found.best.pose.yaw) == pytest.approx(-np.degrees(1.0), abs=0.5)
    assert len(found.best) > 0.7 * QUERIES
