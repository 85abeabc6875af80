"""Street plan: a grid of straight streets with blocks of different sizes.

`Terrain.bend` transforms the plan to the town frame. Units are meters; x is east, y is north.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Self

import numpy as np

from placecell.core.types import Float64

MARGIN = 32.0
"""Extent of the town beyond its outermost streets, meters."""

CURB_HEIGHT = 0.12

BAY_LENGTH = 6.3
BAY_WIDTH = 2.2
"""Width of a parking bay, meters. Bays are along the curb, on the carriageway."""


Crossing = tuple[int, int]
"""Column and row of the crossing streets. Values one outside the range are beyond the town."""


@dataclass(frozen=True, slots=True)
class Frontage:
    """One side of a block, with the frame of the objects along its street.

    The x axis is along the curb. The y axis points from the curb (0) into the block; the
    carriageway has negative y.

    Attributes:
        corner: (2,), the frame's origin on the plan, where two curbs meet, meters.
        heading: direction of the x axis on the plan, radians.
        length: length of the curb to the next corner, meters.
        street: crossings at the two ends.
    """

    corner: Float64
    heading: float
    length: float
    street: tuple[Crossing, Crossing]

    def on_plan(self, x: float, y: float) -> Float64:
        """Transform a place of this frame to the plan, (2,)."""
        along = np.array([np.cos(self.heading), np.sin(self.heading)])
        inward = np.array([-along[1], along[0]])
        return np.asarray(self.corner + x * along + y * inward)

    def bays(self) -> Float64:
        """Return x of the parking bays' centers, (bays,), meters; there is none near crossings."""
        clear = 12.0
        return np.arange(clear + BAY_LENGTH / 2, self.length - clear - BAY_LENGTH / 2, BAY_LENGTH)


@dataclass(frozen=True, slots=True)
class StreetPlan:
    """Streets north-south and east-west.

    Attributes:
        easts: (n,), x of the center lines of the north-south streets, meters.
        norths: (m,), y of the center lines of the east-west streets, meters.
        east_curbs: (n,), distance of the curbs from the center lines `easts`, meters.
        north_curbs: (m,), distance of the curbs from the center lines `norths`, meters.
    """

    easts: Float64
    norths: Float64
    east_curbs: Float64
    north_curbs: Float64

    @classmethod
    def draw(cls, rng: np.random.Generator, streets: tuple[int, int]) -> Self:
        """Draw a random plan.

        Args:
            rng: random number generator.
            streets: number of streets north-south and east-west, at least two each.

        Raises:
            ValueError: A direction has fewer than two streets.
        """
        if min(streets) < 2:
            raise ValueError(
                f"Invalid number of streets: expected at least 2 per direction, not {streets}"
            )
        lines = [np.cumsum(rng.uniform(58.0, 96.0, size=count)) for count in streets]
        curbs = [rng.uniform(5.2, 6.4, size=count) for count in streets]
        return cls(lines[0] - lines[0][0], lines[1] - lines[1][0], curbs[0], curbs[1])

    def crossing(self, column: int, row: int) -> Float64:
        """Return the center of a crossing, (2,), meters."""
        return np.array([self.easts[column], self.norths[row]])

    def spans(self) -> tuple[Float64, Float64]:
        """Return the blocks' intervals from curb to curb, on x (n + 1, 2) and y (m + 1, 2)."""
        return block_spans(self.easts, self.east_curbs), block_spans(self.norths, self.north_curbs)

    def blocks(self) -> Iterator[tuple[int, int]]:
        """Yield column and row of each block. Block (i, j) is southwest of crossing (i, j)."""
        return product(range(len(self.easts) + 1), range(len(self.norths) + 1))

    def block(self, column: int, row: int) -> Iterator[Frontage]:
        """Yield the sides of a block that are on a street, counterclockwise."""
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
        """Yield the sides of all blocks that are on a street, block by block."""
        for column, row in self.blocks():
            yield from self.block(column, row)


def block_spans(lines: Float64, curbs: Float64) -> Float64:
    """Return the intervals of the blocks along an axis, from curb to curb, (lines + 1, 2)."""
    starts = np.concatenate([[lines[0] - MARGIN], lines + curbs])
    ends = np.concatenate([lines - curbs, [lines[-1] + MARGIN]])
    return np.stack([starts, ends], axis=1)
