from pathlib import Path

import numpy as np
import pytest

from benchmarks.peers.exchange import query_files, read_map
from benchmarks.peers.frames import (
    Stretch,
    leveled,
    map_poses,
    near_map,
    query_poses,
    stretches_of_one,
    stretches_of_two,
    write_map,
    write_queries,
)
from placecell.core.types import Float64
from placecell.segmentation.local_map import Accumulator
from tests.placecell.segment_builders import MemoryDrive, pose


def drive(poses: list[Float64], seed: int = 0) -> MemoryDrive:
    """Return a drive with a few points per scan, around the sensor."""
    random = np.random.default_rng(seed)
    return MemoryDrive([random.uniform(-20, 20, (50, 3)) for _ in poses], poses)


def along(count: int, spacing: float = 1.0) -> MemoryDrive:
    return drive([pose(spacing * index, 0.1 * index, yaw=0.05 * index) for index in range(count)])


def test_leveled_pose_keeps_position_and_heading() -> None:
    tilted = pose(1, 2, 3, yaw=0.7)
    tilted[:3, :3] = tilted[:3, :3] @ [[1, 0, 0], [0, 0.995, -0.0998], [0, 0.0998, 0.995]]
    assert leveled(tilted) == pytest.approx(pose(1, 2, 3, yaw=0.7), abs=1e-3)
    assert leveled(pose(1, 2, 3, yaw=0.7), 0.5) == pytest.approx(pose(1, 2, 3, yaw=1.2))


def test_map_files_are_the_local_maps_of_our_segmentation(tmp_path: Path) -> None:
    driven = along(60)
    mapped, _ = stretches_of_one(driven)
    write_map(tmp_path, mapped)
    poses, frames = map_poses(mapped), read_map(tmp_path)
    scans = [(block, scan) for block in mapped for scan in block.frames]
    assert len(frames) == len(poses) == len(scans)
    for frame, (block, scan) in zip(frames, scans, strict=True):
        expected = Accumulator(driven, block.parameters, block.scans.start).local_map(scan)
        in_world = frame.cloud @ frame.pose[:3, :3].T + frame.pose[:3, 3]
        assert frame.pose[:3, 3] == pytest.approx(driven.poses[scan, :3, 3])
        assert in_world == pytest.approx(expected, abs=1e-4)


def test_no_scan_is_in_both_map_and_queries() -> None:
    mapped, asking = stretches_of_one(along(60))
    first, second = (
        {scan for block in blocks for scan in block.scans} for blocks in (mapped, asking)
    )
    assert not first & second
    assert first | second == set(range(60))


def test_drive_without_a_second_block_is_refused() -> None:
    with pytest.raises(ValueError, match="too short for a second block"):
        stretches_of_one(drive([pose()] * 5))


def test_queries_are_rotated_with_their_true_poses(tmp_path: Path) -> None:
    driven = along(60)
    _, asking = stretches_of_one(driven)
    write_queries(tmp_path, asking, seed=3)
    truth = query_poses(asking, seed=3)
    files = query_files(tmp_path)
    scans = [(block, scan) for block in asking for scan in block.frames]
    assert len(files) == len(truth) == len(scans)
    turns = []
    for file, true, (block, scan) in zip(files, truth, scans, strict=True):
        expected = Accumulator(driven, block.parameters, block.scans.start).local_map(scan)
        cloud = np.load(file)
        assert cloud @ true[:3, :3].T + true[:3, 3] == pytest.approx(expected, abs=1e-4)
        turn = leveled(driven.poses[scan])[:3, :3].T @ true[:3, :3]
        turns.append(np.arctan2(turn[1, 0], turn[0, 0]))
    assert min(turns) < -1
    assert max(turns) > 1
    assert not np.allclose(truth, query_poses(asking, seed=4))


def test_true_poses_of_two_drives_are_in_the_frame_of_the_map() -> None:
    mapped, asked = along(4), along(3, spacing=2.0)
    to_map = pose(100, 50, 2, yaw=np.pi / 2)
    first, second = stretches_of_two(mapped, asked, to_map)
    assert [len(stretch.frames) for stretch in first + second] == [4, 3]
    truth = query_poses(second)
    assert truth[:, :3, 3] == pytest.approx((to_map @ asked.poses)[:, :3, 3])


def test_queries_within_ten_meters_are_near_the_map() -> None:
    frames = np.stack([pose(0.0), pose(0.0, 30.0)])
    asked = np.stack([pose(10.0), pose(10.1), pose(8.0, 36.0), pose(0.0, 15.0)])
    assert near_map(frames, asked).tolist() == [True, False, True, False]


def test_fewer_queries_are_spread_evenly() -> None:
    _, asking = stretches_of_two(along(2), along(9), np.eye(4))
    assert query_poses(asking, most=3)[:, 0, 3] == pytest.approx([0, 4, 8])
    assert len(query_poses(asking, most=100)) == 9


def test_files_of_an_earlier_run_are_no_queries(tmp_path: Path) -> None:
    _, asking = stretches_of_two(along(2), along(9), np.eye(4))
    write_queries(tmp_path, asking)
    write_queries(tmp_path, asking, most=2)
    assert len(query_files(tmp_path)) == 2


def test_larger_radius_keeps_points_beyond_the_protocols_radius() -> None:
    def farthest(radius: float | None) -> tuple[float, str]:
        far = MemoryDrive([[(30.0, 0, 0), (55.0, 0, 0), (90.0, 0, 0)]] * 2, [pose(), pose(1.0)])
        (stretch,), _ = stretches_of_two(far, far, np.eye(4), radius)
        return reach_of(stretch), stretch.parameters.protocol

    assert farthest(None) == (30, "v1")
    assert farthest(60.0) == (55, "v1, wider")
    assert farthest(100.0) == (90, "v1, wider")


def reach_of(stretch: Stretch) -> float:
    """Return the largest distance of a point ahead of the first scan in its local map."""
    accumulator = Accumulator(stretch.drive, stretch.parameters, stretch.scans.start)
    return float(accumulator.local_map(0)[:, 0].max())
