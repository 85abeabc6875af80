"""Garden or park: winding paths, many trees, beds, seats, play equipment, and a wall around."""

import numpy as np

from town.geometry.mesh import Mesh
from town.objects.car import person
from town.objects.furniture import bicycles, dustbins, fence, garden_wall, lamp_post
from town.objects.house import house
from town.objects.park import (
    bench,
    chairs_and_table,
    flower_bed,
    fountain,
    notice_board,
    pergola,
    picnic_table,
    sculpture,
    shed,
    slide,
    swing,
)
from town.objects.vegetation import bush, hedge, tree
from town.places.builder import Area, Builder, span
from town.places.edging import Edging, edge_paths
from town.places.paths import Walkways
from town.places.place import Place
from town.streets.route import Route
from town.streets.terrain import Terrain

PATH_WIDTH = 2.8
"""Width of the free ground along a path, meters."""

BESIDE = (
    Edging("bench", bench, 0.24, 1.2),
    Edging("tree", tree, 0.2, 1.0),
    Edging("bush", bush, 0.16, 1.3),
    Edging("flower bed", flower_bed, 0.16, 2.0),
    Edging("lamp post", lamp_post, 0.1, 0.5),
    Edging("notice board", notice_board, 0.06, 1.2),
    Edging("dustbins", dustbins, 0.05, 1.2),
    Edging("sculpture", sculpture, 0.03, 1.0),
)
"""Kinds of objects beside the paths."""

STANDING = (
    ("pergola", pergola, 5, 4.0),
    ("shed", shed, 8, 2.6),
    ("fountain", fountain, 3, 3.2),
    ("swing", swing, 4, 2.6),
    ("slide", slide, 4, 3.6),
    ("sculpture", sculpture, 6, 1.0),
    ("flower bed", flower_bed, 30, 2.1),
    ("table", picnic_table, 12, 1.6),
    ("tree", tree, 110, 1.9),
    ("bush", bush, 130, 1.4),
)
"""Kind, builder, number and radius of the objects between the paths."""


def garden(seed: int, meters: float) -> tuple[Place, Route]:
    """Build a garden and draw a route of at least this length, meters."""
    rng = np.random.default_rng([seed, 24])
    terrain = Terrain.draw(rng, slope=0.04)
    paths = Walkways.grid(rng, (5, 5), (22.0, 38.0), shift=4.0, bend=5.0, missing=0.2)
    builder = Builder(seed, terrain, rng)
    builder.take(paths.points(), PATH_WIDTH / 2)
    area = span(paths.nodes)
    enclose(builder, (area[0] - 14.0, area[1] - 14.0, area[2] + 14.0, area[3] + 14.0))
    edge_paths(builder, paths.lines, BESIDE, PATH_WIDTH, step=(4.0, 8.0), rows=0.2, hedges=0.35)
    beyond = (area[0] - 12.0, area[1] - 12.0, area[2] + 12.0, area[3] + 12.0)
    for kind, make, count, radius in STANDING:
        builder.scatter(kind, make, count, radius, beyond)
    builder.sprinkle("seats", chairs_and_table, 40, 1.3, area)
    builder.sprinkle("person", person, 90, 0.4, area)
    builder.sprinkle("bicycles", bicycles, 10, 1.6, area)
    line = paths.wander(meters, np.random.default_rng([seed, 25]), radius=4.0)
    return builder.place(builder.open_ground(area)), Route(terrain, line, lane_offset=0.5)


def enclose(builder: Builder, area: Area) -> None:
    """Add a boundary of walls, fences and hedges, with houses behind it on some sides."""
    rng = builder.rng
    low, high = np.array(area[:2]), np.array(area[2:])
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    for side in range(4):
        start, end = corners[side], corners[(side + 1) % 4]
        length = float(np.linalg.norm(end - start))
        ahead = (end - start) / length
        outward = np.array([ahead[1], -ahead[0]])
        heading = float(np.arctan2(ahead[1], ahead[0]))
        makers = {"fence": fence, "hedge": hedge, "garden wall": garden_wall}
        along = 0.0
        while along < length - 4.0:
            kind = str(rng.choice(list(makers)))
            run = min(float(rng.uniform(6.0, 18.0)), length - along)
            x, y = (start + along * ahead).tolist()
            builder.put(kind, makers[kind](rng, run), x, y, heading)
            along += run + float(rng.uniform(0.6, 3.0))
        if rng.random() < 0.6:
            along = float(rng.uniform(2.0, 8.0))
            while along < length - 14.0:
                width = float(rng.uniform(8.0, 13.0))
                x, y = (start + (along + width) * ahead + 4.0 * outward).tolist()
                builder.put("house", turned_house(rng, width), x, y, heading + np.pi)
                along += width + float(rng.uniform(3.0, 20.0))


def turned_house(rng: np.random.Generator, width: float) -> Mesh:
    """Build a house whose front faces the garden."""
    return house(rng, width, depth=float(rng.uniform(7.5, 9.0)))
