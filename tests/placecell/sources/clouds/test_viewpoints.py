"""VIEWPOINT of PCD files: the sensor's pose, with points in its frame or in the world's."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.types import Float32, Float64
from placecell.datasets import open_drive
from placecell.sources.clouds import FolderOfClouds
from placecell.sources.scan_options import ScanOptions, use_scan_options
from tests.placecell.sources.clouds.writers import pcd

XYZ = [("x", "F", 4, 1), ("y", "F", 4, 1), ("z", "F", 4, 1)]
PLACES = np.array([[3.0, 1.0, 2.0], [12.0, 4.0, 2.5], [30.0, -8.0, 3.0], [38.0, -8.0, 3.0]])
TURNS = Rotation.from_euler("zyx", [[0.1, 0, 0], [1.0, 0.1, 0], [2.0, 0, 0.2], [-3.0, 0, 0]])


def poses() -> Float64:
    made = np.tile(np.eye(4), (len(PLACES), 1, 1))
    made[:, :3, :3] = TURNS.as_matrix()
    made[:, :3, 3] = PLACES
    return made


def surroundings(seed: int) -> Float32:
    """Return points around a sensor at the origin, densest near it."""
    random = np.random.default_rng(seed)
    angle, far = random.uniform(0, 2 * np.pi, 400), random.exponential(6.0, 400) + 1.0
    rows = np.stack([far * np.cos(angle), far * np.sin(angle), random.uniform(-2, 5, 400)], axis=1)
    return rows.astype(np.float32)


def write(folder: Path, world: bool, scale: float = 1.0) -> list[Float32]:
    scans = [surroundings(seed) for seed in range(len(PLACES))]
    for number, (scan, pose, turn) in enumerate(zip(scans, poses(), TURNS, strict=True)):
        x, y, z, w = turn.as_quat().tolist()
        tx, ty, tz = (pose[:3, 3] / scale).tolist()
        points = scan.astype(np.float64)
        points = points @ pose[:3, :3].T + pose[:3, 3] if world else points
        content = pcd(
            XYZ,
            (points / scale).tolist(),
            "binary",
            VIEWPOINT=f"{tx} {ty} {tz} {w} {x} {y} {z}",
        )
        (folder / f"{number}.pcd").write_bytes(content)
    return scans


@pytest.mark.parametrize(
    ("world", "unit", "scale"), [(False, "m", 1), (True, "m", 1), (True, "ft", 0.3048)]
)
def test_viewpoints_are_the_poses_and_points_come_back_to_the_sensor(
    tmp_path: Path, world: bool, unit: str, scale: float
) -> None:
    scans = write(tmp_path, world, scale)
    with use_scan_options(ScanOptions(unit=unit)):  # type: ignore[arg-type]
        source = FolderOfClouds(tmp_path)
    trajectory = source.trajectory()
    assert trajectory is not None
    np.testing.assert_allclose(trajectory.poses, poses(), atol=1e-6)
    for index, scan in enumerate(scans):
        np.testing.assert_allclose(source.scan(index).points, scan, atol=1e-4)
    (told,) = [note for note in source.notes() if "VIEWPOINT" in note]
    assert ("in the world's frame already" if world else "points are in its frame") in told


@pytest.mark.parametrize("world", [False, True])
def test_drive_has_the_poses_of_the_viewpoints(tmp_path: Path, world: bool) -> None:
    write(tmp_path, world)
    for odometry in (None, "none"):
        with use_scan_options(ScanOptions(odometry=odometry)):
            drive = open_drive(tmp_path)
        expected = poses()
        expected[:, :3, 3] -= PLACES[0]
        np.testing.assert_allclose(drive.poses, expected, atol=1e-6)


def test_sensor_at_the_origin_has_points_in_its_frame(tmp_path: Path) -> None:
    points = surroundings(0)
    (tmp_path / "a.pcd").write_bytes(
        pcd(XYZ, points.tolist(), "binary", VIEWPOINT="0 0 1.5 0 1 0 0")
    )
    source = FolderOfClouds(tmp_path / "a.pcd")
    np.testing.assert_array_equal(source.scan(0).points, points)
    trajectory = source.trajectory()
    assert trajectory is not None
    np.testing.assert_allclose(np.diag(trajectory.poses[0]), [1, -1, -1, 1], atol=1e-9)


@pytest.mark.parametrize("viewpoint", ["0 0 0 1 0 0 0", "1 2 3 0 0 0 0", "nan 0 0 1 0 0 0", "1 2"])
def test_viewpoint_without_a_pose_is_none(tmp_path: Path, viewpoint: str) -> None:
    (tmp_path / "a.pcd").write_bytes(
        pcd(XYZ, surroundings(0).tolist(), "binary", VIEWPOINT=viewpoint)
    )
    source = FolderOfClouds(tmp_path / "a.pcd")
    assert source.trajectory() is None
    assert not [note for note in source.notes() if "VIEWPOINT" in note]
