"""Odometry of a source: motion, leveling, drift and the cache."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.progress import silent
from placecell.core.types import Float32, Float64
from placecell.datasets import ScanOptions, SourceDrive, use_scan_options
from placecell.odometry import cache, source_odometry
from placecell.odometry.cache import CachedOdometry
from placecell.odometry.drift import estimate_drift, windows
from placecell.odometry.scan_odometry import OdometrySettings, times_of
from placecell.odometry.source_odometry import describe_drift, odometry_of
from placecell.sources import DriveError
from placecell.trajectories.trajectory import Trajectory
from tests.placecell.datasets.source_fakes import MemorySource
from tests.placecell.segment_builders import box, pose

HEIGHT = 1.6
SCANS = 16
STEP = 0.5


@lru_cache(1)
def world() -> Float32:
    """Return the points of a yard: ground, and boxes at random places beside the way."""
    draw = np.random.default_rng(4)
    boxes = [
        box((x, side * y, 0.0), (a, b, c), step=0.2)
        for x, side, y, a, b, c in zip(
            draw.uniform(-30, 45, 70),
            draw.choice([-1, 1], 70),
            draw.uniform(4, 20, 70),
            *draw.uniform(0.6, 2.5, (3, 70)),
            strict=True,
        )
    ]
    ground = np.pad(draw.uniform(-45, 60, (14_000, 2)), ((0, 0), (0, 1)))  # a grid has aliases
    return np.concatenate([ground.astype(np.float32), *boxes])


def seen(at: Float64, tilt: Float64) -> Float32:
    """Return the world's points within 35 m of a pose, in the frame of a tilted sensor."""
    points = world() @ np.eye(3, dtype=np.float32) - np.array([*at[:2, 3], HEIGHT], np.float32)
    points = points[np.linalg.norm(points, axis=1) < 35]
    return np.asarray(points @ (at[:3, :3] @ tilt).astype(np.float32), np.float32)


def driven(
    tilt_deg: float = 0.0, speeds: Sequence[float] | None = None
) -> tuple[MemorySource, Float64]:
    """Return a source whose sensor drives ahead in a bend, and its poses in the level world."""
    tilt = Rotation.from_euler("y", tilt_deg, degrees=True).as_matrix()
    steps = np.full(SCANS, STEP) if speeds is None else np.asarray(speeds)
    x = np.cumsum(steps) - steps[0]
    poses = [pose(float(each), 0.005 * float(each) ** 2, 0, 0.01 * float(each)) for each in x]
    scans = [seen(each, tilt) for each in poses]
    return MemorySource(scans, list(100 + 0.1 * np.arange(SCANS))), np.stack(poses)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(cache.FOLDER_VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache" / "odometry"


@pytest.mark.slow
@pytest.mark.parametrize("tilt", [0.0, 25.0])
def test_motion_is_found_and_leveled_by_the_ground(folder: Path, tilt: float) -> None:
    source, poses = driven(tilt)
    said: list[str] = []
    found = odometry_of(source, True, silent, said.append)
    ways = found.poses[:, :3, 3] - found.poses[0, :3, 3]
    assert ways == pytest.approx(poses[:, :3, 3], abs=0.1)
    assert found.ground is not None
    assert found.ground.height == pytest.approx(HEIGHT, abs=0.1)
    assert found.ground.tilt_deg == pytest.approx(tilt, abs=1.0)
    assert found.drift_percent is not None
    assert found.drift_percent < 3
    assert any("kept in" in line for line in said)
    assert any("the drift of the odometry is about" in line for line in said)
    assert any("leveled by the ground: the sensor is 1." in line for line in said)
    (file,) = folder.iterdir()
    assert file.name.startswith("memory.bag-")


@pytest.mark.slow
def test_second_run_reads_the_cache_bit_for_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    source, _ = driven()
    first = odometry_of(source, True, silent, lambda _: None)

    def computed(*_: object) -> CachedOdometry:
        raise AssertionError("computed again")

    monkeypatch.setattr(source_odometry, "compute", computed)
    said: list[str] = []
    second = odometry_of(source, True, silent, said.append)
    np.testing.assert_array_equal(first.poses, second.poses)
    assert second.drift_percent == first.drift_percent
    assert any("read from" in line for line in said)
    source.stamps[3] += 0.01
    with pytest.raises(AssertionError, match="computed again"):
        odometry_of(source, True, silent, lambda _: None)


@pytest.mark.slow
def test_drive_without_poses_gets_those_of_odometry() -> None:
    source, poses = driven()
    with use_scan_options(replace(ScanOptions(), odometry="kiss-icp")):
        drive = SourceDrive(source)
    assert len(drive) == SCANS
    assert drive.poses[:, :3, 3] == pytest.approx(poses[:, :3, 3], abs=0.1)
    assert drive.motion is not None


@pytest.mark.slow
def test_given_poses_of_a_tilted_world_are_leveled() -> None:
    """Poses of an odometry of others: its world is the frame of the tilted sensor."""
    source, poses = driven(25.0)
    tilt = np.eye(4)
    tilt[:3, :3] = Rotation.from_euler("y", 25, degrees=True).as_matrix()
    source.own = Trajectory(np.linalg.inv(tilt) @ poses @ tilt, source.stamps, "lidar", "odom")
    said: list[str] = []
    with use_scan_options(ScanOptions(tell=said.append)):
        drive = SourceDrive(source)
    assert any("the ground is tilted by 25 degrees" in line for line in said)
    assert drive.poses[:, 2, 3] == pytest.approx(0, abs=0.2)
    assert drive.poses[0, :3, :3] == pytest.approx(tilt[:3, :3], abs=0.03)


@pytest.mark.slow
def test_damaged_scan_does_not_end_the_odometry() -> None:
    source, poses = driven()
    source.damaged = {7}
    found = odometry_of(source, True, silent, lambda _: None)
    assert found.poses[-1, :3, 3] == pytest.approx(poses[-1, :3, 3], abs=0.15)


def test_source_without_points_is_refused() -> None:
    source = MemorySource([[], []], [0.0, 0.1])
    with pytest.raises(DriveError, match="2 scans were tried, and none has points"):
        odometry_of(source, True, silent, lambda _: None)


def test_odometry_that_finds_no_motion_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(source_odometry, "run", lambda *_: np.full((2, 4, 4), np.nan))
    source = MemorySource([[[5, 0, 0]], [[5, 0, 0]]], [0.0, 0.1])
    with pytest.raises(DriveError, match="found no motion that fits the scans"):
        odometry_of(source, True, silent, lambda _: None)


def test_world_without_ground_is_not_leveled(monkeypatch: pytest.MonkeyPatch) -> None:
    still = CachedOdometry(np.tile(np.eye(4), (2, 1, 1)), None)
    monkeypatch.setattr(source_odometry, "compute", lambda *_: still)
    source = MemorySource([[[5, 0, 0]], [[5, 0, 0]]], [0.0, 0.1])
    said: list[str] = []
    found = odometry_of(source, True, silent, said.append)
    assert found.ground is None
    assert any("no ground was found" in line for line in said)
    assert any("hardly moves" in line for line in said)


def test_settings_follow_the_range_of_the_sensor() -> None:
    ring = np.stack([np.cos(np.arange(100)), np.sin(np.arange(100)), np.zeros(100)], axis=1)
    indoors = OdometrySettings.of(MemorySource([10 * ring]), use_times=True)
    assert indoors == OdometrySettings(20.0, 0.6, 0.2, True)
    street = OdometrySettings.of(MemorySource([200 * ring]), use_times=False)
    assert street == OdometrySettings(100.0, 3.0, 1.0, False)


def test_times_of_scans_ascend_in_both_directions() -> None:
    source = MemorySource([[], [], []], [5.0, 5.1, 5.1])
    assert times_of(source, range(3)) == pytest.approx([0, 0.1, 0.2])
    assert times_of(source, range(3)[::-1]) == pytest.approx([0, 0.1, 0.2])
    assert times_of(MemorySource([[], []]), range(2)) == pytest.approx([0, 0.1])


def test_windows_are_spread_over_the_drive() -> None:
    assert windows(30) == [range(30)]
    assert windows(120) == [range(50), range(70, 120)]
    assert [part.start for part in windows(1000)] == [0, 316, 633, 950]


def test_drift_by_hand() -> None:
    """The way back is 1% longer than the way there."""
    poses = np.stack([pose(float(index)) for index in range(40)])

    def backward(scans: Sequence[int]) -> Float64:
        return np.stack([pose(1.01 * float(scan - scans[0])) for scan in scans])

    assert estimate_drift(poses, backward) == pytest.approx(1.0)
    assert estimate_drift(poses[:3], backward) is None
    assert estimate_drift(poses[:1], backward) is None
    assert "not reliable" in describe_drift(5.0)
    assert "not reliable" not in describe_drift(0.5)


def test_cache_folder_is_the_users(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(cache.FOLDER_VARIABLE)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.cache_folder() == tmp_path / "placecell" / "odometry"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert cache.cache_folder() == Path.home() / ".cache" / "placecell" / "odometry"


def test_cache_keeps_a_trajectory_whole_or_not_at_all(folder: Path, tmp_path: Path) -> None:
    poses = np.stack([pose(1 / 3, yaw=0.1), pose(2 / 3, yaw=0.2)])
    file = cache.cache_file("a drive/1", ["key"])
    assert file.parent == folder
    assert file.name.startswith("a_drive_1-")
    assert file != cache.cache_file("a drive/1", ["another key"])
    assert cache.load(file, 2) is None
    assert cache.save(file, CachedOdometry(poses, 0.5))
    found = cache.load(file, 2)
    assert found is not None
    np.testing.assert_array_equal(found.poses, poses)
    assert found.drift_percent == 0.5
    assert cache.load(file, 3) is None
    file.write_text("# {}\n")
    assert cache.load(file, 2) is None
    (tmp_path / "file").write_text("")
    assert not cache.save(tmp_path / "file" / "x.txt", CachedOdometry(poses, None))
    assert [each.name for each in folder.iterdir()] == [file.name]


def test_first_poses_come_from_a_run_backward(monkeypatch: pytest.MonkeyPatch) -> None:
    truth = np.stack([pose(0.7 * step, 0.01 * step**2, 0, 0.02 * step) for step in range(60)])
    guides: list[object] = []

    def fake(source: object, scans: Sequence[int], *rest: object) -> Float64:
        guides.append(rest[3] if len(rest) > 3 else None)
        found = np.linalg.inv(truth[scans[0]]) @ truth[list(scans)]
        found[1:5, 0, 3] -= 0.3  # Each run is wrong at its own start.
        return found

    monkeypatch.setattr(source_odometry, "run", fake)
    settings = OdometrySettings(50.0, 1.0, 0.5, True)
    drive = MemorySource([[[1.0, 0, 0]]] * 60, times=[np.zeros(1)] * 60)
    joined = source_odometry.run_joined(drive, range(60), settings, silent, "")
    expected = np.linalg.inv(truth[0]) @ truth
    np.testing.assert_allclose(joined, expected, atol=1e-9)
    assert guides == [None, None]
    np.testing.assert_allclose(
        source_odometry.run_twice(drive, range(60), settings, silent, ""), expected, atol=1e-9
    )
    assert [guide is None for guide in guides[2:]] == [True, True, False, False]
    without = MemorySource([[[1.0, 0, 0]]] * 60)
    source_odometry.run_twice(without, range(60), settings, silent, "")
    assert len(guides) == 8  # Scans without times have one pass.


def test_start_on_which_both_runs_agree_is_that_of_the_run_forward(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fake(source: object, scans: Sequence[int], *rest: object) -> Float64:
        sign = 1.0 if scans[-1] > scans[0] else -1.02
        return np.stack([pose(sign * 0.7 * step) for step in range(len(scans))])

    monkeypatch.setattr(source_odometry, "run", fake)
    drive = MemorySource([[[1.0, 0, 0]]] * 60)
    settings = OdometrySettings(50.0, 1.0, 0.5, True)
    joined = source_odometry.run_joined(drive, range(60), settings, silent, "")
    np.testing.assert_array_equal(joined, np.stack([pose(0.7 * step) for step in range(60)]))


def test_short_and_lost_runs_are_not_joined(monkeypatch: pytest.MonkeyPatch) -> None:
    lost = np.full((5, 4, 4), np.nan)
    monkeypatch.setattr(source_odometry, "run", lambda _, scans, *__: lost[: len(scans)])
    drive = MemorySource([[[1.0, 0, 0]]] * 5)
    settings = OdometrySettings(50.0, 1.0, 0.5, True)
    assert np.isnan(source_odometry.run_twice(drive, range(5), settings, silent, "")).all()
    assert len(source_odometry.run_joined(drive, range(2), settings, silent, "")) == 2
