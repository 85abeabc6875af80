from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.segmentation.local_map import Accumulator
from placecell.segmentation.pipeline import segment_map
from town import read_origin, sensor, write_drive
from town.drives.robots import two_robots
from town.geometry.scene import Scene
from town.places import PLACES, Place, build_place
from town.streets.route import Route

OTHERS = [name for name in PLACES if name != "streets"]


@pytest.fixture(scope="module", params=OTHERS)
def built(request: pytest.FixtureRequest) -> tuple[str, Place, Route]:
    place, route = build_place(request.param, seed=3, meters=120.0)
    assert isinstance(place, Place)
    return request.param, place, route


def places_of(route: Route) -> Float64:
    """Return places along the lanes of both robots, (n, 2), a meter apart."""
    return np.concatenate(
        [
            way.poses(np.arange(0.0, way.length()), 0.0)[:, :3, 3]
            for way in (route, route.reversed())
        ]
    )


def test_same_seed_gives_the_same_place(built: tuple[str, Place, Route]) -> None:
    name, place, route = built
    again, same_route = build_place(name, seed=3, meters=120.0)
    assert isinstance(again, Place)
    assert (again.mesh(1).triangles == place.mesh(1).triangles).all()
    assert (again.mesh(1).reflectance == place.mesh(1).reflectance).all()
    assert (same_route.center == route.center).all()


def test_other_seed_gives_another_place(built: tuple[str, Place, Route]) -> None:
    name, place, _ = built
    other, _ = build_place(name, seed=4, meters=120.0)
    assert isinstance(other, Place)
    assert len(other.mesh(1)) != len(place.mesh(1))


def test_route_is_long_enough_in_both_directions(built: tuple[str, Place, Route]) -> None:
    _, _, route = built
    assert min(route.length(), route.reversed().length()) >= 110.0


def test_robots_of_a_drive_meet_on_the_same_way(built: tuple[str, Place, Route]) -> None:
    """Robot B begins where robot A ends, so most of its places were seen by robot A."""
    _, _, route = built
    at = np.arange(0.0, 100.0)
    a, b = (way.poses(at, height=0.0)[:, :2, 3] for way in (route, route.reversed()))
    nearest = np.linalg.norm(b[:, None] - a[None], axis=2).min(axis=1)
    assert np.mean(nearest < 3.5) > 0.7
    assert route.length() < 135.0


def test_robot_b_begins_where_robot_a_ends(tmp_path: Path) -> None:
    lidar = sensor("vlp-16", columns=60)
    a, b = two_robots(tmp_path, place="indoor", seed=4, scans=30, lidar=lidar)
    last, first = (
        (read_origin(folder) @ open_drive(folder).poses)[at, :2, 3]
        for folder, at in ((a, -1), (b, 0))
    )
    assert np.linalg.norm(last - first) < 2.0


def test_route_runs_on_free_ground(built: tuple[str, Place, Route]) -> None:
    """No surface from 0.3 m to 1.8 m above the ground comes within 0.3 m of either robot."""
    _, place, route = built
    scene = Scene(place.mesh(1))
    angles = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    rays = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1).astype(np.float32)
    for height in (0.3, 0.8, 1.3, 1.8):
        origins = np.repeat(places_of(route) + (0, 0, height), len(rays), axis=0)
        directions = np.tile(rays, (len(origins) // len(rays), 1))
        ranges, _ = scene.cast(origins.astype(np.float32), directions)
        assert ranges.min() > 0.3


def test_robot_has_ground_below_and_is_not_inside_an_object(
    built: tuple[str, Place, Route],
) -> None:
    _, place, route = built
    scene = Scene(place.mesh(1))
    origins = (places_of(route) + (0, 0, 0.5)).astype(np.float32)
    down = np.tile(np.array([[0, 0, -1]], dtype=np.float32), (len(origins), 1))
    ranges, hit = scene.cast(origins, down)
    assert (hit < len(place.ground)).all()
    np.testing.assert_allclose(ranges, 0.5, atol=0.05)


def test_movable_objects_differ_between_drives(built: tuple[str, Place, Route]) -> None:
    _, place, _ = built
    one, other = (
        np.array([thing.mesh.bounds().mean(axis=0) for thing in place.movables(seed)])
        for seed in (1, 2)
    )
    assert len(one) > 20
    apart = np.linalg.norm(one[:, None] - other[None], axis=2).min(axis=1)
    assert np.mean(apart > 0.5) > 0.25
    assert {thing.kind for thing in place.movables(1)} >= {"person"}


def test_meshes_are_finite_and_shades_are_valid(built: tuple[str, Place, Route]) -> None:
    _, place, _ = built
    mesh = place.mesh(1)
    assert np.isfinite(mesh.triangles).all()
    assert 0 < mesh.reflectance.min() <= mesh.reflectance.max() <= 1


def test_unknown_place_is_refused_and_the_names_are_listed(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"Invalid place 'moon': expected one of streets, campus"):
        two_robots(tmp_path, place="moon", scans=2)
    assert not list(tmp_path.iterdir())


def indoor_floor(floor: int, differing: float) -> tuple[Place, Route]:
    place, route = build_place("indoor", 5, 60.0, floor, differing)
    assert isinstance(place, Place)
    return place, route


def parts(place: Place, kind: str, among: bool = True) -> list[bytes]:
    """Return the meshes of one kind of static object, or of all other kinds."""
    return [each.mesh.triangles.tobytes() for each in place.objects if (each.kind == kind) == among]


def test_floors_have_the_same_walls_and_route_and_differ_in_their_furniture() -> None:
    (ground, route), (first, same_route) = indoor_floor(0, 0.3), indoor_floor(1, 0.3)
    assert parts(ground, "wall") == parts(first, "wall")
    assert (route.center == same_route.center).all()
    here, there = parts(ground, "wall", among=False), parts(first, "wall", among=False)
    fixed = {"ceiling", "column", "wall"}
    furniture = sum(each.kind not in fixed for each in ground.objects)
    changed = sum(one != other for one, other in zip(here, there, strict=True))
    assert 0.15 * furniture < changed < 0.45 * furniture
    assert not np.array_equal(ground.mesh(1).triangles, first.mesh(1).triangles)


def test_share_of_zero_makes_floors_that_differ_in_movable_objects_only() -> None:
    (ground, _), (second, _) = indoor_floor(0, 0.0), indoor_floor(2, 0.0)
    assert parts(ground, "") == parts(second, "")
    assert parts(ground, "", among=False) == parts(second, "", among=False)
    assert not np.array_equal(ground.mesh(1).triangles, second.mesh(1).triangles)


def test_indoor_floor_has_a_ceiling_over_the_whole_route() -> None:
    place, route = indoor_floor(0, 0.3)
    origins = (places_of(route) + (0, 0, 1.0)).astype(np.float32)
    up = np.tile(np.array([[0, 0, 1]], dtype=np.float32), (len(origins), 1))
    ranges, _ = Scene(place.mesh(1)).cast(origins, up)
    assert 1.1 < ranges.min() <= ranges.max() < 5.5


@pytest.mark.parametrize(
    ("name", "floor", "differing", "said"),
    [
        ("campus", 1, 0.3, "Invalid floor 1: the place 'campus' has floor 0 only"),
        ("indoor", -1, 0.3, "Invalid floor -1"),
        ("indoor", 0, 1.5, "share 1.5"),
    ],
)
def test_floor_or_share_out_of_range_is_refused(
    name: str, floor: int, differing: float, said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        build_place(name, 1, 10.0, floor, differing)


def test_sensor_that_is_too_high_for_the_doors_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"Invalid mount 2\.5 m: .*'indoor' up to 2\.0 m"):
        two_robots(tmp_path, place="indoor", scans=2, mount=2.5)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["vlp-16", "hdl-64e"])
def test_capture_has_a_usual_number_of_segments(
    built: tuple[str, Place, Route], name: str, tmp_path: Path
) -> None:
    """A place has as many segments as a street, indoors fewer; their sizes are usual, too."""
    kind, place, route = built
    lidar = replace(sensor(name), height=PLACES[kind].sensor_height)
    spacing = PLACES[kind].spacing
    folder = write_drive(
        tmp_path, place, route.cut(40.0, 30.0), traffic_seed=1, scans=12, spacing=spacing,
        lidar=lidar,
    )  # fmt: skip
    clouds = segment_map(Accumulator(open_drive(folder), PROTOCOL_V1).local_map(11), PROTOCOL_V1)
    low, high = (5, 40) if kind == "indoor" else (20, 120)
    assert low <= len(clouds) <= high
    assert 120 <= np.median([len(cloud) for cloud in clouds]) <= 1500
