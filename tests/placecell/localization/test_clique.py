import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.core.bits import packed
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
    found, _ = heaviest_clique(packed(graph), weights, np.arange(n), left, EFFORT)
    return list(found.tolist())


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
    found, _ = heaviest_clique(packed(graph), np.ones(14), queries, left, EFFORT)
    assert found.tolist() == [11, 12, 13]


@given(st.integers(0, 10_000))
def test_clique_has_one_vertex_of_each_query(seed: int) -> None:
    random = np.random.default_rng(seed)
    queries = np.sort(random.integers(0, 30, 150))
    weights = random.uniform(0.1, 1, 150)
    order = np.lexsort((-weights, queries))
    upper = np.triu(random.uniform(size=(150, 150)) < 0.5, 1) & (queries[:, None] != queries)
    graph = upper | upper.T
    left = random.uniform(size=150) < 0.9
    found, _ = heaviest_clique(packed(graph), weights[order], queries, left, EFFORT)
    assert all(graph[i, j] for i, j in itertools.combinations(found, 2))
    assert left[found].all()
    assert len(found) >= 5


def test_little_effort_still_finds_something() -> None:
    graph = random_graph(200, 0.5)
    left = np.ones(200, dtype=bool)
    found, _ = heaviest_clique(packed(graph), np.ones(200), np.arange(200), left, 1)
    assert len(found) > 2


@pytest.mark.parametrize("density", [0.1, 0.5, 0.9, 1.0])
def test_steps_stay_near_the_effort(density: int) -> None:
    graph = random_graph(1_000, density)
    left = np.ones(1_000, dtype=bool)
    found, steps = heaviest_clique(packed(graph), np.ones(1_000), np.arange(1_000), left, 100_000)
    assert len(found) > 2
    # One vertex more: supports of 1,000 neighbors, of 16 words and 1,000 neighbors each at most.
    assert steps < 100_000 + 1_000 * (16 + 2 * 1_000) + 1_000 * 1_000


def random_graph(size: int, density: float) -> Bool:
    upper = np.triu(np.random.default_rng(6).uniform(size=(size, size)) < density, 1)
    return np.asarray(upper | upper.T)
