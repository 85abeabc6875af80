"""The number of false alarms of a pose."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.localization import Candidates, Pose
from placecell.localization.chance import (
    CELL,
    THRESHOLDS,
    area_of,
    log_false_alarms,
    p_values,
    surprise,
)
from tests.placecell.localization.scene_builders import a_pose, scene, take

HERE = Pose.of_yaw(0.0, np.zeros(3))
NAN = float("nan")


def candidates_of(
    centroids: list[list[float]], rows: list[list[int]], places: list[list[list[float]]],
    probabilities: list[list[float]],
) -> Candidates:  # fmt: skip
    return Candidates(
        np.array(centroids, float), np.array(rows), np.array(places, float), np.array(probabilities)
    )


def test_p_values_by_hand() -> None:
    found = candidates_of(
        [[0, 0, 0], [10, 0, 0], [20, 0, 0], [30, 0, 0]],
        [[1, 2], [3, 4], [5, 6], [7, 8]],
        [
            [[1, 0, 0], [0, 0.2, 0]],  # rank 2 at 1 m, rank 1 at 0.2 m, which counts as 0.5 m
            [[50, 0, 0], [10, 1, 0]],  # rank 2 at 1 m
            [[20, 1.6, 0], [20, 0, 1.6]],  # not in the gate: horizontally, vertically
            [[NAN, 0, 0], [30, 0, 0]],  # probability 0
        ],
        [[0.2, 0.7], [0.6, 0.1], [0.5, 0.5], [0.5, 0.0]],
    )
    values = np.sort(p_values(HERE, found, area=1000.0))
    expected = [1 * np.pi * 0.25 / 1000, 2 * np.pi * 1.0 / 1000]
    assert values.tolist() == pytest.approx(expected)


def test_map_segment_counts_for_one_query() -> None:
    found = candidates_of(
        [[0, 0, 0], [1, 0, 0]], [[7], [7]], [[[0, 0, 0]], [[0, 0, 0]]], [[0.5], [0.5]]
    )
    assert p_values(HERE, found, 100.0).tolist() == pytest.approx([np.pi * 0.25 / 100])


def test_area_is_that_of_the_cells_with_candidates() -> None:
    found = candidates_of(
        [[0, 0, 0]],
        [[1, 2, 3, 4]],
        [[[1, 1, 0], [2, 2, 9], [1 + CELL, 1, 0], [500, 0, 0]]],
        [[0.5, 0.5, 0.5, 0.0]],
    )
    assert area_of(found) == 2 * CELL**2


def test_false_alarms_by_hand() -> None:
    # Two of four queries have 0.005 or less; of the thresholds above it, 0.01 is the smallest.
    found = log_false_alarms(np.array([0.005, 0.005]), 4, poses=100.0)
    divergence = 0.5 * np.log(0.5 / 0.01) + 0.5 * np.log(0.5 / 0.99)
    assert found == pytest.approx(np.log(100 * len(THRESHOLDS)) - 4 * divergence)


def test_support_no_better_than_chance_is_no_evidence() -> None:
    assert log_false_alarms(np.zeros(0), 4, 100.0) == np.log(100 * len(THRESHOLDS))
    # One of ten queries at 0.2: fewer than the three that are expected.
    assert log_false_alarms(np.array([0.2]), 10, 100.0) == np.log(100 * len(THRESHOLDS))


@given(st.lists(st.floats(1e-6, 1), min_size=1, max_size=20), st.integers(0, 30))
def test_more_agreement_never_makes_false_alarms_more_likely(
    values: list[float], others: int
) -> None:
    queries = len(values) + others
    less = log_false_alarms(np.array(values[1:]), queries, 100.0)
    assert log_false_alarms(np.array(values), queries, 100.0) <= less + 1e-9


def test_bound_is_not_below_the_binomial_tail() -> None:
    from scipy.stats import binom

    for k in range(1, 11):
        found = log_false_alarms(np.full(k, 0.03), 10, 1 / len(THRESHOLDS))
        assert found >= min(binom.logsf(k - 1, 10, t) for t in THRESHOLDS[:3]) - 1e-9


@pytest.mark.parametrize("seed", range(5))
def test_right_pose_is_surprising_and_a_wrong_one_is_not(seed: int) -> None:
    made = scene(seed)
    assert surprise(made.pose, made.candidates) > 20
    wrong = a_pose(np.random.default_rng(seed + 100))
    assert surprise(wrong, made.candidates) < 0


def test_order_of_the_queries_changes_nothing() -> None:
    made = scene(3)
    order = np.random.default_rng(0).permutation(len(made.candidates))
    shuffled = take(made.candidates, order)
    assert surprise(made.pose, shuffled) == pytest.approx(surprise(made.pose, made.candidates))


def test_no_candidates_are_no_evidence() -> None:
    empty = candidates_of([[0, 0, 0]], [[1]], [[[NAN, 0, 0]]], [[0.5]])
    assert surprise(HERE, empty) == 0
