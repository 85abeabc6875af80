"""The agent: each transition of its state, with fakes of link and engine."""

import errno
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from placecell_client import CompactMap, MapCopy, decode_delta
from placecell_client.maps.follow import moved_at

from placecell.core.types import Float64
from robot.agent import RobotAgent
from robot.core.link import LinkError, RefusedError
from robot.core.settings import AgentSettings
from robot.core.status import AgentState
from robot.core.worker import InlineWorker
from robot.localization.pulled_map import save_copy
from robot.outputs.output import NoOutput
from tests.client.test_follow import line, turned
from tests.robot.agent_fakes import (
    FakeClock,
    FakeEngine,
    FakeLink,
    Recorder,
    Street,
    at,
    drive,
    new_agent,
)
from tests.robot.test_upload import edit

pytestmark = pytest.mark.slow

OFFSET = at(100.0, 50.0, 0.7)
"""Where the odometry frame of the tests lies in the map."""


@pytest.fixture(scope="module")
def street() -> Street:
    return Street()


def settings(**changes: object) -> AgentSettings:
    return AgentSettings(**{"map": "yard", "upload": False} | changes)  # type: ignore[arg-type]


def state_of(agent: RobotAgent) -> str:
    return agent.status.state.value


def steps(first: float, last: float, step: float = 1.0) -> list[float]:
    return np.arange(first, last, step).tolist()


def test_two_agreeing_fixes_make_the_pose_known(street: Street) -> None:
    link, recorder = FakeLink(), Recorder()
    link.transform = OFFSET
    agent = new_agent(settings(), link, recorder=recorder)
    drive(agent, street, steps(0, 12))
    assert recorder.states == ["localizing", "tracking"]
    assert [fix.accepted for fix in recorder.fixes][:2] == [False, True]
    assert agent.map_to_odom is not None
    np.testing.assert_allclose(agent.map_to_odom.transform, OFFSET, atol=1e-6)
    assert agent.close().meters_until_first_fix is not None


def test_ignored_classes_are_asked_for_and_unmapped_ones_are_not_stored(street: Street) -> None:
    # The engine of these tests calls everything a vehicle.
    link = FakeLink()
    agent = new_agent(settings(upload=True, ignore=("movable",), unmapped=("vehicle",)), link)
    drive(agent, street, steps(0, 12))
    agent.finish()
    assert agent.wait_for_uploads(1.0)
    assert {each.ignore for each in link.asked} == {("movable",)}
    assert all(
        each.classes is not None and len(each.classes) == len(each.codes) > 0 for each in link.asked
    )
    assert agent.close().segments == 0
    assert not link.maps


def test_without_any_fix_there_is_no_pose(street: Street) -> None:
    agent = new_agent(settings(), FakeLink())
    drive(agent, street, steps(0, 12))
    assert state_of(agent) == "localizing"
    assert agent.map_to_odom is None
    assert agent.status.reason == "nothing agrees"
    assert agent.close().meters_until_first_fix is None


def test_covariance_grows_with_the_distance_since_the_last_fix(street: Street) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 12))
    assert agent.map_to_odom is not None
    before = agent.map_to_odom.covariance
    link.transform = None
    drive(agent, street, steps(12, 40), first_time=1.2)
    after = agent.map_to_odom.covariance
    assert (np.diag(after)[[0, 1, 5]] > 1.5 * np.diag(before)[[0, 1, 5]]).all()


def test_one_contradicting_fix_makes_the_pose_unsure_but_does_not_move_it(street: Street) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 12))
    link.transform = at(500.0)
    while state_of(agent) == "tracking":
        place = agent.status.meters + 1.0
        drive(agent, street, [place], first_time=1.2 + place / 10)
    assert state_of(agent) == "lost"
    assert agent.map_to_odom is not None
    np.testing.assert_allclose(agent.map_to_odom.transform, OFFSET, atol=1e-6)
    link.transform = OFFSET
    drive(agent, street, steps(20, 26), first_time=4.0)
    assert state_of(agent) == "tracking"


def test_two_fixes_elsewhere_move_the_pose(street: Street) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 12))
    link.transform = at(500.0)
    drive(agent, street, steps(12, 24), first_time=1.2)
    assert state_of(agent) == "tracking"
    assert agent.map_to_odom is not None
    np.testing.assert_allclose(agent.map_to_odom.transform, at(500.0), atol=1e-6)
    assert agent.close().kidnaps == 1


def test_robot_that_is_carried_away_is_noticed_at_the_second_scan(street: Street) -> None:
    link, recorder = FakeLink(), Recorder()
    link.transform = OFFSET
    agent = new_agent(settings(), link, recorder=recorder)
    drive(agent, street, steps(0, 16))
    link.transform = None
    # The odometry goes on, but the scans are those of another place.
    drive(agent, street, steps(120, 122), odometry=lambda x: at(x - 104), first_time=1.6)
    assert recorder.states[-2:] == ["lost", "kidnapped"]
    assert agent.map_to_odom is None
    link.transform = at(700.0)
    drive(agent, street, steps(122, 134), odometry=lambda x: at(x - 104), first_time=1.8)
    assert state_of(agent) == "tracking"
    summary = agent.close()
    assert summary.kidnaps == 1


def test_one_bad_scan_is_left_out_and_the_pose_stays(street: Street) -> None:
    link, recorder = FakeLink(), Recorder()
    link.transform = OFFSET
    agent = new_agent(settings(), link, recorder=recorder)
    drive(agent, street, steps(0, 16))
    agent.on_scan(street.scan(at(150.0)), 1.6, at(16.0))
    assert state_of(agent) == "lost"
    drive(agent, street, [17.0], first_time=1.7)
    assert state_of(agent) == "tracking"
    assert agent.close().kidnaps == 0


def test_leaving_the_map_and_coming_back_is_noticed(street: Street) -> None:
    link, engine, recorder = FakeLink(), FakeEngine(), Recorder()
    link.transform = OFFSET
    agent = new_agent(settings(), link, engine, recorder)
    drive(agent, street, steps(0, 16))
    link.transform = None
    engine.mapped = lambda _: 45.0
    drive(agent, street, steps(16, 30), first_time=1.6)
    assert state_of(agent) == "outside"
    assert agent.map_to_odom is not None
    link.transform = OFFSET
    engine.mapped = lambda _: 0.0
    drive(agent, street, steps(30, 44), first_time=3.0)
    assert state_of(agent) == "tracking"
    assert recorder.states == ["localizing", "tracking", "outside", "tracking"]


def test_a_long_way_without_a_fix_inside_the_map_makes_the_pose_unsure(street: Street) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(keyframe_meters=10.0), link)
    drive(agent, street, steps(0, 30, 2.0))
    link.transform = None
    drive(agent, street, steps(30, 180, 4.0), first_time=3.0)
    assert state_of(agent) == "lost"


def test_without_a_link_the_pulled_map_gives_the_pose(street: Street) -> None:
    link, engine = FakeLink(), FakeEngine()
    link.failure = LinkError("no route to the service")
    engine.local_pose = OFFSET
    mapper = new_agent(settings(map="yard", upload=True, robot="a", localize=False), FakeLink())
    drive(mapper, street, steps(0, 40))
    agent = new_agent(settings(), link, engine)
    engine.pulled = object()  # type: ignore[assignment]
    drive(agent, street, steps(0, 12))
    assert agent.status.link.value == "offline"
    assert state_of(agent) == "tracking"
    assert agent.status.last_fix is not None
    assert agent.status.last_fix.source == "local"


def test_link_that_comes_back_is_used_again(street: Street) -> None:
    link, engine, clock = FakeLink(), FakeEngine(), FakeClock()
    source = FakeLink()
    mapper = new_agent(settings(upload=True, robot="a", localize=False), source)
    drive(mapper, street, steps(0, 60))
    mapper.finish()
    assert mapper.wait_for_uploads(1.0)
    link.maps, link.transform = source.maps, OFFSET
    agent = new_agent(settings(), link, engine, clock=clock)
    link.failure = LinkError("no route to the service")
    drive(agent, street, steps(0, 12))
    assert agent.status.link.value == "offline"
    link.failure = None
    clock.now += 60.0
    drive(agent, street, steps(12, 24), first_time=1.2)
    assert agent.status.link.value == "online"
    assert agent.status.last_fix is not None
    assert agent.status.last_fix.source == "service"
    assert engine.pulled is not None


def test_map_that_was_replaced_makes_the_pose_unknown(street: Street) -> None:
    link, clock = FakeLink(), FakeClock()
    mapper = new_agent(settings(upload=True, robot="a", localize=False), link)
    drive(mapper, street, steps(0, 60))
    mapper.finish()
    assert mapper.wait_for_uploads(1.0)
    link.transform = OFFSET
    agent = new_agent(settings(), link, clock=clock)
    drive(agent, street, steps(0, 12))
    assert state_of(agent) == "tracking"
    link.transform = None
    link.maps["yard"] = replace(link.maps["yard"], frame="another")
    clock.now += 61.0
    drive(agent, street, [12.0, 13.0], first_time=1.2)
    assert state_of(agent) == "localizing"
    assert agent.map_to_odom is None


def test_clock_that_jumps_is_told_and_does_not_disturb(street: Street) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 12))
    agent.on_scan(street.scan(at(12)), -500.0, at(12))
    assert "went back" in agent.messages[0]
    assert state_of(agent) == "tracking"
    agent.on_scan(street.scan(at(13)), 5000.0, at(13))
    assert "no scan for" in agent.messages[0]
    assert state_of(agent) == "tracking"


@pytest.mark.parametrize(
    ("pose", "told"),
    [
        (np.full((4, 4), np.nan), "not finite"),
        (at(1e9), "unit"),
        (at(1e300), "unit"),
        (np.zeros((4, 4)), "no rotation"),
        (np.diag([1.0, 1.0, -1.0, 1.0]), "no rotation"),
        (np.diag([2.0, 2.0, 2.0, 1.0]), "no rotation"),
    ],
)
def test_pose_that_cannot_be_used_is_left_out(street: Street, pose: Float64, told: str) -> None:
    agent = new_agent(settings(), FakeLink())
    agent.on_scan(street.scan(at(0)), 0.0, pose)
    assert told in agent.messages[0]
    assert agent.close().scans_dropped == 1


@pytest.mark.parametrize("name", ["two words", "../yard", "a" * 65, "yard\n"])
@pytest.mark.parametrize("field", ["map", "localize_map", "upload_map"])
def test_name_that_no_map_can_have_is_refused_before_the_drive(field: str, name: str) -> None:
    with pytest.raises(ValueError, match="expected 1 to 64 letters"):
        settings(**{field: name})


def test_infinite_spool_is_refused() -> None:
    with pytest.raises(ValueError, match="positive number"):
        settings(spool_bytes=float("inf"))


def test_output_on_a_full_disk_ends_alone(street: Street) -> None:
    recorder, full = Recorder(), FullOutput()
    agent = RobotAgent(
        settings(),
        FakeLink(),
        [full, recorder],
        FakeClock(),
        FakeEngine(),  # type: ignore[arg-type]
        InlineWorker,
    )
    told = []
    for place in steps(0, 6):
        agent.on_scan(street.scan(at(place)), place / 10, at(place))
        told += agent.messages
    assert [each for each in told if "run.tum" in each] == [
        "run.tum ends here, and the robot goes on: it cannot be written (No space left on device)"
    ]
    assert full.scans == 1
    assert recorder.states
    assert agent.close().scans == len(steps(0, 6))


def test_error_is_told_once_though_its_request_ids_differ(street: Street) -> None:
    link, clock = FakeLink(), FakeClock()
    agent = new_agent(settings(), link, clock=clock)
    told = []
    for number, place in enumerate(steps(0, 12)):
        link.failure = LinkError(f"the service cannot be reached (request {number:032x})")
        clock.now += 30.0
        agent.on_scan(street.scan(at(place)), place / 10, at(place))
        told += [each for each in agent.messages if "cannot be reached" in each]
    assert len(told) == 1


def test_agent_may_wait_without_a_limit(street: Street) -> None:
    agent = RobotAgent(
        settings(upload=True),
        SlowLink(),
        [],
        FakeClock(),
        FakeEngine(),  # type: ignore[arg-type]
    )
    drive(agent, street, steps(0, 12))
    agent.finish()
    assert agent.wait_for_uploads(float("inf"))  # a real worker's wait takes no infinity
    assert agent.close().uploads > 0


def test_refused_report_is_told_once(street: Street) -> None:
    link, clock = DeafLink(), FakeClock()
    agent = new_agent(settings(robot="robot 7"), link, clock=clock)
    told = []
    for place in steps(0, 12):
        clock.now += 10.0
        agent.on_scan(street.scan(at(place)), place / 10, at(place))
        told += [each for each in agent.messages if "others do not see this robot" in each]
    assert len(told) == 1


def test_pulled_map_of_another_model_does_not_stop_the_start(tmp_path: Path) -> None:
    save_copy(MapCopy("yard", decode_delta(edit([1])).changed, "00ab-3"), tmp_path / "maps")
    engine = PickyEngine()
    agent = new_agent(settings(state=tmp_path), FakeLink(), engine)
    assert engine.refused == 1
    agent.close()


class FullOutput(NoOutput):
    """Output on a full disk."""

    path = "run.tum"
    scans = 0

    def scan(self, *_: object) -> None:
        self.scans += 1
        raise OSError(errno.ENOSPC, "No space left on device")


class SlowLink(FakeLink):
    """Link whose uploads take longer than a scan."""

    def upload(self, name: str, delta: bytes, robot: str, create: bool) -> None:
        time.sleep(0.2)
        super().upload(name, delta, robot, create)


class DeafLink(FakeLink):
    """Link to a service that takes no reports of this robot."""

    def report(self, *_: object) -> None:
        raise RefusedError("Invalid robot name", 422, "invalid-name")


class PickyEngine(FakeEngine):
    """Engine of another model than that of the pulled map."""

    refused = 0

    def set_map(self, content: CompactMap, etag: str) -> None:
        self.refused += 1
        raise ValueError("The map has another model.")


def test_robot_that_ends_reports_its_last_state(street: Street) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 30))
    begun = len(link.reports)
    agent.close()
    assert len(link.reports) == begun + 1
    assert (link.reports[-1].state, link.reports[-1].scans) == (AgentState.TRACKING, 30)
    assert link.reports[-1].reason.endswith("; the agent has ended")


@pytest.mark.parametrize(
    "failure", [LinkError("away"), RefusedError("Invalid robot name", 422, "invalid-name")]
)
def test_robot_that_ends_without_a_link_ends_all_the_same(
    street: Street, failure: Exception
) -> None:
    link = FakeLink()
    link.failure = failure
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 5))
    agent.close()
    assert link.reports == []


def test_last_pose_is_confirmed_by_one_fix_after_a_restart(street: Street, tmp_path: Path) -> None:
    link = FakeLink()
    link.transform = OFFSET
    agent = new_agent(settings(state=tmp_path, session="first"), link)
    drive(agent, street, steps(0, 30))
    agent.close()
    # The robot was switched off and on: its odometry begins at 0 again.
    link.transform = OFFSET @ at(29.0)
    recorder = Recorder()
    again = new_agent(settings(state=tmp_path, session="second"), link, recorder=recorder)
    drive(again, street, steps(29, 36), odometry=lambda x: at(x - 29.0), first_time=9.0)
    assert recorder.fixes[0].accepted
    again.close()


@pytest.mark.parametrize("content", ["", "{", "[]", '{"map": "yard"}', "\x00\x01"])
def test_garbage_as_last_pose_is_ignored(street: Street, tmp_path: Path, content: str) -> None:
    (tmp_path / "last_pose.json").write_text(content)
    agent = new_agent(settings(state=tmp_path), FakeLink())
    drive(agent, street, [0.0])
    assert state_of(agent) == "localizing"
    agent.close()


def test_pose_of_a_person_is_taken_and_corrected(street: Street) -> None:
    link = FakeLink()
    agent = new_agent(settings(), link)
    drive(agent, street, steps(0, 6))
    agent.on_initial_pose(OFFSET @ at(5.0), np.eye(6) * 0.25)
    assert state_of(agent) == "tracking"
    assert agent.map_to_odom is not None
    np.testing.assert_allclose(agent.map_to_odom.transform, OFFSET, atol=1e-6)
    agent.localize_now()
    link.transform = OFFSET @ at(0.3)
    drive(agent, street, [6.0, 7.0], first_time=0.6)
    assert agent.close().fixes == 1


def test_robot_without_localization_maps(street: Street) -> None:
    agent = new_agent(settings(localize=False, upload=True), None)
    drive(agent, street, steps(0, 12))
    assert state_of(agent) == "mapping"
    assert agent.map_to_odom is not None
    agent.finish()
    assert agent.close().spool.entries > 0


def test_pose_moves_with_a_map_that_was_optimized(street: Street) -> None:
    engine = FakeEngine()
    agent = new_agent(settings(), FakeLink(), engine)
    drive(agent, street, steps(0, 6))
    agent.on_initial_pose(OFFSET @ at(5.0), np.eye(6) * 0.01)
    before = line()
    after = turned(before)
    engine.replaced = before, after
    position = (OFFSET @ at(6.0))[:3, 3]
    moved = moved_at(before, after, position.tolist())
    assert moved is not None
    drive(agent, street, [6.0], first_time=0.6)
    assert agent.map_to_odom is not None
    np.testing.assert_allclose(agent.map_to_odom.transform, moved @ OFFSET, atol=1e-6)
    assert any("map was corrected" in message for message in agent.messages)
    # A version that moves nothing here changes nothing.
    engine.replaced = after, after
    drive(agent, street, [7.0], first_time=0.7)
    np.testing.assert_allclose(agent.map_to_odom.transform, moved @ OFFSET, atol=1e-6)


def test_robot_that_sends_no_map_asks_for_no_classes(street: Street, tmp_path: Path) -> None:
    asked = {}
    for upload in (False, True):
        engine = FakeEngine()
        agent = new_agent(settings(upload=upload, state=tmp_path / str(upload)), FakeLink(), engine)
        drive(agent, street, steps(0, 6))
        agent.close()
        asked[upload] = engine.classified
    assert asked[False] == len(asked[False]) * [False] != []
    assert asked[True] == len(asked[True]) * [True] != []
