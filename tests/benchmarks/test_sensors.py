"""The matrix of sensors: its cells, its cache, and the run that continues a stopped one."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.localization.sensors import SensorMatrix, cell_figures, matrix_tables, summary
from cli import app
from evaluation.poses.report import Outcome
from evaluation.poses.town_drives import TownDrives
from tests.service.service_builders import write_eigenvalue_model
from tests.town_fakes import replace_town


def outcome(
    probability: float, *, right: bool = True, told: bool = True, mapped: bool = True
) -> Outcome:
    reason, meters = "" if told else "ambiguous", 0.1 if right else 9.0
    return Outcome(reason, probability, meters, 0.1, 3.0, 5.0, 0.0, mapped)


def cell(mapping: str, asking: str, *outcomes: Outcome) -> dict[str, Any]:
    return {"map_sensor": mapping, "query_sensor": asking} | cell_figures(outcomes)


LOST = Outcome("inconsistent", 0.0, np.inf, np.inf, np.nan, 5.0, 0.0, mapped=True)


def test_cell_keeps_each_best_pose() -> None:
    figures = cell_figures(
        [outcome(0.99), outcome(0.4, right=False, told=False), LOST, outcome(0.9, mapped=False)]
    )
    assert figures["best_poses"] == [[0.99, 1, 1], [0.4, 0, 0], [0.9, 1, 1]]
    assert (figures["queries"], figures["beyond_the_map"]) == (3, 1)


def test_sums_are_over_the_queries_of_all_cells() -> None:
    cells = [
        cell("wide", "wide", outcome(0.95), outcome(0.95), outcome(0.45, told=False), LOST),
        cell("wide", "narrow", outcome(0.95, right=False)),
    ]
    told = summary(cells)
    every = told["all"]
    assert (every["cells"], every["queries"]) == (2, 5)
    assert every["counts"] == {"localised_right": 2, "wrong_but_sure": 1, "not_localised": 2}
    assert every["best_pose_right"] == 3 / 5
    assert every["told_share_of_right"] == pytest.approx(2 / 3, abs=1e-5)
    assert every["least_right"] == 0.0
    # Bins: three at 0.95, two of them right; one at 0.45, right.
    error = (3 * abs(0.95 - 2 / 3) + 0.55) / 4
    assert every["expected_calibration_error"] == pytest.approx(error)
    assert told["same_sensor"]["queries"] == 4
    assert told["cross_sensor"]["wrong_but_sure"] == 1.0


def test_sums_of_no_cells_are_undefined() -> None:
    assert summary([])["all"]["localised_right"] is None
    assert summary([])["all"]["expected_calibration_error"] is None


def test_tables_have_a_row_per_map_and_a_column_per_query_sensor() -> None:
    cells = [
        cell("wide", "wide", outcome(0.95)),
        cell("wide", "narrow", outcome(0.95, right=False)),
        cell("narrow", "narrow", LOST),
    ]
    lines = list(matrix_tables({"cells": cells, "summary": summary(cells)}))
    at = lines.index("**Right / wrong but sure, percent**")
    assert lines[at + 2 : at + 6] == [
        "| map \\ queries | wide | narrow |",
        "| --- | --- | --- |",
        "| wide | 100.0 / 0.0 | 0.0 / 100.0 |",
        "| narrow |  | 0.0 / 0.0 |",
    ]
    at = lines.index("**Expected calibration error**")
    assert lines[at + 4] == "| wide | 0.050 | 0.950 |"
    assert lines[at + 5] == "| narrow |  | - |"
    assert lines[-3] == "| all | 3 | 33.33 | 33.33 | 33.33 | 100.00 | 0.450 |"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    write_eigenvalue_model(tmp_path / "models")
    return tmp_path / "models" / "tiny"


def matrix(tmp_path: Path, **words: Any) -> SensorMatrix:
    drives = TownDrives(tmp_path / "cache", seed=3, scans=6)
    return SensorMatrix(drives, tmp_path / "sensors.json", **words)


@pytest.mark.slow
def test_stopped_run_continues_with_the_missing_cells(
    tmp_path: Path, model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = replace_town(monkeypatch)
    first = matrix(tmp_path, jobs=2).measure([("wide", "wide")], model)
    assert [call["lidar"] for call in calls] == ["wide"]
    assert (calls[0]["seed"], calls[0]["place"], calls[0]["scans"]) == (3, "streets", 6)
    (row,) = first["cells"]
    assert row["queries"] == 6
    assert row["counts"]["localised_right"] == row["queries"]
    everything = [("wide", "wide"), ("wide", "narrow"), ("narrow", "wide"), ("narrow", "narrow")]
    second = matrix(tmp_path).measure(everything, model)
    assert [call["lidar"] for call in calls] == ["wide", "narrow"]
    assert second["cells"][0] == row
    assert [(row["map_sensor"], row["query_sensor"]) for row in second["cells"]] == everything
    assert json.loads((tmp_path / "sensors.json").read_text()) == second
    # Nothing is left to do.
    assert matrix(tmp_path).measure(everything, model) == second
    with pytest.raises(ValueError, match=r"sensors\.json has figures with queries None, not 2"):
        matrix(tmp_path, most=2).measure(everything, model)
    (tmp_path / "sensors.json").write_text("{")
    with pytest.raises(ValueError, match=r"sensors\.json: .* no file of 'placecell bench sensors'"):
        matrix(tmp_path).measure(everything, model)


@pytest.mark.slow
def test_error_names_the_sensor_that_sees_nothing(
    tmp_path: Path, model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace_town(monkeypatch, blind="blind")
    with pytest.raises(ValueError, match="blind-robot_b: the drive has no segments for robot b"):
        matrix(tmp_path).measure([("wide", "blind")], model)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--cells", "wide"], "Invalid cell 'wide': expected MAP:QUERY"),
        (["--sensor", "unknown", "--only-prepare"], "Unknown sensor 'unknown'"),
    ],
)
def test_wrong_sensor_is_refused_before_any_work(
    words: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = replace_town(monkeypatch)
    result = CliRunner().invoke(app, ["bench", "sensors", "--cache", str(tmp_path), *words])
    assert result.exit_code != 0
    assert said in result.stderr
    assert not calls


@pytest.mark.slow
def test_command_prepares_and_prints_the_tables(
    tmp_path: Path, model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = replace_town(monkeypatch)
    words = ["bench", "sensors", "--cache", str(tmp_path / "cache"), "--scans", "6"]
    run = CliRunner().invoke(app, [*words, "--only-prepare", "--sensor", "wide"])
    assert run.exit_code == 0, run.output
    kept = sorted(file.name for file in (tmp_path / "cache").rglob("*.*"))
    assert kept == [
        *(f"wide-robot_a.{ending}" for ending in ("npz", "safetensors")),
        *(f"wide-robot_b.{ending}" for ending in ("npz", "safetensors")),
    ]
    run = CliRunner().invoke(app, [*words, "--sensor", "wide", "--model", str(model)])
    assert run.exit_code == 0, run.output
    assert "| wide | 100.0 / 0.0 |" in run.stdout
    assert len(calls) == 1
    assert (tmp_path / "cache" / "sensors.json").exists()
