"""Acceptance of poses by conformal risk control."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.localization.acceptance import KEPT, Acceptance
from placecell.localization.confidence import FEATURES, SHIPPED, Confidence

NINE = Acceptance(9, (0.9, 0.6, 0.2))
"""Nine queries, three of them with false poses."""


@pytest.mark.parametrize(
    ("risk", "threshold"),
    [(0.1, 0.9), (0.19, 0.9), (0.2, 0.6), (0.3, 0.2), (0.4, 0.0), (0.5, 0.0)],
)
def test_threshold_by_hand(risk: float, threshold: float) -> None:
    # (k + 1) / (9 + 1) <= risk: none of the false poses for 0.1, one for 0.2, two for 0.3.
    assert NINE.threshold(risk) == threshold


def test_smallest_risk_allows_no_false_pose() -> None:
    assert NINE.smallest_risk == 0.1
    assert NINE.threshold(NINE.smallest_risk) == max(NINE.false)


def test_risk_below_the_calibration_is_refused_with_the_smallest() -> None:
    with pytest.raises(ValueError, match=r"0\.05: the model's 9 calibration queries support 0\.1"):
        NINE.threshold(0.05)


@pytest.mark.parametrize("risk", [0.0, -0.1, 0.51, float("nan"), float("inf")])
def test_risk_out_of_range_is_refused(risk: float) -> None:
    with pytest.raises(ValueError, match="expected more than 0 and at most"):
        NINE.threshold(risk)


probabilities = st.lists(st.floats(0, 1), max_size=30)


@given(probabilities, st.integers(0, 50), st.floats(0.001, 0.5), st.floats(0.001, 0.5))
def test_larger_risk_never_has_a_larger_threshold(
    false: list[float], right: int, one: float, other: float
) -> None:
    least, most = sorted((one, other))
    values = np.array([*false, *[1.0] * right])
    made = Acceptance.of(values, np.arange(len(values)) < len(false))
    if least >= made.smallest_risk:
        assert made.threshold(most) <= made.threshold(least)


@given(probabilities, st.integers(0, 50), st.floats(0.001, 0.5))
def test_false_share_with_the_correction_is_at_most_the_risk(
    false: list[float], right: int, risk: float
) -> None:
    values = np.array([*false, *[1.0] * right])
    made = Acceptance.of(values, np.arange(len(values)) < len(false))
    if risk >= made.smallest_risk:
        accepted = sum(each > made.threshold(risk) for each in false)
        assert (accepted + 1) / (len(values) + 1) <= risk * (1 + 1e-9)


def test_a_further_query_is_falsely_accepted_at_most_at_the_risk() -> None:
    random = np.random.default_rng(0)
    risk, accepted = 0.05, []
    for _ in range(3_000):
        values, false = random.uniform(size=60), random.uniform(size=60) < 0.3
        made = Acceptance.of(values[1:], false[1:])
        accepted.append(false[0] and values[0] > made.threshold(risk))
    # Standard deviation of the mean: 0.004.
    assert np.mean(accepted) <= risk + 0.012


def test_each_sensor_alone_keeps_the_risk() -> None:
    # Pooled, one false pose in 40 is allowed at 0.05; of the 20 queries of sensor b, none is.
    values = np.array([0.9, 0.8, 0.3] + [1.0] * 37)
    false = np.arange(40) < 3
    sensors = np.array(["b", "b", "a"] + ["b"] * 18 + ["a"] * 19)
    pooled = Acceptance.of(values, false)
    each = Acceptance.by_group(values, false, sensors, np.full(40, "streets"))
    assert pooled.threshold(0.05) == 0.8
    assert each.threshold(0.05) == 0.9
    assert dict(each.sensors)["a"] == Acceptance(20, (0.3,))
    # Two false poses of sensor b, and one more of sensor a, are 3 in 21 and 2 in 21.
    assert each.threshold(0.15) == 0.0
    assert Acceptance.of_json(each.as_json()) == each


def test_each_kind_of_place_alone_keeps_the_risk() -> None:
    values = np.array([0.9, 0.8, 0.3] + [1.0] * 37)
    false = np.arange(40) < 3
    places = np.array(["look-alikes"] * 10 + ["campus"] * 30)
    each = Acceptance.by_group(values, false, np.full(40, "a"), places)
    assert each.threshold(0.05) == 0.9
    # Pooled, seven false poses in 40 are allowed at 0.2; of ten look-alikes, one is.
    assert each.threshold(0.2) == 0.8
    assert Acceptance.of_json(json.loads(json.dumps(each.as_json()))) == each


def test_more_false_poses_than_a_file_keeps_never_lower_the_threshold() -> None:
    values = np.linspace(0, 1, 2 * KEPT)
    made = Acceptance.of(values, np.ones(len(values), dtype=bool))
    assert len(made.false) == KEPT
    assert made.threshold(0.5) == pytest.approx(values[KEPT], abs=1e-3)


def test_confidence_reads_its_calibration(tmp_path: Path) -> None:
    content = json.loads(SHIPPED.read_text()) | {"acceptance": NINE.as_json()}
    file = tmp_path / "confidence.json"
    file.write_text(json.dumps(content))
    loaded = Confidence.load(file)
    assert loaded.acceptance == NINE
    assert loaded.threshold(0.2, 0.5) == (0.6, 0.2)
    # The default, 0.001, is smaller than nine queries support.
    assert loaded.threshold(None, 0.5) == (0.9, 0.1)


def test_confidence_without_calibration_has_the_fixed_threshold() -> None:
    old = Confidence((0.0,), (1.0,), (1.0,), 0.0, 0.99, FEATURES[:1])
    assert old.threshold(None, 0.5) == (0.5, None)
    with pytest.raises(ValueError, match="placecell fit-confidence"):
        old.threshold(0.01, 0.5)
