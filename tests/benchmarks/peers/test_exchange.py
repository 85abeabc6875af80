import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.peers.exchange import (
    NOTHING,
    Estimate,
    MapFrame,
    Peer,
    PeerAnswer,
    nearest_frame,
    read_answers,
    write_answers,
)
from tests.placecell.segment_builders import pose

PEER = Peer("somebody", {"voxel": 0.3}, {"numpy": "2"}, 1.5)
ANSWERS = [
    PeerAnswer(Estimate(pose(1.5, -2.0, 0.1, yaw=0.3), 12.0, sure=True), 30.5),
    PeerAnswer(NOTHING, 2.0),
    PeerAnswer(Estimate(pose(), -0.2, sure=False), 3.0),
]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    file = tmp_path / "somebody.jsonl"
    write_answers(file, PEER, ANSWERS)
    return file


def test_answers_are_read_as_written(file: Path) -> None:
    peer, answers = read_answers(file, 3)
    assert peer == PEER
    assert [answer.milliseconds for answer in answers] == [30.5, 2.0, 3.0]
    assert answers[1].estimate is NOTHING
    for answer, before in zip(answers[::2], ANSWERS[::2], strict=True):
        assert np.array_equal(answer.estimate.pose, before.estimate.pose)  # type: ignore[arg-type]
        assert answer.estimate.score == before.estimate.score
        assert answer.estimate.sure == before.estimate.sure


def test_every_line_is_standard_json(file: Path) -> None:
    for line in file.read_text().splitlines():
        json.loads(line, parse_constant=pytest.fail)


def test_too_few_answers_are_refused(file: Path) -> None:
    with pytest.raises(ValueError, match="3 answers; 4 were expected"):
        read_answers(file, 4)


@pytest.mark.parametrize(
    "line",
    [
        "{",
        "[]",
        "{}",
        '{"milliseconds": 1}',
        '{"milliseconds": "x", "pose": null}',
        '{"milliseconds": 1, "pose": [[1, 2], [3, 4]], "score": 1, "sure": true}',
        json.dumps(
            {"milliseconds": 1, "pose": (np.eye(4) * np.nan).tolist(), "score": 1, "sure": 1}
        ),
        json.dumps({"milliseconds": 1, "pose": np.eye(4).tolist(), "score": None, "sure": True}),
    ],
)
def test_line_that_is_no_answer_is_refused(file: Path, line: str) -> None:
    file.write_text(file.read_text().splitlines()[0] + "\n" + line + "\n")
    with pytest.raises(ValueError, match=r"somebody.jsonl is not a file of a peer's answers"):
        read_answers(file, 1)


@pytest.mark.parametrize("text", ["", "{}\n", '{"name": 1, "more": 2}\n', "\x00\n"])
def test_file_without_a_peer_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "x.jsonl").write_text(text)
    with pytest.raises(ValueError, match="not a file of a peer's answers"):
        read_answers(tmp_path / "x.jsonl", 0)


def test_nearest_frame_is_the_one_with_the_nearest_origin() -> None:
    frames = [MapFrame(pose(x), np.zeros((0, 3), np.float32)) for x in (0.0, 5.0, 10.0)]
    assert nearest_frame(frames, pose(7.4, 2.0)) is frames[1]
    assert nearest_frame(frames, pose(7.6, 2.0)) is frames[2]
