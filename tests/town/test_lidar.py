from dataclasses import replace

import numpy as np
import pytest

from placecell.core.types import Float32, Float64
from town import HDL_64E, Lidar, Mesh, Scene
from town.geometry.shapes import box

COLUMNS = 360
NOISELESS = replace(HDL_64E, columns=COLUMNS, range_noise=0.0, dropout=0.0, resolution=1e-6)


def still(lidar: Lidar) -> Float64:
    return np.tile(np.eye(4), (lidar.columns, 1, 1))


def scan(lidar: Lidar, mesh: Mesh, seed: int = 0) -> Float32:
    return lidar.scan(Scene(mesh), still(lidar), np.eye(4), np.random.default_rng(seed))


@pytest.fixture(scope="module")
def room() -> Mesh:
    """Return a closed bright room: 10 m ahead, 20 m behind, 5 m to both sides."""
    return box((-20.0, -5.0, -2.0), (30.0, 10.0, 8.0), reflectance=0.8)


def test_elevations_are_those_of_the_sensor() -> None:
    elevations = np.array(HDL_64E.elevations)
    assert len(elevations) == 64
    assert elevations[0] == pytest.approx(2.0)
    assert elevations[-1] == pytest.approx(-24.33)
    steps = -np.diff(elevations)
    assert steps[:31] == pytest.approx(1 / 3, abs=0.001)
    assert steps[31:] == pytest.approx(1 / 2, abs=0.001)


def test_points_lie_on_the_walls_of_a_room(room: Mesh) -> None:
    points = scan(NOISELESS, room)
    assert len(points) == COLUMNS * 64
    x, y, z = points[:, :3].T
    off = np.min(np.abs([x - 10, x + 20, y - 5, y + 5, z + 2, z - 6]), axis=0)
    assert off.max() < 1e-4
    # It is not the same wall all the time.
    assert np.count_nonzero(np.abs(x - 10) < 1e-3) > 1000
    assert np.count_nonzero(np.abs(x + 20) < 1e-3) > 500
    assert points[:, 3] == pytest.approx(0.8)


def test_noise_has_the_stated_spread(room: Mesh) -> None:
    noisy = replace(NOISELESS, range_noise=0.02)
    ranges = np.linalg.norm(scan(noisy, room)[:, :3], axis=1)
    exact = np.linalg.norm(scan(NOISELESS, room)[:, :3], axis=1)
    assert np.std(ranges - exact) == pytest.approx(0.02, rel=0.05)
    assert abs(np.mean(ranges - exact)) < 0.001


def test_dropout_takes_the_stated_share(room: Mesh) -> None:
    some = scan(replace(NOISELESS, dropout=0.25), room)
    assert len(some) / (COLUMNS * 64) == pytest.approx(0.75, abs=0.02)


def test_resolution_quantizes_ranges(room: Mesh) -> None:
    ranges = np.linalg.norm(scan(replace(NOISELESS, resolution=0.5), room)[:, :3], axis=1)
    assert np.abs(ranges * 2 - np.round(ranges * 2)).max() < 1e-4


@pytest.mark.parametrize(
    ("lidar", "reflectance", "farthest"),
    [
        (NOISELESS, 0.8, 100.0),  # bright: the sensor's own limit
        (NOISELESS, 0.1, 50.0),  # the limit of a tenth
        (NOISELESS, 0.025, 25.0),  # a quarter of the light: half as far
        (replace(NOISELESS, max_range=30.0), 0.8, 30.0),
    ],
)
def test_range_depends_on_reflectance(lidar: Lidar, reflectance: float, farthest: float) -> None:
    plain = box((-200.0, -200.0, -3.0), (400.0, 400.0, 1.27), reflectance)
    flat = replace(lidar, elevations=tuple(np.linspace(-5.0, -0.5, 64)))
    ranges = np.linalg.norm(scan(flat, plain)[:, :3], axis=1)
    assert 0.9 * farthest < ranges.max() <= farthest + 1e-3


def test_empty_scene_has_no_returns() -> None:
    assert scan(NOISELESS, box((-500.0, 0.0, 0.0), (1.0, 1.0, 1.0), 1.0)).shape == (0, 4)


def test_a_moving_sensor_is_deskewed(room: Mesh) -> None:
    """Points of a moving and rotating sensor are on the walls, in the mid-sweep frame."""
    times = NOISELESS.sweep_times()
    sweep = still(NOISELESS)
    cosine, sine = np.cos(0.2 * times), np.sin(0.2 * times)
    sweep[:, :2, :2] = np.stack([np.stack([cosine, -sine], -1), np.stack([sine, cosine], -1)], 1)
    sweep[:, 0, 3] = 1.0 + 2.0 * times
    pose = np.eye(4)
    pose[0, 3] = 1.0
    points = NOISELESS.scan(Scene(room), sweep, pose, np.random.default_rng(0))
    x, y, z = points[:, :3].T
    off = np.min(np.abs([x - 9, x + 21, y - 5, y + 5, z + 2, z - 6]), axis=0)
    assert off.max() < 1e-4


def test_the_nearer_of_two_things_hides_the_farther(room: Mesh) -> None:
    board = box((4.0, -0.5, -1.0), (0.1, 1.0, 2.0), reflectance=0.3)
    points = scan(NOISELESS, Mesh.joined([room, board]))
    ahead = points[(points[:, 0] > 0) & (np.abs(points[:, 1]) < 0.1 * points[:, 0])]
    low = ahead[np.abs(ahead[:, 2]) < 0.2 * ahead[:, 0]]
    assert low[:, 0] == pytest.approx(4.0, abs=1e-3)
    assert low[:, 3] == pytest.approx(0.3)


@pytest.mark.parametrize(("rain", "farthest"), [(0.0, 50.0), (10.0, 21.36), (50.0, 12.93)])
def test_rain_shortens_sight(rain: float, farthest: float) -> None:
    """The range r solves (50 m / r)^2 = exp(2 * 0.01 * rain^0.6 * r)."""
    plain = box((-200.0, -200.0, -3.0), (400.0, 400.0, 1.27), 0.1)
    lidar = replace(NOISELESS, rain=rain, elevations=tuple(np.linspace(-20.0, -0.5, 64)))
    ranges = np.linalg.norm(scan(lidar, plain)[:, :3], axis=1)
    assert 0.8 * farthest < ranges.max() <= farthest + 0.1
    assert (50.0 / farthest) ** 2 == pytest.approx(np.exp(0.02 * rain**0.6 * farthest), rel=0.02)
