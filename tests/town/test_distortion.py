"""Raw sweeps: points at their own time, which deskewing moves to where the scan has them."""

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.types import Float32, Float64
from placecell.datasets import open_drive
from town import Lidar, Route, Scene, Town, sensor, two_robots, write_drive
from town.geometry.shapes import box

NAMES = ["vlp-16", "os0-32", "solid-state"]


def moving(lidar: Lidar, meters: float, turn: float = 0.0) -> Float64:
    """Return poses of a sensor that drives ahead and turns left during the sweep."""
    times = lidar.sweep_times()
    sweep = np.tile(np.eye(4), (lidar.columns, 1, 1))
    cosine, sine = np.cos(turn * times), np.sin(turn * times)
    sweep[:, :2, :2] = np.stack([np.stack([cosine, -sine], -1), np.stack([sine, cosine], -1)], 1)
    sweep[:, 0, 3] = meters * times
    return sweep


def deskewed(points: Float32, meters: float, turn: float) -> Float64:
    """Deskew as a user would, from the time column and the motion in a sweep."""
    revolutions = points[:, 4].astype(np.float64) / 0.1
    x, y, z = points[:, :3].T.astype(np.float64)
    angle = turn * revolutions
    return np.stack(
        [
            np.cos(angle) * x - np.sin(angle) * y + meters * revolutions,
            np.sin(angle) * x + np.cos(angle) * y,
            z,
        ],
        axis=1,
    )


def test_wall_ahead_is_measured_from_where_the_sensor_is() -> None:
    """A wall 10 m ahead, approached by 2 m in a sweep, has its points at 10 m less the way."""
    wall = Scene(box((10.0, -50.0, -50.0), (0.1, 100.0, 100.0), reflectance=0.8))
    lidar = replace(
        sensor("vlp-16", dropout=0.0), range_noise=0.0, resolution=1e-6, elevations=(0.0,)
    )
    points = lidar.raw_scan(wall, moving(lidar, 2.0), np.random.default_rng(0))
    assert points.shape[1] == 5
    assert points[:, 4].min() > -0.05
    assert points[:, 4].max() < 0.05
    assert points[:, 0] == pytest.approx(10 - 2 * points[:, 4] / 0.1, abs=1e-4)
    # The sweep is clockwise and begins behind: the left half of the wall is seen first.
    assert np.all((points[:, 1] > 0.1) <= (points[:, 4] < 0))


@pytest.mark.parametrize("name", NAMES)
def test_deskewing_gives_the_scan(name: str) -> None:
    room = Scene(box((-20.0, -5.0, -6.0), (30.0, 10.0, 12.0), reflectance=0.8))
    lidar = sensor(name, columns=200)
    sweep = moving(lidar, 1.5, 0.3)
    raw = lidar.raw_scan(room, sweep, np.random.default_rng(3), 0.4)
    scan = lidar.scan(room, sweep, np.eye(4), np.random.default_rng(3), 0.4)
    assert len(raw) == len(scan) > 1000
    assert np.abs(raw[:, :3] - scan[:, :3]).max() > 0.3
    assert deskewed(raw, 1.5, 0.3) == pytest.approx(scan[:, :3], abs=1e-4)
    np.testing.assert_array_equal(raw[:, 3], scan[:, 3])


@pytest.fixture(scope="module")
def town() -> Town:
    return Town.build(seed=5, streets=(2, 2))


@pytest.fixture(scope="module")
def route(town: Town) -> Route:
    whole = Route.through(town.plan, town.terrain, [(0, 0), (1, 0), (1, 1)])
    return whole.cut(start=20.0, length=60.0)


def test_drive_with_distortion_is_deskewed_with_its_own_poses(
    town: Town, route: Route, tmp_path: Path
) -> None:
    """The fifth column and the drive's times and poses are enough to deskew."""
    lidar = sensor("os1-32", columns=128, mount=0.8)
    drives = [
        write_drive(
            *(tmp_path / str(distortion), town, route),
            traffic_seed=1,
            scans=12,
            spacing=1.0,
            lidar=lidar,
            speed=5.0,
            distortion=distortion,
        )
        for distortion in (False, True)
    ]
    deskewed_drive, raw_drive = (open_drive(drive) for drive in drives)
    assert raw_drive.point_layout.point_bytes == 20
    assert raw_drive.times == pytest.approx(0.2 * np.arange(12), abs=1e-9)
    assert raw_drive.poses == pytest.approx(deskewed_drive.poses)
    for index in range(2, 10):
        file = raw_drive.scan_files[index]
        points = np.fromfile(file, "<f4").reshape(-1, 5)
        place = raw_drive.times[index] + points[:, 4]
        # Linear in each element of the pose: exact enough for steps of 1 m.
        poses = np.stack(
            [
                np.interp(place, raw_drive.times, raw_drive.poses[:, row, column])
                for row in range(3)
                for column in range(4)
            ],
            axis=1,
        ).reshape(-1, 3, 4)
        world = np.einsum("nij,nj->ni", poses[:, :, :3], points[:, :3]) + poses[:, :, 3]
        pose = deskewed_drive.poses[index]
        expected = deskewed_drive.scan(index) @ pose[:3, :3].T + pose[:3, 3]
        off = np.linalg.norm(world - expected, axis=1)
        assert np.median(off) < 0.02
        assert np.quantile(off, 0.99) < 0.25


def test_default_sensor_is_unchanged(tmp_path: Path) -> None:
    """The files of the small town are those of earlier versions, byte for byte."""
    drive, _ = two_robots(tmp_path, seed=5, scans=3, columns=64)
    digest = hashlib.sha256()
    for file in [*sorted((drive / "velodyne").iterdir()), *sorted(drive.glob("*.txt"))]:
        digest.update(file.read_bytes())
    assert digest.hexdigest() == (
        "fc6a757488f5862e2b2abee5da222274f8885202194124db6eb122ebd3c52137"
    )


@pytest.mark.parametrize("name", NAMES)
def test_same_seed_gives_the_same_bytes(
    town: Town, route: Route, tmp_path: Path, name: str
) -> None:
    lidar = sensor(name, columns=64, rain=5.0)

    def written(folder: Path, noise_seed: int) -> list[bytes]:
        write_drive(
            *(folder, town, route),
            traffic_seed=1,
            noise_seed=noise_seed,
            scans=2,
            lidar=lidar,
            distortion=True,
        )
        return [file.read_bytes() for file in sorted((folder / "velodyne").iterdir())]

    first = written(tmp_path / "one", 1)
    assert written(tmp_path / "again", 1) == first
    assert written(tmp_path / "other", 2) != first
