"""Wide local maps cover a length of travel, and a query's holds no later scan."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.peers.exchange import MAP, QUERIES, folder_of, query_files, read_map
from benchmarks.peers.frames import query_poses, stretches_of_two, write_map, write_queries
from benchmarks.peers.wide_maps import WideAccumulator, WideMaps, apart_from, traveled
from tests.placecell.segment_builders import MemoryDrive, pose

KIND = WideMaps(length=4.0, reach=30.0, apart=0.0)


def straight(spacing: float, count: int) -> MemoryDrive:
    """Return a drive along x with one point per scan, 10 m to the left and at its own height."""
    scans = [[(0.0, 10.0, float(index))] for index in range(count)]
    return MemoryDrive(scans, [pose(spacing * index) for index in range(count)])


def test_query_reaches_back_and_map_reaches_both_ways() -> None:
    accumulator = WideAccumulator(straight(1.0, 20), range(20), KIND)
    assert accumulator.scans_of(10, ahead=False) == [6, 7, 8, 9, 10]
    assert accumulator.scans_of(10, ahead=True) == [8, 9, 10, 11, 12]


def test_local_map_ends_where_the_stretch_ends() -> None:
    accumulator = WideAccumulator(straight(1.0, 20), range(9, 12), KIND)
    assert accumulator.scans_of(10, ahead=False) == [9, 10]
    assert accumulator.scans_of(10, ahead=True) == [9, 10, 11]


def test_scans_of_a_standing_robot_count_once() -> None:
    accumulator = WideAccumulator(straight(0.2, 20), range(20), WideMaps(1.0, 30.0, 0.0))
    assert accumulator.scans_of(10, ahead=False) == [7, 10]
    assert accumulator.scans_of(10, ahead=True) == [10]
    assert WideAccumulator(straight(0.0, 5), range(5), KIND).scans_of(2, ahead=True) == [2]


def test_points_of_all_scans_are_in_the_frame_of_the_drive() -> None:
    accumulator = WideAccumulator(straight(1.0, 20), range(20), KIND)
    points = accumulator.local_map(3, ahead=False)
    order = np.argsort(points[:, 0])
    assert points[order] == pytest.approx(np.array([[x, 10.0, x] for x in range(4)]), abs=1e-5)


def test_returns_beyond_the_range_and_of_the_vehicle_are_dropped() -> None:
    drive = MemoryDrive([[(1.0, 0, 0), (20.0, 0, 0), (31.0, 0, 0)]], [pose()])
    points = WideAccumulator(drive, range(1), KIND).local_map(0, ahead=False)
    assert points == pytest.approx(np.array([[20.0, 0, 0]]))


def test_travel_is_the_length_of_the_path() -> None:
    poses = np.stack([pose(0), pose(3, 4), pose(3, 4), pose(0, 0)])
    assert traveled(poses).tolist() == [0, 5, 5, 10]


def test_spaced_positions_include_the_first_and_the_last() -> None:
    along = np.array([0.0, 4, 9, 10, 19, 20.5, 21])
    assert apart_from(along, 10.0).tolist() == [0, 3, 5, 6]
    assert apart_from(along, 0.0).tolist() == [*range(7)]
    assert apart_from(np.array([3.0]), 10.0).tolist() == [0]


def test_files_of_each_kind_have_their_own_folder(tmp_path: Path) -> None:
    driven = straight(1.0, 25)
    mapped, asking = stretches_of_two(driven, driven, np.eye(4))
    write_map(tmp_path, mapped, kinds=("near", "long"))
    write_queries(tmp_path, asking, most=3, kinds=("long",))
    assert len(read_map(tmp_path)) == 25
    frames = read_map(tmp_path, "long")
    assert [frame.pose[0, 3] for frame in frames] == [0, 10, 20, 24]
    assert not (tmp_path / QUERIES).exists()
    assert folder_of(tmp_path, MAP, "long").name == "map-long"
    files, truth = query_files(tmp_path, "long"), query_poses(asking, most=3)
    assert len(files) == len(truth) == 3
    # The second query is at 12 m: it holds scans 0 to 12, the map's local map there all scans.
    assert len(np.load(files[1])) == 13
    assert len(frames[1].cloud) == 25
