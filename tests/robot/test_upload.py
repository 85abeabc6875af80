"""Upload: names of maps, lost answers, refusals."""

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, encode_delta

from robot.core.link import LinkError, RefusedError
from robot.mapping.spool import SpoolEntry
from robot.mapping.upload import names_for, send
from tests.robot.agent_fakes import FakeLink


def edit(ids: list[int], frame: str = "robot/session/0", removed: tuple[int, ...] = ()) -> bytes:
    count = len(ids)
    content = CompactMap(
        model_id="fake-0123",
        preprocessing="1",
        frame=frame,
        codes=np.zeros((count, 4), np.int8),
        centroids=np.zeros((count, 3)),
        ids=np.array(ids, np.uint32),
        robots=("robot",) if count else (),
        robot=np.zeros(count, np.uint16),
        frame_index=np.zeros(count, np.uint32),
        frame_times=np.zeros(1),
        frame_positions=np.zeros((1, 3)),
        frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
    )
    return encode_delta(Delta(content, np.array(removed, np.uint32)))


def entry(number: int, content: bytes, part: int = 0) -> SpoolEntry:
    return SpoolEntry(number, "session", part, content)


def test_names_begin_with_the_wanted_one_and_stay_valid() -> None:
    names = names_for("yard", "robot 7/é")
    assert [next(names) for _ in range(4)] == [
        "yard",
        "yard-robot_7_",
        "yard-robot_7_-2",
        "yard-robot_7_-3",
    ]
    long = names_for("y" * 64, "r" * 90)
    assert all(len(next(long)) <= 64 for _ in range(20))
    assert len({next(long) for _ in range(20)}) == 20


def test_first_edit_creates_the_map_and_the_others_extend_it() -> None:
    link = FakeLink()
    result = send(link, [entry(1, edit([0])), entry(2, edit([1]))], {}, "yard", "robot")
    assert [name for _, name in result.sent] == ["yard", "yard"]
    assert link.maps["yard"].ids.tolist() == [0, 1]


def test_edit_that_only_removes_segments_goes_to_the_same_map() -> None:
    link = FakeLink()
    edits = [edit([0, 1]), edit([], removed=(1,)), edit([2])]
    entries = [entry(number, content) for number, content in enumerate(edits)]
    result = send(link, entries, {}, "yard", "robot")
    assert [name for _, name in result.sent] == ["yard"] * 3
    assert link.maps["yard"].ids.tolist() == [0, 2]


def test_map_of_another_robot_is_not_changed() -> None:
    link = FakeLink()
    send(link, [entry(1, edit([5], frame="other"))], {}, "yard", "other")
    result = send(link, [entry(1, edit([0]))], {}, "yard", "robot")
    assert [name for _, name in result.sent] == ["yard-robot"]
    assert link.maps["yard"].ids.tolist() == [5]


def test_edit_whose_answer_was_lost_is_stored_once() -> None:
    link = FakeLink()
    link.lost_answers = 1
    entries = [entry(1, edit([0, 1]))]
    first = send(link, entries, {}, "yard", "robot")
    assert first.sent == ()
    assert first.error == "the answer was lost"
    assert not first.was_reached
    second = send(link, entries, {}, "yard", "robot")
    assert [name for _, name in second.sent] == ["yard"]
    assert link.maps["yard"].ids.tolist() == [0, 1]
    assert list(link.maps) == ["yard"]


def test_failure_in_the_middle_keeps_the_rest() -> None:
    link = FakeLink()
    failing = edit([2])
    upload = link.upload

    def refuse(name: str, delta: bytes, robot: str, create: bool) -> None:
        if delta == failing:
            raise LinkError("busy", 7.0, was_reached=True)
        upload(name, delta, robot, create)

    link.upload = refuse  # type: ignore[method-assign]
    result = send(link, [entry(1, edit([0])), entry(2, failing)], {}, "yard", "robot")
    assert [each.number for each, _ in result.sent] == [1]
    assert (result.error, result.retry_after, result.was_reached) == ("busy", 7.0, True)


def test_map_that_was_removed_is_begun_again() -> None:
    link = FakeLink()
    result = send(link, [entry(1, edit([3]))], {("session", 0): "yard"}, "yard", "robot")
    assert [name for _, name in result.sent] == ["yard"]


@pytest.mark.parametrize(
    ("status", "is_kept"), [(401, True), (403, True), (507, True), (422, False)]
)
def test_refused_edit_is_kept_if_a_person_can_cure_it(status: int, is_kept: bool) -> None:
    link = FakeLink()
    link.failure = RefusedError("no", status, "some-problem")
    result = send(link, [entry(1, edit([0]))], {}, "yard", "robot")
    assert (result.refused is None) == is_kept
    assert (result.error is not None) == is_kept
