"""Car park: rows of bays along aisles, with masts, islands of trees, shelters and a shop."""

from itertools import pairwise

import numpy as np

from placecell.core.types import Float64
from town.objects.car import car, person
from town.objects.furniture import bollards, cabinet, fence, garden_wall, traffic_sign
from town.objects.parking import (
    barrier,
    carport,
    charging_post,
    containers,
    light_mast,
    ticket_machine,
    trolley,
    trolley_shelter,
)
from town.objects.vegetation import bush, hedge, tree
from town.places.builder import Builder, span
from town.places.buildings import OUT, large_building
from town.places.paths import Walkways
from town.places.place import Place, Spot
from town.streets.route import Route
from town.streets.terrain import Terrain

AISLE_WIDTH = 6.2
"""Width of the carriageway between two rows of bays, meters."""

BAY = (2.5, 5.0)
"""Width and length of a bay, meters."""

TAKEN = 0.6
"""Share of the bays in which a car is parked."""

STRIP = 2.0
"""Smallest width of the strip between two rows of bays, back to back, meters."""

ON_STRIPS = (
    ("light mast", light_mast, 0.22),
    ("tree", tree, 0.26),
    ("bush", bush, 0.14),
    ("charging post", charging_post, 0.12),
    ("traffic sign", traffic_sign, 0.1),
    ("cabinet", cabinet, 0.06),
    ("bollards", bollards, 0.05),
    ("ticket machine", ticket_machine, 0.05),
)
"""Kind, builder and share of the objects on the strips."""


def car_park(seed: int, meters: float) -> tuple[Place, Route]:
    """Build a car park and draw a route of at least this length, meters."""
    rng = np.random.default_rng([seed, 26])
    terrain = Terrain.draw(rng, slope=0.015)
    lanes = np.cumsum([0.0, *(AISLE_WIDTH + 2 * BAY[1] + rng.uniform(STRIP, 4.0, size=4))])
    crossings = np.cumsum([0.0, *rng.uniform(38.0, 62.0, size=3)])
    paths = aisles(crossings, lanes)
    builder = Builder(seed, terrain, rng)
    builder.take(paths.points(), AISLE_WIDTH / 2 - 0.2)
    add_bays(builder, crossings, lanes)
    add_strips(builder, crossings, lanes)
    add_surroundings(builder, paths)
    area = span(paths.nodes)
    builder.sprinkle("person", person, 60, 0.4, area)
    builder.sprinkle("trolley", trolley, 30, 0.6, area)
    line = paths.wander(meters, np.random.default_rng([seed, 27]), radius=5.5)
    return builder.place(builder.open_ground(area)), Route(terrain, line, lane_offset=1.3)


def aisles(crossings: Float64, lanes: Float64) -> Walkways:
    """Return the graph of the aisles (along x) and of the cross lanes (along y)."""
    nodes = np.array([[x, y] for x in crossings for y in lanes])
    columns, rows = len(crossings), len(lanes)
    along = [(i * rows + j, (i + 1) * rows + j) for i in range(columns - 1) for j in range(rows)]
    across = [(i * rows + j, i * rows + j + 1) for i in range(columns) for j in range(rows - 1)]
    return Walkways.straight(nodes, along + across)


def bay_columns(crossings: Float64, rng: np.random.Generator) -> Float64:
    """Return x of the bays' middles along an aisle, (n,), with a gap now and then."""
    middles = []
    for west, east in pairwise(crossings):
        # The first and the last bay keep clear of the turning cars.
        x = west + 6.5 + BAY[0]
        while x < east - 6.5 - BAY[0]:
            middles.append(x)
            x += BAY[0] + (BAY[0] if rng.random() < 0.1 else 0.0)
    return np.array(middles)


def add_bays(builder: Builder, crossings: Float64, lanes: Float64) -> None:
    """Offer the bays on both sides of each aisle to cars, which park forward or backward."""
    rng = builder.rng
    for lane in lanes:
        for side in (-1.0, 1.0):
            y = float(lane) + side * (AISLE_WIDTH + BAY[1]) / 2
            for x in bay_columns(crossings, rng):
                heading = side * np.pi / 2 + np.pi * float(rng.random() < 0.3)
                spot = Spot("parked car", car, float(x), y, heading, TAKEN, 0.12, 0.03)
                builder.offer(spot, 0.7)


def add_strips(builder: Builder, crossings: Float64, lanes: Float64) -> None:
    """Add objects on the strips between rows of bays, and islands at the ends of the rows."""
    rng = builder.rng
    shares = np.array([share for _, _, share in ON_STRIPS])
    reach = AISLE_WIDTH / 2 + BAY[1]
    first, last = lanes[0] - reach - 1.0, lanes[-1] + reach + 1.0
    for y in (first, *((lanes[:-1] + lanes[1:]) / 2), last):
        for west, east in pairwise(crossings):
            covered = rng.random() < 0.25 and float(first) < float(y) < float(last)
            if covered:
                length = float(east - west) - 22.0
                builder.put("carport", carport(rng, length), float(west + east) / 2, float(y))
            x = float(west) + float(rng.uniform(7.0, 10.0))
            while x < east - 7.0 and not covered:
                kind, make, _ = ON_STRIPS[int(rng.choice(len(ON_STRIPS), p=shares / shares.sum()))]
                builder.stand(kind, make, x, float(y), 0.9, 0.0)
                x += float(rng.uniform(4.0, 11.0))
    for lane in lanes:
        for cross in crossings:
            for side in (-1.0, 1.0):
                x = float(cross) + side * 6.4
                y = float(lane) + float(rng.choice([-1, 1])) * (AISLE_WIDTH / 2 + 2.2)
                kind, make, radius = (
                    ("tree", tree, 1.0), ("traffic sign", traffic_sign, 0.6),
                    ("trolley shelter", trolley_shelter, 2.2), ("bush", bush, 1.2),
                    ("light mast", light_mast, 0.6),
                )[int(rng.integers(5))]  # fmt: skip
                builder.stand(kind, make, x, y, radius, np.pi / 2)


def add_surroundings(builder: Builder, paths: Walkways) -> None:
    """Add the boundary, the barriers, containers, a shop and other buildings around."""
    rng = builder.rng
    low, high = (np.array(side) for side in (paths.nodes.min(axis=0), paths.nodes.max(axis=0)))
    out = AISLE_WIDTH / 2 + BAY[1] + 4.0
    low, high = low - out, high + out
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    shop = int(rng.integers(4))
    makers = {"fence": fence, "hedge": hedge, "garden wall": garden_wall}
    for side in range(4):
        start, end = corners[side], corners[(side + 1) % 4]
        length = float(np.linalg.norm(end - start))
        ahead = (end - start) / length
        outward = np.array([ahead[1], -ahead[0]])
        heading = float(np.arctan2(ahead[1], ahead[0]))
        along = 0.0
        while along < length - 4.0 and side != shop:
            kind = str(rng.choice(list(makers)))
            run = min(float(rng.uniform(6.0, 16.0)), length - along)
            x, y = (start + along * ahead).tolist()
            builder.put(kind, makers[kind](rng, run), x, y, heading)
            along += run + float(rng.uniform(0.6, 3.0))
        along = float(rng.uniform(0.0, 10.0))
        while along < length - 20.0:
            width = float(rng.uniform(36.0, 56.0) if side == shop else rng.uniform(12.0, 24.0))
            depth = float(rng.uniform(12.0, 20.0))
            middle = start + (along + width / 2) * ahead + (OUT + 2.0 + depth / 2) * outward
            mesh = large_building(rng, width, depth)
            x, y = middle.tolist()
            builder.block("building", mesh, (width, depth), x, y, heading + np.pi, 1.0)
            along += width + float(rng.uniform(6.0, 25.0))
        for kind, make, radius in (
            ("containers", containers, 3.0), ("barrier", barrier, 1.2),
            ("trolley shelter", trolley_shelter, 2.6), ("ticket machine", ticket_machine, 1.0),
        ):  # fmt: skip
            x, y = (start + float(rng.uniform(0.1, 0.9)) * length * ahead - 1.6 * outward).tolist()
            builder.stand(kind, make, x, y, radius, heading)
