"""Re-ranking of candidates, on scenes whose truth is known."""

import numpy as np
import pytest

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from placecell.core.types import Float64, Int64
from placecell.descriptors.reranking import (
    DEPTH,
    NEIGHBORS,
    count_supports,
    neighbors_of,
    rerank,
    supports,
)

SCENE = np.array([[0.0, 0.0, 0.0], [6.0, 0.0, 1.0], [0.0, 9.0, -1.0], [-4.0, -5.0, 0.5]])
"""Four segments that a robot sees; no two pairs have equal distances."""

LOOK_ALIKE = np.array([[100.0, 0, 0], [100, 50, 0], [150, 0, 0], [150, 60, 0]])
"""Where the map has another segment like each of these, with other offsets."""


def moved(points: Float64, degrees: float, offset: tuple[float, float, float]) -> Float64:
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(points @ turn.T + offset)


def candidates(degrees: float = 0.0) -> tuple[Float64, Int64]:
    """The look-alike first, and the right place second; one map."""
    places = np.stack([LOOK_ALIKE, moved(SCENE, degrees, (30.0, -20.0, 4.0))], axis=1)
    return places, np.zeros((4, 2), dtype=np.int64)


@pytest.mark.parametrize("degrees", [0.0, 33.0, 90.0, 180.0, -150.0])
def test_right_candidate_gets_the_support_of_all_neighbors(degrees: float) -> None:
    counts = supports(SCENE, *candidates(degrees))
    assert counts.tolist() == [[0, 3]] * 4
    order = rerank(np.tile([1.0, 1.2], (4, 1)), counts)
    assert order.tolist() == [[1, 0]] * 4


def test_motion_of_either_frame_changes_nothing() -> None:
    random = np.random.default_rng(0)
    centroids = random.uniform(-20, 20, (40, 3)) * [1, 1, 0.05]
    places = random.uniform(-20, 20, (40, 12, 3)) * [1, 1, 0.05]
    maps = random.integers(0, 2, (40, 12))
    counts = supports(centroids, places, maps)
    assert counts.max() == 3
    apart = moved(centroids, 77.0, (500.0, -3.0, 40.0))
    assert supports(apart, places, maps).tolist() == counts.tolist()
    apart = moved(places.reshape(-1, 3), -142.0, (5e5, 5e6, -300.0)).reshape(places.shape)
    assert supports(centroids, apart, maps).tolist() == counts.tolist()


def test_neighbors_that_turn_differently_do_not_add_up() -> None:
    places, maps = candidates()
    # Two of three neighbors of segment 0 lie at the right distance in another direction.
    places[1, 1] = places[0, 1] + [0.0, 6.0, 1.0]
    places[2, 1] = places[0, 1] + [0.0, 9.0, -1.0]
    places[3, 1] = places[0, 1] + moved(SCENE[3:], 90.0, (0.0, 0.0, 0.0))[0]
    assert supports(SCENE, places, maps)[0].tolist() == [0, 2]


def test_candidates_of_different_maps_do_not_support_each_other() -> None:
    places, maps = candidates()
    maps[1:3, 1] = 1
    assert supports(SCENE, places, maps)[:, 1].tolist() == [1, 1, 1, 1]


def test_other_distance_or_height_is_no_support() -> None:
    places, maps = candidates()
    places[1, 1] += [0.8, 0.0, 0.0]
    places[2, 1] += [0.0, 0.0, 0.8]
    assert supports(SCENE, places, maps)[0].tolist() == [0, 1]
    places, maps = candidates()
    places[1, 1] += [0.6, 0.0, 0.6]
    assert supports(SCENE, places, maps)[0].tolist() == [0, 3]


def test_neighbor_that_finds_one_place_twice_counts_once() -> None:
    places, maps = candidates()
    places[1, 0] = places[1, 1]
    assert supports(SCENE, places, maps)[0].tolist() == [0, 3]


def test_segments_of_other_captures_far_away_or_too_near_are_no_neighbors() -> None:
    centroids = np.array([[0.0, 0, 0], [0.5, 0, 9], [2.0, 0, 0], [39.0, 0, 0], [41.0, 0, 0]])
    captures = np.array([7, 7, 7, 7, 7])
    assert neighbors_of(centroids)[0, :3].tolist() == [2, 3, -1]
    assert neighbors_of(centroids, captures).tolist() == neighbors_of(centroids).tolist()
    assert neighbors_of(centroids, np.array([7, 7, 9, 7, 7]))[0, :2].tolist() == [3, -1]
    places, maps = candidates()
    assert supports(SCENE, places, maps, np.array([3, 3, 3, -8]))[:, 1].tolist() == [2, 2, 2, 0]


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_segment_that_is_not_finite_supports_nothing(value: float) -> None:
    places, maps = candidates()
    scene = SCENE.copy()
    scene[1, 2] = value
    assert supports(scene, places, maps)[:, 1].tolist() == [2, 0, 2, 2]
    places[2, 1, 0] = value
    assert supports(scene, places, maps)[:, 1].tolist() == [1, 0, 0, 1]


def test_missing_candidates_have_no_support_and_come_last() -> None:
    places, maps = candidates()
    maps[:2, 1] = -1
    counts = supports(SCENE, places, maps)
    assert counts.tolist() == [[0, 0], [0, 0], [0, 1], [0, 1]]
    distances = np.array([[1.0, np.inf], [np.inf, np.inf], [1.0, 1.5], [1.0, 1.8]])
    assert rerank(distances, counts).tolist() == [[0, 1], [0, 1], [1, 0], [0, 1]]


@pytest.mark.parametrize("queries", [0, 1])
def test_no_neighbor_gives_no_support(queries: int) -> None:
    places, maps = candidates()
    counts = supports(SCENE[:queries], places[:queries], maps[:queries])
    assert counts.tolist() == [[0, 0]] * queries
    assert supports(SCENE, np.zeros((4, 0, 3)), np.zeros((4, 0), np.int64)).shape == (4, 0)


def test_without_support_the_order_stays_and_ties_keep_their_order() -> None:
    distances = np.array([[0.0, 0.0, 2.0], [1.0, 1.0, 1.1]])
    assert rerank(distances, np.zeros((2, 3), np.int64)).tolist() == [[0, 1, 2], [0, 1, 2]]
    counts = np.array([[0, 3, 9], [2, 2, 3]])
    # An equal descriptor is never displaced by one that differs.
    assert rerank(distances, counts).tolist() == [[1, 0, 2], [2, 0, 1]]


def test_scale_of_the_distances_does_not_matter() -> None:
    random = np.random.default_rng(1)
    distances = np.sort(random.uniform(1, 2, (50, 25)), axis=1)
    counts = random.integers(0, 5, (50, 25))
    order = rerank(distances, counts)
    assert (order != np.arange(25)).any()
    assert rerank(1000 * distances, counts).tolist() == order.tolist()


@pytest.mark.parametrize("spread", [0.0, 3.0, 30.0, 1e6])
def test_number_of_comparisons_is_bounded_for_any_scene(spread: float) -> None:
    random = np.random.default_rng(2)
    queries, k = 120, 40
    centroids = random.uniform(-spread, spread, (queries, 3))
    maps = np.zeros((queries, k), dtype=np.int64)
    comparisons = count_supports(
        centroids,
        random.uniform(-spread, spread, (queries, k, 3)),
        maps,
        neighbors_of(centroids),
        CancelToken().flag,
        np.zeros_like(maps),
    )
    assert comparisons <= queries * k * NEIGHBORS * DEPTH


def test_cancelled_request_stops() -> None:
    token = CancelToken()
    token.cancel()
    with cancelled_by(token), pytest.raises(Cancelled):
        supports(SCENE, *candidates())
