"""Live odometry: poses come at once, level, whatever the times are."""

import numpy as np
import pytest

from placecell.odometry.live_odometry import LEVELING_SCANS, LiveOdometry, posed_scans
from placecell.sources.scan import LidarScan
from tests.robot.agent_fakes import Street, at

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def scans() -> list[LidarScan]:
    street = Street(4)
    tilt = np.eye(4)
    tilt[[0, 2], [0, 2]] = 0.995
    tilt[0, 2], tilt[2, 0] = 0.0998, -0.0998
    return [
        LidarScan(street.scan(at(0.5 * number) @ tilt), stamp=0.1 * number) for number in range(26)
    ]


def test_poses_are_level_and_come_at_once_after_the_first_scans(scans: list[LidarScan]) -> None:
    odometry = LiveOdometry()
    counts = [len(odometry.add(scan)) for scan in scans]
    assert counts[: LEVELING_SCANS - 1] == [0] * (LEVELING_SCANS - 1)
    assert counts[LEVELING_SCANS - 1] == LEVELING_SCANS
    assert counts[LEVELING_SCANS:] == [1] * (len(scans) - LEVELING_SCANS)
    assert odometry.flush() == []


def test_world_of_a_tilted_sensor_is_level(scans: list[LidarScan]) -> None:
    posed = list(posed_scans(iter(scans)))
    moved = posed[-1].pose[:3, 3] - posed[0].pose[:3, 3]
    assert np.linalg.norm(moved) == pytest.approx(12.5, abs=0.5)
    assert abs(moved[2]) < 0.4


def test_unknown_and_repeated_times_ascend(scans: list[LidarScan]) -> None:
    odometry = LiveOdometry()
    stamps = [float("nan"), 5.0, 5.0, 4.0, 6.0]
    for scan, stamp in zip(scans, stamps, strict=False):
        odometry.add(LidarScan(scan.points, stamp=stamp))
    times = [each.time for each in odometry.flush()]
    np.testing.assert_allclose(times, [0.0, 5.0, 5.1, 5.2, 6.0])


def test_empty_first_scan_is_left_out(scans: list[LidarScan]) -> None:
    odometry = LiveOdometry()
    assert odometry.add(LidarScan(np.zeros((0, 3), np.float32))) == []
    odometry.add(scans[0])
    assert len(odometry.flush()) == 1


def test_points_with_times_are_moved_to_the_time_of_their_scan(scans: list[LidarScan]) -> None:
    odometry, plain = LiveOdometry(), LiveOdometry(use_times=False)
    for scan in scans[:6]:
        times = np.linspace(-0.05, 0.05, len(scan.points))
        timed = LidarScan(scan.points, times, scan.stamp)
        odometry.add(timed)
        plain.add(timed)
    moved, unmoved = odometry.flush()[-1], plain.flush()[-1]
    np.testing.assert_array_equal(unmoved.points, scans[5].points)
    assert not np.array_equal(moved.points, unmoved.points)
