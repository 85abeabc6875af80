"""A killed agent that continues makes the same map; so does one whose link fails at random."""

import random
from pathlib import Path

import numpy as np
import pytest
from placecell_client import encode

import robot.agent
from robot.core.link import LinkError
from robot.core.settings import AgentSettings
from robot.mapping.spool import FILE, Spool
from tests.robot.agent_fakes import FakeClock, FakeLink, Street, at, drive, new_agent

pytestmark = pytest.mark.slow

PLACES = np.arange(0.0, 60.0).tolist()


def settings(state: Path | None = None) -> AgentSettings:
    return AgentSettings("yard", robot="ann", session="drive", state=state, localize=False)


@pytest.fixture(scope="module")
def street() -> Street:
    return Street(8)


@pytest.fixture(scope="module")
def expected(street: Street) -> bytes:
    link = FakeLink()
    agent = new_agent(settings(), link)
    drive(agent, street, PLACES)
    agent.finish()
    assert agent.wait_for_uploads(1.0)
    agent.close()
    return encode(link.maps["yard"])


def test_agent_that_is_killed_and_continues_makes_the_same_map(
    street: Street, expected: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(robot.agent, "CHECKPOINT_KEYFRAMES", 3)
    link, draw = FakeLink(), random.Random(0)
    resumed = []
    for _ in range(5):
        agent = new_agent(settings(tmp_path), link)
        resumed.append(agent.first_scan)
        until = min(agent.first_scan + draw.randrange(5, 25), 55)
        drive(agent, street, PLACES[agent.first_scan : until], first_time=0.1 * agent.first_scan)
        agent._spool.close()  # It is killed: nothing else is done.
    assert resumed[-1] > 0
    agent = new_agent(settings(tmp_path), link)
    drive(agent, street, PLACES[agent.first_scan :], first_time=0.1 * agent.first_scan)
    agent.finish()
    assert agent.wait_for_uploads(1.0)
    agent.close()
    assert encode(link.maps["yard"]) == expected
    assert list(link.maps) == ["yard"]


def test_link_that_fails_at_random_changes_nothing(street: Street, expected: bytes) -> None:
    link, clock, draw = FakeLink(), FakeClock(), random.Random(1)
    agent = new_agent(settings(), link, clock=clock)
    for number, place in enumerate(PLACES):
        link.failure = LinkError("cut") if draw.random() < 0.5 else None
        link.lost_answers = int(draw.random() < 0.3)
        clock.now += 5.0
        agent.on_scan(street.scan(at(place)), round(0.1 * number, 6), at(place))
    link.failure, link.lost_answers = None, 0
    clock.now += 60.0
    agent.finish()
    assert agent.wait_for_uploads(1.0)
    assert encode(link.maps["yard"]) == expected


def test_drive_that_is_run_again_stores_nothing_twice(
    street: Street, expected: bytes, tmp_path: Path
) -> None:
    link = FakeLink()
    for _ in range(2):
        agent = new_agent(settings(tmp_path), link)
        assert agent.first_scan == 0
        drive(agent, street, PLACES)
        agent.finish()
        assert agent.wait_for_uploads(1.0)
        agent.close()
    assert encode(link.maps["yard"]) == expected


@pytest.mark.parametrize("content", [b"garbage" * 999, b""])
def test_damaged_state_folder_leads_to_the_same_map(
    street: Street, expected: bytes, tmp_path: Path, content: bytes
) -> None:
    link = FakeLink()
    agent = new_agent(settings(tmp_path), link)
    drive(agent, street, PLACES[:30])
    agent.close()
    (tmp_path / FILE).write_bytes(content)
    for suffix in ("-wal", "-shm"):
        (tmp_path / f"{FILE}{suffix}").unlink(missing_ok=True)
    agent = new_agent(settings(tmp_path), link)
    assert agent.first_scan == 0
    drive(agent, street, PLACES)
    agent.finish()
    assert agent.wait_for_uploads(1.0)
    agent.close()
    assert encode(link.maps["yard"]) == expected


@pytest.mark.parametrize("checkpoint", [b"not a pickle", b"\x80\x04K\x01."])
def test_checkpoint_that_cannot_be_used_leads_to_the_beginning(
    tmp_path: Path, checkpoint: bytes
) -> None:
    with Spool.open(tmp_path, "drive", 1000) as spool:
        spool.save(17, checkpoint)
    agent = new_agent(settings(tmp_path), FakeLink())
    assert agent.first_scan == 0
    assert "anew" in agent.messages[-1]
    agent.close()


def test_jump_of_the_odometry_begins_another_map(street: Street) -> None:
    link = FakeLink()
    agent = new_agent(settings(), link)
    drive(agent, street, PLACES[:30])
    drive(
        agent,
        street,
        np.arange(120.0, 150.0).tolist(),
        odometry=lambda x: at(x - 90),
        first_time=3.0,
    )
    agent.finish()
    assert agent.wait_for_uploads(1.0)
    assert sorted(link.maps) == ["yard", "yard-ann"]
    assert link.maps["yard"].frame != link.maps["yard-ann"].frame
    assert link.maps["yard-ann"].ids.min() == 0
