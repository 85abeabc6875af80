"""Tests of `placecell town` with large towns."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from cli import app
from placecell.datasets import open_drive
from town import ODOMETRY_FILE, read_origin

pytestmark = pytest.mark.slow


def run(*words: str | Path | float, status: int = 0) -> Result:
    result = CliRunner().invoke(app, ["town", *(str(word) for word in words)])
    assert result.exit_code == status, result.output
    return result


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulate two robots on 1 km of streets, one scan of a few columns every 8 m."""
    folder = tmp_path_factory.mktemp("large")
    run(
        *(folder / "drives", "--meters", 1000, "--spacing", 8, "--columns", 32),
        *("--pairs", 3, "--pair-meters", 80, "--rain", 5),
        *("--picture", folder / "plan.png", "--json", folder / "figures.json"),
    )
    return folder


def test_robots_drive_all_streets(folder: Path) -> None:
    figures = json.loads((folder / "figures.json").read_text())
    assert 1000 <= figures["street_metres"] < 1100
    drives = [open_drive(folder / "drives" / name) for name in ("robot_a", "robot_b")]
    for drive in drives:
        assert len(drive) == figures["scans"][drive.folder.name]
        assert drive.path_length() == pytest.approx(figures["route_metres"], rel=0.05)
        assert (drive.folder / ODOMETRY_FILE).exists()


def test_option_from_starts_the_drives_further_along_the_route(
    folder: Path, tmp_path: Path
) -> None:
    words = ("--meters", 1000, "--spacing", 8, "--columns", 32, "--from", 400, "--scans", 3)
    run(tmp_path, *words)
    for name in ("robot_a", "robot_b"):
        whole = read_origin(folder / "drives" / name) @ open_drive(folder / "drives" / name).poses
        part = read_origin(tmp_path / name) @ open_drive(tmp_path / name).poses
        apart = np.linalg.norm(whole[:, None, :2, 3] - part[None, :, :2, 3], axis=2)
        assert len(part) == 3
        assert apart.min(axis=0).max() < 4.5
        # In a curve the inner lane is shorter than the middle of the street.
        assert apart[:, 0].argmin() == pytest.approx(400 / 8, abs=4)
    assert "too short" in run(tmp_path / "x", *words[:-4], "--from", 1e5, status=1).output


def test_option_pairs_writes_pairs(folder: Path) -> None:
    pairs = json.loads((folder / "drives" / "pairs.json").read_text())
    assert pairs["drives"] == ["robot_a", "robot_b"]
    assert len(pairs["overlapping"]) == len(pairs["apart"]) == 3
    for pair in pairs["overlapping"]:
        a, b = (folder / "drives" / name for name in pairs["drives"])
        places = [
            (read_origin(drive) @ open_drive(drive).poses)[first : last + 1, :2, 3]
            for drive, (first, last) in ((a, pair["scans_a"]), (b, pair["scans_b"]))
        ]
        nearest = np.linalg.norm(places[0][:, None] - places[1][None], axis=2).min()
        assert nearest < 7.0
        assert np.shape(pair["b_to_a"]) == (4, 4)


def test_option_picture_writes_a_png(folder: Path) -> None:
    assert (folder / "plan.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("route", "meters"), [("wander:60", 60), ("loop:200:2", 400), ("0,0:0,1", 50)]
)
def test_route_has_the_length_asked_for(tmp_path: Path, route: str, meters: float) -> None:
    result = run(
        *(tmp_path, "--meters", 700, "--route", route, "--robots", 1, "--scans", 2),
        *("--columns", 16, "--lane", 0),
    )
    figures = json.loads(result.output.splitlines()[-1])
    assert meters <= figures["route_metres"] < meters + 400
    assert figures["scans"] == {"robot_a": 2}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--robots", 3], "--robots needs a large town: give --meters too"),
        (["--sensor", "hdl-65"], "expected one of hdl-64e, hdl-32e, vlp-16, os0-32"),
        (["--mount", 0.2], "expected 0.3 to 3.0 m above the ground"),
        (["--mount", "nan"], "expected 0.3 to 3.0 m above the ground"),
        (["--speed", 11], "a speed above 0 and at most 10 m/s"),
        (["--meters", 700, "--speed", 0], "a speed above 0 and at most 10 m/s"),
        (["--pairs", 1], "--pairs needs a large town"),
        (["--meters", 0], "m of streets"),
        (["--meters", "nan"], "m of streets"),
        (["--meters", 1e9], "m of streets"),
        (["--meters", 700, "--route", "nowhere"], "expected all, wander:METERS"),
        (["--meters", 700, "--route", "loop:x"], "expected all, wander:METERS"),
        (["--meters", 700, "--route", "loop:100:0"], "one lap or more"),
        (["--meters", 700, "--route", "0,0:99,0"], "no crossing"),
        (["--meters", 700, "--pairs", 1, "--robots", 1], "--pairs needs two robots"),
        (["--meters", 700, "--pairs", 1], "no two stretches of the drives that are 100 m apart"),
        (["--meters", 700, "--pairs", 1, "--pair-meters", 9e9], "has no stretch of"),
        (["--meters", 700, "--scans", 9999], "too short for 9999 scans"),
    ],
)
def test_wrong_option_values_are_refused(
    tmp_path: Path, words: list[str | float], said: str
) -> None:
    result = run(tmp_path / "drives", *words, status=1)
    assert said in " ".join(result.output.split())
    assert not (tmp_path / "drives").exists()


def test_small_town_takes_sensor_rain_and_distortion(tmp_path: Path) -> None:
    words = ("--scans", 2, "--sensor", "vlp-16", "--columns", 300, "--spacing", 0.5)
    run(tmp_path / "dry", *words)
    run(tmp_path / "wet", *words, "--rain", 40, "--mount", 0.4)
    run(tmp_path / "raw", *words, "--distortion", "--speed", 2, "--dropout", 0.5)
    sizes = {
        name: (tmp_path / name / "robot_a" / "velodyne" / "000000.bin").stat().st_size / bytes_each
        for name, bytes_each in (("dry", 16), ("wet", 16), ("raw", 20))
    }
    assert sizes["wet"] < sizes["dry"] <= 300 * 16
    assert sizes["raw"] == pytest.approx(0.5 / 0.98 * sizes["dry"], rel=0.1)
    raw = open_drive(tmp_path / "raw" / "robot_a")
    assert raw.times.tolist() == [0.0, 0.25]
    assert raw.point_layout.point_bytes == 20


def test_help_shows_an_example() -> None:
    shown = " ".join(run("--help").output.split())
    assert "--meters 5000" in shown
    assert "--sensor vlp-16 --mount 0.5" in shown
    assert "os1-128 or solid-state" in shown
    assert "--distortion" in shown
    assert "poses_odometry.txt" in shown


def test_british_spelling_of_an_option_is_accepted(tmp_path: Path) -> None:
    result = run(tmp_path / "drives", "--metres", 0, status=1)
    assert result.output == run(tmp_path / "drives", "--meters", 0, status=1).output
