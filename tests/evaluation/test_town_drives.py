"""Simulated drives with two sensors are prepared once, and keep no scans."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cli import app
from evaluation.poses.town_drives import TownDrives
from tests.service.service_builders import write_eigenvalue_model
from tests.town_fakes import replace_town

pytestmark = pytest.mark.slow


def test_kept_robot_equals_the_simulated_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = replace_town(monkeypatch)
    drives = TownDrives(tmp_path, seed=3, place="campus", scans=6)
    one, other = (drives.robot("robot_b", "wide") for _ in range(2))
    assert [(call["place"], call["lidar"]) for call in calls] == [("campus", "wide")]
    assert (other.name, other.sensor) == ("robot b", "wide")
    assert len(other.drive) == 6
    assert other.drive.path_length() == pytest.approx(5.0)
    np.testing.assert_array_equal(one.drive.poses, other.drive.poses)
    np.testing.assert_array_equal(other.drive.times, other.drive.times)
    np.testing.assert_array_equal(other.to_common, np.eye(4))
    assert len(other.recordings[0].segments) > 0
    # Robot A was not asked for, and no scan is left.
    assert sorted(file.suffix for file in tmp_path.rglob("*.*")) == [".npz", ".safetensors"]


def test_other_settings_are_other_drives(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = replace_town(monkeypatch)
    drives = TownDrives(tmp_path, seed=3, scans=6)
    others = ({"seed": 4}, {"every": 3}, {"place": "garden"})
    for each in (drives, *(replace(drives, **other) for other in others)):
        each.robot("robot_a", "wide")
    assert len(calls) == 4


def test_command_evaluates_two_sensors_in_one_town(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_eigenvalue_model(tmp_path / "models")
    calls = replace_town(monkeypatch)
    file = tmp_path / "report.json"
    words = [
        "--map-sensor",
        "wide",
        "--query-sensor",
        "narrow",
        "--scans",
        "6",
        "--place",
        "campus",
    ]
    model = ["--model", str(tmp_path / "models" / "tiny"), "--json", str(file)]
    run = CliRunner().invoke(app, ["evaluate-poses", "town:3", "--scans", "6", *words, *model])
    assert run.exit_code == 0, run.output
    assert [call["lidar"] for call in calls] == ["wide", "narrow"]
    report = json.loads(file.read_text())
    assert (report["map_sensor"], report["query_sensor"]) == ("wide", "narrow")
    assert (report["queries"], report["best_pose_right"]) == (6, 1.0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["town:x"], "Invalid town 'town:x': expected town:SEED"),
        (["town:3", "--place", "moon"], "Invalid place 'moon'"),
        (["town:3", "drive"], "town:3 is both drives. Omit QUERY_DRIVE"),
        (["town:3", "--map-sensor", "unknown"], "Unknown sensor 'unknown'"),
        (["drive", "--query-sensor", "wide"], "need a simulated drive. Give town:SEED"),
    ],
)
def test_wrong_use_of_a_town_is_refused(
    words: list[str], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace_town(monkeypatch)
    result = CliRunner().invoke(app, ["evaluate-poses", *words])
    assert result.exit_code != 0
    assert said in result.stderr
