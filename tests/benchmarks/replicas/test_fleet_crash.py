"""The benches of replicas, run shortly with real servers: nothing is lost, nothing is stale."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks.replicas import throughput
from benchmarks.replicas.fault_schedule import FleetCrashPlan
from benchmarks.replicas.fleet_crash import run_fleet_crash
from benchmarks.replicas.missing_tool import MissingToolError, haproxy_program, postgres_binaries
from benchmarks.replicas.throughput import ReplicasPlan
from cli import app

pytestmark = [pytest.mark.integration, pytest.mark.slow]
pytest.importorskip("psycopg", reason="needs psycopg: pip install 'placecell[postgres]'")


@pytest.fixture(autouse=True)
def tools() -> None:
    try:
        postgres_binaries()
        haproxy_program()
    except MissingToolError as error:
        pytest.skip(str(error))


def test_fleet_keeps_its_promise_under_faults() -> None:
    plan = FleetCrashPlan(
        seconds=6.0,
        kills=2,
        crashes=1,
        cuts=1,
        pauses=1,
        full_disks=1,
        paused=1.0,
        full=0.5,
        replicas=2,
    )
    report = run_fleet_crash(plan, seed=3)
    assert report["wrong"] == []
    assert report["good"]
    assert report["lost"] == 0
    assert report["stale_reads"] == 0
    assert report["replicas_identical"]
    assert report["maps_are_the_union"]
    assert report["acknowledged"] > 0
    assert report["reads"] > 0
    disks = {} if "full_disk" in report["skipped"] else {"full_disk": 1}
    causes = {"replica": 2, "primary": 1, "cut_commit": 1, "paused": 1} | disks
    assert report["faults"] == causes
    assert report["promotions"] == 1
    # How long depends on the machine and its other work; the report of a whole run tells it.
    assert set(report["longest_gap_s"]) >= {"replica", "primary"}
    assert report["slowest"][0]["seconds"] == pytest.approx(max(report["longest_gap_s"].values()))


def test_throughput_is_measured_with_each_number_of_replicas(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tiny = ReplicasPlan(replicas=2, clients=2, requests=4, writers=2, writes=5)
    monkeypatch.setattr(
        throughput,
        "ReplicasPlan",
        lambda seconds, segments: replace(tiny, seconds=seconds, segments=segments),
    )
    words = ["bench", "replicas", "--seconds", "0.5", "--segments", "1000",
             "--json", str(tmp_path / "replicas.json")]  # fmt: skip
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "replicas.json").read_text())
    assert [row["replicas"] for row in report["rows"]] == [1, 2]
    for row in report["rows"]:
        assert row["match"]["failed"] == row["localize"]["failed"] == 0
        assert row["match"]["a_second"] > 0
        assert row["writes_a_second"] > 0
    assert report["write_to_match_ms"]["max"] < 10_000
