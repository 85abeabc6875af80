"""Chinese postman tour: the shortest closed path that contains every street of a network.

A tour leaves a crossing as often as it enters it. So crossings with an odd number of streets are
paired at the smallest total distance, and the streets on the paths between them are used twice
(Edmonds and Johnson 1973, *Matching, Euler tours and the Chinese postman*). The resulting graph
consists of closed trails, which are joined at common crossings without U-turns. That is always
possible if each crossing has at least four street ends and at most two of one street (Kotzig 1968,
*Moves without forbidden transitions in a graph*).
"""

from itertools import combinations

import networkx
import numpy as np
from scipy.cluster.hierarchy import DisjointSet
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from placecell.core.types import Float64, Int64


def postman(streets: Int64, lengths: Float64) -> list[int]:
    """Return the tour as arcs: k along street k, k + streets in the opposite direction.

    Args:
        streets: (streets, 2), crossings of each street, at least two streets per crossing, all
            connected.
        lengths: (streets,), meters.
    """
    copies = np.concatenate([np.arange(len(streets)), twice(streets, lengths)]).astype(np.int64)
    partner = transitions(streets[copies], copies)
    end, arcs = 0, []
    while True:
        arcs.append(int(copies[end // 2]) + (end % 2) * len(streets))
        end = partner[end ^ 1]
        if end == 0:
            return arcs


def twice(streets: Int64, lengths: Float64) -> Int64:
    """Return the indices of the streets that the tour uses twice."""
    odd = np.flatnonzero(np.bincount(streets.ravel()) % 2)
    crossings = int(streets.max()) + 1
    graph = csr_matrix((lengths, tuple(streets.T)), shape=(crossings, crossings))
    distances, previous = dijkstra(graph, directed=False, indices=odd, return_predecessors=True)
    pairs = networkx.Graph()
    pairs.add_weighted_edges_from(
        (one, other, distances[one, odd[other]]) for one, other in combinations(range(len(odd)), 2)
    )
    index = {frozenset(ends): street for street, ends in enumerate(streets.tolist())}
    found = []
    for one, other in networkx.min_weight_matching(pairs):
        here = int(odd[other])
        while here != odd[one]:
            there = int(previous[one, here])
            found.append(index[frozenset((here, there))])
            here = there
    return np.array(sorted(found), dtype=np.int64)


def transitions(edges: Int64, streets: Int64) -> list[int]:
    """Return the end by which the tour continues from each end of an edge.

    Args:
        edges: (edges, 2), crossings of each edge. Edge e has the ends 2 e and 2 e + 1. Each
            crossing has an even number of ends.
        streets: (edges,), street of each edge.

    Returns:
        The partner of each end, at the same crossing and on another street.
    """
    partner = [0] * edges.size
    at_crossing = []
    for crossing in range(int(edges.max()) + 1):
        ends = np.flatnonzero(edges.ravel() == crossing)
        ends = ends[np.argsort(streets[ends // 2], kind="stable")]
        half = len(ends) // 2
        # Ends of one street are adjacent; the end half a list away is another street's.
        pairs = [
            (int(one), int(other)) for one, other in zip(ends[:half], ends[half:], strict=True)
        ]
        at_crossing.append(pairs)
        for one, other in pairs:
            partner[one], partner[other] = other, one
    trails = DisjointSet(range(len(edges)))
    for pairs in at_crossing:
        for one, other in pairs:
            trails.merge(one // 2, other // 2)
    for pairs in at_crossing:
        a, b = pairs[0]
        for one, other in pairs[1:]:
            if not trails.merge(a // 2, one // 2):
                continue
            c, d = one, other
            if streets[a // 2] == streets[c // 2] or streets[b // 2] == streets[d // 2]:
                c, d = other, one
            partner[a], partner[c], partner[b], partner[d] = c, a, d, b
            b = c
    return partner
