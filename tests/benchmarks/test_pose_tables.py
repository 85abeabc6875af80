"""Localization tables agree with the reports."""

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from benchmarks.localization.pose_tables import comparison_table, full_table, read_reports
from cli import app

REPORT: dict[str, Any] = {
    "queries": 3012,
    "localised_right": 0.9612,
    "wrong_but_sure": 0.00033,
    "not_localised": 0.03,
    "bounds_95": {
        "localised_right": [0.9537, 0.9678],
        "wrong_but_sure": [0.00001, 0.00185],
        "not_localised": [0.0242, 0.0367],
    },
    "median_position_error_m": 0.0712,
    "median_yaw_error_deg": 0.1499,
    "metres_until_localised": {"median": 0.0, "p95": 4.4, "never": 3},
    "seen": False,
}
PEER = {"name": "scan-context", "localised_right": 0.5, "wrong_but_sure": 0.1}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    case = tmp_path / "town"
    case.mkdir()
    (case / "context.json").write_text(json.dumps(REPORT))
    (case / "group.json").write_text(json.dumps(REPORT | {"seen": True}))
    (case / "peers.json").write_text(json.dumps({"rows": [PEER]}))
    return case


def test_comparison_has_a_row_per_system_and_a_column_per_case(folder: Path) -> None:
    table = list(comparison_table({"town": read_reports(folder), "drive": {"context": REPORT}}))
    assert table == [
        "|  | town | drive |",
        "| --- | --- | --- |",
        "| context | 96.1 / 0.03 | 96.1 / 0.03 |",
        "| group | 96.1 / 0.03 * |  |",
        "| scan-context | 50.0 / 10.00 |  |",
    ]


def test_full_table_states_bounds() -> None:
    nothing = {"median_position_error_m": None, "median_yaw_error_deg": None}
    never = {"metres_until_localised": {"median": None, "p95": None, "never": 9}}
    _, _, told, untold = full_table({"town": REPORT, "lost": REPORT | nothing | never})
    assert "3,012 | 96.12 (95.37 to 96.78) | 0.03 (0.00 to 0.18) | 3.00 (2.42 to 3.67)" in told
    # This report is older than the figures of the best poses.
    assert "| - | - | - | 0.07 m, 0.15 deg | 0 m; 95%: 4 |" in told
    assert untold.endswith("| - | - |")


def test_full_table_states_best_poses_and_orders_by_sensor() -> None:
    best = {
        "best_pose_right": 0.98,
        "told_share_of_right": 0.9808,
        "expected_calibration_error": 0.0123,
    }
    both = {"map_sensor": "vlp-16", "query_sensor": "os1-64"}
    same = {"map_sensor": "hdl-64e", "query_sensor": "hdl-64e"}
    cases = {"cross": REPORT | best | both, "one": REPORT | same, "recorded": REPORT}
    header, _, *rows = full_table(cases)
    assert header.startswith(
        "|  | sensors | queries | right | wrong but sure | not localized | best"
    )
    assert [row.split(" | ")[:2] for row in rows] == [
        ["| recorded", "-"],
        ["| one", "hdl-64e"],
        ["| cross", "os1-64 in the map of vlp-16"],
    ]
    assert "| 98.00 | 98.08 | 0.012 | 0.07 m" in rows[2]


def test_shares_without_queries_are_a_dash() -> None:
    keys = ("localised_right", "wrong_but_sure", "not_localised")
    beyond = REPORT | {
        "queries": 0,
        **dict.fromkeys(keys),
        "bounds_95": {key: [0.0, 1.0] for key in keys},
        "median_position_error_m": None,
        "metres_until_localised": {"median": None, "p95": None, "never": 0},
    }
    assert list(comparison_table({"town": {"context": beyond}}))[-1] == "| context | - / - |"
    *_, row = full_table({"town": beyond})
    assert row == f"| town | 0 |{3 * ' - (0.00 to 100.00) |'}{5 * ' - |'}"


def test_peer_has_no_distance_until_localized() -> None:
    peer = {key: value for key, value in REPORT.items() if key != "metres_until_localised"}
    *_, row = full_table({"town": peer})
    assert row.endswith("| 0.07 m, 0.15 deg | - |")


def test_command_writes_both_kinds_of_tables(folder: Path, tmp_path: Path) -> None:
    def run(*words: object) -> tuple[int, str]:
        done = CliRunner().invoke(app, ["bench", "pose-tables", *map(str, words)])
        return done.exit_code, done.output

    assert "scan-context" in run(folder)[1]
    status, output = run(folder, "--system", "context")
    assert status == 0
    assert "95.37 to" in output
    assert "scan-context" not in output
    status, output = run(folder, "--system", "nope")
    assert status == 1
    assert "unknown system 'nope'; expected one of context, group" in " ".join(output.split())
    (tmp_path / "empty").mkdir()
    status, output = run(folder, tmp_path / "empty")
    assert status == 1
    assert "no figures" in output
