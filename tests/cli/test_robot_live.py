"""`placecell robot zenoh://...`, in this process; the network is a stand-in."""

import json
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import pytest
from typer.testing import CliRunner

from cli import app
from robot.core.settings import AgentSettings
from robot.core.status import AgentState, LinkState, SpoolStatus, Summary
from robot.zenoh.address import ZenohAddress
from robot.zenoh.bus import MISSING

SUMMARY = Summary(
    1.5, 3, 0, 1, 2, 1, 0, 1.0, 0, 0, SpoolStatus(), (), AgentState.TRACKING, LinkState.ONLINE
)


class StandIn:
    """Stand-in for the agent; keeps its settings."""

    settings: AgentSettings
    summary = SUMMARY

    def close(self) -> Summary:
        return self.summary


@pytest.fixture
def agent(monkeypatch: pytest.MonkeyPatch) -> StandIn:
    agent = StandIn()

    @contextmanager
    def opened(settings: AgentSettings, *_: Any) -> Iterator[StandIn]:
        agent.settings = settings
        yield agent

    monkeypatch.setattr("robot.live.live_agent", opened)
    return agent


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """Arguments of each run; a run ends by the signal of Ctrl-C."""
    calls: list[tuple[Any, ...]] = []

    def run(*arguments: Any) -> None:
        calls.append(arguments)
        arguments[-1]("the link is back")
        os.kill(os.getpid(), signal.SIGINT)
        assert arguments[3].wait(5)

    pytest.importorskip("zenoh", reason="Zenoh is not installed: pip install 'placecell[zenoh]'")
    monkeypatch.setattr("robot.zenoh.node.run_on_zenoh", run)
    return calls


def robot(*words: str) -> tuple[int, str, str]:
    """Run the command and return status, output and errors."""
    done = CliRunner().invoke(app, ["robot", *words])
    assert done.exception is None or isinstance(done.exception, SystemExit)
    return done.exit_code, done.stdout, done.stderr


def test_topics_of_a_robot_are_a_source(agent: StandIn, calls: list[tuple[Any, ...]]) -> None:
    before = signal.getsignal(signal.SIGINT)
    source = "zenoh://h?points=/velodyne&map_frame=site"
    status, output, errors = robot(
        source, "--map", "yard", "--extrinsic", "0 0 1.5 0 0 0", "--no-deskew", "--json"
    )
    assert (status, errors) == (0, "placecell: the link is back\n")
    assert json.loads(output)["fixes"] == 1
    assert (agent.settings.map, agent.settings.robot) == ("yard", "robot")
    given, address, settings, _, _ = calls[0]
    assert given is agent
    assert address == ZenohAddress(connect=("tcp/h:7447",), points="/velodyne", map_frame="site")
    assert settings.mount[2, 3] == 1.5
    assert (settings.map_frame, settings.deskew) == ("site", False)
    assert signal.getsignal(signal.SIGINT) is before


def test_each_start_begins_a_session(agent: StandIn, calls: list[tuple[Any, ...]]) -> None:
    sessions = set()
    for _ in range(2):
        assert robot("zenoh://h", "--map", "yard", "--robot-name", "ann")[0] == 0
        sessions.add(agent.settings.session)
        assert agent.settings.robot == "ann"
    assert len(sessions) == 2


def test_edits_that_are_left_are_told(agent: StandIn, calls: list[tuple[Any, ...]]) -> None:
    agent.summary = replace(SUMMARY, spool=SpoolStatus(entries=2))
    _, _, errors = robot("zenoh://h", "--map", "yard")
    assert "placecell: 2 edits could not be sent. They are lost." in errors


def test_invalid_address_is_told() -> None:
    status, _, errors = robot("zenoh://h?cloud=/points", "--map", "yard")
    assert status == 1
    assert "Unknown key 'cloud'" in errors


def test_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zenoh", None)
    status, _, errors = robot("zenoh://h", "--map", "yard")
    assert status == 1
    assert MISSING.split(":")[0] in errors
