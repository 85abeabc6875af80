"""The ground plane, on planes and boxes made by hand and on simulated scans."""

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import town
from placecell.core.types import Float32, Float64
from placecell.odometry.ground_plane import (
    GroundPlane,
    NoGroundError,
    find_common_ground,
    find_ground,
    rotation_between,
)
from placecell.odometry.leveling import leveling_of
from town.places.catalog import build_place

UP = np.array([0.0, 0.0, 1.0])


def rectangle(x: tuple[float, float], y: tuple[float, float], height: float) -> Float64:
    """Return a level grid of points, 10 cm apart."""
    across, along = np.meshgrid(np.arange(*x, 0.1), np.arange(*y, 0.1))
    return np.column_stack([across.ravel(), along.ravel(), np.full(across.size, height)])


def wall(x: float, y: tuple[float, float], z: tuple[float, float]) -> Float64:
    """Return an upright grid of points, 10 cm apart, across the x axis."""
    along, up = np.meshgrid(np.arange(*y, 0.1), np.arange(*z, 0.1))
    return np.column_stack([np.full(along.size, x), along.ravel(), up.ravel()])


def room(height: float, ceiling: float) -> Float64:
    """Return a room of 8 m x 6 m around a sensor: floor, ceiling and four walls."""
    walls = wall(4.0, (-3, 3), (-height, ceiling - height))
    others = wall(3.0, (-4, 4), (-height, ceiling - height))[:, [1, 0, 2]]
    floor = rectangle((-4, 4), (-3, 3), -height)
    return np.concatenate(
        [floor, floor + [0, 0, ceiling], walls, walls * [-1, 1, 1], others, others * [1, -1, 1]]
    )


def noisy(points: Float64, tilt: float = 0.0, around: float = 0.0) -> Float32:
    """Return the points in the frame of a sensor with a tilt around a level axis, degrees."""
    jitter = np.random.default_rng(0).normal(0, 0.02, points.shape)
    return np.asarray((points + jitter) @ mount(tilt, around).T, dtype=np.float32)


def mount(tilt: float, around: float) -> Float64:
    angle = np.radians(around)
    axis = np.array([np.cos(angle), np.sin(angle), 0.0])
    return np.asarray(Rotation.from_rotvec(np.radians(tilt) * axis).as_matrix())


def angle(one: Float64, other: Float64) -> float:
    return float(np.degrees(np.arccos(np.clip(one @ other, -1, 1))))


@pytest.mark.parametrize("height", [0.3, 1.0, 3.0])
@pytest.mark.parametrize(("tilt", "around"), [(0, 0), (10, 90), (25, 200), (40, 33)])
def test_field_gives_height_and_tilt(height: float, tilt: float, around: float) -> None:
    ground = find_ground(noisy(rectangle((-12, 12), (-12, 12), -height), tilt, around))
    assert ground.height == pytest.approx(height, abs=0.02)
    assert ground.tilt_deg == pytest.approx(tilt, abs=0.2)
    assert angle(ground.up, mount(tilt, around) @ UP) < 0.2
    assert 0.001 < ground.deviation < 0.02


@pytest.mark.parametrize("tilt", [0, 20, 40])
def test_room_gives_its_floor_not_its_ceiling_or_walls(tilt: float) -> None:
    ground = find_ground(noisy(room(height=1.2, ceiling=2.5), tilt, 70))
    assert ground.height == pytest.approx(1.2, abs=0.03)
    assert angle(ground.up, mount(tilt, 70) @ UP) < 0.5


def test_car_roof_below_the_sensor_is_not_the_ground() -> None:
    roof = rectangle((-1.5, 1), (-0.7, 0.7), -0.4)
    ground = find_ground(noisy(np.concatenate([rectangle((-15, 15), (-9, 9), -1.9), roof])))
    assert ground.height == pytest.approx(1.9, abs=0.03)


def test_tables_above_a_floor_are_not_the_ground() -> None:
    tables = [rectangle((x, x + 1.6), (y, y + 0.8), -0.5) for x in (-3, 1) for y in (-2, 0, 1)]
    ground = find_ground(noisy(np.concatenate([room(1.2, 2.5), *tables])))
    assert ground.height == pytest.approx(1.2, abs=0.03)


def test_a_few_reflections_below_the_ground_change_nothing() -> None:
    below = rectangle((3, 5), (3, 4), -4.0)
    ground = find_ground(noisy(np.concatenate([rectangle((-9, 9), (-9, 9), -1.5), below])))
    assert ground.height == pytest.approx(1.5, abs=0.03)


def test_far_rings_of_a_sensor_that_is_mounted_high_suffice() -> None:
    """A 16-beam sensor 3 m above the ground sees it from 11 m on, in rings."""
    around = np.radians(np.arange(0, 360, 0.4))
    rings = [
        np.column_stack([distance * np.cos(around), distance * np.sin(around), -3 + 0 * around])
        for distance in 3 / np.tan(np.radians(np.arange(3, 16, 2)))
    ]
    ground = find_ground(noisy(np.concatenate(rings), 5))
    assert ground.height == pytest.approx(3.0, abs=0.05)
    assert ground.tilt_deg == pytest.approx(5, abs=0.3)


def test_walls_alone_give_no_ground() -> None:
    upper = room(1.2, 2.5)
    upper = upper[(upper[:, 2] > -0.4) & (upper[:, 2] < 0.4)]
    with pytest.raises(NoGroundError, match="No ground was found below the sensor"):
        find_ground(noisy(upper))


def test_ceiling_alone_gives_no_ground() -> None:
    with pytest.raises(NoGroundError):
        find_ground(noisy(rectangle((-6, 6), (-6, 6), 2.0)))


def test_points_without_structure_give_no_ground() -> None:
    cloud = np.random.default_rng(1).uniform(-8, 8, (20_000, 3)).astype(np.float32)
    with pytest.raises(NoGroundError):
        find_ground(cloud)


@pytest.mark.parametrize("points", [np.zeros((0, 3)), np.ones((5, 3)), np.full((500, 3), 90.0)])
def test_too_few_points_give_no_ground(points: Float64) -> None:
    with pytest.raises(NoGroundError):
        find_ground(points.astype(np.float32))


def test_line_of_points_gives_no_ground() -> None:
    line = np.column_stack([np.arange(-11, 11, 0.05), np.zeros(440), np.full(440, -1.0)])
    with pytest.raises(NoGroundError):
        find_ground(noisy(line))


def test_expected_up_finds_the_ground_in_a_camera_frame() -> None:
    """A camera's frame has x to the right, y down and z ahead."""
    field = noisy(rectangle((-12, 12), (-12, 12), -1.7))
    camera = np.column_stack([-field[:, 1], -field[:, 2], field[:, 0]])
    with pytest.raises(NoGroundError):
        find_ground(camera)
    ground = find_ground(camera, expected_up=(0, -1, 0))
    assert ground.height == pytest.approx(1.7, abs=0.02)
    assert angle(ground.up, np.array([0.0, -1.0, 0.0])) < 0.2


def test_leveling_turns_up_into_z() -> None:
    ground = find_ground(noisy(rectangle((-12, 12), (-12, 12), -1.0), 30, 120))
    turn = leveling_of(ground.up)[:3, :3]
    assert turn @ ground.up == pytest.approx(UP, abs=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)


@pytest.mark.parametrize("other", [UP, -UP, np.array([1.0, 0, 0]), np.array([0.6, 0, -0.8])])
def test_rotation_between_turns_one_vector_into_the_other(other: Float64) -> None:
    rotation = rotation_between(UP, other)
    assert rotation @ UP == pytest.approx(other, abs=1e-9)
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-9)


def test_common_ground_ignores_scans_on_a_slope_and_without_ground() -> None:
    field = rectangle((-12, 12), (-12, 12), -1.5)
    scans = [noisy(field, 3), noisy(field, 3), noisy(field, 3), noisy(field, 12), noisy(field * 0)]
    ground = find_common_ground(scans)
    assert ground.height == pytest.approx(1.5, abs=0.02)
    assert ground.tilt_deg == pytest.approx(3, abs=0.2)


@pytest.mark.parametrize("seen", [0, 1])
def test_common_ground_needs_a_ground_in_half_of_the_scans(seen: int) -> None:
    field = noisy(rectangle((-12, 12), (-12, 12), -1.5))
    with pytest.raises(NoGroundError, match=f"Ground in {seen} of {seen + 2} scans"):
        find_common_ground([field] * seen + [np.zeros((0, 3), np.float32)] * 2)
    with pytest.raises(NoGroundError):
        find_common_ground([])


@cache
def built_place(place: str) -> Any:
    return build_place(place, 3, 40.0)


def simulated(place: str, sensor: str, height: float) -> list[Float32]:
    """Return scans of a simulated place in the sensor's frame."""
    lidar = town.sensor(sensor, mount=height, columns=600)
    built, route = built_place(place)
    found = []
    for along in (6.0, 30.0):
        sweep = route.poses(along + 0.1 * lidar.sweep_times(), height)
        pose = route.poses(np.array([along]), height)[0]
        scene = built.scenes(1, lidar.max_range).around(pose[:2, 3])
        points = lidar.scan(scene, sweep, pose, np.random.default_rng(0))
        found.append(np.ascontiguousarray(points[:, :3]))
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("place", "sensor", "height"),
    [
        ("streets", "hdl-64e", 1.73),
        ("streets", "vlp-16", 3.0),
        ("streets", "solid-state", 1.0),
        ("indoor", "vlp-16", 0.3),
        ("indoor", "os0-32", 1.0),
    ],
)
def test_simulated_scans_give_height_and_mount(place: str, sensor: str, height: float) -> None:
    """The pose of a simulated sensor follows the ground, so the ground is level in its frame."""
    for index, points in enumerate(simulated(place, sensor, height), start=1):
        turned = (points @ mount(20.0 * index, 100.0 * index).T).astype(np.float32)
        ground = find_ground(turned)
        assert ground.height == pytest.approx(height, abs=0.05 + 0.05 * height)
        assert angle(ground.up, mount(20.0 * index, 100.0 * index) @ UP) < 1.5


def test_ground_plane_tells_the_tilt_of_an_upside_down_sensor() -> None:
    assert GroundPlane(-UP, 1.0, 1.0, 0.0).tilt_deg == pytest.approx(180)
