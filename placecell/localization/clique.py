"""Heaviest clique: the heaviest set of correspondences that are all consistent with each other.

The exact maximum is NP-hard. This is the greedy search of CLIPPER+ (Fathian and Summers 2024): a
clique is grown from every vertex, and vertices whose upper bound is below the best weight are
skipped. A clique adds vertices in the order of their support *among the neighbors of its first
vertex* (second-order compatibility, SC2-PCR, Chen et al. 2022), which wrong vertices seldom have.

A clique holds one vertex per query at most. So support and bounds count the heaviest neighbor of
each query only. If the vertices of a query stand together, the heaviest first, that is the first
bit of a run of bits: the time depends on the number of queries, not of neighbors.
"""

import numpy as np

from placecell.core.bits import WORD, packed, trailing_zeros
from placecell.core.cancellation import current, is_cancelled
from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Bool, Float64, Int32, Int64, UInt64


def heaviest_clique(
    graph: UInt64, weights: Float64, queries: Int64, left: Bool, effort: int
) -> tuple[Int64, int]:
    """Return the vertices of a clique, and the number of elementary steps that the search took.

    The vertices are ascending, int64 (c,); there are none if no two are consistent.

    Args:
        graph: uint64 (m, words), symmetric, without edges between vertices of one query (see
            `consistent`).
        weights: float64 (m,), more than 0.
        queries: int64 (m,), query of each vertex. The vertices of a query stand together, the
            heaviest first.
        left: bool (m,), vertices that may be used.
        effort: number of elementary steps after which the best clique so far is returned. It is a
            count, not a time, so that the result is the same on every machine.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    if not len(left):
        return np.zeros(0, dtype=np.int64), 0
    usable = packed(left)
    starts = np.flatnonzero(np.diff(queries, prepend=-1))
    nexts = np.repeat(np.append(starts[1:], len(queries)), np.diff(starts, append=len(queries)))
    bounds = np.zeros(len(left))
    _bound(graph, usable, weights, nexts, bounds)
    seeds = np.argsort(-bounds, kind="stable")
    best = np.empty(len(left), dtype=np.int64)
    size = np.zeros(1, dtype=np.int64)
    token = current()
    steps = _grow(graph, weights, nexts, bounds, seeds, effort, token.flag, best, size)
    token.check()
    return np.sort(best[: size[0]]), steps


@compiled_part
def _support(
    graph: UInt64, vertex: int, among: UInt64, weights: Float64, nexts: Int64
) -> tuple[float, int]:
    """Return the weight of the heaviest neighbor of each query, summed, and the steps it took.

    Args:
        graph: see `heaviest_clique`.
        vertex: the vertex.
        among: bits of the vertices that count, uint64 (words,).
        weights: weight of each vertex.
        nexts: first vertex of the next query, for each vertex.
    """
    words = len(among)
    total = 0.0
    word = 0
    count = 0
    bits = graph[vertex, 0] & among[0]
    while True:
        while bits == 0:
            word += 1
            if word >= words:
                return total, word + 2 * count
            bits = graph[vertex, word] & among[word]
        neighbor = WORD * word + trailing_zeros(bits)
        total += weights[neighbor]
        count += 1
        following = nexts[neighbor]
        if following // WORD != word:
            word = following // WORD
            if word >= words:
                return total, word + 2 * count
            bits = graph[vertex, word] & among[word]
        bits &= ~np.uint64(0) << np.uint64(following % WORD)


@compiled
def _bound(graph: UInt64, usable: UInt64, weights: Float64, nexts: Int64, bounds: Float64) -> None:
    """Fill `bounds` with the upper bound of a clique with each vertex; 0 without neighbors."""
    for vertex in range(len(bounds)):
        if (usable[vertex // WORD] >> np.uint64(vertex % WORD)) & np.uint64(1):
            total, _ = _support(graph, vertex, usable, weights, nexts)
            if total > 0.0:
                bounds[vertex] = weights[vertex] + total


@compiled_part
def _prune(
    graph: UInt64,
    weights: Float64,
    nexts: Int64,
    least: float,
    vertices: UInt64,
    support: Float64,
) -> int:
    """Remove vertices that are in no clique, among these vertices, of more than a weight.

    Args:
        graph: see `heaviest_clique`.
        weights: see `heaviest_clique`.
        nexts: see `_support`.
        least: the weight.
        vertices: bits of the vertices, uint64 (words,), changed.
        support: filled with the support of each vertex among the others.

    Returns:
        Number of elementary steps.
    """
    steps = 0
    for word in range(len(vertices)):
        bits = vertices[word]
        while bits:
            vertex = WORD * word + trailing_zeros(bits)
            support[vertex], spent = _support(graph, vertex, vertices, weights, nexts)
            steps += spent
            if weights[vertex] + support[vertex] <= least:
                vertices[word] &= ~(bits & (~bits + np.uint64(1)))
            bits &= bits - np.uint64(1)
    return steps


@compiled_part
def _extend(
    graph: UInt64, weights: Float64, support: Float64, allowed: UInt64, members: Int64
) -> tuple[int, float, int]:
    """Extend a clique of one member greedily, the best supported vertex first.

    Args:
        graph: see `heaviest_clique`.
        weights: see `heaviest_clique`.
        support: support of each allowed vertex.
        allowed: bits of the member's neighbors that may be added, uint64 (words,); removed.
        members: the member, then filled with the added vertices.

    Returns:
        Number of members, their weight, and the number of elementary steps.
    """
    found, weight = 1, weights[members[0]]
    steps = 0
    while True:
        top = -1
        for word in range(len(allowed)):
            bits = allowed[word]
            while bits:
                vertex = WORD * word + trailing_zeros(bits)
                if top < 0 or support[vertex] > support[top]:
                    top = vertex
                bits &= bits - np.uint64(1)
                steps += 1
        steps += len(allowed)
        if top < 0:
            return found, weight, steps
        members[found] = top
        found += 1
        weight += weights[top]
        for word in range(len(allowed)):
            allowed[word] &= graph[top, word]


@compiled
def _grow(
    graph: UInt64,
    weights: Float64,
    nexts: Int64,
    bounds: Float64,
    seeds: Int64,
    effort: int,
    flag: Int32,
    best: Int64,
    size: Int64,
) -> int:
    """Fill `best` with the heaviest clique found, and `size` with its number of vertices.

    Return the number of elementary steps.

    Args:
        graph: see `heaviest_clique`.
        weights: see `heaviest_clique`.
        nexts: see `_support`.
        bounds: upper bound of a clique with each vertex; 0 for vertices that are not used.
        seeds: vertices by descending bound.
        effort: see `heaviest_clique`.
        flag: flag of a `CancelToken`.
        best: filled with vertices.
        size: int64 (1,), filled.
    """
    # Vertices of which a heavier clique may consist.
    hopeful = np.zeros(graph.shape[1], dtype=np.uint64)
    last = 0
    while last < len(seeds) and bounds[seeds[last]] > 0.0:
        hopeful[seeds[last] // WORD] |= np.uint64(1) << np.uint64(seeds[last] % WORD)
        last += 1
    pruned = last
    support = np.empty(len(weights))
    members = np.empty(len(weights), dtype=np.int64)
    heaviest = 0.0
    steps = 0
    for seed in seeds:
        if bounds[seed] <= heaviest or steps > effort or is_cancelled(flag):
            break
        if not (hopeful[seed // WORD] >> np.uint64(seed % WORD)) & np.uint64(1):
            continue
        allowed = graph[seed] & hopeful
        steps += _prune(graph, weights, nexts, heaviest - weights[seed], allowed, support)
        most, spent = _support(graph, seed, allowed, weights, nexts)
        steps += spent
        if weights[seed] + most <= heaviest:
            continue
        members[0] = seed
        found, weight, spent = _extend(graph, weights, support, allowed, members)
        steps += spent
        if weight > heaviest and found > 1:
            heaviest = weight
            size[0] = found
            best[:found] = members[:found]
            while last and bounds[seeds[last - 1]] <= heaviest:
                last -= 1
                hopeful[seeds[last] // WORD] &= ~(np.uint64(1) << np.uint64(seeds[last] % WORD))
            # Tighter bounds are worth their steps once few vertices are left.
            if 4 * last <= pruned:
                steps += _prune(graph, weights, nexts, heaviest, hopeful, support)
                pruned = last
    return steps
