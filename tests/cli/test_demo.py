"""What the demo says at its end is what came out."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from cli import app
from demo.meeting import Meeting, PoseAnswer
from demo.run import DemoResult
from demo.score import Score
from evaluation.poses.robot import Robot
from placecell.localization import Pose
from tests.placecell.segment_builders import MemoryDrive, pose

HERE = np.zeros(3)
RIGHT = PoseAnswer(HERE, HERE, 0.1, 0.1, 5.0)
WRONG = PoseAnswer(HERE, HERE + 30, 52.0, 0.1, 5.0)
LOST = PoseAnswer(HERE, None, np.inf, np.inf, 5.0)

LAID = Meeting([LOST, RIGHT], Pose.of_matrix(np.eye(4)), (0.1, 0.2), 9, 1)
NOWHERE = Meeting([LOST, WRONG, LOST], LAID.laid, LAID.off, 9, 1)
APART = Meeting([RIGHT], None, (np.inf, np.inf), 0, 0, "7 segments in a map.")
ASIDE = Meeting([RIGHT], LAID.laid, (4.25, 0.5), 9, 1)
NOTHING = Meeting([LOST], None, (np.inf, np.inf), 0, 0, "7 segments in a map.")

SHORT, LONG = 20, 30
"""Metres driven."""


@pytest.fixture
def ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The demo of a drive of so many metres, that ends with a meeting: status and words."""

    def run(meeting: Meeting, meters: int, found: float = 0.7) -> tuple[int, str]:
        drive = MemoryDrive([np.zeros((0, 3))] * (meters + 1), [pose(x) for x in range(meters + 1)])
        robots = tuple(Robot(name, drive, [], np.eye(4)) for name in ("robot A", "robot B"))
        score = Score(10, 10, 0.01, {1: found}, np.ones(10, dtype=bool))
        outcome = DemoResult(score, {"model_id": "tiny"}, meeting)
        monkeypatch.setattr("evaluation.poses.robots.robots_of_drive", lambda *_: robots)
        monkeypatch.setattr("demo.run.run_demo", lambda *_: outcome)
        words = ["demo", "--drive", str(tmp_path), "--output", str(tmp_path)]
        done = CliRunner().invoke(app, words)
        return done.exit_code, " ".join(done.output.split())

    return run


@pytest.mark.parametrize("meters", [SHORT, LONG])
def test_it_works_only_where_both_came_out(ended: Any, tmp_path: Path, meters: int) -> None:
    status, said = ended(LAID, meters)
    assert status == 0
    assert "It works: robot B knows where it is" in said
    assert json.loads((tmp_path / "figures.json").read_text())["model_id"] == "tiny"


KNOWS, SHARE = "yes: robot B knows where it is", "yes: both robots share one map"
UNKNOWN = "robot B was nowhere told its right pose; of 3 answers 1 tell a wrong one"
REFUSED = "could not be laid on each other (7 segments in a map.)"


@pytest.mark.parametrize(
    ("meeting", "there", "absent"),
    [
        (NOWHERE, [f"no: {UNKNOWN}", SHARE], [KNOWS]),
        (APART, [KNOWS, REFUSED], [SHARE]),
        (ASIDE, [KNOWS, "no: the two maps were laid on each other 4.2 m and 0.5 deg off"], [SHARE]),
        (NOTHING, ["no: robot B was nowhere told", f"no: the two maps {REFUSED}"], [KNOWS, SHARE]),
    ],
)
def test_a_short_drive_is_told_which_of_both_came_out(
    ended: Any, meeting: Meeting, there: list[str], absent: list[str]
) -> None:
    status, said = ended(meeting, SHORT)
    assert status == 0
    assert "Robot B is recognised; the drive is too short to demand more" in said
    assert all(words in said for words in there)
    assert not any(words in said for words in [*absent, "It works"])


@pytest.mark.parametrize(
    ("meeting", "words"),
    [(NOWHERE, UNKNOWN), (APART, REFUSED), (ASIDE, "4.2 m"), (NOTHING, REFUSED)],
)
def test_of_a_long_drive_both_are_demanded(ended: Any, meeting: Meeting, words: str) -> None:
    status, said = ended(meeting, LONG)
    assert status == 1
    assert words in said
    assert "It works" not in said


@pytest.mark.parametrize("meters", [SHORT, LONG])
def test_whoever_is_not_recognized_fails(ended: Any, meters: int) -> None:
    status, said = ended(LAID, meters, found=0.01)
    assert status == 1
    assert "hardly better than chance" in said
