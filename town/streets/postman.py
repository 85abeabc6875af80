"""The Chinese postman's round: every street of a network at least once, in as few meters as can be.

Where an odd number of streets meets, the round cannot leave as often as it comes; so such crossings
are paired with the least meters in all, and the streets on the paths between the two of a pair are
taken twice (Edmonds and Johnson, Matching, Euler tours and the Chinese postman, 1973). What is then
even everywhere falls into closed trails, which are joined where they meet, and never so that the
round goes back along the street that it came by (Kotzig, Moves without forbidden transitions in a
graph, 1968: where four or more ways meet and no street is there more than twice, it need not).
"""

from itertools import combinations

import networkx
import numpy as np
from scipy.cluster.hierarchy import DisjointSet
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from placecell.core.types import Float64, Int64


def postman(streets: Int64, lengths: Float64) -> list[int]:
    """The round, as arcs: k along street k, k + streets along it the other way.

    Args:
        streets: (streets, 2): the crossings that each joins; two or more at each crossing, and all
            of them connected.
        lengths: (streets,) meters.
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
    """The streets that the round takes twice: indices."""
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
    """By which end the round goes on, wherever it comes to an end of an edge.

    Args:
        edges: (edges, 2): the crossings of each; edge e has the ends 2 e and 2 e + 1. An even
            number of ends is at each crossing.
        streets: (edges,): the street that each runs along.

    Returns:
        the partner of each end, at the same crossing and on another street.
    """
    partner = [0] * edges.size
    at_crossing = []
    for crossing in range(int(edges.max()) + 1):
        ends = np.flatnonzero(edges.ravel() == crossing)
        ends = ends[np.argsort(streets[ends // 2], kind="stable")]
        half = len(ends) // 2
        # Both ends of a street taken twice stand side by side; half a round of four on is another.
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
