"""Measures of recognition equal those computed by hand on small sets."""

import numpy as np
import pytest

from evaluation.recognition import retrieval


def brute_force_top1(descriptors: np.ndarray, groups: np.ndarray) -> float:
    right = 0
    for i in range(len(groups)):
        distances = [
            float(np.linalg.norm(descriptors[i] - descriptors[j])) if j != i else np.inf
            for j in range(len(groups))
        ]
        right += groups[int(np.argmin(distances))] == groups[i]
    return right / len(groups)


def test_top1_agrees_with_brute_force_over_several_blocks_of_rows() -> None:
    random = np.random.default_rng(3)
    descriptors = random.integers(-127, 128, (1203, 5)).astype(np.float32)
    groups = random.integers(0, 40, 1203)
    expected = brute_force_top1(descriptors[:300], groups[:300])
    assert retrieval.top1(descriptors[:300], groups[:300]) == pytest.approx(expected)
    several_blocks = retrieval.retrieve(descriptors, groups).right
    one_block = np.concatenate(
        [
            distances.argmin(axis=1)
            for _, distances in retrieval.distance_rows(descriptors, rows=2000)
        ]
    )
    assert (several_blocks == (groups[one_block] == groups)).all()


def test_segments_without_a_mate_are_misses_but_do_not_count_with_mate() -> None:
    descriptors = np.array([[0.0], [0.1], [5.0]], dtype=np.float32)
    found = retrieval.retrieve(descriptors, np.array([0, 0, 1]))
    assert found.right.tolist() == [True, True, False]
    assert found.has_mate.tolist() == [True, True, False]


def test_cross_view_leaves_out_near_mates() -> None:
    # Segment 0's nearest is its view from half a meter on; from afar only segment 3 is left,
    # behind a stranger.
    descriptors = np.array([[0.0], [0.1], [1.0], [1.5]], dtype=np.float32)
    groups = np.array([0, 0, 1, 0])
    sensors = np.array([[0, 0, 0], [0.5, 0, 0], [0, 0, 0], [11, 0, 0]], dtype=np.float32)
    plain = retrieval.retrieve(descriptors, groups)
    crossed = retrieval.retrieve(descriptors, groups, retrieval.seen_within(sensors, 10.0))
    assert plain.right.tolist() == [True, True, False, False]
    assert crossed.right.tolist() == [False, False, False, False]
    assert crossed.has_mate.tolist() == [True, True, False, True]
    # Near mates are gone, not turned into strangers: without segment 2, segment 3 is found.
    keep = np.array([0, 1, 3])
    alone = retrieval.retrieve(
        descriptors[keep], groups[keep], retrieval.seen_within(sensors[keep], 10.0)
    )
    assert alone.right.tolist() == [True, True, True]


def test_mates_exactly_ten_meters_away_are_left_out() -> None:
    sensors = np.array([[0, 0, 0], [10, 0, 0]], dtype=np.float32)
    pair = retrieval.retrieve(
        np.zeros((2, 1), np.float32), np.zeros(2, int), retrieval.seen_within(sensors, 10.0)
    )
    assert not pair.has_mate.any()


def test_recall_looks_at_twenty_five_and_no_more() -> None:
    # The mate of segment 0 stands behind 24 strangers (found), then behind 25 (not found).
    for strangers, found in ((24, True), (25, False)):
        descriptors = np.arange(strangers + 2, dtype=np.float32)[:, None]
        groups = np.array([0, *range(1, strangers + 1), 0])
        assert retrieval.retrieve(descriptors, groups).recalled[0] == found


@pytest.mark.parametrize("count", [0, 1])
def test_set_without_mates_raises_no_error(count: int) -> None:
    found = retrieval.retrieve(np.zeros((count, 3), np.float32), np.zeros(count, np.int64))
    assert not found.right.any()


def test_pairs_are_of_one_group_or_of_two_and_never_one_segment() -> None:
    groups = np.array([0, 0, 0, 1, 1, 2, 3])
    positive, negative = retrieval.draw_pairs(groups, 5000, np.random.default_rng(0))
    assert (groups[positive[:, 0]] == groups[positive[:, 1]]).all()
    assert (positive[:, 0] != positive[:, 1]).all()
    assert (groups[negative[:, 0]] != groups[negative[:, 1]]).all()
    assert len(positive) == len(negative) == 5000
    # Groups are drawn uniformly, whatever their size: half of the positives are of group 1.
    assert (groups[positive[:, 0]] == 1).mean() == pytest.approx(0.5, abs=0.03)
    # Within a group every ordered pair is as likely as another.
    in_first = positive[groups[positive[:, 0]] == 0]
    assert len(np.unique(in_first, axis=0)) == 6


def test_draw_pairs_returns_no_pairs_if_there_are_none() -> None:
    positive, negative = retrieval.draw_pairs(np.array([0, 1]), 10, np.random.default_rng(0))
    assert positive.shape == (0, 2)
    assert len(negative) == 10
    positive, negative = retrieval.draw_pairs(np.array([0, 0]), 10, np.random.default_rng(0))
    assert len(positive) == 10
    assert negative.shape == (0, 2)


def test_area_under_roc_by_hand_with_a_tie() -> None:
    # Of 2 x 2 comparisons: 3 > 1, 3 > 2, 2 > 1, and one tie.
    area = retrieval.area_under_roc(np.array([3.0, 2.0]), np.array([1.0, 2.0]))
    assert area == pytest.approx(3.5 / 4)


def test_threshold_and_accuracy_by_hand() -> None:
    near, far = np.array([0.1, 0.2, 0.9]), np.array([0.5, 0.8, 1.0])
    threshold = retrieval.best_threshold(near, far)
    assert 0.2 < threshold < 0.5
    assert retrieval.accuracy_at(threshold, near, far) == pytest.approx(5 / 6)
    assert retrieval.accuracy_at(0.95, near, far) == pytest.approx((1 + 1 / 3) / 2)


def test_nearest_pairs_by_hand() -> None:
    descriptors = np.array([[0.0], [1.0], [1.5], [5.0]], dtype=np.float32)
    groups = np.array([0, 1, 0, 1])
    matches, others = retrieval.nearest_pairs(descriptors, groups, np.array([0, 3]), candidates=2)
    assert sorted(map(tuple, matches)) == [(0, 2), (3, 1)]
    assert sorted(map(tuple, others)) == [(0, 1), (3, 2)]


def test_views_from_one_side_are_too_easy_across_north() -> None:
    bearings = np.radians([179.0, -179.0, 90.0])
    too_easy = retrieval.seen_from_angle(bearings, 10.0)
    assert too_easy(np.array([0, 2])).tolist() == [[True, True, False], [False, False, True]]


def test_queries_may_be_other_descriptors_of_the_same_segments() -> None:
    descriptors = np.array([[0.0], [1.0], [5.0], [6.0]], dtype=np.float32)
    queries = np.array([[5.2], [0.2], [6.4], [4.0]], dtype=np.float32)
    found = retrieval.retrieve(descriptors, np.array([0, 0, 1, 1]), queries=queries)
    assert found.nearest.tolist() == [2, 0, 3, 2]
    assert found.right.tolist() == [False, True, True, True]


# Capture 0 and capture 1 see objects 0, 1, 2. Capture 2 sees look-alikes, which stand differently.
LOOKS = np.array([0.0, 10.0, 20.0, 1.2, 11.2, 21.2, -1.0, 9.0, 19.0], dtype=np.float32)[:, None]
GROUPS = np.array([0, 1, 2, 0, 1, 2, 3, 4, 5])
CAPTURES = np.array([0, 0, 0, 1, 1, 1, 2, 2, 2])
SCENE = np.array([[0.0, 0, 0], [5, 0, 0], [0, 7, 0]])
CENTROIDS = np.concatenate([SCENE, SCENE + 0.1, [[90.0, 0, 0], [99, 0, 0], [90, 14, 0]]])


def test_reranking_finds_the_candidate_whose_neighbors_are_right() -> None:
    found = retrieval.retrieve(LOOKS, GROUPS)
    assert found.candidates[0, :2].tolist() == [6, 3]
    assert found.distances[0, :2].tolist() == pytest.approx([1.0, 1.2])
    assert not found.right[:3].any()
    right = retrieval.reranked(found, GROUPS, CENTROIDS, CAPTURES)
    assert right.tolist() == [True] * 6 + [False] * 3
    # Segments that no capture saw together have no neighbors.
    apart = retrieval.reranked(found, GROUPS, CENTROIDS, np.arange(9))
    assert apart.tolist() == found.right.tolist()


def test_reranking_leaves_out_the_same_mates() -> None:
    near = retrieval.seen_within(np.zeros((9, 3), dtype=np.float32), 10.0)
    found = retrieval.retrieve(LOOKS, GROUPS, near)
    assert not found.has_mate.any()
    assert (found.candidates[:, -3:] == -1).all()
    assert np.isinf(found.distances[:, -3:]).all()
    assert not retrieval.reranked(found, GROUPS, CENTROIDS, CAPTURES).any()


@pytest.mark.parametrize("count", [0, 1])
def test_reranking_of_too_few_segments_finds_nothing(count: int) -> None:
    found = retrieval.retrieve(LOOKS[:count], GROUPS[:count])
    right = retrieval.reranked(found, GROUPS[:count], CENTROIDS[:count], CAPTURES[:count])
    assert right.tolist() == [False] * count
