"""Calibration figures equal those computed by hand."""

import numpy as np
import pytest

from evaluation.calibration import brier, calibration_figures, expected_calibration_error
from evaluation.recognition.evaluate import candidate_calibration


def test_brier_score_by_hand() -> None:
    assert brier(np.array([0.9, 0.2]), np.array([True, True])) == pytest.approx(
        (0.1**2 + 0.8**2) / 2
    )


def test_probability_of_one_is_in_the_last_bin() -> None:
    error, points = expected_calibration_error(np.array([0.9, 1.0]), np.array([True, False]))
    assert points == [(0.95, 0.5, 2)]
    assert error == pytest.approx(0.45)


def test_calibration_of_nothing_is_undefined() -> None:
    nothing = calibration_figures(np.zeros(0), np.zeros(0))
    assert nothing == {"expected_calibration_error": None, "brier": None}


def _stated(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """State a tenth of the sum of two codes as probability."""
    return np.asarray((one[:, 0] + other[:, 0]) / 10)


def test_calibration_of_candidate_pairs_by_hand() -> None:
    codes = np.array([[4], [5], [2], [0]], dtype=np.int8)
    matches, others = np.array([[0, 1]]), np.array([[0, 2], [2, 3]])
    told = candidate_calibration(_stated, codes, matches, others)
    # Stated 0.9, 0.6 and 0.2; only the first pair is a match.
    assert told["expected_calibration_error"] == pytest.approx((0.1 + 0.6 + 0.2) / 3)
    assert told["brier"] == pytest.approx((0.1**2 + 0.6**2 + 0.2**2) / 3)
    assert told["candidate_calibration_error"] == told["expected_calibration_error"]
    none = np.zeros((0, 2), dtype=np.int64)
    assert set(candidate_calibration(_stated, codes, none, none).values()) == {None}
