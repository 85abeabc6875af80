import math
from collections import defaultdict

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Float32
from placecell.segmentation.local_map import Accumulator, in_range, transform, voxel_means
from tests.placecell.segment_builders import MemoryDrive, pose


def cloud(*rows: tuple[float, float, float]) -> Float32:
    return np.array(rows, dtype=np.float32).reshape(-1, 3)


def test_voxel_means_by_hand() -> None:
    # Voxels of 1 m: two points in the first, one each in two others.
    means = voxel_means(cloud((0.2, 0.2, 0.2), (5.5, 0.5, 0.5), (0.4, 0.6, 0.8), (0, 1, 0)), 1.0)
    by_hand = [(0.3, 0.4, 0.5), (0, 1, 0), (5.5, 0.5, 0.5)]
    assert means.dtype == np.float32
    assert means == pytest.approx(np.array(by_hand), abs=1e-6)


def test_voxels_do_not_join_across_the_origin() -> None:
    # -0.05 and 0.05 truncate to the same voxel, but lie in different ones.
    means = voxel_means(cloud((-0.05, 0, 0), (0.05, 0, 0)), 0.1)
    assert means == pytest.approx(np.array([[-0.05, 0, 0], [0.05, 0, 0]]), abs=1e-7)


def test_grid_is_fixed_to_the_world_not_to_the_cloud() -> None:
    # 0.9 and 1.1 lie in different voxels whether or not another point comes before them.
    pair = [(0.9, 0.0, 0.0), (1.1, 0.0, 0.0)]
    for other in (-3.3, -0.7, 0.2):
        assert len(voxel_means(cloud(*pair, (other, 0, 0)), 1.0)) == (3 if other < 0 else 2)
    assert len(voxel_means(cloud(*pair), 1.0)) == 2


def test_voxel_means_against_slow_reference() -> None:
    points = np.random.default_rng(0).uniform(-3, 3, (2000, 3)).astype(np.float32)
    cells: dict[tuple[int, ...], list[list[float]]] = defaultdict(list)
    for point in points.tolist():
        cells[tuple(math.floor(value / 0.5) for value in point)].append(point)
    slow = [np.mean(cells[cell], axis=0) for cell in sorted(cells)]
    assert voxel_means(points, 0.5) == pytest.approx(np.array(slow), abs=1e-6)


def test_voxel_means_of_nothing() -> None:
    assert voxel_means(cloud(), 0.1).shape == (0, 3)


def test_in_range_limits_are_inclusive() -> None:
    ranges = [2.99, 3.0, 30.0, 60.0, 60.01]
    kept = in_range(cloud(*[(0, 0, r) for r in ranges]), PROTOCOL_V1)
    assert kept[:, 2].tolist() == [3.0, 30.0, 60.0]


def test_range_is_measured_in_space() -> None:
    assert len(in_range(cloud((2, 2, 2)), PROTOCOL_V1)) == 1  # 3.46 m
    assert len(in_range(cloud((1.7, 1.7, 1.7)), PROTOCOL_V1)) == 0  # 2.94 m


def test_transform_against_scipy() -> None:
    turn = Rotation.from_euler("ZYX", [0.8, -0.3, 0.5])
    rigid = np.eye(4)
    rigid[:3, :3], rigid[:3, 3] = turn.as_matrix(), [5.0, -2.0, 1.0]
    points = np.random.default_rng(1).normal(size=(30, 3)).astype(np.float32)
    moved = transform(rigid, points)
    assert moved.dtype == np.float32
    assert moved == pytest.approx(turn.apply(points) + [5.0, -2.0, 1.0], abs=1e-5)


def test_pose_moves_the_sensors_points_to_the_world() -> None:
    # At (10, 0), looking north: 5 m ahead is (10, 5), 4 m to the left is (6, 0).
    drive = MemoryDrive([cloud((5, 0, 0.3), (0, 4, 0.3))], [pose(10, 0, 1, yaw=np.pi / 2)])
    assert Accumulator(drive, PROTOCOL_V1).local_map(0) == pytest.approx(
        np.array([[6, 0, 1.3], [10, 5, 1.3]]), abs=1e-5
    )


def test_range_counts_from_the_sensor_that_saw_it_not_from_the_world() -> None:
    drive = MemoryDrive([cloud((5, 0, 0), (1, 0, 0))], [pose(100, 0, 0)])
    assert Accumulator(drive, PROTOCOL_V1).local_map(0) == pytest.approx(np.array([[105, 0, 0]]))


def markers(scans: int, parameters: Parameters, first: int = 0) -> list[set[int]]:
    """Return the scans of each capture's map: scan i has one point at a height of i/2 meters."""
    drive = MemoryDrive([cloud((5, 0, index / 2)) for index in range(scans)], [pose()] * scans)
    accumulator = Accumulator(drive, parameters, first)
    return [
        {round(2 * z) for z in accumulator.local_map(frame)[:, 2].tolist()}
        for frame in range(first, scans)
    ]


def test_map_holds_the_captures_scan_and_the_nine_before() -> None:
    fed = markers(25, PROTOCOL_V1)
    assert fed == [set(range(max(0, frame - 9), frame + 1)) for frame in range(25)]


def test_no_scan_before_the_first_feeds_a_map() -> None:
    fed = markers(25, PROTOCOL_V1, first=12)
    assert fed == [set(range(max(12, frame - 9), frame + 1)) for frame in range(12, 25)]


def test_accumulated_scans_is_a_parameter() -> None:
    assert markers(5, Parameters(accumulated_scans=1)) == [{frame} for frame in range(5)]


def test_each_scan_is_read_once() -> None:
    drive = MemoryDrive([cloud((5, 0, 0))] * 30, [pose()] * 30)
    accumulator = Accumulator(drive, PROTOCOL_V1)
    for frame in range(0, 30, 2):
        accumulator.local_map(frame)
    assert drive.reads == [1] * 29 + [0]


def test_radius_is_horizontal_and_about_the_present_position() -> None:
    # Scan 0 sees 30 m to either side of x = 0. From x = 15, x = -30 is 45 m away, 30 only 15 m.
    behind, ahead, high = (-30.0, 0.0, 0.0), (30.0, 0.0, 0.0), (24.0, 0.0, 50.0)
    drive = MemoryDrive(
        [cloud(behind, ahead, high), cloud((40, 0, 0), (41, 0, 0))], [pose(), pose(15)]
    )
    accumulator = Accumulator(drive, PROTOCOL_V1)
    assert sorted(accumulator.local_map(0)[:, 0].tolist()) == [-30, 24, 30]
    # 40 m ahead is just within; 41 m is not.
    assert sorted(accumulator.local_map(1)[:, 0].tolist()) == [24, 30, 55]


def test_map_keeps_one_mean_a_voxel_over_all_scans() -> None:
    drive = MemoryDrive([cloud((5.02, 0.05, 0.05)), cloud((5.06, 0.05, 0.05))], [pose(), pose()])
    local_map = Accumulator(drive, PROTOCOL_V1).local_map(1)
    assert local_map == pytest.approx(np.array([[5.04, 0.05, 0.05]]), abs=1e-6)


def test_scan_with_nothing_in_range_gives_an_empty_map() -> None:
    drive = MemoryDrive([cloud((1, 0, 0), (0, 80, 0))], [pose()])
    assert Accumulator(drive, PROTOCOL_V1).local_map(0).shape == (0, 3)
