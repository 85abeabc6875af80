import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Float32, UInt8
from placecell.descriptors.orientation import orient
from placecell.descriptors.voxels import voxelize
from tests.placecell.segment_builders import box, many_segments, one_segment


def slow_grid(aligned: Float32, parameters: Parameters = PROTOCOL_V1) -> UInt8:
    """Compute the grid point by point with Python numbers, as a reference."""
    grid = np.zeros(parameters.grid, np.uint8)
    points = [[float(value) for value in point] for point in aligned]
    middle = [(min(axis) + max(axis)) / 2 for axis in zip(*points, strict=True)]
    for point in points:
        cell = tuple(
            math.floor((value - center) / parameters.grid_voxel + size / 2)
            for value, center, size in zip(point, middle, parameters.grid, strict=True)
        )
        if all(0 <= at < size for at, size in zip(cell, parameters.grid, strict=True)):
            grid[cell] = 1
    return grid


def line_along_x(*xs: float) -> Segments:
    """Return points on the x axis, seen from far ahead, so that orientation does not rotate."""
    return one_segment([[x, 0.0, 0.0] for x in xs], sensor=(1000.0, 0.0, 0.0))


def test_grid_is_the_papers() -> None:
    occupancy, extents = voxelize(many_segments([100, 200]), PROTOCOL_V1)
    assert occupancy.shape == (2, 38, 38, 18)
    assert occupancy.dtype == np.uint8
    assert set(np.unique(occupancy)) == {0, 1}
    assert extents.shape == (2, 3)
    assert extents.dtype == np.float32


def test_against_slow_reference() -> None:
    # Deviations of 1.5, 1.0 and 0.7 m: some of the points are outside the grid's 3.6 m of height.
    segments = many_segments([10, 300, 2000, 50, 1])
    occupancy, _ = voxelize(segments, PROTOCOL_V1)
    aligned = orient(segments)
    for index in range(len(segments)):
        assert np.array_equal(occupancy[index], slow_grid(aligned[segments.owners == index]))


def test_single_point_is_in_the_middle() -> None:
    occupancy, extents = voxelize(one_segment([[4.0, -3.0, 1.0]]), PROTOCOL_V1)
    assert np.argwhere(occupancy[0]).tolist() == [[19, 19, 9]]
    assert extents.tolist() == [[0.0, 0.0, 0.0]]


def test_box_is_centered_for_any_centroid() -> None:
    # 30 points at one end and one at the other: the grid is centered on the box, not on the mean.
    occupancy, _ = voxelize(line_along_x(*[0.0] * 30, 2.1), PROTOCOL_V1)
    # The ends lie 1.05 m = 5.25 voxels from the middle, which is the border of voxels 18 and 19.
    assert np.argwhere(occupancy[0])[:, 0].tolist() == [13, 24]


def test_points_outside_are_dropped_but_count_in_the_extents() -> None:
    # 8.1 m long: 0.25 m beyond the grid's 7.6 m at either end.
    occupancy, extents = voxelize(line_along_x(0.0, 4.1, 4.3, 8.1), PROTOCOL_V1)
    assert np.argwhere(occupancy[0]).tolist() == [[19, 19, 9], [20, 19, 9]]
    assert extents[0] == pytest.approx([8.1, 0.0, 0.0], abs=1e-5)


def test_tall_segment_loses_its_foot_and_its_top() -> None:
    post = one_segment([[0.0, 0.0, z] for z in np.arange(0.0, 10.05, 0.1)])
    occupancy, extents = voxelize(post, PROTOCOL_V1)
    assert occupancy[0, 19, 19].all()
    assert occupancy.sum() == 18
    assert extents[0, 2] == pytest.approx(10.0, abs=1e-5)


def test_grid_reaches_38_voxels() -> None:
    # 7.5 m < 7.6 m: both ends are in, in the first and in the last voxel.
    occupancy, _ = voxelize(line_along_x(0.0, 7.5), PROTOCOL_V1)
    assert np.argwhere(occupancy[0])[:, 0].tolist() == [0, 37]


def test_lower_boundary_is_in_and_upper_boundary_is_out() -> None:
    # Voxels of 0.25 m and 8 of them: every number here is exact in binary.
    parameters = Parameters(grid=(8, 8, 8), grid_voxel=0.25)
    occupancy, _ = voxelize(line_along_x(-1.0, 0.0, 0.75, 1.0), parameters)
    assert np.argwhere(occupancy[0])[:, 0].tolist() == [0, 4, 7]


def test_size_is_not_scaled_away() -> None:
    small = one_segment(box((0, 0, 0), (1, 1, 1)), sensor=(100.0, 0.0, 0.5))
    large = one_segment(box((0, 0, 0), (2, 2, 2)), sensor=(100.0, 0.0, 0.5))
    (small_grid, small_extents) = voxelize(small, PROTOCOL_V1)
    (large_grid, large_extents) = voxelize(large, PROTOCOL_V1)
    assert small_extents[0] == pytest.approx([1, 1, 1], abs=1e-4)
    assert large_extents[0] == pytest.approx([2, 2, 2], abs=1e-4)
    # 1 m is 5 voxels, 2 m is 10 (and one more where the box lies across a border).
    for grid, voxels in ((small_grid, 5), (large_grid, 10)):
        wide = np.ptp(np.argwhere(grid[0]), axis=0) + 1
        assert ((wide >= voxels) & (wide <= voxels + 1)).all()


def test_extents_are_those_of_the_aligned_box() -> None:
    # 4 m along world y, seen from +y: along x once aligned.
    segment = one_segment([[0, -2, 0], [0, 2, 0], [0.5, 0, 1], [-0.5, 0, 1]], (0.0, 50.0, 0.0))
    _, extents = voxelize(segment, PROTOCOL_V1)
    assert extents[0] == pytest.approx([4, 1, 1], abs=1e-5)


def test_extra_yaw_turns_the_grid() -> None:
    segment = line_along_x(0.0, 1.1, 3.3)
    straight, _ = voxelize(segment, PROTOCOL_V1)
    turned, extents = voxelize(segment, PROTOCOL_V1, yaw=np.pi / 2)
    assert straight[0].any(axis=(1, 2)).sum() == 3
    assert turned[0].any(axis=(0, 2)).sum() == 3
    assert extents[0] == pytest.approx([0, 3.3, 0], abs=1e-5)


def test_batch_equals_singles() -> None:
    segments = many_segments([5, 500, 60, 1200])
    occupancy, extents = voxelize(segments, PROTOCOL_V1)
    for index in range(len(segments)):
        alone, its_extents = voxelize(segments.take([index]), PROTOCOL_V1)
        assert np.array_equal(occupancy[index], alone[0])
        assert np.array_equal(extents[index], its_extents[0])


def test_threads_make_no_difference() -> None:
    segments = many_segments([5, 500, 60, 1200] * 4)
    parts = [segments.take([index]) for index in range(len(segments))]
    with ThreadPoolExecutor(4) as pool:
        grids = list(pool.map(lambda part: voxelize(part, PROTOCOL_V1)[0], parts))
    assert np.array_equal(np.concatenate(grids), voxelize(segments, PROTOCOL_V1)[0])


@pytest.mark.parametrize("strange", [np.nan, np.inf, 1e30])
@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_a_coordinate_that_is_no_number_fills_no_voxel_of_its_neighbor(strange: float) -> None:
    good = many_segments([50])
    bad = np.array([[0, 0, 0], [strange, 0, 0]], np.float32)
    segments = Segments.of([bad, good.points], np.concatenate([good.sensors, good.sensors]))
    occupancy, extents = voxelize(segments, PROTOCOL_V1)
    assert occupancy[0].sum() == 0
    assert np.array_equal(occupancy[1], voxelize(good, PROTOCOL_V1)[0][0])
    assert not extents[0, 0] < 1e29


def test_order_of_points_makes_no_difference() -> None:
    segments = many_segments([800])
    shuffled = np.random.default_rng(1).permutation(segments.points)
    occupancy, extents = voxelize(segments, PROTOCOL_V1)
    other, its_extents = voxelize(Segments(shuffled, segments.ends, segments.sensors), PROTOCOL_V1)
    assert np.array_equal(occupancy, other)
    assert extents == pytest.approx(its_extents, abs=1e-6)


def test_repeated_points_make_no_difference() -> None:
    segment = many_segments([300])
    twice = Segments.of([np.concatenate([segment.points] * 2)], segment.sensors)
    assert np.array_equal(voxelize(segment, PROTOCOL_V1)[0], voxelize(twice, PROTOCOL_V1)[0])


def test_no_segments() -> None:
    occupancy, extents = voxelize(Segments.of([], np.zeros((0, 3))), PROTOCOL_V1)
    assert occupancy.shape == (0, 38, 38, 18)
    assert extents.shape == (0, 3)


def test_halved_voxel_counts_its_parts() -> None:
    # Parts of 0.125 m. The box has its middle at 0, where voxel (4, 4, 4) begins.
    parameters = Parameters(grid=(8, 8, 8), grid_voxel=0.25, voxel_parts=2)
    ends = [(-0.75, 0, 0), (0.75, 0, 0), (0, -0.75, 0), (0, 0.75, 0), (0, 0, -0.75), (0, 0, 0.75)]
    corner = [(0.0625, 0.0625, 0.0625)] * 3
    other_part = [(0.1875, 0.0625, 0.0625)]
    segment = one_segment([*ends, *corner, *other_part], sensor=(1000.0, 0.0, 0.0))
    middle = voxelize(segment, parameters)[0][0]
    assert middle[4, 4, 4] == 2
    # The points at the ends are alone in their voxels.
    assert middle.sum() == 2 + 6


def test_full_voxel_has_eight_parts() -> None:
    steps = np.arange(-0.9375, 1, 0.125)
    points = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    parameters = Parameters(grid=(8, 8, 8), grid_voxel=0.25, voxel_parts=2)
    occupancy, _ = voxelize(one_segment(points, sensor=(1000.0, 0.0, 0.0)), parameters)
    assert (occupancy == 8).all()


def test_halved_voxels_are_occupied_where_whole_voxels_are() -> None:
    segments = many_segments([10, 300, 2000, 50, 1])
    halved, extents = voxelize(segments, Parameters(voxel_parts=2))
    whole, same_extents = voxelize(segments, PROTOCOL_V1)
    assert np.array_equal(halved > 0, whole > 0)
    assert np.array_equal(extents, same_extents)
    assert 1 < halved.max() <= 8
    # Parts are the voxels of a grid with half the edge length.
    finer = Parameters(grid=(76, 76, 36), grid_voxel=0.1)
    parts = voxelize(segments, finer)[0].reshape(-1, 38, 2, 38, 2, 18, 2).sum(axis=(2, 4, 6))
    assert (halved != parts).mean() < 1e-5
