"""Short runs of the crash, power loss and fleet benchmarks, and their ability to find faults."""

import json
import random
import subprocess
from dataclasses import replace
from pathlib import Path
from shutil import which
from typing import Any

import pytest
from typer.testing import CliRunner

from benchmarks.durability.power_loss import power_cuts
from benchmarks.durability.power_loss.power_cuts import PowerLossPlan, replay_power_cuts
from benchmarks.durability.power_loss.recorded_run import RecordedRun, record_run
from cli import app

pytestmark = pytest.mark.integration


def report_of(file: Path, *words: str | float) -> dict[str, Any]:
    """Run `placecell bench` and return its report."""
    result = CliRunner().invoke(app, ["bench", *map(str, words), "--json", str(file)])
    assert result.exit_code == 0, result.output
    content: dict[str, Any] = json.loads(file.read_text())
    return content


@pytest.mark.slow
@pytest.mark.usefixtures("tiny")
def test_killed_service_loses_nothing(tmp_path: Path) -> None:
    report = report_of(tmp_path / "crash.json", "crash", "--kills", 5, "--seed", 1)
    assert report["kills"] == 5
    assert report["losses"] == report["half_seen"] == 0
    assert report["wrong"] == []
    assert report["writes_acknowledged"] > 10
    assert report["versions_compared"] > 10
    assert report["reads"] > 0
    assert report["killed_during"]["start"] == 1
    assert report["restart_seconds"]["max"] >= report["restart_seconds"]["p50"] > 0


@pytest.mark.slow
@pytest.mark.usefixtures("tiny")
def test_robots_of_a_fleet_end_with_the_same_map(tmp_path: Path) -> None:
    words = ("fleet", "--minutes", 0.05, "--clients", 8, "--seed", 1)
    report = report_of(tmp_path / "fleet.json", *words)
    assert report["robots_with_the_service_s_map"] == 8
    assert report["map_is_the_union"] is True
    assert report["ids_reserved_twice"] == 0
    assert report["wrong"] == []
    assert report["edits_acknowledged"] > 8
    assert report["connections_cut"] > 0


@pytest.fixture(scope="module")
def recorded(tiny: None, tmp_path_factory: pytest.TempPathFactory) -> RecordedRun:
    """A short recorded run; skips if strace cannot trace a process."""
    if which("strace") is None:
        pytest.skip("strace is not installed")
    tried = subprocess.run(["strace", "-D", "true"], capture_output=True, text=True, check=False)
    if tried.returncode:
        pytest.skip(f"strace cannot trace a process here: {tried.stderr.strip()}")
    return record_run(tmp_path_factory.mktemp("run"), writes=16, large=300, seed=1)


PLAN = PowerLossPlan(cuts=30)


@pytest.mark.slow
def test_power_cut_loses_nothing(recorded: RecordedRun, tmp_path: Path) -> None:
    findings = replay_power_cuts(recorded, PLAN, random.Random(0), tmp_path / "left")
    assert findings.faults == []
    assert {*findings.results} <= {"good", "landed"}
    assert len(findings.found) > 15


def test_write_that_is_not_synced_is_found_lost(recorded: RecordedRun, tmp_path: Path) -> None:
    """The benchmark finds a missing sync."""
    steps = [
        step for step in recorded.steps if not (step.kind == "sync" and step.path.endswith("-wal"))
    ]
    careless = replace(recorded, steps=steps)
    findings = replay_power_cuts(careless, PLAN, random.Random(0), tmp_path / "left")
    assert findings.results["lost"] > 0
    assert any("were acknowledged" in fault for fault in findings.faults)


def test_report_counts_the_power_cuts(
    tmp_path: Path, recorded: RecordedRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(power_cuts, "record_run", lambda *_: recorded)
    report = report_of(tmp_path / "powerloss.json", "powerloss", "--writes", 16, "--cuts", 3)
    assert report["writes"] == 16
    assert report["power_cuts"] > 0
    assert report["losses"] == report["half_seen"] == 0
