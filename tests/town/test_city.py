from dataclasses import replace

import numpy as np
import pytest

from placecell.core.types import Float32, Float64
from town import HDL_64E, City, Mesh, Scene, Town
from town.streets.ground import Ground
from town.streets.plan import CURB_HEIGHT
from town.tiles import SLACK, Tiles

NOISELESS = replace(HDL_64E, columns=180, range_noise=0.0, dropout=0.0)


@pytest.fixture(scope="module")
def city() -> City:
    return City.build(seed=3, meters=900.0)


def tiles_of(city: City) -> list[tuple[int, int]]:
    return list(city.network.plan.blocks())


def down_on(mesh: Mesh, places: Float64) -> Float32:
    """Return the height of the first hit of a ray from above."""
    origins = np.column_stack([places, np.full(len(places), 50.0)]).astype(np.float32)
    rays = np.tile(np.array([0, 0, -1], np.float32), (len(places), 1))
    return np.float32(50.0) - Scene(mesh).cast(origins, rays)[0]


def test_tiles_make_up_the_ground_without_gaps(city: City) -> None:
    parts = [city.ground.tile(*tile) for tile in tiles_of(city)]
    assert sum(map(len, parts)) == len(city.ground.mesh())
    plan = city.network.plan
    inside = np.random.default_rng(0).uniform(
        (plan.easts[0] - 30, plan.norths[0] - 30),
        (plan.easts[-1] + 30, plan.norths[-1] + 30),
        size=(5000, 2),
    )
    places = city.network.terrain.bend(inside)
    height = down_on(Mesh.joined(parts), places) - city.network.terrain.height(places)
    assert np.isfinite(height).all()
    assert height.min() > -0.01
    assert height.max() < CURB_HEIGHT + 0.01


def test_streets_are_a_curb_lower_than_what_is_between_them(city: City) -> None:
    """The ground of a missing street is as high as the blocks."""
    network = city.network
    heights: dict[bool, list[float]] = {True: [], False: []}
    for column, row in np.ndindex(len(network.plan.easts), len(network.plan.norths)):
        for other in ((column + 1, row), (column, row + 1)):
            if network.has(other):
                ends = [network.plan.crossing(*end) for end in ((column, row), other)]
                middle = network.terrain.bend(np.mean(ends, axis=0))[None]
                height = down_on(city.ground.mesh(), middle) - network.terrain.height(middle)
                heights[network.joins((column, row), other)].append(float(height[0]))
    assert heights[True] == pytest.approx([0.0] * len(network.streets), abs=0.005)
    assert heights[False] == pytest.approx([CURB_HEIGHT] * len(heights[False]), abs=0.005)
    assert len(heights[False]) >= 2


def test_a_tile_follows_from_its_place_alone(city: City) -> None:
    again = City.build(seed=3, meters=900.0)
    for tile in reversed(tiles_of(again)):
        assert np.array_equal(again.tile(*tile, 1).triangles, city.tile(*tile, 1).triangles)
    other = City.build(seed=4, meters=900.0)
    assert len(other.tile(1, 1, 1)) != len(city.tile(1, 1, 1))


def test_other_traffic_seed_gives_other_cars(city: City) -> None:
    assert len(city.tile(1, 1, 1)) != len(city.tile(1, 1, 2))


def seen(scenes: Tiles | Scene, pose: Float64) -> Float32:
    scene = scenes if isinstance(scenes, Scene) else scenes.around(pose[:2, 3])
    sweep = np.tile(pose, (NOISELESS.columns, 1, 1))
    return NOISELESS.scan(scene, sweep, pose, np.random.default_rng(0))


def test_tiles_show_the_same_as_the_whole_town(city: City) -> None:
    whole = Scene(Mesh.joined(city.tile(*tile, 1) for tile in tiles_of(city)))
    tiles = city.scenes(1, NOISELESS.max_range)
    route = city.route(city.planner.every_street())
    for pose in route.poses(np.linspace(1, route.length() - 1, 5), NOISELESS.height):
        points, expected = seen(tiles, pose), seen(whole, pose)
        assert len(points) > 5000
        assert np.array_equal(points[:, :3], expected[:, :3])
        # Where two surfaces lie in one plane, either may be the one that is hit.
        assert np.mean(points[:, 3] == expected[:, 3]) > 0.998


def test_only_what_is_near_is_built() -> None:
    """A few blocks of twenty kilometers of streets are built."""
    city = City.build(seed=3, meters=20_000.0)
    tiles = city.scenes(1, reach=60.0)
    place = city.route([(0, 0), (0, 1)] if city.network.joins((0, 0), (0, 1)) else [(0, 0), (1, 0)])
    scene = tiles.around(place.lane()[0])
    built = tiles.built()
    assert 1 <= built <= 12 < len(tiles_of(city)) / 10
    assert tiles.around(place.lane()[0] + 0.1) is scene
    assert tiles.built() == built


def test_far_tiles_are_not_in_the_scene() -> None:
    """One tile is in reach, the other 1 m out of reach."""
    asked = []

    def build(column: int, row: int) -> Mesh:
        asked.append((column, row))
        return Mesh.of_triangles(np.ones((1, 3, 3)), 0.5)

    edge = 80.0 + 10.0 + SLACK  # a cell, the reach, and what may jut out
    boxes = np.array([[[[0, 0], [5, 5]], [[edge + 1, 0], [edge + 9, 5]]],
                      [[[edge - 1, 0], [edge + 9, 5]], [[0, -500], [5, -490]]]])  # fmt: skip
    Tiles(boxes.astype(float), build, reach=10.0).around(np.array([1.0, 1.0]))
    assert asked == [(0, 0), (1, 0)]


def houses(city: City, design: int) -> list[Mesh]:
    """Return the houses in streets of a design, each rotated to its own frame."""
    return [
        thing.mesh
        for column, row in tiles_of(city)
        for frontage in city.network.plan.block(column, row)
        if city.network.joins(*frontage.street) and city.network.design(*frontage.street) == design
        for thing in city.terraces[design].furnish(
            frontage, city.network.terrain, np.random.default_rng(0)
        )
        if thing.kind == "house"
    ]


def test_rows_of_identical_houses_stand_in_different_streets() -> None:
    city = City.build(seed=3, meters=5000.0, look_alikes=0.5)
    designs = city.network.designs
    design = int(np.bincount(designs[designs >= 0]).argmax())
    assert np.count_nonzero(designs == design) >= 2
    edges = [
        np.linalg.norm(np.diff(house.triangles, axis=1), axis=2) for house in houses(city, design)
    ]
    assert len(edges) > 10
    for other in edges[1:]:
        assert other == pytest.approx(edges[0], abs=1e-9)


def test_the_ends_of_gaps_are_planted(city: City) -> None:
    """The gap of a missing street has objects at its ends."""
    from town.streets.gap import gap_ends

    network = city.network
    ends = [end for tile in tiles_of(city) for end in gap_ends(network, *tile)]
    for end in ends:
        assert not network.joins(*end.street)
        assert 9.0 < end.length < 14.0
        # The gap lies ahead, and a carriageway behind.
        into, back = (
            network.terrain.bend(end.on_plan(end.length / 2, depth)) for depth in (3.0, -3.0)
        )
        above = down_on(city.ground.mesh(), np.stack([into, back]))
        above -= network.terrain.height(np.stack([into, back]))
        assert above == pytest.approx([CURB_HEIGHT, 0.0], abs=0.005)
    degrees = np.bincount(network.streets.ravel())
    assert len(ends) == int((4 - degrees).sum())


def test_designs_at_finds_the_street(city: City) -> None:
    network = city.network
    middles = np.stack([line[len(line) // 2] for line in network.lines()])
    assert np.array_equal(city.designs_at(middles), network.designs)


def test_a_route_keeps_to_the_streets(city: City) -> None:
    route = city.route(city.planner.every_street(), lane_offset=2.2)
    lane = route.lane()
    height = down_on(city.ground.mesh(), lane) - city.network.terrain.height(lane)
    assert np.abs(height).max() < 0.02
    with pytest.raises(ValueError, match="no street joins"):
        city.route([(0, 0), (1, 1)])


def test_the_small_town_is_unchanged() -> None:
    """Models were trained in it: neither its random numbers nor their order may change."""
    town = Town.build(seed=7)
    mesh = town.mesh(1)
    assert (len(town.objects), len(town.ground), len(mesh)) == (1039, 56_100, 559_458)
    assert mesh.triangles.mean(axis=(0, 1)) == pytest.approx(
        [121.636038, 117.743622, 3.076537], abs=1e-6
    )


def test_the_ground_of_a_whole_plan_has_all_streets() -> None:
    town = Town.build(seed=3, streets=(2, 2))
    ground = Ground.of(town.plan, town.terrain)
    assert np.array_equal(ground.mesh().triangles, town.ground.triangles)
    assert sum(len(ground.tile(*tile)) for tile in town.plan.blocks()) == len(town.ground)
