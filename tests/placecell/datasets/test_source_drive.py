"""Drives of any source: poses from a file, from the source, mounts, and deskewing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.datasets import DriveError, ScanOptions, SourceDrive, use_scan_options
from placecell.trajectories.trajectory import Trajectory
from tests.placecell.datasets.source_fakes import MemorySource
from tests.placecell.segment_builders import pose

SCANS = [[[5, index, 0], [6, index, 1]] for index in range(4)]
STAMPS = [100.0, 100.1, 100.2, 100.3]
POSES = [pose(7.0, 3.0), pose(8.0, 3.0), pose(9.0, 3.1, 0, 0.1), pose(9.9, 3.4, 0, 0.4)]


def tum(folder: Path, stamps: object = STAMPS, poses: object = POSES) -> Path:
    """Write a TUM trajectory of poses that turn about z."""
    lines = []
    for stamp, each in zip(np.asarray(stamps), np.asarray(poses), strict=True):
        half = np.arctan2(each[1, 0], each[0, 0]) / 2
        x, y, z = each[:3, 3]
        lines.append(f"{stamp:.9f} {x} {y} {z} 0 0 {np.sin(half)} {np.cos(half)}\n")
    (folder / "poses.tum").write_text("".join(lines))
    return folder / "poses.tum"


def drive(source: MemorySource, said: list[str] | None = None, **options: object) -> SourceDrive:
    """Open a source as a drive with these options."""
    tell = (lambda _: None) if said is None else said.append
    with use_scan_options(replace(ScanOptions(tell=tell), **options)):  # type: ignore[arg-type]
        return SourceDrive(source)


def own(frame: str = "lidar", poses: object = POSES) -> Trajectory:
    return Trajectory(np.asarray(poses), np.array(STAMPS), frame, "odom")


def test_poses_of_a_file_become_the_drives(tmp_path: Path) -> None:
    said: list[str] = []
    found = drive(MemorySource(SCANS, STAMPS), said, poses=tum(tmp_path))
    assert len(found) == 4
    assert found.title == "memory.bag"
    assert found.times.tolist() == STAMPS
    assert found.origin.tolist() == [7, 3, 0]
    assert found.poses[0] == pytest.approx(np.eye(4))
    assert found.poses[3] == pytest.approx(pose(2.9, 0.4, 0, 0.4))
    assert found.scan(2).tolist() == SCANS[2]
    assert found.scan_hash(1) == "0000000000000001"
    assert any("4 of 4 scans have a pose" in line for line in said)
    assert any("taken as the sensor's. State its mount with --extrinsic" in line for line in said)
    assert any("the points have no times" in line for line in said)


def test_scans_without_a_pose_are_left_out_and_told(tmp_path: Path) -> None:
    said: list[str] = []
    file = tum(tmp_path, STAMPS[1:3], POSES[1:3])
    found = drive(MemorySource(SCANS, STAMPS), said, poses=file)
    assert found.scans.tolist() == [1, 2]
    assert found.scan(0).tolist() == SCANS[1]
    assert found.scan_hash(0) == "0000000000000001"
    assert any("2 of 4 scans have no pose and are left out" in line for line in said)


def test_points_are_those_of_the_source_bit_for_bit(tmp_path: Path) -> None:
    source = MemorySource(SCANS, STAMPS)
    found = drive(source, poses=tum(tmp_path))
    assert found.scan(1) is source.points[1]


def test_own_poses_are_used_and_told() -> None:
    said: list[str] = []
    found = drive(MemorySource(SCANS, STAMPS, own()), said)
    assert found.poses[1] == pytest.approx(pose(1.0))
    assert any("memory.bag: 4 of 4 scans have a pose" in line for line in said)
    assert any("poses are those of the sensor's frame 'lidar'" in line for line in said)


def test_mount_moves_the_poses_of_a_base_to_the_sensor() -> None:
    said: list[str] = []
    source = MemorySource(SCANS, STAMPS, own("base_link"))
    found = drive(source, said, extrinsic="1 0 2 0 0 90 deg")
    # The sensor is 1 m ahead of the base, and looks to the left.
    assert found.origin == pytest.approx([8, 3, 2])
    assert found.poses[0, :3, 0] == pytest.approx([0, 1, 0], abs=1e-9)
    ahead = np.array([np.cos(0.4), np.sin(0.4), 0.0])
    assert found.poses[3, :3, 3] == pytest.approx(np.array([2.9, 0.4, 0]) + ahead - [1, 0, 0])
    assert any("mounted at 1.00 0.00 2.00 m, 0.0 0.0 90.0 deg" in line for line in said)


def test_unknown_mount_is_told() -> None:
    said: list[str] = []
    drive(MemorySource(SCANS, STAMPS, own("base_link")), said)
    assert any("mount of lidar on base_link is not known" in line for line in said)


def test_poses_that_never_move_are_not_used(tmp_path: Path) -> None:
    said: list[str] = []
    source = MemorySource(SCANS, STAMPS, own(poses=[np.eye(4)] * 4))
    with pytest.raises(DriveError, match="has no poses"):
        drive(source, said, odometry="none")
    assert any("its own poses never change" in line for line in said)
    assert len(drive(source, odometry="/odom")) == 4


def test_source_without_poses_is_refused_with_what_to_give() -> None:
    with pytest.raises(
        DriveError,
        match=r"neither those in a bag nor kiss-icp. Give poses with --poses FILE .KITTI",
    ):
        drive(MemorySource(SCANS, STAMPS), odometry="none")
    with pytest.raises(DriveError, match="has no poses on /odom; memory has none"):
        drive(MemorySource(SCANS, STAMPS), odometry="/odom")


def test_single_scan_needs_no_poses() -> None:
    found = drive(MemorySource(SCANS[:1]))
    assert found.poses[0].tolist() == np.eye(4).tolist()
    assert found.times.tolist() == [0]


def test_empty_source_is_refused() -> None:
    with pytest.raises(DriveError, match="holds no scans"):
        drive(MemorySource([]))


def test_unused_topic_is_told(tmp_path: Path) -> None:
    said: list[str] = []
    drive(MemorySource(SCANS, STAMPS), said, poses=tum(tmp_path), topic="/points")
    assert any("--topic is not used" in line for line in said)


def test_camera_poses_get_the_sensors_own_frame_as_world(tmp_path: Path) -> None:
    """The camera looks along the sensor's x, 0.3 m ahead; the sensor drives 5 m ahead."""
    (tmp_path / "calib.txt").write_text("Tr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n")
    (tmp_path / "kitti.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 5\n")
    found = drive(
        MemorySource(SCANS[:2]),
        poses=tmp_path / "kitti.txt",
        extrinsic=str(tmp_path / "calib.txt"),
    )
    assert found.poses == pytest.approx(np.stack([pose(), pose(5.0)]), abs=1e-9)


def test_damaged_scan_is_skipped_or_refused(tmp_path: Path) -> None:
    source = MemorySource([*SCANS[:3], [[0, 0, 0], [np.nan, 1, 1]]], STAMPS)
    source.damaged = {1}
    source.points[2] = np.array([[1, 2, 3], [np.nan, 0, 1]], np.float32)
    found = drive(source, poses=tum(tmp_path))
    assert [len(found.scan(index)) for index in range(4)] == [2, 0, 1, 0]
    assert found.dropouts.dropped == {2: 1}
    summary = found.summary(range(4))
    assert "2 of 4 scans skipped (scan 1: scan 1 is damaged" in summary
    assert "all 2 points are not finite" in summary
    strict = drive(source, poses=tum(tmp_path), strict=True)
    with pytest.raises(DriveError, match=r"memory.bag, scan 2: 1 of 2 points are not finite"):
        strict.scan(2)
    with pytest.raises(DriveError, match=r"memory.bag, scan 1: .*Without --strict it is skipped"):
        strict.scan(1)


def moving_source(times: list[Float64] | None) -> MemorySource:
    """Return scans of a sensor at 10 m/s that sees one point 20 m ahead of its first place."""
    offsets = np.linspace(-0.05, 0.05, 11)
    scans = [
        np.column_stack([20 - 10 * (0.1 * index + offsets), offsets * 0 + 1, offsets * 0])
        for index in range(4)
    ]
    return MemorySource(scans, STAMPS, times=times)


def straight_file(folder: Path) -> Path:
    return tum(folder, STAMPS, [pose(float(index)) for index in range(4)])


def test_points_with_times_are_deskewed_and_told(tmp_path: Path) -> None:
    said: list[str] = []
    source = moving_source([np.linspace(-0.05, 0.05, 11)] * 4)
    found = drive(source, said, poses=straight_file(tmp_path))
    for index in range(4):
        expected = np.tile([20.0 - index, 1, 0], (11, 1))
        assert found.scan(index) == pytest.approx(expected, abs=1e-4)
    assert any("deskewed by the points' times (-0.050 to 0.050 s)" in line for line in said)


def test_no_deskew_leaves_the_points(tmp_path: Path) -> None:
    said: list[str] = []
    source = moving_source([np.linspace(-0.05, 0.05, 11)] * 4)
    found = drive(source, said, poses=straight_file(tmp_path), deskew=False)
    assert found.scan(1) is source.points[1]
    assert any("not deskewed (--no-deskew)" in line for line in said)


def test_poses_without_times_deskew_by_the_times_of_the_scans(tmp_path: Path) -> None:
    rows = [" ".join(f"{value}" for value in pose(float(i))[:3].ravel()) for i in range(4)]
    (tmp_path / "kitti.txt").write_text("\n".join(rows))
    times = [np.linspace(-0.05, 0.05, 11)] * 4
    found = drive(moving_source(times), poses=tmp_path / "kitti.txt")
    assert found.scan(2) == pytest.approx(np.tile([18.0, 1, 0], (11, 1)), abs=1e-4)
    source = moving_source(times)
    source.stamps[:] = np.nan
    said: list[str] = []
    found = drive(source, said, poses=tmp_path / "kitti.txt")
    assert found.times == pytest.approx([0, 0.1, 0.2, 0.3])
    assert any("taken as 0.1 s apart" in line for line in said)
