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
from town.objects.vegetation import bush, hedge, tree
from town.places.builder import Builder, span
from town.places.buildings import OUT, large_building
from town.places.paths import Walkways
from town.places.place import Place
from town.streets.route import Route
from town.streets.terrain import Terrain

PATH_WIDTH = 4.5
"""Width of the free ground along a path, meters."""


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
    line_paths(builder, paths)
    builder.scatter("tree", tree, 90, 2.2, beyond)
    builder.scatter("bush", bush, 60, 1.4, beyond)
    builder.sprinkle("person", person, 90, 0.5, area)
    line = paths.wander(meters, np.random.default_rng([seed, 23]), radius=5.0)
    return builder.place(builder.open_ground(area)), Route(terrain, line, lane_offset=0.9)


def add_buildings(builder: Builder, paths: Walkways) -> None:
    """Add a building in most gaps between the paths, with bicycles and a few cars beside it."""
    rng = builder.rng
    area = span(paths.nodes)
    built = 0
    for _ in range(400):
        if built == 15:
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


def line_paths(builder: Builder, paths: Walkways) -> None:
    """Add lamps, benches, signs, hedges and rows of trees beside the paths."""
    rng = builder.rng
    makers = (
        ("lamp post", lamp_post, 0.26, 0.5),
        ("bench", bench, 0.16, 1.2),
        ("tree", tree, 0.2, 1.2),
        ("bicycles", bicycles, 0.1, 1.6),
        ("notice board", notice_board, 0.08, 1.2),
        ("dustbins", dustbins, 0.06, 1.2),
        ("cabinet", cabinet, 0.06, 1.2),
        ("bollards", bollards, 0.04, 1.2),
        ("traffic sign", traffic_sign, 0.04, 0.5),
    )
    shares = np.array([share for _, _, share, _ in makers])
    for line in paths.lines:
        ahead = line[-1] - line[0]
        length = float(np.linalg.norm(ahead))
        heading = float(np.arctan2(ahead[1], ahead[0]))
        right = np.array([ahead[1], -ahead[0]]) / length
        for side in (-1.0, 1.0):
            row = bool(rng.random() < 0.3)
            for along in np.arange(4.0, length - 4.0, float(rng.uniform(6.0, 10.0))):
                kind, make, _, radius = makers[int(rng.choice(len(makers), p=shares))]
                if row:
                    kind, make, radius = "tree", tree, 1.2
                share = (along + float(rng.uniform(-1.5, 1.5))) / length * (len(line) - 1)
                middle = [np.interp(share, np.arange(len(line)), line[:, axis]) for axis in (0, 1)]
                away = PATH_WIDTH / 2 + radius + float(rng.uniform(0.1, 1.2))
                x, y = (np.array(middle) + side * away * right).tolist()
                turn = heading + (0.0 if side > 0 else np.pi) + np.pi
                builder.stand(kind, make, x, y, radius, turn)
            if rng.random() < 0.25:
                add_hedge(builder, line, side)


def add_hedge(builder: Builder, line: np.ndarray, side: float) -> None:
    """Add a piece of hedge along a path, where the ground is free."""
    rng = builder.rng
    first = int(rng.integers(0, len(line) - 2))
    start, end = line[first], line[first + 2]
    ahead = end - start
    length = float(np.linalg.norm(ahead))
    right = np.array([ahead[1], -ahead[0]]) / length
    x, y = ((start + end) / 2 + side * (PATH_WIDTH / 2 + 1.6) * right).tolist()
    heading = float(np.arctan2(ahead[1], ahead[0]))
    mesh = hedge(rng, length)
    builder.block("hedge", mesh.moved(y=0.6), (length, 1.2), x, y, heading, 0.2)
