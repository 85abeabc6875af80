"""The fit of the pose probability, on cases made by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.poses import confidence
from evaluation.poses.cases import Cases, FitPair, ahead_of
from evaluation.poses.confidence import MOST_NEEDED, figures, fit_cases, logistic, needs_of
from placecell.core.types import Bool, Float64
from placecell.localization import Confidence
from placecell.localization.confidence import FEATURES
from placecell.segmentation.pipeline import silent
from town import sensor, two_robots


def cases_of(count: int = 600, seed: int = 0) -> Cases:
    """Return cases of three sensors in which right poses have larger features."""
    random = np.random.default_rng(seed)
    right = random.uniform(size=count) < 0.7
    features = random.normal(size=(count, len(FEATURES))) + 3.0 * right[:, None]
    found = random.uniform(size=count) < 0.95
    features[~found] = np.nan
    right &= found
    return Cases(
        features=features,
        limits=found.astype(float),
        rejected=np.zeros(count, dtype=bool),
        right=right,
        false=found & ~right,
        usable=random.integers(4, 60, count),
        answerable=np.ones(count, dtype=bool),
        whole=np.ones(count, dtype=bool),
        towns=random.integers(1, 5, count),
        sensors=np.array(["hdl-64e", "vlp-16", "os1-64"])[random.integers(0, 3, (count, 1))][
            :, [0, 0]
        ],
        places=np.full(count, "streets"),
        growth=np.array([1.0, 2.0, np.nan, 9.0]),
    )


def test_fit_has_figures_of_each_sensor_that_was_left_out() -> None:
    cases = cases_of()
    content = fit_cases(cases)
    held_out = content["held_out"]
    assert set(held_out["sensors"]) == {"hdl-64e", "vlp-16", "os1-64"}
    assert sum(each["cases"] for each in held_out["sensors"].values()) == len(cases)
    assert held_out["all"]["told_share_of_right"] > 0.9
    assert held_out["all"]["false_acceptance"] <= 1 / (len(cases) + 1)
    assert held_out["all"]["expected_calibration_error"] < 0.05
    assert content["acceptance"]["queries"] == len(cases)
    assert len(content["acceptance"]["false"]) == int(cases.false.sum())
    assert min(content["model"]["weights"]) >= 0
    assert content["needs"]["per_meter"] == 2.0  # the median of 1, 2 and 9


def test_case_of_two_sensors_is_left_out_with_both(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = cases_of()
    sensors = cases.sensors.copy()
    sensors[:100] = ["os1-64", "vlp-16"]
    sensors[100:200] = ["vlp-16", "os1-64"]
    cases = replace(cases, sensors=sensors)
    fitted_on = []

    def spy(features: Float64, right: Bool, highest: float) -> Confidence:
        fitted_on.append(len(features))
        return logistic(features, right, highest)

    monkeypatch.setattr(confidence, "logistic", spy)
    content = fit_cases(cases)
    # Both directions are one group, and only the cases with the third sensor are apart from it.
    only_third = int((sensors == "hdl-64e").all(axis=1).sum())
    assert only_third in fitted_on
    held_out = content["held_out"]
    assert held_out["cross_sensor"]["cases"] == 200
    assert held_out["same_sensor"]["cases"] == len(cases) - 200
    vlp = (sensors == "vlp-16").any(axis=1)
    assert held_out["sensors"]["vlp-16"]["cases"] == vlp.sum()
    assert content["acceptance"]["sensors"]["vlp-16"]["queries"] == vlp.sum()


def test_two_sensors_that_always_meet_leave_each_town_out() -> None:
    cases = cases_of()
    both = replace(cases, sensors=np.full((len(cases), 2), ["vlp-16", "os1-64"]))
    held_out = fit_cases(both)["held_out"]
    assert held_out["all"] == held_out["by_town"]
    assert held_out["same_sensor"]["cases"] == 0


def test_rejected_poses_do_not_count_as_accepted() -> None:
    cases = cases_of()
    content = fit_cases(replace(cases, rejected=cases.false))
    assert content["acceptance"]["false"] == []
    assert content["held_out"]["threshold"] == 0.0
    assert content["held_out"]["all"]["false_acceptance"] == 0.0


def test_one_sensor_leaves_each_town_out() -> None:
    cases = cases_of()
    one = replace(cases, sensors=np.full((len(cases), 2), "vlp-16"))
    held_out = fit_cases(one)["held_out"]
    assert held_out["all"] == held_out["by_town"]


def test_figures_by_hand() -> None:
    cases = replace(
        cases_of(4),
        right=np.array([True, True, False, False]),
        false=np.array([False, False, True, True]),
        rejected=np.array([False, False, False, True]),
        whole=np.array([True, False, True, True]),
    )
    stated = np.array([0.95, 0.5, 0.92, 0.99])
    found = figures(cases, stated, 0.9, np.ones(4, dtype=bool))
    assert found["told_share_of_right"] == 0.5
    assert found["told_share_of_right_captures"] == 1.0
    assert found["false_acceptance"] == found["wrong_but_sure"] == 0.25
    assert found["brier"] == pytest.approx((0.05**2 + 0.5**2 + 0.92**2 + 0.99**2) / 4, abs=1e-5)


def test_segments_needed_by_hand() -> None:
    cases = cases_of()
    cases = replace(cases, sensors=np.full((len(cases), 2), "vlp-16"))
    told = cases.usable >= 20
    found = needs_of(replace(cases, right=np.ones(len(cases), dtype=bool)), told)
    # From 20 segments on, all robots are localized; from 17 to 25, not 95 of 100.
    assert 18 <= found.segments <= 20
    # Cases of two sensors count only if there are no others.
    crossed = cases.sensors.copy()
    crossed[cases.usable >= 20, 0] = "os1-64"
    right = np.ones(len(cases), dtype=bool)
    few = needs_of(replace(cases, right=right, sensors=crossed), told)
    assert few.segments == MOST_NEEDED - 1
    crossed[:, 0] = "os1-64"
    assert needs_of(replace(cases, right=right, sensors=crossed), told) == found


def test_map_ends_ahead_of_the_robot_or_behind_it() -> None:
    # The way leads along y; the robot is 1 m beside the third capture.
    frames = np.column_stack([np.zeros(5), 10.0 * np.arange(5), np.ones(5)])
    place = np.array([1.0, 20.0, 0.0])
    assert ahead_of(frames, place, 5.0).tolist() == [False, False, False, True, True]
    assert ahead_of(frames, place, -5.0).tolist() == [False, False, True, True, True]
    assert ahead_of(frames, place, -5.0, -1.0).tolist() == [True, True, False, False, False]
    assert ahead_of(frames[::-1], place, 5.0).tolist() == [False, False, False, True, True]


def test_pair_of_a_folder_has_the_sensor_and_the_place_of_its_name(tmp_path: Path) -> None:
    folder = tmp_path / "7-os1-32-car-park"
    two_robots(folder, seed=7, scans=3, columns=64)
    pair = FitPair.of_folder(folder, silent)
    assert (pair.town, pair.place) == (7, "car-park")
    assert pair.sensors == pair.swapped().sensors == ("os1-32", "os1-32")
    assert len(pair.pair.mapper.drive) == len(pair.pair.asker.drive) == 3


def test_pair_of_a_folder_has_two_sensors(tmp_path: Path) -> None:
    folder = tmp_path / "7-vlp-16+os1-32-look-alikes"
    lidars = [replace(sensor(name), columns=64) for name in ("vlp-16", "os1-32")]
    two_robots(folder, seed=7, scans=3, lidar=lidars[0], other_lidar=lidars[1])
    pair = FitPair.of_folder(folder, silent)
    assert (pair.sensors, pair.place, pair.look_alikes) == (
        ("vlp-16", "os1-32"),
        "look-alikes",
        1.0,
    )
    swapped = pair.swapped()
    assert swapped.sensors == ("os1-32", "vlp-16")
    assert swapped.pair.mapper is pair.pair.asker
    assert swapped.swapped().sensors == pair.sensors


@pytest.mark.parametrize(
    "name",
    ["7-sonar-streets", "vlp-16-streets", "x-vlp-16-streets", "7-vlp-16+sonar-streets"],
)
def test_folder_with_another_name_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ValueError, match="expected SEED-SENSOR-PLACE, such as 101-vlp-16-streets"):
        FitPair.of_folder(tmp_path / name, silent)
