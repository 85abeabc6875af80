"""The steps of a robot, measured on small drives."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.robot.live_steps import (
    StepTimes,
    dropped,
    forward_and_backward,
    measure_robot,
    on_cores,
    period_of,
)
from cli import app
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from tests.benchmarks.drive_builders import trip
from tests.town_fakes import replace_town


@pytest.mark.slow
def test_report_has_the_documented_keys(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 16, range(0))
    report = measure_robot(drive, None, MODELS_FOLDER / DEFAULT_MODEL, scans=30, localize_every=2)
    assert set(report["rows"]) == {
        *("read", "odometry", "local map", "ground", "regions", "ids", "describe", "localize"),
    }
    for goal in ("segments", "pose"):
        assert 0 < report[f"scan_to_{goal}_p50_ms"] <= report[f"scan_to_{goal}_p99_ms"]
        assert report[f"scan_to_{goal}_cpu_p50_ms"] > 0
    assert report["scan_to_segments_p50_ms"] < report["scan_to_pose_p50_ms"]
    assert report["batch"]["scans"] == 6
    assert report["batch_ratio"] > 0
    assert report["scans"] == 30
    assert report["scans_dropped"] >= 0
    assert report["segments_a_scan"] > 0
    assert report["map_segments"] > 0
    assert 0 <= report["localized"] <= 1
    assert report["peak_mb"] >= max(mb for _, mb in report["memory_mb"]) > 0
    assert [number for number, _ in report["memory_mb"]] == list(range(30))


@pytest.mark.slow
def test_town_is_simulated_once_and_its_other_robot_makes_the_map(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = replace_town(monkeypatch)
    file = tmp_path / "robot.json"
    words = ("bench", "robot", "town:3:wide", "--town-scans", 20, "--seconds", 0.4, "--json", file)
    for _ in range(2):
        run = CliRunner().invoke(app, [str(each) for each in (*words, "--output", tmp_path)])
        assert run.exit_code == 0, run.output
    assert [call["scans"] for call in calls] == [20]
    report = json.loads(file.read_text())
    assert report["source"] == "town:3:wide"
    assert report["map"] == "of robot B"
    assert report["scans"] == 4
    assert report["cores"] in (1, None)
    assert "scan to pose" in run.output


def test_scans_and_seconds_exclude_each_other(tmp_path: Path) -> None:
    words = ["bench", "robot", str(tmp_path), "--scans", "3", "--seconds", "3"]
    run = CliRunner().invoke(app, words)
    assert run.exit_code == 1
    assert "--scans and --seconds exclude each other" in run.output


@pytest.mark.slow
def test_drive_shorter_than_the_warm_up_is_measured(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 3, range(0))
    report = measure_robot(drive, None, MODELS_FOLDER / DEFAULT_MODEL)
    assert report["scans"] == 1


def test_drive_is_played_forward_and_backward() -> None:
    order = forward_and_backward(4)
    assert [next(order) for _ in range(9)] == [0, 1, 2, 3, 2, 1, 0, 1, 2]
    single = forward_and_backward(1)
    assert [next(single) for _ in range(3)] == [0, 0, 0]


@pytest.mark.parametrize(
    ("milliseconds", "lost"),
    [([90] * 10, 0), ([100] * 10, 0), ([150] * 6, 1), ([210] * 6, 3), ([90, 290, 90, 90, 90], 1)],
)
def test_scans_are_dropped_that_wait_too_long(milliseconds: list[int], lost: int) -> None:
    assert dropped(np.array(milliseconds) / 1e3, 0.1) == lost


def test_steps_that_are_not_done_at_each_scan_are_added_where_they_are() -> None:
    times = StepTimes(wall={"often": [1.0, 2.0, 3.0, 4.0], "seldom": [10.0, 20.0]})
    assert times.total(["often", "seldom", "never"]).tolist() == [11.0, 23.0]


def test_period_of_a_drive_without_times(tmp_path: Path) -> None:
    drive = trip(tmp_path / "trip", 3, range(0))
    assert period_of(drive) == pytest.approx(0.1)
    drive.times = np.full(3, np.nan)
    assert period_of(drive) == 0.1


@pytest.mark.skipif(not hasattr(os, "sched_getaffinity"), reason="the system cannot pin threads")
def test_threads_run_on_the_chosen_cores_only() -> None:
    allowed = os.sched_getaffinity(0)
    with on_cores(1):
        assert os.sched_getaffinity(0) == {min(allowed)}
    assert os.sched_getaffinity(0) == allowed
    with (
        pytest.raises(ValueError, match=r"^Invalid --cores 4096: this process may use 1 to"),
        on_cores(4096),
    ):
        pass
