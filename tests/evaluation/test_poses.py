"""Figures of `evaluate-poses` equal those computed by hand; drives need a common frame."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from evaluation.poses.evaluate import outcome_of, row_of
from evaluation.poses.queries import Pair, PoseQuery, joined, random_frame, spread
from evaluation.poses.report import (
    Outcome,
    best_pose_shares,
    bounds,
    calibration,
    precision_recall,
    reliability_of,
    report,
    shares,
    until_localized,
)
from placecell.localization import Pose, localize
from tests.client.map_builders import random_map
from tests.placecell.localization.scene_builders import scene
from tests.placecell.segment_builders import pose, write_odometry


def outcome(
    meters: float = 0.1,
    degrees: float = 0.1,
    probability: float = 0.99,
    reason: str = "",
    driven: float = 0.0,
    mapped: bool = True,
) -> Outcome:
    return Outcome(reason, probability, meters, degrees, 3.0, 5.0, driven, mapped)


RIGHT = outcome()
ASIDE = outcome(meters=2.0)
"""Neither right nor off."""
OFF = outcome(meters=30.0)
TURNED = outcome(degrees=11.0)
DOUBTFUL = outcome(meters=30.0, probability=0.6)
UNKNOWN = outcome(meters=0.2, probability=0.4, reason="ambiguous")
LOST = outcome(np.inf, np.inf, 0.0, "inconsistent")


def test_outcomes_are_right_wrong_but_sure_or_not_localized() -> None:
    told = shares([RIGHT, ASIDE, OFF, TURNED, DOUBTFUL, UNKNOWN, LOST, RIGHT])
    assert told["queries"] == 8
    assert told["counts"] == {"localised_right": 2, "wrong_but_sure": 2, "not_localised": 2}
    assert told["localised_right"] == 0.25
    # Not told, so nobody is misled.
    assert not outcome(meters=30.0, reason="ambiguous").wrong_but_sure


@pytest.mark.parametrize(
    ("meters", "degrees", "right"),
    [(1.0, 3.0, True), (1.01, 0.0, False), (0.0, 3.01, False)],
)
def test_right_is_within_a_meter_and_three_degrees(
    meters: float, degrees: float, right: bool
) -> None:
    assert outcome(meters, degrees).right is right


def test_best_poses_count_whether_they_are_told_or_not() -> None:
    wide = outcome(meters=2.0, degrees=5.0)
    told = best_pose_shares([RIGHT, RIGHT, RIGHT, UNKNOWN, wide, OFF, TURNED, LOST])
    assert told == {
        "best_pose_right": 4 / 8,
        "told_share_of_right": 3 / 4,
        "success_1m_3deg": 3 / 8,
        "success_2m_5deg": 4 / 8,
        "best_pose_2m_5deg": 5 / 8,
    }


def test_best_poses_without_queries_are_undefined() -> None:
    assert set(best_pose_shares([]).values()) == {None}
    told = best_pose_shares([LOST])
    assert (told["best_pose_right"], told["told_share_of_right"]) == (0.0, None)


def test_calibration_of_best_poses_by_hand() -> None:
    stated = [
        outcome(probability=0.95),
        outcome(meters=9, probability=0.95),
        outcome(probability=0.4, reason="inconsistent"),
        outcome(meters=9, probability=0.0, reason="inconsistent", mapped=False),
        LOST,  # states no probability
    ]
    told = calibration(stated)
    # Bins: 0.9 to 1 (two, half of them right), 0.4 to 0.5 (one, right), 0 to 0.1 (one, wrong).
    assert told["expected_calibration_error"] == pytest.approx((2 * 0.45 + 0.6 + 0.0) / 4)
    assert told["brier"] == pytest.approx((0.05**2 + 0.95**2 + 0.6**2 + 0.0) / 4)
    assert calibration([LOST]) == {"expected_calibration_error": None, "brier": None}


def test_bounds_are_those_of_the_binomial_distribution() -> None:
    low, high = bounds(3, 50)
    assert stats.binom.sf(2, 50, low) == pytest.approx(0.025, abs=1e-3)
    assert stats.binom.cdf(3, 50, high) == pytest.approx(0.025, abs=1e-3)
    # The rule of three, nearly: 1 - 0.025 ** (1 / n).
    assert bounds(0, 3000) == pytest.approx([0, 0.00123], abs=1e-5)
    assert bounds(4, 4)[1] == 1
    assert bounds(0, 0) == [0, 1]


def test_precision_and_recall_by_hand() -> None:
    rows = {row["probability"]: row for row in precision_recall([RIGHT, OFF, DOUBTFUL, UNKNOWN])}
    assert rows[0.5]["precision"] == pytest.approx(1 / 3, abs=1e-4)
    assert rows[0.9]["precision"] == 0.5
    assert rows[0.9]["recall"] == 0.25
    assert 0.995 not in rows  # nobody was as sure


def test_reliability_compares_stated_with_true() -> None:
    stated = np.array([0.05, 0.15, 0.11, 0.97, 0.992, 1.0])
    right = np.array([False, True, False, True, True, False])
    assert reliability_of(stated, right) == [
        {"stated": 0.05, "right": 0.0, "count": 1},
        {"stated": 0.13, "right": 0.5, "count": 2},
        {"stated": 0.97, "right": 1.0, "count": 1},
        {"stated": 0.996, "right": 0.5, "count": 2},
    ]


def test_meters_until_localized_from_each_start() -> None:
    way = [
        outcome(meters=30, driven=0.0),
        replace(UNKNOWN, driven=2.0),
        replace(RIGHT, driven=5.0),
        replace(LOST, driven=6.0),
    ]
    # 5 m, 3 m and none; from the last start never.
    assert until_localized(way) == {"median": 3.0, "p95": 4.8, "never": 1}
    assert until_localized([LOST]) == {"median": None, "p95": None, "never": 1}


def test_queries_beyond_the_map_are_counted_apart() -> None:
    told = report([RIGHT, RIGHT, LOST, outcome(mapped=False), replace(LOST, mapped=False)])
    assert told["queries"] == 3
    assert told["localised_right"] == pytest.approx(2 / 3, abs=1e-5)
    assert told["beyond_the_map"]["queries"] == 2
    assert told["reasons"] == {"inconsistent": 1}
    assert told["median_position_error_m"] == 0.1
    assert told["p50_ms"] == told["p99_ms"] == 5.0
    assert told["covariance_ratio"] == pytest.approx(3 / stats.chi2.median(4), abs=1e-4)
    assert sum(row["count"] for row in told["reliability"]) == 5
    # Shares are of the mapped area; the calibration also has the queries beyond the map.
    assert told["best_pose_right"] == pytest.approx(2 / 3, abs=1e-5)
    assert told["expected_calibration_error"] == pytest.approx(0.01)
    json.dumps(told, allow_nan=False)


def test_pose_error_is_measured_at_the_sensor() -> None:
    made = scene(1)
    found = localize(made.candidates)
    sensor = made.candidates.centroids.mean(axis=0)
    told = outcome_of(found, query(made.pose, sensor), 5.0)
    assert told.localized
    assert told.meters < 0.2
    assert 0 < told.normalized < 50
    # A truth that lies 2 m to the east.
    aside = Pose.of_yaw(0, np.array([2.0, 0, 0])).after(made.pose)
    assert outcome_of(found, query(aside, sensor), 5.0).meters == pytest.approx(2, abs=0.2)
    lost = localize(scene(2, found=0.0).candidates)
    told = outcome_of(lost, query(made.pose, sensor), 5.0)
    assert told.reason
    assert np.isnan(told.normalized)


@pytest.mark.parametrize(
    "deviations",
    [(0.1, 0.2, 0.3, 0.01), (0.1, 0.2, 0.3, 5.0, 7.0, 0.01)],
    ids=["yaw", "se3"],
)
def test_error_is_normalized_by_the_stated_covariance(deviations: tuple[float, ...]) -> None:
    found = localize(scene(1).candidates)
    assert found.best is not None
    pose, sensor = Pose.of_yaw(0.5, np.array([10.0, 20.0, 0.0])), np.zeros(3)
    stated = np.diag(np.square(deviations))
    told = replace(found, best=replace(found.best, pose=pose, covariance=stated))
    # Off by one deviation east, two north, none in height and three of yaw: 1 + 4 + 9.
    true = Pose.of_yaw(0.5 + 0.03, np.array([10.1, 20.4, 0.0]))
    assert outcome_of(told, query(true, sensor), 5.0).normalized == pytest.approx(14)


def query(truth: Pose, sensor: np.ndarray) -> PoseQuery:
    return PoseQuery(
        8, 0.0, 0.0, np.zeros((1, 2), np.int8), np.zeros((1, 3)), sensor, truth, mapped=True
    )


def test_row_of_a_query_is_valid_json() -> None:
    truth = Pose.of_yaw(np.pi / 2, np.array([10.0, 0, 0]))
    row = row_of(query(truth, np.array([1.0, 0, 0])), LOST)
    assert (row["scan"], row["segments"], row["position"]) == (8, 1, [10.0, 1.0, 0.0])
    assert (row["reason"], row["metres"], row["probability"]) == ("inconsistent", None, 0.0)
    json.dumps(row, allow_nan=False)


@given(st.integers(1, 500), st.integers(1, 600))
def test_chosen_queries_are_spread_evenly(count: int, most: int) -> None:
    chosen = spread(count, most)
    assert len(set(chosen.tolist())) == min(count, most)
    assert chosen[0] == 0
    if len(chosen) > 1:
        assert chosen[-1] == count - 1
        assert np.ptp(np.diff(chosen)) <= 1
    np.testing.assert_array_equal(spread(count), np.arange(count))


def test_random_frame_has_any_yaw_and_position() -> None:
    frames = [random_frame(seed) for seed in range(20)]
    assert np.ptp([frame.yaw for frame in frames]) > 4
    np.testing.assert_array_equal(random_frame(3).matrix, random_frame(3).matrix)


def test_maps_are_joined_side_by_side() -> None:
    one, other = random_map(), random_map(seed=2)
    both = joined([one, other], [np.zeros(3), np.array([100.0, 0, 0])])
    both.check()
    assert len(both) == len(one) + len(other)
    np.testing.assert_allclose(both.centroids[len(one) :], other.centroids + (100.0, 0, 0))
    positions = both.frame_positions[both.frame_index]
    expected = other.frame_positions[other.frame_index] + (100.0, 0, 0)
    np.testing.assert_allclose(positions[len(one) :], expected)


def test_two_recorded_drives_have_no_common_frame(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_odometry(tmp_path / name, [np.ones((9, 3))] * 2, [pose(), pose(1.0)])
    with pytest.raises(ValueError, match=r"origin\.txt"):
        Pair.of(tmp_path / "a", tmp_path / "b")
