"""Measurement of drift, in a small form."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.drift import drift as measurement
from benchmarks.drift.drift import DriftPlan, measured, run_drift
from benchmarks.drift.drifting_odometry import WanderingOdometry
from benchmarks.drift.long_life import TrueDay, counted, day_of
from benchmarks.drift.merging import interval_of_difference, merge_row
from benchmarks.drift.town_maps import DriftCase, TrueMap, robot_maps
from cli import app
from placecell.core.types import Float64
from placecell.lasting.judgment import ABSENT, CONFIRMED, UNSEEN, ObservedSegments, judge
from placecell.pose_graph import CaptureOdometry, GraphFrames, GraphMap
from service.engine import Engine
from tests.placecell.pose_graph.graph_builders import square_path
from tests.service.merging.drifting_maps import SIDE, drifting_map
from tests.service.service_builders import write_eigenvalue_model

pytestmark = pytest.mark.slow


def true_poses(laps: int) -> Float64:
    positions, yaws = square_path(SIDE, laps)
    poses = np.tile(np.eye(4), (len(yaws), 1, 1))
    poses[:, :3, 3] = positions
    poses[:, 0, 0] = poses[:, 1, 1] = np.cos(yaws)
    poses[:, 1, 0] = np.sin(yaws)
    poses[:, 0, 1] = -np.sin(yaws)
    return poses


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("models")
    write_eigenvalue_model(folder, pair_threshold=0.8)
    return folder / "tiny"


def test_loops_and_errors_of_robots_are_counted(model: Path) -> None:
    with Engine.temporary(model) as engine:
        maps = [
            TrueMap(drifting_map(engine.model.id, seed, 1)[0], true_poses(1), 480.0)
            for seed in (1, 2)
        ]
        both = measured(DriftCase(960.0, 2), 1.0, maps, engine)
    assert both["loops_wrong"] == 0
    assert both["loops_accepted"] > 10
    assert both["parts"] == 1
    assert both["within_0_3_m"] > 0.8
    assert both["outliers"] == both["loops_found"]
    assert both["outliers_accepted"] == 0
    assert both["outliers_change"] < 0.1


def test_maps_are_merged_and_localized_in(model: Path) -> None:
    with Engine.temporary(model) as engine:
        maps = [
            TrueMap(
                drifting_map(engine.model.id, seed, 1, robot=name, odometry=True)[0],
                true_poses(1),
                480.0,
            )
            for seed, name in ((1, "ann"), (2, "bob"))
        ]
        row = merge_row(maps, engine)
        assert all(engine.maps.find(name) is None for name in ("drift-0", "drift-1"))
    assert row["merged_maps"] == 2
    assert row["merged_within_0_3_m"] > 0.5
    assert row["localized_queries"] == 96
    assert row["localized_merged_wrong"] == row["localized_undrifted_wrong"] == 0
    assert row["localized_merged"] >= row["localized_undrifted"] - 0.1
    assert row["localized_difference_low"] <= row["localized_difference_high"]


def test_town_is_simulated_once_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = DriftCase(40.0, seed=3)
    first = robot_maps(case, [0.0, 2.0], tmp_path)
    assert len(first[0.0][0].content) > 20
    np.testing.assert_allclose(
        first[0.0][0].content.frame_positions, first[0.0][0].poses[:, :3, 3], atol=1e-9
    )
    from benchmarks.drift import town_maps

    monkeypatch.delattr(town_maps, "_drive")
    again = robot_maps(case, [0.0, 2.0], tmp_path)
    np.testing.assert_array_equal(again[2.0][0].content.codes, first[2.0][0].content.codes)
    kept: list[int] = []
    plan = DriftPlan([case], [2.0], tmp_path)
    report = run_drift(plan, keep=lambda so_far: kept.append(len(so_far["rows"])))
    assert kept == [report["rows_planned"]] == [1]
    assert report["rows"][0]["loops_wrong"] == 0
    assert report["rows"][0]["ate_after_scaled_m"] <= report["rows"][0]["ate_after_m"]


def test_routes_of_three_robots_overlap_in_both_directions() -> None:
    _, routes = DriftCase(2000.0, 3).routes()
    heads = [route.center[0] - route.center[-1] for route in routes]
    assert len(routes) == 3
    assert np.dot(heads[0], heads[1]) != 0.0
    assert all(600.0 < route.length() < 700.0 for route in routes)


def test_wandering_odometry_has_no_error_without_drift() -> None:
    true = true_poses(1)
    np.testing.assert_allclose(WanderingOdometry(0.0).poses(true, 1), true, atol=1e-9)
    off = WanderingOdometry(2.0).poses(true, 1)
    assert 0.5 < np.linalg.norm(off[-1, :3, 3] - true[-1, :3, 3]) < 50.0


def test_command_ends_with_status_1_if_a_wrong_loop_is_accepted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    row = {
        "case": "town", "meters": 40.0, "loops_accepted": 1, "loops_found": 1, "loops_wrong": 0,
        "ate_before_m": 1.0, "ate_after_m": 0.1, "seconds": 2.0,
    }  # fmt: skip
    plans: list[DriftPlan] = []

    def fake(
        plan: DriftPlan, tell: object, keep: Callable[[dict[str, Any]], None]
    ) -> dict[str, Any]:
        del tell
        plans.append(plan)
        keep({"rows": [row]})
        assert json.loads(file.read_text())["rows"] == [row], "the row is kept at once"
        return {"rows": [row]}

    monkeypatch.setattr(measurement, "run_drift", fake)
    file = tmp_path / "drift.json"
    words = ["bench", "drift", "--meters", "500", "--json", str(file)]
    assert CliRunner().invoke(app, words).exit_code == 0
    assert json.loads(file.read_text())["rows"] == [row]
    assert [case.robots for case in plans[0].cases] == [1, 3, 1, 3]
    row["loops_wrong"] = 1
    assert CliRunner().invoke(app, words).exit_code == 1


def test_interval_of_the_difference_holds_it_and_narrows_with_more_stretches() -> None:
    rng = np.random.default_rng(5)
    widths = []
    for count in (400, 6400):
        positions = np.column_stack([5.0 * np.arange(count), np.zeros((count, 2))])
        odometry = CaptureOdometry.from_poses(np.ones(count, np.int64), positions, np.zeros(count))
        frames = GraphFrames(np.arange(float(count)), positions, np.zeros(count), odometry)
        graph = GraphMap(frames, np.zeros((0, 3)), np.zeros(0, np.int64))
        merged, other = (
            np.column_stack([np.arange(count), rng.random(count) < share]).astype(np.int64)
            for share in (0.90, 0.95)
        )
        low, high = interval_of_difference(graph, merged, other)
        told = float(merged[:, 1].mean() - other[:, 1].mean())
        assert low <= told <= high
        widths.append(high - low)
    assert 0 < widths[1] < widths[0] / 2
    assert interval_of_difference(graph, other, other) == (0.0, 0.0)
    nothing = np.zeros((0, 2), np.int64)
    assert interval_of_difference(graph, nothing, nothing) == (0.0, 0.0)


def test_verdicts_are_compared_with_the_truth() -> None:
    seen = ObservedSegments(
        np.zeros((6, 3)), np.ones((6, 3)), np.zeros((1, 3)), np.zeros(6, np.int64)
    )
    day = TrueDay(
        seen,
        movable=np.array([1, 1, 1, 0, 0, 0], bool),
        known=np.array([1, 1, 1, 1, 1, 0], bool),
    )
    verdicts = np.array([ABSENT, CONFIRMED, UNSEEN, ABSENT, CONFIRMED, ABSENT])
    row = counted(verdicts, day)
    assert (row["gone"], row["stays"]) == (3, 2)
    assert row["absent_precision"] == row["absent_recall"] == 0.5
    assert row["absent_of_all_gone"] == 0.3333
    assert row["confirmed_precision"] == row["confirmed_recall"] == 0.5


def test_cars_of_the_first_day_are_gone_on_the_other_one(tmp_path: Path) -> None:
    first, second = (day_of(3, "vlp-16", 30, other, tmp_path) for other in (False, True))
    assert first.movable.any()
    assert second.movable.any()
    row = counted(judge(first.seen, second.seen), first)
    assert row["gone_absent"] + row["stays_confirmed"] > 0
    same = counted(judge(first.seen, first.seen), first)
    assert same["stays_absent"] == same["gone_absent"] == 0


def test_maps_that_cannot_be_aligned_are_reported_as_not_merged(model: Path) -> None:
    with Engine.temporary(model) as engine:
        near = drifting_map(engine.model.id, 1, 1, robot="ann", odometry=True)[0]
        other = replace(near, robots=("bob",), codes=np.zeros_like(near.codes))
        maps = [TrueMap(each, true_poses(1), 480.0) for each in (near, other)]
        row = merge_row(maps, engine)
        assert row["merged_maps"] == 0
        assert row["merge_problem"]
        assert all(engine.maps.find(name) is None for name in ("drift-0", "drift-1"))
