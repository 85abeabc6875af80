"""Score of the demo, compared with values computed by hand."""

import numpy as np
import pytest

from demo.score import score
from evaluation.poses.robot import Answer


def answer(centroid: list[float], *candidates: list[float]) -> Answer:
    return Answer(np.array(centroid), np.array(candidates).reshape(-1, 3), np.zeros(3))


def test_candidate_within_one_and_a_half_meters_is_right() -> None:
    # The map's frame lies 100 m east of the common one.
    to_common = np.eye(4)
    to_common[0, 3] = 100.0
    mapped = np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0]])
    answers = [
        answer([100.0, 1.4, 0.0], [0.0, 0.0, 0.0]),  # right at once
        answer([120.0, 0.0, 0.0], [0.0, 0.0, 0.0], [20.0, 0.0, 0.0]),  # right second
        answer([100.0, 0.0, 0.0], [20.0, 0.0, 0.0]),  # never right
        answer([150.0, 0.0, 0.0], [20.0, 0.0, 0.0]),  # not in the map: not counted
    ]
    result = score(answers, mapped, to_common)
    assert result.queries == 4
    assert result.findable == 3
    assert result.chance == pytest.approx(1 / 2)
    assert not result.recognized
    assert result.right == pytest.approx({1: 1 / 3, 5: 2 / 3, 25: 2 / 3})
    assert result.first_is_right.tolist() == [True, False, False, False]


def test_query_without_candidates_is_wrong_and_no_findable_query_gives_no_shares() -> None:
    nothing = score([answer([0.0, 0.0, 0.0])], np.array([[50.0, 0.0, 0.0]]), np.eye(4))
    assert nothing.findable == 0
    assert nothing.right == {}
    missed = score([answer([0.0, 0.0, 0.0])], np.array([[1.0, 0.0, 0.0]]), np.eye(4))
    assert missed.right[25] == 0.0


def test_score_is_recognized_if_far_better_than_chance() -> None:
    mapped = np.stack([np.arange(0.0, 100.0, 10.0), np.zeros(10), np.zeros(10)], axis=1)
    right = [answer([10.0 * at, 0.0, 0.0], [10.0 * at, 0.0, 0.0]) for at in range(4)]
    wrong = [answer([10.0 * at, 0.0, 0.0], [90.0, 0.0, 0.0]) for at in range(4, 9)]
    assert score(right + wrong, mapped, np.eye(4)).recognized  # 4 of 9 against 1 of 10
    assert not score(right[:2] + wrong, mapped, np.eye(4)).recognized  # 2 of 7
