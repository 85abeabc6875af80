"""Heaviest clique: the heaviest set of correspondences that are all consistent with each other.

The exact maximum is NP-hard. This is the greedy search of CLIPPER+ (Fathian and Summers 2024): a
clique is grown from every vertex, and vertices whose upper bound is below the best weight are
skipped. A clique adds vertices in the order of their support *among the neighbors of its first
vertex* (second-order compatibility, SC2-PCR, Chen et al. 2022), which wrong vertices seldom have.
"""

import numpy as np

from placecell.core.cancellation import current, is_cancelled
from placecell.core.jit import compiled
from placecell.core.types import Bool, Float64, Int32, Int64


def heaviest_clique(
    graph: Bool, weights: Float64, queries: Int64, left: Bool, effort: int
) -> Int64:
    """Return the vertices of a clique, ascending, int64 (c,); empty if no two are consistent.

    Args:
        graph: bool (m, m), symmetric, without edges between vertices of one query.
        weights: float64 (m,), more than 0.
        queries: int64 (m,), query of each vertex, from 0.
        left: bool (m,), vertices that may be used.
        effort: largest number of elementary steps; the best clique so far is returned then. It is
            a count, not a time, so that the result is the same on every machine.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    ends = np.zeros(len(left) + 1, dtype=np.int64)
    _count(graph, left, ends)
    neighbors = np.empty(ends[-1], dtype=np.int64)
    _list(graph, left, neighbors)
    bounds = np.zeros(len(left))
    heaviest = np.zeros(int(queries.max(initial=-1)) + 1)
    _bound(neighbors, ends, weights, queries, heaviest, bounds)
    seeds = np.argsort(-bounds, kind="stable")
    best = np.empty(len(left), dtype=np.int64)
    size = np.zeros(1, dtype=np.int64)
    token = current()
    _grow(graph, neighbors, ends, weights, bounds, seeds, effort, token.flag, best, size)
    token.check()
    return np.sort(best[: size[0]])


@compiled
def _count(graph: Bool, left: Bool, ends: Int64) -> None:
    """Fill `ends`: vertex i has ends[i + 1] - ends[i] neighbors."""
    for vertex in range(len(left)):
        count = 0
        if left[vertex]:
            for other in range(len(left)):
                if graph[vertex, other] and left[other]:
                    count += 1
        ends[vertex + 1] = ends[vertex] + count


@compiled
def _list(graph: Bool, left: Bool, neighbors: Int64) -> None:
    """Fill `neighbors`, vertex by vertex."""
    place = 0
    for vertex in range(len(left)):
        if left[vertex]:
            for other in range(len(left)):
                if graph[vertex, other] and left[other]:
                    neighbors[place] = other
                    place += 1


@compiled
def _bound(
    neighbors: Int64,
    ends: Int64,
    weights: Float64,
    queries: Int64,
    heaviest: Float64,
    bounds: Float64,
) -> None:
    """Fill `bounds` with the upper bound of a clique with each vertex; 0 without neighbors.

    A clique never holds two vertices of one query, so only the heaviest neighbor per query counts.
    """
    for vertex in range(len(bounds)):
        total = 0.0
        for place in range(ends[vertex], ends[vertex + 1]):
            other = neighbors[place]
            if weights[other] > heaviest[queries[other]]:
                total += weights[other] - heaviest[queries[other]]
                heaviest[queries[other]] = weights[other]
        for place in range(ends[vertex], ends[vertex + 1]):
            heaviest[queries[neighbors[place]]] = 0.0
        if total > 0.0:
            bounds[vertex] = weights[vertex] + total


@compiled
def _grow(
    graph: Bool,
    neighbors: Int64,
    ends: Int64,
    weights: Float64,
    bounds: Float64,
    seeds: Int64,
    effort: int,
    flag: Int32,
    best: Int64,
    size: Int64,
) -> None:
    """Fill `best` with the heaviest clique found, and `size` with its number of vertices."""
    around = np.empty(len(weights), dtype=np.int64)
    support = np.empty(len(weights))
    members = np.empty(len(weights), dtype=np.int64)
    heaviest = 0.0
    steps = 0
    for seed in seeds:
        if bounds[seed] <= heaviest or steps > effort or is_cancelled(flag):
            break
        count = 0
        for place in range(ends[seed], ends[seed + 1]):
            if bounds[neighbors[place]] > heaviest:
                around[count] = neighbors[place]
                support[count] = weights[around[count]]
                count += 1
        for one in range(count):
            for other in range(one):
                if graph[around[one], around[other]]:
                    support[one] += weights[around[other]]
                    support[other] += weights[around[one]]
        steps += count * count
        members[0] = seed
        found = 1
        weight = weights[seed]
        for one in np.argsort(-support[:count], kind="mergesort"):
            vertex = around[one]
            agrees = True
            for member in range(found):
                if not graph[vertex, members[member]]:
                    agrees = False
                    break
            if agrees:
                members[found] = vertex
                found += 1
                weight += weights[vertex]
        if weight > heaviest and found > 1:
            heaviest = weight
            size[0] = found
            best[:found] = members[:found]
