"""Plan of an indoor floor: corridors, the blocks between them, and the ways of robots."""

from dataclasses import dataclass
from itertools import pairwise, product
from typing import Self

import numpy as np

from placecell.core.types import Float64
from town.places.paths import Walkways

HALLS = ("warehouse", "library", "workshop", "office", "lobby")
"""Kinds of halls."""


@dataclass(frozen=True)
class FloorPlan:
    """Corridors of a floor and the blocks between them.

    Attributes:
        spans_x: (columns, 2), x of both sides of each corridor along y, meters.
        spans_y: (rows, 2), y of both sides of each corridor along x, meters.
        depth: depth of the rooms along the outer walls, meters.
        height: height of the ceiling of corridors and rooms, meters.
        blocks: kind of each block (column, row): "rooms" or one of `HALLS`.
        gates: x of the gates of each hall, meters.
    """

    spans_x: Float64
    spans_y: Float64
    depth: float
    height: float
    blocks: dict[tuple[int, int], str]
    gates: dict[tuple[int, int], float]

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        """Draw a random plan with four corridors along y, three along x, and six blocks."""
        depth = float(rng.uniform(4.5, 6.5))
        spans_x = corridors(rng, 4, (16.0, 25.0))
        spans_y = corridors(rng, 3, (12.0, 17.0))
        kinds = rng.permutation(["rooms", "rooms", *rng.choice(HALLS, size=4, replace=False)])
        places = list(product(range(3), range(2)))
        blocks = dict(zip(places, map(str, kinds), strict=True))
        gates = {
            (i, j): float(
                rng.uniform(spans_x[i, 1] + 0.35 * width, spans_x[i + 1, 0] - 0.35 * width)
            )
            for (i, j) in places
            for width in [spans_x[i + 1, 0] - spans_x[i, 1]]
        }
        return cls(spans_x, spans_y, depth, float(rng.uniform(2.8, 3.2)), blocks, gates)

    def walkways(self) -> Walkways:
        """Return the ways of robots: all corridors, and through the gates of all halls."""
        xs, ys = self.spans_x.mean(axis=1), self.spans_y.mean(axis=1)
        nodes = [(float(x), float(y)) for y in ys for x in xs]
        ends = [(len(xs) * j + i, len(xs) * (j + 1) + i)
                for i in range(len(xs)) for j in range(len(ys) - 1)]  # fmt: skip
        along = [list(range(len(xs) * j, len(xs) * (j + 1))) for j in range(len(ys))]
        for (i, j), kind in self.blocks.items():
            if kind == "rooms":
                continue
            for row in (j, j + 1):
                along[row].append(len(nodes))
                nodes.append((self.gates[i, j], float(ys[row])))
            ends.append((len(nodes) - 2, len(nodes) - 1))
        for numbers in along:
            ends += pairwise(sorted(numbers, key=lambda number: nodes[number][0]))
        return Walkways.straight(np.array(nodes), ends)

    def block(self, i: int, j: int) -> tuple[Float64, Float64]:
        """Return lowest and highest x and y of a block, (2,) each."""
        low = np.array([self.spans_x[i, 1], self.spans_y[j, 1]])
        return low, np.array([self.spans_x[i + 1, 0], self.spans_y[j + 1, 0]])

    def inner(self) -> tuple[Float64, Float64]:
        """Return lowest and highest x and y of corridors and blocks together, (2,) each."""
        low = np.array([self.spans_x[0, 0], self.spans_y[0, 0]])
        return low, np.array([self.spans_x[-1, 1], self.spans_y[-1, 1]])


def corridors(rng: np.random.Generator, count: int, gap: tuple[float, float]) -> Float64:
    """Draw corridors side by side: low and high side of each, (count, 2), meters.

    Args:
        rng: random number generator.
        count: number of corridors.
        gap: smallest and largest distance between two of them, meters.
    """
    widths = rng.uniform(3.1, 4.2, size=count)
    starts = np.concatenate([[0.0], np.cumsum(widths[:-1] + rng.uniform(*gap, size=count - 1))])
    return np.stack([starts, starts + widths], axis=1)
