from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.datasets.kitti_odometry import KittiOdometry
from placecell.segmentation.pipeline import record
from placecell.segmentation.recording import Recording
from town import (
    HDL_64E,
    ODOMETRY_FILE,
    City,
    Odometry,
    read_origin,
    several_robots,
    two_robots,
)

SCANS = 32


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return two_robots(tmp_path_factory.mktemp("town"), seed=7, scans=SCANS)


@pytest.fixture(scope="module")
def recordings(drives: tuple[Path, Path]) -> tuple[Recording, Recording]:
    parameters = PROTOCOL_V1.for_drive(SCANS, every=6)
    one, other = (record(open_drive(folder), parameters) for folder in drives)
    return one, other


def sensors(folder: Path) -> Float64:
    return np.asarray(read_origin(folder) @ open_drive(folder).poses)


def centroids(folder: Path, recording: Recording) -> Float64:
    origin = read_origin(folder)
    return np.asarray(recording.segments.centroids() @ origin[:3, :3].T + origin[:3, 3])


def test_robots_meet_head_on(drives: tuple[Path, Path]) -> None:
    one, other = (sensors(folder) for folder in drives)
    assert [folder.name for folder in drives] == ["robot_a", "robot_b"]
    distance, nearest = cKDTree(one[:, :3, 3]).query(other[:, :3, 3])
    shared = distance < 4.0
    assert shared.mean() > 0.7
    assert distance.min() > 2.5  # never in the same lane
    heading = np.einsum("ij,ij->i", other[shared, :3, 0], one[nearest[shared], :3, 0])
    assert heading.max() < -0.9


def test_capture_has_as_many_segments_as_a_real_street(
    recordings: tuple[Recording, Recording],
) -> None:
    for recording in recordings:
        frames = recording.captures[recording.captures >= 10]  # with a full local map
        a_frame = np.bincount(frames)[np.unique(frames)]
        assert 30 <= a_frame.mean() <= 100
        sizes = np.diff(recording.segments.ends, prepend=0)
        assert 150 <= np.median(sizes) <= 800
        assert sizes.max() > 1500


def test_robots_see_the_same_segments(
    drives: tuple[Path, Path], recordings: tuple[Recording, Recording]
) -> None:
    one, other = (
        centroids(folder, recording) for folder, recording in zip(drives, recordings, strict=True)
    )
    distance, _ = cKDTree(one).query(other)
    # Were the frames apart, some centroids would lie near one another all the same.
    by_chance, _ = cKDTree(one).query(np.add(other, (6.0, 6.0, 0.0)))
    assert np.mean(distance < 1.5) > 0.6
    assert np.mean(distance < 1.5) > np.mean(by_chance < 1.5) + 0.2


def test_progress_is_shown_and_drives_are_not_overwritten(
    drives: tuple[Path, Path], tmp_path: Path
) -> None:
    told = []

    def progress(items: Iterable[int], total: int, what: str) -> Iterable[int]:
        told.append((total, what))
        return items

    two_robots(tmp_path, scans=2, columns=100, progress=progress)
    assert told == [(2, "scans of robot_a"), (2, "scans of robot_b")]
    with pytest.raises(FileExistsError):
        two_robots(tmp_path, scans=2, columns=100)


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    city = City.build(seed=3, meters=600.0)
    return several_robots(
        tmp_path_factory.mktemp("fleet"), city, city.route(city.planner.every_street()), 3,
        scans=3, lidar=replace(HDL_64E, columns=120), odometry=Odometry(yaw=1.0), oncoming=20.0,
    )  # fmt: skip


def test_every_second_robot_drives_the_other_way(fleet: list[Path]) -> None:
    assert [folder.name for folder in fleet] == ["robot_a", "robot_b", "robot_c"]
    one, other, third = (sensors(folder) for folder in fleet)
    assert np.array_equal(one, third)
    city = City.build(seed=3, meters=600.0)
    back = city.route(city.planner.every_street()).reversed().poses(np.arange(0.5, 3.0), 1.73)
    assert other == pytest.approx(back, abs=1e-6)


def test_robots_have_different_scans(fleet: list[Path]) -> None:
    one, third = ((fleet[index] / "velodyne" / "000000.bin").read_bytes() for index in (0, 2))
    assert one != third


def test_odometry_stands_beside_the_truth(fleet: list[Path]) -> None:
    for folder in fleet:
        true, believed = open_drive(folder), KittiOdometry(folder, ODOMETRY_FILE)
        assert believed.poses[0] == pytest.approx(true.poses[0])
        assert np.abs(believed.poses[-1] - true.poses[-1]).max() > 1e-3
        assert believed.poses[-1, :3, 3] == pytest.approx(true.poses[-1, :3, 3], abs=0.5)
    one, third = ((fleet[index] / ODOMETRY_FILE).read_text() for index in (0, 2))
    assert one != third


def test_all_drives_are_checked_before_the_first(tmp_path: Path) -> None:
    city = City.build(seed=3, meters=600.0)
    route = city.route(city.planner.every_street())
    (tmp_path / "robot_b").mkdir()
    (tmp_path / "robot_b" / "notes.txt").write_text("mine")
    with pytest.raises(FileExistsError, match="robot_b is not empty"):
        several_robots(tmp_path, city, route, 2, scans=2)
    with pytest.raises(ValueError, match="too short"):
        several_robots(tmp_path / "long", city, route, 2, scans=5000)
    with pytest.raises(ValueError, match="expected 1 to 26"):
        several_robots(tmp_path / "many", city, route, 27)
    assert {path.name for path in tmp_path.rglob("*")} == {"robot_b", "notes.txt"}
