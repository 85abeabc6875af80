"""The street plan: a grid of streets with blocks of unlike size between them.

The plan is straight; `Terrain.bend` takes it to the town frame. Meters, x east, y north.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Self

import numpy as np

from placecell.core.types import Float64

MARGIN = 32.0
"""How far the town goes on beyond its outermost streets."""

CURB_HEIGHT = 0.12

BAY_LENGTH = 6.3
BAY_WIDTH = 2.2
"""Parking bays lie along the curb, on the carriageway."""


Crossing = tuple[int, int]
"""Column and row of the streets that cross; one less or more than there are: beyond the town."""


@dataclass(frozen=True, slots=True)
class Frontage:
    """One side of one block: the frame in which its street is furnished.

    Its x runs along the curb, its y from the curb (0) into the block; the carriageway lies at
    negative y.

    Attributes:
        corner: (2,) the frame's origin on the plan, where two curbs meet.
        heading: of its x axis on the plan, radians.
        length: of the curb to the next corner.
        street: the crossings at its two ends.
    """

    corner: Float64
    heading: float
    length: float
    street: tuple[Crossing, Crossing]

    def on_plan(self, x: float, y: float) -> Float64:
        """A place of this frame, on the plan: (2,)."""
        along = np.array([np.cos(self.heading), np.sin(self.heading)])
        inward = np.array([-along[1], along[0]])
        return np.asarray(self.corner + x * along + y * inward)

    def bays(self) -> Float64:
        """Centres of the parking bays along x: (bays,); none near the crossings."""
        clear = 12.0
        return np.arange(clear + BAY_LENGTH / 2, self.length - clear - BAY_LENGTH / 2, BAY_LENGTH)


@dataclass(frozen=True, slots=True)
class StreetPlan:
    """Streets north-south and east-west.

    Attributes:
        easts: (n,) x of the center lines of the streets that run north-south.
        norths: (m,) y of those that run east-west.
        east_curbs: (n,) distance of the curbs from the center line.
        north_curbs: (m,) the same.
    """

    easts: Float64
    norths: Float64
    east_curbs: Float64
    north_curbs: Float64

    @classmethod
    def draw(cls, rng: np.random.Generator, streets: tuple[int, int]) -> Self:
        """A random plan.

        Args:
            streets: how many run north-south and how many east-west, two or more each.

        Raises:
            ValueError: fewer than two streets a direction.
        """
        if min(streets) < 2:
            raise ValueError(f"a town needs two streets a direction or more, not {streets}")
        lines = [np.cumsum(rng.uniform(58.0, 96.0, size=count)) for count in streets]
        curbs = [rng.uniform(5.2, 6.4, size=count) for count in streets]
        return cls(lines[0] - lines[0][0], lines[1] - lines[1][0], curbs[0], curbs[1])

    def crossing(self, column: int, row: int) -> Float64:
        """The middle of a crossing: (2,)."""
        return np.array([self.easts[column], self.norths[row]])

    def spans(self) -> tuple[Float64, Float64]:
        """From curb to curb: where the blocks lie on x (n + 1, 2) and on y (m + 1, 2)."""
        return block_spans(self.easts, self.east_curbs), block_spans(self.norths, self.north_curbs)

    def blocks(self) -> Iterator[tuple[int, int]]:
        """Columns and rows of the blocks: block (i, j) lies south-west of crossing (i, j)."""
        return product(range(len(self.easts) + 1), range(len(self.norths) + 1))

    def block(self, column: int, row: int) -> Iterator[Frontage]:
        """A block's sides that lie on a street, anticlockwise."""
        spans_x, spans_y = self.spans()
        (west, east), (south, north) = spans_x[column], spans_y[row]
        here = (column, row)
        corners = [(column - 1, row - 1), (column, row - 1), here, (column - 1, row)]
        sides = [
            (row > 0, (west, south), 0.0, east - west),
            (column < len(self.easts), (east, south), np.pi / 2, north - south),
            (row < len(self.norths), (east, north), np.pi, east - west),
            (column > 0, (west, north), -np.pi / 2, north - south),
        ]
        for side, (on_street, corner, heading, length) in enumerate(sides):
            if on_street:
                ends = (corners[side], corners[(side + 1) % 4])
                yield Frontage(np.array(corner), heading, float(length), ends)

    def frontages(self) -> Iterator[Frontage]:
        """Every block's sides that lie on a street, block by block."""
        for column, row in self.blocks():
            yield from self.block(column, row)


def block_spans(lines: Float64, curbs: Float64) -> Float64:
    """Intervals between the streets' curbs and outside the outermost: (lines + 1, 2)."""
    starts = np.concatenate([[lines[0] - MARGIN], lines + curbs])
    ends = np.concatenate([lines - curbs, [lines[-1] + MARGIN]])
    return np.stack([starts, ends], axis=1)
