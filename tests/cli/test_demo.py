"""The demo's last lines and exit status agree with its results."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from cli import app
from cli.demo import poses_in_words
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
NOWHERE = Meeting([LOST, WRONG, LOST], LAID.alignment, LAID.alignment_error, 9, 1)
APART = Meeting([RIGHT], None, (np.inf, np.inf), 0, 0, "7 segments in a map.")
ASIDE = Meeting([RIGHT], LAID.alignment, (4.25, 0.5), 9, 1)
NOTHING = Meeting([LOST], None, (np.inf, np.inf), 0, 0, "7 segments in a map.")

SHORT, LONG = 20, 30
"""Path lengths in meters, below and above the limit of a short drive."""


@pytest.fixture
def ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Run the demo on a drive of some length with given results; return status and output."""

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
def test_demo_with_right_results_succeeds(ended: Any, tmp_path: Path, meters: int) -> None:
    status, said = ended(LAID, meters)
    assert status == 0
    assert "It works: robot B is localized in robot A's map" in said
    assert json.loads((tmp_path / "figures.json").read_text())["model_id"] == "tiny"


KNOWS, SHARE = "yes: Robot B is localized", "yes: Both robots share one map"
UNKNOWN = "Robot B was never localized rightly: of 3 answers 1 are wrong"
REFUSED = "could not be aligned (7 segments in a map.)"


@pytest.mark.parametrize(
    ("meeting", "there", "absent"),
    [
        (NOWHERE, [f"no: {UNKNOWN}", SHARE], [KNOWS]),
        (APART, [KNOWS, REFUSED], [SHARE]),
        (ASIDE, [KNOWS, "no: The alignment of the two maps is 4.2 m and 0.5 deg off"], [SHARE]),
        (
            NOTHING,
            ["no: Robot B was never localized", f"no: The two maps {REFUSED}"],
            [KNOWS, SHARE],
        ),
    ],
)
def test_demo_on_a_short_drive_reports_each_result(
    ended: Any, meeting: Meeting, there: list[str], absent: list[str]
) -> None:
    status, said = ended(meeting, SHORT)
    assert status == 0
    assert "The matches of robot B are right. The drive is too short to require more" in said
    assert all(words in said for words in there)
    assert not any(words in said for words in [*absent, "It works"])


@pytest.mark.parametrize(
    ("meeting", "words"),
    [(NOWHERE, UNKNOWN), (APART, REFUSED), (ASIDE, "4.2 m"), (NOTHING, REFUSED)],
)
def test_demo_on_a_long_drive_fails_if_one_result_is_wrong(
    ended: Any, meeting: Meeting, words: str
) -> None:
    status, said = ended(meeting, LONG)
    assert status == 1
    assert words in said
    assert "It works" not in said


@pytest.mark.parametrize("meters", [SHORT, LONG])
def test_demo_with_chance_matches_fails(ended: Any, meters: int) -> None:
    status, said = ended(LAID, meters, found=0.01)
    assert status == 1
    assert "hardly better than chance" in said


@pytest.mark.parametrize(
    ("right", "wrong", "words"),
    [
        (53, 0, "53 right (median error 3 cm), 0 wrong, 7"),
        (0, 53, "0 right, 53 wrong, 7"),
    ],
)
def test_poses_are_summarized_in_one_sentence(right: int, wrong: int, words: str) -> None:
    figures = {
        "poses_asked": 60,
        "poses_right": right,
        "poses_wrong": wrong,
        "not_localised": 7,
        "pose_median_m": 0.031 if right else None,
    }
    said = poses_in_words(figures)
    assert said == f"Robot B asks for its pose 60 times; the answers are: {words} 'not localized'."
