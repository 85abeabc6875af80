import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.core.types import Bool, Float64
from placecell.localization.clique import heaviest_clique

EFFORT = 10**9


def graph_of(size: int, edges: list[tuple[int, int]]) -> Bool:
    graph = np.zeros((size, size), dtype=bool)
    for i, j in edges:
        graph[i, j] = graph[j, i] = True
    return graph


def search(graph: Bool, weights: Float64 | None = None, left: Bool | None = None) -> list[int]:
    n = len(graph)
    weights = np.ones(n) if weights is None else weights
    left = np.ones(n, dtype=bool) if left is None else left
    found: list[int] = heaviest_clique(graph, weights, np.arange(n), left, EFFORT).tolist()
    return found


SQUARE_AND_TRIANGLE = [*itertools.combinations(range(4), 2), (3, 4), (4, 5), (5, 6), (4, 6)]


def test_larger_of_two_cliques_is_found() -> None:
    assert search(graph_of(7, SQUARE_AND_TRIANGLE)) == [0, 1, 2, 3]


def test_heavier_of_two_cliques_is_found() -> None:
    weights = np.array([1, 1, 1, 1, 3, 3, 3.0])
    assert search(graph_of(7, SQUARE_AND_TRIANGLE), weights) == [4, 5, 6]


def test_removed_vertices_are_in_no_clique() -> None:
    left = np.array([True, True, False, False, True, True, True])
    assert search(graph_of(7, SQUARE_AND_TRIANGLE), left=left) == [4, 5, 6]


@pytest.mark.parametrize("size", [0, 1, 5])
def test_without_edges_there_is_no_clique(size: int) -> None:
    assert search(graph_of(size, [])) == []


@given(st.integers(0, 10_000), st.integers(2, 11), st.floats(0.1, 0.9))
def test_found_clique_is_maximal(seed: int, size: int, density: float) -> None:
    random = np.random.default_rng(seed)
    upper = np.triu(random.uniform(size=(size, size)) < density, 1)
    graph, weights = upper | upper.T, random.uniform(0.1, 1, size)
    found = search(graph, weights)
    assert all(graph[i, j] for i, j in itertools.combinations(found, 2))
    assert not any(graph[i, found].all() for i in range(size) if i not in found and found)
    every = (c for n in range(2, size + 1) for c in itertools.combinations(range(size), n))
    cliques = (c for c in every if all(graph[i, j] for i, j in itertools.combinations(c, 2)))
    best = max((weights[list(c)].sum() for c in cliques), default=0.0)
    # Greedy, so not always the very best, but never far from it.
    assert 0.6 * best <= weights[found].sum() <= best + 1e-9


def test_a_planted_clique_is_found() -> None:
    random = np.random.default_rng(5)
    upper = np.triu(random.uniform(size=(300, 300)) < 0.1, 1)
    graph = upper | upper.T
    planted = np.sort(random.choice(300, 12, replace=False))
    graph[np.ix_(planted, planted)] = ~np.eye(12, dtype=bool)
    assert search(graph) == planted.tolist()


def test_one_query_counts_once_in_the_bound() -> None:
    """Ten vertices of one query around vertex 0 do not hide the triangle."""
    graph = graph_of(14, [*((0, i) for i in range(1, 11)), (11, 12), (12, 13), (11, 13)])
    queries = np.array([0, *[1] * 10, 2, 3, 4])
    left = np.ones(14, dtype=bool)
    assert heaviest_clique(graph, np.ones(14), queries, left, EFFORT).tolist() == [11, 12, 13]


def test_little_effort_still_finds_something() -> None:
    random = np.random.default_rng(6)
    upper = np.triu(random.uniform(size=(200, 200)) < 0.5, 1)
    graph = upper | upper.T
    left = np.ones(200, dtype=bool)
    found = heaviest_clique(graph, np.ones(200), np.arange(200), left, 1)
    assert len(found) > 2
