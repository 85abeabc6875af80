"""Street network of a large town: an irregular grid of winding streets with gaps."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from typing import Self

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from placecell.core.types import Bool, Float64, Int64
from town.streets.plan import Crossing, StreetPlan
from town.streets.terrain import Terrain

LONGEST = 200_000.0
"""Largest total length of the streets, meters. Float32 rays are exact to 0.5 mm at that extent."""

SPARE = 1.25
"""Length of the plan's streets divided by the length that is kept."""

DESIGNS = 4
"""Number of designs of identical houses."""

OWN = -1
"""Design number of a street whose houses are all different."""

STEP = 1.0
"""Distance between the points of a center line, meters on the plan."""


@dataclass(frozen=True, slots=True)
class Network:
    """Graph of crossings that are joined by streets.

    At least two streets meet at each crossing. So there is no dead end, and each street can be
    driven in both directions without a U-turn.

    Attributes:
        plan: grid that contains the streets.
        terrain: terrain that bends the plan.
        streets: int64 (streets, 2), crossings of each street, numbered column by column.
        lengths: (streets,), length of each center line from crossing to crossing, meters.
        designs: int64 (streets,), design of the identical houses along each street, or `OWN`.
        joined: bool (crossings, crossings), whether a street joins two crossings.
    """

    plan: StreetPlan
    terrain: Terrain
    streets: Int64
    lengths: Float64
    designs: Int64
    joined: Bool

    @classmethod
    def draw(cls, seed: int, meters: float, look_alikes: float = 0.25) -> Self:
        """Draw the network of a seed.

        Args:
            seed: seed of the town.
            meters: total length of the streets, meters. The network has up to one street more, and
                at least 500 m.
            look_alikes: share of the streets that are lined by identical houses, 0 to 1.

        Raises:
            ValueError: `meters` or `look_alikes` is out of range.
        """
        if not 0 <= look_alikes <= 1:
            raise ValueError(f"Invalid share of look-alikes: expected 0 to 1, not {look_alikes}")
        if not 0 < meters <= LONGEST:
            raise ValueError(f"a town has up to {LONGEST:.0f} m of streets, not {meters} m")
        terrain = Terrain.winding(np.random.default_rng([seed, 3]))
        for size in count(5):
            rng = np.random.default_rng([seed, 4, size])
            plan = StreetPlan.draw(rng, (size // 2, size - size // 2))
            streets = grid_streets(plan)
            lengths = np.array([arc_length(line) for line in center_lines(plan, terrain, streets)])
            if lengths.sum() >= SPARE * meters:
                break
        kept = thinned(streets, lengths, meters, rng)
        alike = rng.random(len(kept)) < look_alikes
        designs = np.where(alike, rng.integers(DESIGNS, size=len(kept)), OWN)
        joined = np.zeros((streets.max() + 1,) * 2, dtype=bool)
        joined[tuple(streets[kept].T)] = True
        return cls(plan, terrain, streets[kept], lengths[kept], designs, joined | joined.T)

    def meters(self) -> float:
        """Return the total length of the streets, meters."""
        return float(self.lengths.sum())

    def number(self, crossing: Crossing) -> int:
        """Return the number of a crossing, counted column by column.

        Raises:
            ValueError: The crossing does not exist.
        """
        column, row = crossing
        if not self.has(crossing):
            raise ValueError(f"there is no crossing {crossing}")
        return column * len(self.plan.norths) + row

    def crossing(self, number: int) -> Crossing:
        """Return column and row of a crossing, given its number."""
        return divmod(int(number), len(self.plan.norths))

    def has(self, crossing: Crossing) -> bool:
        """Return whether the crossing exists."""
        column, row = crossing
        return 0 <= column < len(self.plan.easts) and 0 <= row < len(self.plan.norths)

    def joins(self, one: Crossing, other: Crossing) -> bool:
        """Return whether a street joins two crossings directly. Outside the town none does."""
        if not (self.has(one) and self.has(other)):
            return False
        return bool(self.joined[self.number(one), self.number(other)])

    def design(self, one: Crossing, other: Crossing) -> int:
        """Return the design of the houses along the street between two crossings."""
        ends = sorted((self.number(one), self.number(other)))
        (street,) = np.flatnonzero((self.streets == ends).all(axis=1))
        return int(self.designs[street])

    def raised(self) -> Bool:
        """Return whether each region of `town.streets.ground` is raised by a curb."""
        columns, rows = len(self.plan.easts), len(self.plan.norths)
        raised = np.zeros((2 * columns + 3, 2 * rows + 3), dtype=bool)
        raised[1:-1, 1:-1] = True
        raised[2:-2:2, 2:-2:2] = False
        for ends in self.streets:
            (i, j), (k, m) = self.crossing(ends[0]), self.crossing(ends[1])
            raised[i + k + 2, j + m + 2] = False
        return raised

    def lines(self) -> Iterator[Float64]:
        """Yield each street's center line in the town frame, from crossing to crossing, (n, 2)."""
        return center_lines(self.plan, self.terrain, self.streets)


def grid_streets(plan: StreetPlan) -> Int64:
    """Return the crossings of each street of a plan, (streets, 2)."""
    numbers = np.arange(len(plan.easts) * len(plan.norths)).reshape(len(plan.easts), -1)
    along = np.stack([numbers[:, :-1].ravel(), numbers[:, 1:].ravel()], axis=1)
    across = np.stack([numbers[:-1].ravel(), numbers[1:].ravel()], axis=1)
    return np.concatenate([along, across]).astype(np.int64)


def center_lines(plan: StreetPlan, terrain: Terrain, streets: Int64) -> Iterator[Float64]:
    """Yield the center line of each street in the town frame, (n, 2), meters."""
    for ends in streets:
        start, end = (plan.crossing(*divmod(int(number), len(plan.norths))) for number in ends)
        points = int(np.linalg.norm(end - start) / STEP) + 2
        yield terrain.bend(np.linspace(start, end, points))


def arc_length(line: Float64) -> float:
    """Return the length of a line (n, 2), meters."""
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def thinned(streets: Int64, lengths: Float64, meters: float, rng: np.random.Generator) -> Int64:
    """Remove random streets and return the indices of the others.

    Each crossing keeps at least two streets, and the network remains connected and is not a single
    ring. Then every street can be reached from every other, in both directions, without a U-turn:
    the graph of directed edges is strongly connected (Kotani and Sunada 2000, *Zeta functions of
    finite graphs*).

    Args:
        streets: int64 (streets, 2), crossings of each street.
        lengths: (streets,), meters.
        meters: smallest total length that remains, meters.
        rng: random number generator.
    """
    crossings = int(streets.max()) + 1
    kept = np.ones(len(streets), dtype=bool)
    degrees = np.bincount(streets.ravel(), minlength=crossings)
    for street in rng.permutation(len(streets)):
        ends = streets[street]
        if (
            lengths[kept].sum() - lengths[street] < meters
            or degrees[ends].min() < 3
            or np.count_nonzero(kept) == crossings + 1
        ):
            continue
        kept[street] = False
        if components(streets[kept], crossings) == 1:
            degrees[ends] -= 1
        else:
            kept[street] = True
    return np.flatnonzero(kept)


def components(streets: Int64, crossings: int) -> int:
    """Return the number of connected components of a network."""
    graph = csr_matrix((np.ones(len(streets)), tuple(streets.T)), shape=(crossings, crossings))
    return int(connected_components(graph, directed=False)[0])
