"""Poses of scans: interpolation, gaps, units of time and clocks."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.errors import DriveError
from placecell.core.types import Float64
from placecell.trajectories.interpolation import interpolate
from placecell.trajectories.scan_poses import poses_of_scans
from placecell.trajectories.trajectory import Trajectory


def straight(times: Float64, stamps: Float64 | None = None) -> Trajectory:
    """Return poses that drive 10 m/s along x and turn by 1 rad/s."""
    poses = np.tile(np.eye(4), (len(times), 1, 1))
    poses[:, 0, 3] = 10 * times
    poses[:, :3, :3] = Rotation.from_euler("z", times[:, None]).as_matrix()
    return Trajectory(poses, times if stamps is None else stamps)


TIMES = np.arange(0, 10, 0.1)
SCANS = np.arange(0.5, 9.0, 0.13)


def test_pose_lies_between_two_poses() -> None:
    found = poses_of_scans(straight(TIMES), SCANS, "poses.txt")
    assert found.scans.tolist() == list(range(len(SCANS)))
    assert found.poses[:, 0, 3] == pytest.approx(10 * SCANS)
    angles = Rotation.from_matrix(found.poses[:, :3, :3]).as_euler("xyz")[:, 2]
    assert np.angle(np.exp(1j * (angles - SCANS))) == pytest.approx(0, abs=1e-9)
    assert found.remarks == ()


def test_scan_at_the_time_of_a_pose_has_that_pose_bit_for_bit() -> None:
    trajectory = straight(TIMES)
    found = poses_of_scans(trajectory, TIMES, "poses.txt")
    np.testing.assert_array_equal(found.poses, trajectory.poses)


def test_scans_outside_and_in_gaps_are_left_out_and_told() -> None:
    times = np.concatenate([np.arange(1, 3, 0.1), np.arange(4, 6, 0.1)])
    stamps = np.array([0.5, 1.5, 3.5, 4.05, 9.0])
    found = poses_of_scans(straight(times), stamps, "poses.txt")
    assert found.scans.tolist() == [1, 3]
    assert "3 of 5 scans have no pose" in found.remarks[0]
    assert "1 before the first pose, 1 after the last, 1 between poses" in found.remarks[0]


@pytest.mark.parametrize(("unit", "scale"), [("milliseconds", 1e3), ("nanoseconds", 1e9)])
def test_unit_of_the_poses_is_told_by_the_overlap(unit: str, scale: float) -> None:
    trajectory = straight(TIMES, TIMES * scale)
    found = poses_of_scans(trajectory, SCANS, "poses.txt")
    assert found.poses[:, 0, 3] == pytest.approx(10 * SCANS)
    assert f"times are {unit}" in found.remarks[0]


def test_clocks_that_never_overlap_are_refused_with_the_offset_to_state() -> None:
    trajectory = straight(TIMES, TIMES + 1.7e9)
    with pytest.raises(DriveError, match=r"do not overlap .* --pose-offset, such as -1699999999.5"):
        poses_of_scans(trajectory, SCANS, "poses.txt")
    found = poses_of_scans(trajectory, SCANS, "poses.txt", offset=-1.7e9)
    assert found.poses[:, 0, 3] == pytest.approx(10 * SCANS, abs=1e-4)
    assert "-1.7e+09 s were added to its times, as stated" in found.remarks[0]


def test_time_zone_is_named() -> None:
    with pytest.raises(DriveError, match=r"time zone of 2 h: 7200"):
        poses_of_scans(straight(TIMES, TIMES + 1.7e9), SCANS + 1.7e9 + 7200, "poses.txt")


def test_poses_and_scans_of_equal_intervals_belong_together_and_the_clocks_are_told() -> None:
    uneven = np.cumsum(np.random.default_rng(0).uniform(0.08, 0.12, 50))
    found = poses_of_scans(straight(uneven), uneven + 1.7e9, "poses.txt")
    assert found.poses[:, 0, 3] == pytest.approx(10 * uneven)
    assert "its clock is -1,700,000,000.000 s off" in found.remarks[0]


def test_sparse_poses_are_refused() -> None:
    with pytest.raises(DriveError, match=r"poses are 2.00 s apart .median., expected at most 0.5"):
        poses_of_scans(straight(np.arange(0, 10, 2.0)), SCANS + 0.05, "poses.txt")


def test_keyframes_give_poses_to_the_scans_at_their_times() -> None:
    found = poses_of_scans(straight(np.arange(0, 10, 2.0)), np.arange(0, 10, 0.1), "poses.txt")
    assert found.scans.tolist() == [0, 20, 40, 60, 80]


@pytest.mark.parametrize("unknown", [False, True])
def test_poses_without_times_belong_to_the_scans_in_order(unknown: bool) -> None:
    trajectory = Trajectory(straight(TIMES).poses)
    stamps = np.full(len(TIMES), np.nan) if unknown else TIMES
    found = poses_of_scans(trajectory, stamps, "poses.txt")
    np.testing.assert_array_equal(found.poses, trajectory.poses)
    assert (found.track is None) == unknown
    with pytest.raises(DriveError, match=r"100 poses for 99 scans, and .*Give one pose a scan"):
        poses_of_scans(trajectory, stamps[1:], "poses.txt")


def test_scans_without_times_get_those_of_the_poses() -> None:
    found = poses_of_scans(straight(TIMES), np.full(len(TIMES), np.nan), "poses.txt")
    assert found.stamps == pytest.approx(TIMES)
    assert "get those of the poses" in found.remarks[0]


def test_interpolation_by_hand() -> None:
    poses = np.tile(np.eye(4), (2, 1, 1))
    poses[1, :3, 3] = 2, 4, 6
    poses[1, :3, :3] = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    found = interpolate(np.array([0.5]), np.array([0.0, 1.0]), poses)
    assert found[0, :3, 3].tolist() == [1, 2, 3]
    half = np.sqrt(0.5)
    assert found[0, :2, :2] == pytest.approx(np.array([[half, -half], [half, half]]))
    assert interpolate(np.zeros(0), np.array([0.0, 1.0]), poses).shape == (0, 4, 4)
