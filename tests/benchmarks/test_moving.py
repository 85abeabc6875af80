"""`placecell bench moving` on a short drive: cars are found by the labels and marked."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.robot.moving_segments import MovingSegments
from cli import app

pytestmark = pytest.mark.slow


def test_figures_count_views_by_hand() -> None:
    found = MovingSegments(
        ids=np.array([1, 1, 2, 3, 4]),
        marked=np.array([False, True, False, False, True]),
        share=np.array([0.9, 1.0, 0.0, 0.2, 0.01]),
    )
    assert found.left_out.tolist() == [True, True, False, False, True]
    assert found.figures() == {
        "views": 5,
        "marked": 2,
        "left_out": 3,
        "moving": 2,
        "moving_marked": 1,
        "moving_left_out": 2,
        "standing": 2,
        "standing_marked": 1,
        "standing_left_out": 1,
    }


def test_command_writes_a_report(tmp_path: Path) -> None:
    file = tmp_path / "moving.json"
    command = ["bench", "moving", "--scans", "30", "--sensor", "vlp-16", "--oncoming", "100"]
    result = CliRunner().invoke(app, [*command, "--json", str(file)])
    assert result.exit_code == 0, result.output
    (row,) = json.loads(file.read_text())["rows"]
    assert row["sensor"] == "vlp-16"
    assert row["moving"] > row["moving_left_out"] > 0
    assert row["standing_left_out"] < 0.01 * row["standing"]
    poses = row["poses"]
    assert poses["all"]["map_segments"] > poses["without moving"]["map_segments"]
    assert poses["all"]["queries"] == poses["without moving"]["queries"]
