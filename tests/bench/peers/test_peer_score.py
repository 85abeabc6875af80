import numpy as np
import pytest

from bench.peers.exchange import NOTHING, Answer, Estimate, Peer
from bench.peers.score import errors, score
from tests.segments.segment_builders import pose

PEER = Peer("somebody", {"voxel": 0.3}, {"numpy": "2"}, 1.5)


def answer(x: float = 0.0, degrees: float = 0.0, *, sure: bool = True, value: float = 0) -> Answer:
    return Answer(Estimate(pose(x, yaw=np.radians(degrees)), value, sure), 10.0)


def test_errors_by_hand() -> None:
    truth = np.stack([pose(1.0, 2.0, 3.0, yaw=np.pi)] * 3)
    there = Answer(Estimate(pose(1.0, 2.0, 3.0, yaw=-np.pi), 1, sure=True), 1)
    off = Answer(Estimate(pose(1.0, -1.0, 7.0, yaw=np.pi - 0.1), 1, sure=True), 1)
    metres, degrees = errors([there, off, Answer(NOTHING, 1)], truth)
    assert metres.tolist() == [0, 5, np.inf]
    assert degrees == pytest.approx([0, np.degrees(0.1), np.inf], abs=1e-6)


def test_a_tilt_counts_too() -> None:
    tilted = np.eye(4)
    tilted[1:3, 1:3] = [[np.cos(0.2), -np.sin(0.2)], [np.sin(0.2), np.cos(0.2)]]
    _, degrees = errors([Answer(Estimate(tilted, 1, sure=True), 1)], np.eye(4)[None])
    assert degrees == pytest.approx([np.degrees(0.2)])


def test_shares_by_hand() -> None:
    answers = [
        answer(0.9, value=9),
        answer(0.9, 2.9, value=5),
        answer(0.9, 2.9, value=8, sure=False),  # right, but its rule does not accept it
        answer(1.1, value=7),  # neither right nor wrong
        answer(0.0, 5.0, value=7),
        answer(3.1, value=6),
        answer(0.0, 11.0, value=4),
        answer(50.0, value=6.5, sure=False),
        Answer(NOTHING, 30.0),
        Answer(NOTHING, 30.0),
    ]
    figures = score(PEER, answers, np.stack([np.eye(4)] * 10))
    assert figures["queries"] == 10
    assert figures["localised_right"] == 0.2
    assert figures["wrong_but_sure"] == 0.2
    assert figures["not_localised"] == 0.4
    assert figures["right_if_all_accepted"] == 0.3
    assert figures["wrong_if_all_accepted"] == 0.3
    assert figures["right_above_all_wrong"] == 0.2  # the scores 9 and 8, above 6.5
    assert figures["median_position_error_m"] == pytest.approx(0.9)
    assert figures["median_yaw_error_deg"] == pytest.approx(1.45)
    assert (figures["p50_ms"], figures["p99_ms"]) == (10.0, 30.0)
    assert (figures["name"], figures["settings"]) == ("somebody", {"voxel": 0.3})


def test_limits_are_inclusive() -> None:
    at_limit = score(PEER, [answer(1.0), answer(3.0, 10.0)], np.stack([np.eye(4)] * 2))
    assert (at_limit["localised_right"], at_limit["wrong_but_sure"]) == (0.5, 0)


def test_bounds_are_those_of_the_binomial_distribution() -> None:
    figures = score(PEER, [answer() for _ in range(100)], np.stack([np.eye(4)] * 100))
    # None of a hundred: 1 - 0.025 ** (1 / 100).
    assert figures["wrong_but_sure_95"] == pytest.approx([0, 0.0362167])
    assert figures["localised_right_95"] == pytest.approx([1 - 0.0362167, 1])


def test_a_peer_that_says_nothing() -> None:
    figures = score(PEER, [Answer(NOTHING, 5.0)], np.eye(4)[None])
    assert figures["not_localised"] == 1
    assert figures["median_position_error_m"] is None
    assert figures["right_above_all_wrong"] == 0
