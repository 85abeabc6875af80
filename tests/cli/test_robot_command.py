"""`placecell robot`: a robot maps, another localizes, with a real service."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from placecell_client import Client
from typer.testing import CliRunner

from cli import app
from placecell.trajectories.reading import read_trajectory
from service.child_process import running_service
from town import two_robots

pytestmark = [pytest.mark.slow, pytest.mark.integration]


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return two_robots(tmp_path_factory.mktemp("town"), seed=4, scans=45, columns=400)


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with running_service(tmp_path_factory.mktemp("data")) as address:
        yield address


def run(*words: object) -> Any:
    done = CliRunner().invoke(app, ["robot", *map(str, words)])
    assert done.exit_code == 0, done.output
    return done


def test_one_robot_maps_and_another_localizes(
    drives: tuple[Path, Path], url: str, tmp_path: Path
) -> None:
    mapped = run(drives[0], "--service", url, "--map", "yard", "--robot-name", "ann", "--json")
    summary = json.loads(mapped.stdout)
    assert summary["upload_maps"] == ["yard"]
    assert summary["segments"] > 0
    assert summary["spool"]["entries"] == 0
    with Client(url) as client:
        (stored,) = client.maps().maps
        assert stored.robots == {"ann": stored.segments}

    words = ["--service", url, "--map", "yard", "--robot-name", "zoe", "--state", tmp_path / "s"]
    found = run(
        drives[1],
        *words,
        *("--trajectory", tmp_path / "zoe.tum", "--events", tmp_path / "zoe.jsonl"),
        *("--mcap", tmp_path / "zoe.mcap", "--realtime", "--speed", "0.2", "--json"),
    )
    summary = json.loads(found.stdout)
    assert summary["fixes"] > 0
    assert summary["state"] == "tracking"
    assert summary["upload_maps"] == ["yard-zoe"]
    assert summary["meters_until_first_fix"] < 20
    assert len(read_trajectory(tmp_path / "zoe.tum").poses) > 5
    assert (tmp_path / "zoe.mcap").stat().st_size > 1000

    # Without a link, the pulled map gives the pose; the edits of the new session wait.
    silent = [
        "--service",
        "http://127.0.0.1:9",
        "--map",
        "yard",
        "--local",
        tmp_path / "s" / "maps",
    ]
    alone = run(drives[1], *silent, "--state", tmp_path / "t", "--wait", "0", "--json")
    summary = json.loads(alone.stdout)
    assert summary["link"] == "offline"
    assert summary["fixes"] > 0
    assert summary["spool"]["entries"] > 0
    assert "run the command again" in alone.stderr
    words = ["--service", url, "--map", "yard", "--state", tmp_path / "t"]
    assert "edits sent" in run(drives[1], *words).stdout


def test_town_is_simulated(monkeypatch: pytest.MonkeyPatch, url: str) -> None:
    monkeypatch.setattr(sys.modules["cli.robot"], "TOWN_SCANS", 12)
    done = run("town:5:vlp-16", "--service", url, "--map", "town", "--no-localize", "--no-upload")
    assert "mapping" in done.stdout


def test_missing_source_is_told(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["robot", str(tmp_path / "missing"), "--map", "yard"])
    assert done.exit_code == 1
    assert "Check the path" in done.output


def test_drive_without_a_segment_is_told(tmp_path: Path) -> None:
    short, _ = two_robots(tmp_path, seed=4, scans=2, columns=64)
    words = ["--service", "http://127.0.0.1:9", "--map", "yard", "--wait", "0"]
    done = run(short, *words, "--spool-mb", "inf")
    assert "nothing is mapped: 2 scans gave no segment" in done.stderr
