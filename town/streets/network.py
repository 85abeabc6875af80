"""The street network of a large town: an irregular grid of winding streets with gaps in it."""

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
"""Meters of streets. Rays are cast in float32, which is half a millimeter coarse that far out."""

SPARE = 1.25
"""A plan has this many times the meters that are kept."""

DESIGNS = 4
"""Of rows of identical houses."""

OWN = -1
"""The design of a street whose houses are all their own."""

STEP = 1.0
"""Between the points of a street's center line, meters on the plan."""


@dataclass(frozen=True, slots=True)
class Network:
    """A graph: crossings, joined by streets.

    Two streets or more meet at each crossing: none is a dead end, and each can be driven, either
    way, without turning on the spot.

    Attributes:
        plan: the grid of which the streets are a part.
        terrain: bends it.
        streets: int64 (streets, 2): the crossings that each joins, numbered column by column.
        lengths: (streets,) meters along the center lines, from crossing to crossing.
        designs: int64 (streets,): which identical houses line it, or `OWN`.
        joined: bool (crossings, crossings).
    """

    plan: StreetPlan
    terrain: Terrain
    streets: Int64
    lengths: Float64
    designs: Int64
    joined: Bool

    @classmethod
    def draw(cls, seed: int, meters: float, look_alikes: float = 0.25) -> Self:
        """The network of this seed.

        Args:
            meters: of streets in all; there are up to a street's length more, and half a kilometer
                at least.
            look_alikes: the share of the streets that identical houses line.

        Raises:
            ValueError: no number of meters that a town can have, or no share.
        """
        if not 0 <= look_alikes <= 1:
            raise ValueError(f"the share of look-alikes is 0 to 1, not {look_alikes}")
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
        """Of streets in all."""
        return float(self.lengths.sum())

    def number(self, crossing: Crossing) -> int:
        """Of a crossing, column by column.

        Raises:
            ValueError: there is no such crossing.
        """
        column, row = crossing
        if not self.has(crossing):
            raise ValueError(f"there is no crossing {crossing}")
        return column * len(self.plan.norths) + row

    def crossing(self, number: int) -> Crossing:
        """Column and row of a crossing."""
        return divmod(int(number), len(self.plan.norths))

    def has(self, crossing: Crossing) -> bool:
        """Whether there is this crossing."""
        column, row = crossing
        return 0 <= column < len(self.plan.easts) and 0 <= row < len(self.plan.norths)

    def joins(self, one: Crossing, other: Crossing) -> bool:
        """Whether a street joins two crossings directly; beyond the town there is none."""
        if not (self.has(one) and self.has(other)):
            return False
        return bool(self.joined[self.number(one), self.number(other)])

    def design(self, one: Crossing, other: Crossing) -> int:
        """Of the houses along the street between two crossings."""
        ends = sorted((self.number(one), self.number(other)))
        (street,) = np.flatnonzero((self.streets == ends).all(axis=1))
        return int(self.designs[street])

    def raised(self) -> Bool:
        """Tell, by region of `town.streets.ground`, where the ground is raised by a curb."""
        columns, rows = len(self.plan.easts), len(self.plan.norths)
        raised = np.zeros((2 * columns + 3, 2 * rows + 3), dtype=bool)
        raised[1:-1, 1:-1] = True
        raised[2:-2:2, 2:-2:2] = False
        for ends in self.streets:
            (i, j), (k, m) = self.crossing(ends[0]), self.crossing(ends[1])
            raised[i + k + 2, j + m + 2] = False
        return raised

    def lines(self) -> Iterator[Float64]:
        """The center line of each street in the town frame, from crossing to crossing: (n, 2)."""
        return center_lines(self.plan, self.terrain, self.streets)


def grid_streets(plan: StreetPlan) -> Int64:
    """All streets of a plan, as the numbers of the crossings that each joins: (streets, 2)."""
    numbers = np.arange(len(plan.easts) * len(plan.norths)).reshape(len(plan.easts), -1)
    along = np.stack([numbers[:, :-1].ravel(), numbers[:, 1:].ravel()], axis=1)
    across = np.stack([numbers[:-1].ravel(), numbers[1:].ravel()], axis=1)
    return np.concatenate([along, across]).astype(np.int64)


def center_lines(plan: StreetPlan, terrain: Terrain, streets: Int64) -> Iterator[Float64]:
    """Of each street (streets, 2) the center line in the town frame: (n, 2), a step apart."""
    for ends in streets:
        start, end = (plan.crossing(*divmod(int(number), len(plan.norths))) for number in ends)
        points = int(np.linalg.norm(end - start) / STEP) + 2
        yield terrain.bend(np.linspace(start, end, points))


def arc_length(line: Float64) -> float:
    """Meters along a line (n, 2)."""
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def thinned(streets: Int64, lengths: Float64, meters: float, rng: np.random.Generator) -> Int64:
    """Indices of the streets that are left when random ones are taken away.

    Each crossing keeps two streets or more, the network hangs together, and it is no mere ring:
    then every street can be reached from every other without turning on the spot, in whichever
    direction it is to be driven (Kotani and Sunada, Zeta functions of finite graphs, 2000: the
    graph of directed edges is strongly connected).

    Args:
        meters: that are left at least.
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
    """How many parts a network falls into."""
    graph = csr_matrix((np.ones(len(streets)), tuple(streets.T)), shape=(crossings, crossings))
    return int(connected_components(graph, directed=False)[0])
