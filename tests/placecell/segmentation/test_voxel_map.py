"""A voxel map that is updated scan by scan equals one that is built anew."""

import pickle
from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from placecell.core.types import Float32, Float64
from placecell.segmentation.local_map import voxel_means
from placecell.segmentation.voxel_map import VoxelMap

VOXEL, RADIUS, SCANS = 0.5, 10.0, 4


class RebuiltMap:
    """Reference: all points are kept, and the map is built anew from those near the sensor."""

    def __init__(self) -> None:
        self.scans = deque[Float32](maxlen=SCANS)

    def add(self, points: Float32, sensor: Float64) -> Float32:
        self.scans.append(points)
        every = np.concatenate(self.scans)
        offset = every[:, :2] - sensor[:2].astype(np.float32)
        near = (offset**2).sum(axis=1) <= np.float32(RADIUS**2)
        return voxel_means(every[near], VOXEL)


def check_drive(scans: list[Float32], sensors: Float64) -> VoxelMap:
    """Check the map after each scan; return it."""
    voxel_map, rebuilt = VoxelMap(VOXEL, RADIUS, SCANS), RebuiltMap()
    for points, sensor in zip(scans, sensors, strict=True):
        voxel_map.add(points, sensor)
        expected = rebuilt.add(points, sensor)
        assert voxel_map.means.tobytes() == expected.tobytes()
        assert len(voxel_map) == len(voxel_map.labels) == len(expected)
    return voxel_map


def around(sensor: Float64, count: int, random: np.random.Generator) -> Float32:
    """Return points up to 14 m from the sensor along each axis, so that many are too far away."""
    return (sensor + random.uniform(-14, 14, (count, 3)) * (1, 1, 0.2)).astype(np.float32)


@settings(deadline=None)  # the first call compiles
@given(
    steps=st.lists(st.floats(-8, 8), min_size=1, max_size=12),
    counts=st.lists(st.integers(0, 300), min_size=12, max_size=12),
    seed=st.integers(0, 1000),
    start=st.sampled_from([0.0, -500.0, 20_000.0]),
)
def test_map_equals_one_built_anew_after_each_scan(
    steps: list[float], counts: list[int], seed: int, start: float
) -> None:
    random = np.random.default_rng(seed)
    sensors = start + np.cumsum([[step, -step / 2, 0.1] for step in steps], axis=0)
    check_drive(
        [around(at, count, random) for at, count in zip(sensors, counts, strict=False)], sensors
    )


def test_points_come_back_with_the_sensor() -> None:
    random, home, away = np.random.default_rng(0), np.zeros(3), np.array([9.0, 0, 0])
    check_drive([around(home, 500, random) for _ in range(4)], np.array([home, away, home, away]))


def test_empty_scans_empty_the_map() -> None:
    random, nothing = np.random.default_rng(1), np.zeros((0, 3), np.float32)
    voxel_map = check_drive([around(np.zeros(3), 50, random)] + [nothing] * 4, np.zeros((5, 3)))
    assert len(voxel_map) == 0


def test_origin_of_the_keys_moves_with_the_sensor() -> None:
    # 6 km in steps of 300 m: the keys are shifted every kilometer, with all scans in the map.
    random = np.random.default_rng(2)
    sensors = np.linspace([0, 0, 0], [4000, -4000, 200], 14)
    check_drive([around(at, 200, random) for at in sensors], sensors)
    close = np.repeat(sensors[::2], 2, axis=0)
    check_drive([around(at, 200, random) for at in close], close)


def test_map_begins_anew_after_a_jump() -> None:
    random, voxel_map = np.random.default_rng(3), VoxelMap(VOXEL, RADIUS, SCANS)
    here, there = np.zeros(3), np.array([1e6, -1e6, 0])
    for at in (here, there, here):
        points = around(at, 100, random)
        voxel_map.add(points, at)
        assert voxel_map.means.tobytes() == RebuiltMap().add(points, at).tobytes()


def test_labels_stay_with_their_voxels() -> None:
    voxel_map = VoxelMap(VOXEL, RADIUS, limit=2)
    first = np.array([[1.1, 0, 0], [3.1, 0, 0]], np.float32)
    voxel_map.add(first, np.zeros(3))
    assert voxel_map.labels.tolist() == [-1, -1]
    voxel_map.labels[:] = [7, 8]
    voxel_map.add(np.array([[2.1, 0, 0], [3.2, 0, 0]], np.float32), np.zeros(3))
    assert voxel_map.labels.tolist() == [7, -1, 8]
    # The first scan leaves: its first voxel is gone, and the second one is held by the second scan.
    voxel_map.add(first[:0], np.zeros(3))
    assert voxel_map.labels.tolist() == [-1, 8]


def test_tiny_coordinate_leaves_no_trace_when_its_scan_leaves() -> None:
    # The sum with 1e-15 is rounded. What is left without it must be exact: the mean of the two
    # other points lies exactly between two float32 numbers, so any trace would show.
    a, b = 0.0027657109312713146, 0.001987622817978263
    xs = [[1.5e-15, 0.0046889], [a], [b], []]
    scans = [np.array([[x, 1, 1] for x in row], np.float32).reshape(-1, 3) for row in xs]
    voxel_map = check_drive([*scans, scans[3]], np.zeros((5, 3)))
    assert voxel_map.means[0, 0] == np.float32((a + b) / 2)


def test_pickled_map_continues_as_the_map_itself() -> None:
    random = np.random.default_rng(5)
    sensors = np.linspace([0, 0, 0], [30, 5, 1], 8)
    scans = [around(at, 300, random) for at in sensors]
    voxel_map = VoxelMap(VOXEL, RADIUS, SCANS)
    for points, sensor in zip(scans[:6], sensors, strict=False):
        voxel_map.add(points, sensor)
    voxel_map.labels[:] = np.arange(len(voxel_map))
    other = pickle.loads(pickle.dumps(voxel_map))
    for points, sensor in zip(scans[6:], sensors[6:], strict=True):
        for each in (voxel_map, other):
            each.add(points, sensor)
        assert other.means.tobytes() == voxel_map.means.tobytes()
        assert other.labels.tolist() == voxel_map.labels.tolist()


def test_pickle_of_an_empty_map() -> None:
    assert len(pickle.loads(pickle.dumps(VoxelMap(VOXEL, RADIUS, SCANS)))) == 0


@pytest.mark.slow
def test_memory_stays_flat_and_sums_stay_exact_over_a_long_drive() -> None:
    random = np.random.default_rng(4)
    circle = np.linspace(0, 2 * np.pi, 50)
    sensors = np.column_stack([20 * np.cos(circle), 20 * np.sin(circle), np.zeros(50)])
    scans = [around(at, 400, random) for at in sensors]
    voxel_map = VoxelMap(VOXEL, RADIUS, SCANS)
    sizes = set[int]()
    for turn in range(40):
        for points, sensor in zip(scans, sensors, strict=True):
            voxel_map.add(points, sensor)
            if turn > 1:
                sizes.add(voxel_map.nbytes)
    rebuilt = RebuiltMap()
    expected = [rebuilt.add(*pair) for pair in zip(scans[-SCANS:], sensors[-SCANS:], strict=True)]
    assert voxel_map.means.tobytes() == expected[-1].tobytes()
    assert len(sizes) == 1
