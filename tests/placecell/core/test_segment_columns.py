import numpy as np
import pytest

from placecell.core.segments import Segments
from tests.placecell.segment_builders import many_segments

CLOUDS = [
    np.array([[0, 0, 0], [2, 4, 6]], np.float32),
    np.array([[5, 5, 5]], np.float32),
    np.array([[1, 0, 0], [-1, 3, 2], [0, 0, 4]], np.float32),
]
SENSORS = np.array([[9, 0, 0], [0, 9, 0], [0, 0, 9]], np.float32)


@pytest.fixture
def segments() -> Segments:
    return Segments.of(CLOUDS, SENSORS)


def same(a: Segments, b: Segments) -> bool:
    return (
        np.array_equal(a.points, b.points)
        and np.array_equal(a.ends, b.ends)
        and np.array_equal(a.sensors, b.sensors)
    )


def test_columns_match_values_by_hand(segments: Segments) -> None:
    assert len(segments) == 3
    assert segments.points.shape == (6, 3)
    assert segments.ends.tolist() == [2, 3, 6]
    assert segments.starts.tolist() == [0, 2, 3]
    assert segments.counts.tolist() == [2, 1, 3]
    assert segments.owners.tolist() == [0, 0, 1, 2, 2, 2]


def test_any_input_type_gives_the_documented_types() -> None:
    made = Segments.of([cloud.astype(np.float64) for cloud in CLOUDS], SENSORS.astype(np.float64))
    types = [str(column.dtype) for column in (made.points, made.ends, made.sensors)]
    assert types == ["float32", "int64", "float32"]


def test_cloud_returns_the_input_points(segments: Segments) -> None:
    for index, cloud in enumerate(CLOUDS):
        assert np.array_equal(segments.cloud(index), cloud)


def test_centroids_by_hand(segments: Segments) -> None:
    assert segments.centroids() == pytest.approx(np.array([[1, 2, 3], [5, 5, 5], [0, 1, 2]]))


def test_centroids_far_from_the_origin_do_not_drift() -> None:
    # The mean of equal points is that point; summed in float32 it is not.
    cloud = np.tile(np.array([[1000.1, -1000.3, 0.1]], np.float32), (100_003, 1))
    assert Segments.of([cloud], np.zeros((1, 3))).centroids()[0] == pytest.approx(
        cloud[0].astype(np.float64), abs=1e-6
    )


def test_bounds_by_hand(segments: Segments) -> None:
    lowest, highest = segments.bounds()
    assert lowest.tolist() == [[0, 0, 0], [5, 5, 5], [-1, 0, 0]]
    assert highest.tolist() == [[2, 4, 6], [5, 5, 5], [1, 3, 4]]


@pytest.mark.parametrize("indices", [[0], [2, 0], [1, 1, 2], [0, 1, 2], []])
def test_take_in_the_order_asked_for(segments: Segments, indices: list[int]) -> None:
    taken = segments.take(indices)
    expected = Segments.of([CLOUDS[i] for i in indices], SENSORS[indices])
    assert same(taken, expected)


def test_take_from_many_segments_keeps_points() -> None:
    segments = many_segments(list(range(1, 60)))
    order = np.random.default_rng(0).permutation(len(segments))[:40]
    taken = segments.take(order)
    for at, index in enumerate(order.tolist()):
        assert np.array_equal(taken.cloud(at), segments.cloud(index))
        assert np.array_equal(taken.sensors[at], segments.sensors[index])


def test_concatenate_undoes_take(segments: Segments) -> None:
    parts = [segments.take([0]), segments.take([]), segments.take([1, 2])]
    assert same(Segments.concatenate(parts), segments)


def test_concatenate_without_parts_is_empty() -> None:
    assert len(Segments.concatenate([])) == 0


def test_empty_segments_have_no_rows() -> None:
    empty = Segments.of([], np.zeros((0, 3)))
    assert len(empty) == 0
    assert empty.points.shape == empty.sensors.shape == empty.centroids().shape == (0, 3)
    for column in (empty.starts, empty.counts, empty.owners, empty.ends):
        assert column.shape == (0,)
        assert column.dtype == np.int64
    assert [corner.shape for corner in empty.bounds()] == [(0, 3), (0, 3)]
    assert len(empty.take([])) == 0


def test_take_refuses_a_mask() -> None:
    two = Segments.of([np.ones((3, 3), np.float32), np.zeros((2, 3), np.float32)], np.ones((2, 3)))
    with pytest.raises(TypeError, match="mask"):
        two.take(np.array([True, False]))
