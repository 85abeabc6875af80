"""Planner of paths through a street network: all streets, random paths, loops, shortest paths.

A path is a list of crossings, each joined to the next by a street. It has no U-turns: it never goes
back along the street by which it came. So the search graph has *arcs*: streets with a direction.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from placecell.core.types import Float64, Int64
from town.streets.network import Network
from town.streets.plan import Crossing
from town.streets.postman import postman

Way = list[Crossing]


@dataclass(frozen=True)
class Planner:
    """Planner of paths.

    Attributes:
        network: street network.
        arcs: int64 (2 * streets, 2), start and end crossing of each arc. Arcs k and k + streets are
            the two directions of street k.
        lengths: (2 * streets,), meters.
        onward: sparse (arcs, arcs), length of each arc that continues another one, except its
            reverse, meters.
    """

    network: Network
    arcs: Int64
    lengths: Float64
    onward: csr_matrix

    @classmethod
    def of(cls, network: Network) -> Self:
        """Create the planner of a network."""
        arcs = np.concatenate([network.streets, network.streets[:, ::-1]])
        lengths = np.tile(network.lengths, 2)
        before, after = np.nonzero(
            (arcs[:, None, 1] == arcs[None, :, 0]) & (arcs[:, None, 0] != arcs[None, :, 1])
        )
        onward = csr_matrix((lengths[after], (before, after)), shape=(len(arcs), len(arcs)))
        return cls(network, arcs, lengths, onward)

    def between(self, start: Crossing, goal: Crossing) -> Way:
        """Return the shortest path from one crossing to another.

        Raises:
            ValueError: A crossing does not exist, or both are the same.
        """
        first, last = self.network.number(start), self.network.number(goal)
        if first == last:
            raise ValueError(f"a way needs two crossings, not {start} twice")
        count = len(self.network.joined)
        graph = csr_matrix((self.lengths, tuple(self.arcs.T)), shape=(count, count))
        _, previous = dijkstra(graph, indices=first, return_predecessors=True)
        return [self.network.crossing(number) for number in traced(previous, first, last)]

    def every_street(self) -> Way:
        """Return the shortest closed path that contains each street at least once."""
        return self._way(postman(self.network.streets, self.network.lengths))

    def wander(self, length: float, rng: np.random.Generator) -> Way:
        """Return a random path of at least this length, meters."""
        walk = [int(rng.integers(len(self.arcs)))]
        while self.lengths[walk].sum() < length:
            walk.append(self._any_onward(walk[-1], rng))
        return self._way(walk)

    def loop(self, length: float, rng: np.random.Generator, laps: int = 1) -> Way:
        """Return a random closed path of at least this length. It ends with its first street.

        Args:
            length: smallest length of one lap, meters.
            rng: random number generator.
            laps: number of laps.

        Raises:
            ValueError: `laps` is less than 1.
        """
        if laps < 1:
            raise ValueError(f"a loop has one lap or more, not {laps}")
        first = int(rng.integers(len(self.arcs)))
        # Distance from the end of each arc back to the end of the first.
        home, towards = dijkstra(self.onward.T, indices=first, return_predecessors=True)
        walk = [first]
        while len(walk) < 2 or self.lengths[walk[1:]].sum() + home[walk[-1]] < length:
            walk.append(self._any_onward(walk[-1], rng))
        back = traced(towards, first, walk[-1])[::-1]
        lap = walk + back[1:-1]
        return self._way([*(lap * laps), first])

    def meters(self, way: Sequence[Crossing]) -> float:
        """Return the length of a path, meters.

        Raises:
            ValueError: It is no valid path (see `arcs_of`).
        """
        return float(sum(self.lengths[arc] for arc in self.arcs_of(way)))

    def arcs_of(self, way: Sequence[Crossing]) -> list[int]:
        """Return the arcs of a path.

        Raises:
            ValueError: The path has fewer than two crossings, a gap, or a U-turn.
        """
        if len(way) < 2:
            raise ValueError("a way needs two crossings or more")
        found = []
        for one, other in pairwise(way):
            if not self.network.joins(one, other):
                raise ValueError(f"no street joins the crossings {one} and {other} directly")
            ends = [self.network.number(one), self.network.number(other)]
            found.append(int(np.flatnonzero((self.arcs == ends).all(axis=1))[0]))
            if len(found) > 1 and abs(found[-1] - found[-2]) == len(self.network.streets):
                raise ValueError(f"the way turns on the spot at {one}")
        return found

    def _any_onward(self, arc: int, rng: np.random.Generator) -> int:
        ways = self.onward.indices[self.onward.indptr[arc] : self.onward.indptr[arc + 1]]
        return int(ways[int(rng.integers(len(ways)))])

    def _way(self, walk: Sequence[int]) -> Way:
        numbers = [self.arcs[walk[0], 0], *self.arcs[list(walk), 1]]
        return [self.network.crossing(number) for number in numbers]


def traced(previous: Int64, start: int, end: int) -> list[int]:
    """Return the nodes from start to end, given each node's predecessor (nodes,)."""
    path = [end]
    while path[-1] != start:
        path.append(int(previous[path[-1]]))
    return path[::-1]
