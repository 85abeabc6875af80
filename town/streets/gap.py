"""Gaps between blocks, where a street of the plan is missing, and the frontages at their ends."""

from collections.abc import Iterator

import numpy as np

from town.streets.network import Network
from town.streets.plan import Frontage


def gap_ends(network: Network, column: int, row: int) -> Iterator[Frontage]:
    """Yield the frontages at the ends of the gaps east and north of a block."""
    spans_x, spans_y = network.plan.spans()
    (west, east), (south, north) = spans_x[column], spans_y[row]
    here = (column, row)
    beyond_east, beyond_north = column == len(spans_x) - 1, row == len(spans_y) - 1
    below, left = (column, row - 1), (column - 1, row)
    if not beyond_east and not network.joins(below, here):
        width = float(spans_x[column + 1, 0] - east)
        if row > 0:
            yield Frontage(np.array([east, south]), 0.0, width, (below, here))
        if not beyond_north:
            yield Frontage(np.array([east + width, north]), np.pi, width, (here, below))
    if not beyond_north and not network.joins(left, here):
        width = float(spans_y[row + 1, 0] - north)
        if column > 0:
            yield Frontage(np.array([west, north + width]), -np.pi / 2, width, (left, here))
        if not beyond_east:
            yield Frontage(np.array([east, north]), np.pi / 2, width, (here, left))
