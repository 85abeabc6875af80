"""Playback: which odometry is used, and the pace."""

from pathlib import Path

import numpy as np
import pytest

from placecell.odometry.live_odometry import PosedScan
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import ScanOptions, use_scan_options
from robot.playback import DrivePlayback, OdometryPlayback, at_own_pace, open_playback
from tests.placecell.segment_builders import write_odometry
from tests.placecell.sources.bags.bag_builders import (
    PERIOD_NS,
    START_NS,
    Message,
    cloud_message,
    cloud_of,
    odometry_message,
    write_mcap,
    xyz,
)
from tests.robot.agent_fakes import FakeClock, Street, at


def scan_at(time: float) -> PosedScan:
    return PosedScan(np.zeros((0, 3), np.float32), time, np.eye(4))


def test_scans_come_at_their_own_pace() -> None:
    clock, waits, late = FakeClock(), list[float](), list[int]()

    def sleep(seconds: float) -> None:
        waits.append(round(seconds, 6))
        clock.now += seconds

    scans = (scan_at(time) for time in [5.0, 5.1, 5.2, 5.3])
    got = list(at_own_pace(scans, 2.0, lambda: late.append(1), clock, sleep))
    assert len(got) == 4
    assert waits == [0.05, 0.05, 0.05]
    assert not late


def test_late_scans_are_left_out_and_counted() -> None:
    clock, late = FakeClock(), list[int]()
    times = []
    for scan in at_own_pace(
        (scan_at(0.1 * number) for number in range(10)),
        1.0,
        lambda: late.append(1),
        clock,
        lambda _: None,
    ):
        times.append(round(scan.time, 1))
        clock.now += 0.35  # Each scan takes longer than the pause to the next.
    assert len(times) + len(late) == 10
    assert late
    assert times[0] == 0.0


def test_clock_of_the_recording_that_jumps_back_does_not_stop_the_playback() -> None:
    clock = FakeClock()

    def sleep(seconds: float) -> None:
        assert seconds <= 60.1
        clock.now += seconds

    times = [0.0, 0.1, -900.0, -899.9, 5000.0, 5000.1]
    got = list(at_own_pace(map(scan_at, times), 1.0, lambda: None, clock, sleep))
    assert [each.time for each in got] == times


def test_folder_with_poses_is_played_with_them(tmp_path: Path) -> None:
    street = Street(5, 60.0)
    poses = [at(float(x)) for x in range(4)]
    write_odometry(tmp_path / "drive", [street.scan(pose) for pose in poses], poses)
    playback = open_playback(tmp_path / "drive")
    assert isinstance(playback, DrivePlayback)
    scans = list(playback.scans(1))
    assert len(scans) == len(playback) - 1
    np.testing.assert_array_equal(scans[0].pose, playback.drive.poses[1])
    assert playback.session == open_playback(tmp_path / "drive").session


def test_bag_is_played_with_the_covariances_of_its_odometry(tmp_path: Path) -> None:
    points = np.random.default_rng(0).normal(size=(20, 3))
    messages: list[Message] = []
    for number in range(5):
        stamp = START_NS + number * PERIOD_NS
        covariance = np.diag([0.1, 0.1, 0.1, 0.1, 0.1, 0.01]) * (1 + number)
        odometry = odometry_message(
            at(float(number)), stamp, "cdr", child="lidar", covariance=covariance
        )
        cloud = cloud_of(xyz(points), stamp_ns=stamp + PERIOD_NS // 2)
        messages.append(("/odom", stamp, odometry))
        messages.append(("/points", stamp, cloud_message(cloud, "cdr")))
    playback = open_playback(write_mcap(tmp_path / "a.mcap", messages))
    scans = list(playback.scans())
    assert len(scans) == 4  # The last one is after the odometry.
    for number, scan in enumerate(scans):
        assert scan.covariance is not None
        np.testing.assert_allclose(scan.covariance[0, 0], 0.1 * (1.5 + number), rtol=1e-6)


@pytest.fixture
def without_poses(tmp_path: Path) -> Path:
    street, folder = Street(3), tmp_path / "scans"
    folder.mkdir()
    for number in range(24):
        scan = street.scan(at(0.5 * number))
        np.save(folder / f"{number:06d}.npy", scan)
    return folder


@pytest.mark.slow
def test_source_without_poses_gets_a_causal_odometry(without_poses: Path) -> None:
    playback = open_playback(without_poses)
    assert isinstance(playback, OdometryPlayback)
    whole = [each.pose for each in playback.scans()]
    assert len(whole) == len(playback) == 24
    # Later scans change nothing, and a playback that begins later has the same poses.
    again = [each.pose for each in playback.scans(22)]
    np.testing.assert_array_equal(again, whole[22:])
    moved = whole[-1][:3, 3] - whole[0][:3, 3]
    assert moved[0] == pytest.approx(11.5, abs=0.5)
    assert abs(moved[2]) < 0.3


def test_odometry_none_refuses_a_source_without_poses(without_poses: Path) -> None:
    with (
        use_scan_options(ScanOptions(odometry="none")),
        pytest.raises(DriveError, match="no poses"),
    ):
        open_playback(without_poses)


def test_missing_source_is_told(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match="Check the path"):
        open_playback(tmp_path / "missing")
