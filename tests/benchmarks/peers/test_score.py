from typing import Any

import numpy as np
import pytest

from benchmarks.peers.exchange import NOTHING, Estimate, Peer, PeerAnswer
from benchmarks.peers.score import outcome_of, score_peer
from tests.placecell.segment_builders import pose

PEER = Peer("somebody", {"voxel": 0.3}, {"numpy": "2"}, 1.5)


def answer(
    x: float = 0.0, degrees: float = 0.0, *, sure: bool = True, value: float = 0
) -> PeerAnswer:
    return PeerAnswer(Estimate(pose(x, yaw=np.radians(degrees)), value, sure), 10.0)


def scored(answers: list[PeerAnswer], mapped: list[bool] | None = None) -> dict[str, Any]:
    """Return the outcome of an answer if the true pose is the identity."""
    within = np.array(mapped or [True] * len(answers))
    return score_peer(PEER, answers, np.stack([np.eye(4)] * len(answers)), within)


def test_errors_equal_those_computed_by_hand() -> None:
    true = pose(1.0, 2.0, 3.0, yaw=np.pi)
    there = outcome_of(PeerAnswer(Estimate(true, 1, sure=True), 7.0), true, mapped=True)
    assert (there.meters, there.degrees) == pytest.approx((0, 0), abs=1e-9)
    assert (there.localized, there.right, there.milliseconds) == (True, True, 7.0)
    off = Estimate(pose(1.0, -1.0, 7.0, yaw=0.1 - np.pi), 1, sure=False)
    found = outcome_of(PeerAnswer(off, 1.0), true, mapped=False)
    assert (found.meters, found.degrees) == pytest.approx((5, np.degrees(0.1)))
    assert not found.localized
    nothing = outcome_of(PeerAnswer(NOTHING, 1.0), true, mapped=True)
    assert (nothing.meters, nothing.degrees) == (np.inf, np.inf)
    assert not nothing.localized
    assert not nothing.wrong_but_sure


def test_tilt_counts_as_error() -> None:
    tilted = np.eye(4)
    tilted[1:3, 1:3] = [[np.cos(0.2), -np.sin(0.2)], [np.sin(0.2), np.cos(0.2)]]
    found = outcome_of(PeerAnswer(Estimate(tilted, 1, sure=True), 1.0), np.eye(4), mapped=True)
    assert found.degrees == pytest.approx(np.degrees(0.2))
    assert found.wrong_but_sure


def test_shares_equal_those_computed_by_hand() -> None:
    answers = [
        answer(0.9, value=9),
        answer(0.9, 2.9, value=5),
        answer(0.9, 2.9, value=8, sure=False),  # right, but not accepted by the peer's rule
        answer(1.1, value=7),  # neither right nor wrong
        answer(0.0, 5.0, value=7),
        answer(3.1, value=6),
        answer(0.0, 11.0, value=4),
        answer(50.0, value=6.5, sure=False),
        PeerAnswer(NOTHING, 30.0),
        PeerAnswer(NOTHING, 30.0),
    ]
    figures = scored(answers)
    assert figures["queries"] == 10
    assert figures["localised_right"] == 0.2
    assert figures["wrong_but_sure"] == 0.2
    assert figures["not_localised"] == 0.4
    assert figures["counts"] == {"localised_right": 2, "wrong_but_sure": 2, "not_localised": 4}
    assert figures["by_score"][0] == {"score": 4, "right": 0.3, "wrong": 0.3}
    assert figures["by_score"][2] == {"score": 6, "right": 0.2, "wrong": 0.2}
    assert figures["by_score"][-1] == {"score": 9, "right": 0.1, "wrong": 0}
    assert figures["right_above_all_wrong"] == 0.2  # the scores 9 and 8, above 6.5
    assert figures["median_position_error_m"] == pytest.approx(0.9)
    assert figures["median_yaw_error_deg"] == pytest.approx(1.45)
    assert (figures["p50_ms"], figures["p99_ms"]) == (10.0, 30.0)
    assert (figures["name"], figures["settings"]) == ("somebody", {"voxel": 0.3})


def test_error_at_the_tolerance_is_right() -> None:
    at_limit = scored([answer(1.0), answer(3.0, 10.0)])
    assert (at_limit["localised_right"], at_limit["wrong_but_sure"]) == (0.5, 0)


def test_bounds_are_those_of_the_binomial_distribution() -> None:
    figures = scored([answer() for _ in range(100)])
    # The upper bound of 0 of 100 is 1 - 0.025 ** (1 / 100).
    assert figures["bounds_95"]["wrong_but_sure"] == [0, 0.03622]
    assert figures["bounds_95"]["localised_right"] == [1 - 0.03622, 1]


def test_peer_without_any_pose_has_no_errors() -> None:
    figures = scored([PeerAnswer(NOTHING, 5.0)])
    assert figures["not_localised"] == 1
    assert figures["median_position_error_m"] is None
    assert figures["right_above_all_wrong"] == 0
    assert figures["by_score"] == []


def test_queries_beyond_the_map_are_counted_apart() -> None:
    answers = [answer(value=5), answer(50.0, value=9), PeerAnswer(NOTHING, 1.0)]
    figures = scored(answers, [True, False, False])
    assert (figures["queries"], figures["localised_right"]) == (1, 1)
    assert figures["right_above_all_wrong"] == 1
    beyond = figures["beyond_the_map"]
    assert (beyond["queries"], beyond["wrong_but_sure"], beyond["not_localised"]) == (2, 0.5, 0.5)
    nowhere = scored(answers, [False] * 3)
    assert nowhere["localised_right"] is None
    assert nowhere["bounds_95"]["localised_right"] == [0, 1]
    assert nowhere["right_above_all_wrong"] is None


@pytest.mark.parametrize("count", [1, 2, 19, 20, 21, 300])
def test_score_thresholds_are_spread_over_all_scores(count: int) -> None:
    rows = scored([answer(value=value) for value in range(count)])["by_score"]
    assert len(rows) == min(count, 20)
    assert (rows[0]["score"], rows[-1]["score"]) == (0, count - 1)
    assert rows[0]["right"] == 1
