import numpy as np
import pytest

from placecell.core.jit import compiled
from placecell.core.segments import Segments
from placecell.core.types import Int64
from placecell.descriptors.orientation import orient, sensor_bearings
from tests.placecell.segment_builders import many_segments, one_segment, yaw_matrix

# Nothing about it is symmetric; its centroid is (2, 1, 2).
HOOK = np.array([[0, 0, 0], [4, 0, 1], [4, 1, 3], [0, 3, 4]], np.float32)
CENTROID = np.array([2.0, 1.0, 2.0])


def test_points_are_about_the_centroid_with_the_robot_on_positive_x() -> None:
    # The robot is north of the hook: north (y) must become x, and west become y.
    segment = one_segment(HOOK, sensor=(2.0, 11.0, 2.0))

    aligned = orient(segment)

    by_hand = np.array([[-1, 2, -2], [-1, -2, -1], [0, -2, 1], [2, 2, 2]])
    assert aligned.dtype == np.float32
    assert aligned == pytest.approx(by_hand, abs=1e-6)


@pytest.mark.parametrize("side", [0, 90, 180, 270])
def test_one_surface_from_each_side_is_oriented_alike(side: int) -> None:
    # The robot always looks at the hook's same side: world and robot turn about the centroid.
    turn = yaw_matrix(np.radians(side))
    points = (HOOK - CENTROID) @ turn.T
    sensor = turn @ [7.0, 0.0, 1.5]

    aligned = orient(one_segment(points, sensor))

    assert aligned == pytest.approx(HOOK - CENTROID, abs=1e-5)


def test_from_another_side_another_side_faces_the_robot() -> None:
    for bearing, face in {0.0: (1, 0), 90.0: (0, 1), 180.0: (-1, 0), 270.0: (0, -1)}.items():
        direction = np.array([np.cos(np.radians(bearing)), np.sin(np.radians(bearing)), 0.0])
        markers = np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], np.float32)
        aligned = orient(one_segment(markers, 9 * direction))
        facing = markers[np.argmax(aligned[:, 0])]
        assert tuple(facing[:2]) == face
        assert aligned[:, 0].max() == pytest.approx(1.0, abs=1e-6)


def test_robot_lies_on_positive_x_for_random_segments() -> None:
    segments = many_segments([50] * 20)
    bearings = sensor_bearings(segments)
    for index in range(len(segments)):
        offset = segments.sensors[index] - segments.centroids()[index]
        x, y, _ = yaw_matrix(-bearings[index]) @ offset
        assert x > 0
        assert y == pytest.approx(0.0, abs=1e-6)


def test_world_turned_and_moved_makes_no_difference() -> None:
    segments = many_segments([40, 60, 80])
    turn, shift = yaw_matrix(2.1), np.array([120.0, -75.0, 8.0])
    moved = Segments(
        (segments.points @ turn.T + shift).astype(np.float32),
        segments.ends,
        (segments.sensors @ turn.T + shift).astype(np.float32),
    )
    # float32 coordinates of 120 m are good to 8 micrometers.
    assert orient(moved) == pytest.approx(orient(segments), abs=1e-4)


def test_distance_and_height_of_the_robot_make_no_difference() -> None:
    near = one_segment(HOOK, CENTROID + [3.0, 4.0, 0.0])
    far = one_segment(HOOK, CENTROID + [30.0, 40.0, 5.0])
    assert orient(near) == pytest.approx(orient(far), abs=1e-5)


def test_heights_are_about_the_centroid_and_otherwise_untouched() -> None:
    aligned = orient(one_segment(HOOK, (-5.0, 3.0, 60.0)), yaw=1.0)
    assert aligned[:, 2].tolist() == [-2.0, -1.0, 1.0, 2.0]


@pytest.mark.parametrize("above", [0.0, 10.0, -10.0])
def test_sensor_above_or_below_leaves_the_segment_unrotated(above: float) -> None:
    segment = one_segment(HOOK, CENTROID + [0.0, 0.0, above])
    assert sensor_bearings(segment).tolist() == [0.0]
    assert orient(segment) == pytest.approx(HOOK - CENTROID, abs=1e-6)


def test_extra_yaw_turns_counter_clockwise_after_alignment() -> None:
    segment = one_segment(HOOK, CENTROID + [9.0, 0.0, 0.0])
    quarter = orient(segment, yaw=np.pi / 2)
    by_hand = np.array([[1, -2, -2], [1, 2, -1], [0, 2, 1], [-2, -2, 2]])
    assert quarter == pytest.approx(by_hand, abs=1e-6)


def test_each_segment_has_its_own_yaw() -> None:
    segments = many_segments([30, 40, 50])
    yaws = np.array([0.3, -1.2, 2.5])
    together = orient(segments, yaws)
    for index, yaw in enumerate(yaws):
        alone = orient(segments.take([index]), float(yaw))
        rows = segments.owners == index
        assert np.array_equal(together[rows], alone)


def test_against_numpy_bit_for_bit() -> None:
    segments = many_segments([1, 7, 100, 3000])
    yaw = np.array([0.0, 1.0, -2.0, 3.0])
    turn = yaw - sensor_bearings(segments)
    for index in range(len(segments)):
        centered = segments.cloud(index) - segments.centroids()[index]
        cosine, sine = np.cos(turn)[index], np.sin(turn)[index]
        by_hand = np.stack(
            [
                cosine * centered[:, 0] - sine * centered[:, 1],
                sine * centered[:, 0] + cosine * centered[:, 1],
                centered[:, 2],
            ],
            axis=1,
        ).astype(np.float32)
        assert np.array_equal(orient(segments, yaw)[segments.owners == index], by_hand)


def test_centroid_is_the_mean_in_double_precision() -> None:
    # In float32 the sum of 15,000 coordinates of 1 km would be off by centimeters.
    points = np.random.default_rng(0).uniform(999, 1000, (15_000, 3)).astype(np.float32)
    (centroid,) = one_segment(points).centroids()
    assert centroid == pytest.approx(points.astype(np.float64).mean(axis=0), abs=1e-9)


def test_read_only_and_strided_points_are_accepted() -> None:
    segments = many_segments([40, 60])
    fixed = segments.points.copy()
    fixed.flags.writeable = False
    columns = np.asfortranarray(segments.points)
    for points in (fixed, columns):
        other = Segments(points, segments.ends, segments.sensors)
        assert np.array_equal(orient(other), orient(segments))


def test_compiles_without_a_writable_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("numba.core.caching.CacheImpl._locator_classes", [])

    @compiled
    def double(values: Int64) -> None:
        values *= 2

    values = np.arange(3)
    double(values)
    assert values.tolist() == [0, 2, 4]


@pytest.mark.parametrize("ends", [[50, 101], [50, 90], [0, 100], [60, 50, 100], [120, 100]])
def test_ends_that_do_not_divide_the_points_are_refused(ends: list[int]) -> None:
    points = np.zeros((100, 3), np.float32)
    segments = Segments(points, np.array(ends), np.zeros((len(ends), 3), np.float32))
    with pytest.raises(ValueError, match="do not divide the 100 points"):
        orient(segments)


def test_no_segments() -> None:
    nothing = Segments.of([], np.zeros((0, 3)))
    assert sensor_bearings(nothing).shape == (0,)
    assert orient(nothing).shape == (0, 3)
