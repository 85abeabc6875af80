"""Plan of the suburb: bending roads, with lots on both sides of each."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from placecell.core.types import Float64
from town.objects.car import person
from town.places.builder import Builder, span
from town.places.edging import point_on
from town.places.paths import Walkways
from town.places.place import Place
from town.places.suburb.lots import Side, line_with_lots
from town.streets.route import Route, arc_lengths
from town.streets.terrain import Terrain

ROAD_WIDTH = 5.0
"""Width of the free ground along a road, meters."""

PIECE = 24.0
"""Length of the straight pieces of road along which lots lie, meters."""

CLEAR = 10.0
"""Length of a road's ends without lots, meters: crossings."""


def suburb(seed: int, meters: float) -> tuple[Place, Route]:
    """Build a suburb and draw a route of at least this length, meters."""
    rng = np.random.default_rng([seed, 32])
    terrain = Terrain.draw(rng, slope=0.06)
    paths = Walkways.grid(rng, (4, 4), (52.0, 78.0), shift=6.0, bend=6.0, missing=0.2)
    builder = Builder(seed, terrain, rng)
    builder.take(paths.points(), ROAD_WIDTH / 2)
    for line in paths.lines:
        for ordered in (line, line[::-1]):
            for start, end in pieces(ordered):
                ahead = end - start
                heading = float(np.arctan2(ahead[1], ahead[0]))
                line_with_lots(Side(builder, start, heading, float(np.linalg.norm(ahead))))
    area = span(paths.nodes)
    builder.sprinkle("person", person, 60, 0.4, area)
    line = paths.wander(meters, np.random.default_rng([seed, 33]), radius=6.0)
    return builder.place(builder.open_ground(area)), Route(terrain, line, lane_offset=1.0)


def pieces(line: Float64) -> Iterator[tuple[Float64, Float64]]:
    """Yield start and end of straight pieces along a road (k, 2), clear of its two ends."""
    length = float(arc_lengths(line)[-1])
    edges = np.linspace(CLEAR, length - CLEAR, max(1, round((length - 2 * CLEAR) / PIECE)) + 1)
    points = [point_on(line, float(edge) / length) for edge in edges]
    yield from pairwise(points)
