"""Campus: large buildings far apart, lawns with groups of trees, and paths between them."""

import numpy as np

from town.objects.car import car, person
from town.objects.furniture import (
    bicycles,
    bollards,
    cabinet,
    dustbins,
    lamp_post,
    traffic_sign,
)
from town.objects.park import bench, notice_board, picnic_table, sculpture, shed
from town.objects.vegetation import bush, tree
from town.places.builder import Builder, span
from town.places.buildings import OUT, large_building
from town.places.edging import Edging, edge_paths
from town.places.paths import Walkways
from town.places.place import Place
from town.streets.route import Route
from town.streets.terrain import Terrain

PATH_WIDTH = 4.5
"""Width of the free ground along a path, meters."""

BUILDINGS = 15
"""Largest number of buildings."""

BESIDE = (
    Edging("lamp post", lamp_post, 0.26, 0.5),
    Edging("bench", bench, 0.16, 1.2),
    Edging("tree", tree, 0.2, 1.2),
    Edging("bicycles", bicycles, 0.1, 1.6),
    Edging("notice board", notice_board, 0.08, 1.2),
    Edging("dustbins", dustbins, 0.06, 1.2),
    Edging("cabinet", cabinet, 0.06, 1.2),
    Edging("bollards", bollards, 0.04, 1.2),
    Edging("traffic sign", traffic_sign, 0.04, 0.5),
)
"""Kinds of objects beside the paths."""


def campus(seed: int, meters: float) -> tuple[Place, Route]:
    """Build a campus and draw a route of at least this length, meters."""
    rng = np.random.default_rng([seed, 22])
    terrain = Terrain.draw(rng, slope=0.02)
    paths = Walkways.grid(rng, (5, 5), (46.0, 74.0), shift=7.0, bend=5.0, missing=0.25)
    builder = Builder(seed, terrain, rng)
    builder.take(paths.points(), PATH_WIDTH / 2)
    area = span(paths.nodes)
    beyond = (area[0] - 35.0, area[1] - 35.0, area[2] + 35.0, area[3] + 35.0)
    add_buildings(builder, paths)
    add_lawns(builder, paths)
    edge_paths(builder, paths.lines, BESIDE, PATH_WIDTH)
    builder.scatter("tree", tree, 90, 2.2, beyond)
    builder.scatter("bush", bush, 60, 1.4, beyond)
    builder.sprinkle("person", person, 90, 0.5, area)
    line = paths.wander(meters, np.random.default_rng([seed, 23]), radius=5.0)
    return builder.place(builder.open_ground(area)), Route(terrain, line, lane_offset=0.9)


def add_buildings(builder: Builder, paths: Walkways) -> None:
    """Add buildings between the paths, at right angles or nearly so."""
    rng = builder.rng
    area = span(paths.nodes)
    built = 0
    for _ in range(20 * BUILDINGS):
        if built == BUILDINGS:
            return
        width, depth = float(rng.uniform(16.0, 44.0)), float(rng.uniform(10.0, 18.0))
        x, y = rng.uniform(np.array(area[:2]) - 25.0, np.array(area[2:]) + 25.0).tolist()
        heading = float(rng.choice([0.0, np.pi / 2]) + rng.normal(scale=0.06))
        mesh = large_building(rng, width, depth)
        built += builder.block("building", mesh, (width, depth), x, y, heading, OUT)


def add_lawns(builder: Builder, paths: Walkways) -> None:
    """Add groups of trees, sheds, sculptures and tables between the paths."""
    rng = builder.rng
    area = span(paths.nodes)
    for _ in range(24):
        x, y = rng.uniform(area[:2], area[2:]).tolist()
        around = (x - 12.0, y - 12.0, x + 12.0, y + 12.0)
        builder.scatter("tree", tree, int(rng.integers(3, 9)), 2.2, around)
        builder.scatter("bush", bush, int(rng.integers(0, 4)), 1.4, around)
    for kind, make, count, radius in (
        ("sculpture", sculpture, 8, 1.0),
        ("shed", shed, 8, 2.8),
        ("table", picnic_table, 12, 1.6),
    ):
        builder.scatter(kind, make, count, radius, area)
    builder.sprinkle("parked car", car, 16, 3.2, area)
    builder.sprinkle("bicycles", bicycles, 14, 1.8, area)
