"""Attack suite in its short form, and its ability to find faults."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.attack import suite
from benchmarks.attack.cases import CASES
from benchmarks.attack.stage import VICTIM_MAP, AttackCase, Stage
from benchmarks.attack.suite import AttackPlan, run_case
from benchmarks.attack.target import OWNER
from cli import app

pytestmark = pytest.mark.integration

PLAN = AttackPlan(short=True)


def run_attack(attack: Any, plan: AttackPlan = PLAN) -> dict[str, Any]:
    """Run a case with this attack and return its part of the report."""
    return run_case(AttackCase("A0", attack, "It holds."), plan)


def test_every_fault_row_has_a_case() -> None:
    assert [case.id for case in CASES] == [f"A{number}" for number in range(1, 29)]
    assert all(case.expected.endswith(".") for case in CASES)


@pytest.mark.slow
def test_short_form_holds(tmp_path: Path) -> None:
    file = tmp_path / "attack.json"
    # Other load on the machine makes a victim wait longer; a fault makes it wait far longer.
    command = ["bench", "attack", "--short", "--victim-seconds", "5", "--json", str(file)]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 0, result.output
    report = json.loads(file.read_text())
    assert report["failed"] == 0
    assert report["held"] == sum(case.in_short for case in CASES)


def test_unknown_case_is_refused() -> None:
    result = CliRunner().invoke(app, ["bench", "attack", "--case", "A99"])
    assert result.exit_code == 1
    assert "A99" in result.output


@pytest.mark.usefixtures("tiny")
def test_service_without_attack_holds() -> None:
    def leave_alone(stage: Stage) -> None:
        with stage.service() as target, stage.victim(target, reads=True):
            pass

    report = run_attack(leave_alone, AttackPlan(short=True, victim_seconds=60))
    assert report["held"], report["why"]
    assert report["lost"] == 0
    assert report["peak_mb"] > 50
    assert report["victim_idle_max_s"] > 0
    assert set(report["statuses"]) <= {"200", "429"}


@pytest.mark.usefixtures("tiny")
def test_service_that_dies_is_a_failure() -> None:
    def kill(stage: Stage) -> None:
        with stage.service() as target, stage.victim(target):
            target.service.process.kill()
            target.service.process.wait()

    report = run_attack(kill)
    assert not report["held"]
    assert "did not survive" in report["why"]
    assert "never answered" in report["why"]


@pytest.mark.usefixtures("tiny")
def test_service_above_the_memory_limit_is_killed() -> None:
    def nothing(stage: Stage) -> None:
        with stage.service():
            pass

    report = run_attack(nothing, AttackPlan(short=True, limit_mb=60))
    assert not report["held"]
    assert "killed at the limit of 60 MB" in report["why"]


@pytest.mark.usefixtures("tiny")
def test_lost_write_is_counted() -> None:
    def undo(stage: Stage) -> None:
        with stage.service() as target:
            with stage.victim(target):
                pass
            target.client(OWNER).delete_map(VICTIM_MAP)

    report = run_attack(undo)
    assert report["lost"] > 0
    assert "are lost" in report["why"]


def test_victim_that_waits_too_long_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage(Path(), 1_000, True, 1.0, np.random.default_rng(0))
    waits = {"max": 1.5, "idle_max": 0.1, "statuses": {"200": 3}, "done": 3, "unanswered": False}
    stage._take(None, {"describe": waits}, 1.0)  # type: ignore[arg-type]
    assert stage.found.victim_max_s == 1.5
    assert stage.found.statuses["200"] == 3
    assert "waited 1.50 s" in stage.found.why[0]


def test_case_that_raises_is_a_failure() -> None:
    def fail(stage: Stage) -> None:
        raise ValueError("no such thing")

    report = run_attack(fail)
    assert not report["held"]
    assert "ValueError: no such thing" in report["why"]


def test_command_writes_a_report_and_ends_with_status_1(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def hold(stage: Stage) -> None:
        stage.note("figure", 1)

    def fail(stage: Stage) -> None:
        stage.expect(False, "It fails.")
        stage.expect(False, "It fails.")

    cases = (AttackCase("A1", hold, "Held."), AttackCase("A2", fail, "Failed.", in_short=False))
    monkeypatch.setattr(suite, "CASES", cases)
    file = tmp_path / "attack.json"
    command = ["bench", "attack", "--json", str(file)]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 1, result.output
    report = json.loads(file.read_text())
    assert (report["held"], report["failed"]) == (1, 1)
    assert report["cases"]["A1"]["held"]
    assert report["cases"]["A2"]["why"] == "It fails."
    assert {"machine", "cores", "memory_limit_mb", "seeds", "seconds"} <= set(report)
    result = CliRunner().invoke(app, [*command, "--short"])
    assert result.exit_code == 0, result.output
    assert set(json.loads(file.read_text())["cases"]) == {"A1"}
