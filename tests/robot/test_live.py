"""The agent on a live source, with a service that cannot be reached."""

from pathlib import Path

import numpy as np
import pytest

from robot.core.settings import AgentSettings
from robot.live import live_agent
from tests.robot.node.node_fakes import moved


@pytest.mark.slow
def test_agent_is_closed_at_the_end_and_keeps_what_it_could_not_send(tmp_path: Path) -> None:
    settings = AgentSettings("yard", state=tmp_path / "state")
    points = np.random.default_rng(0).uniform(-5, 5, (2000, 3)).astype(np.float32)
    with live_agent(settings, "http://127.0.0.1:1", wait=0.1) as agent:
        agent.on_scan(points, 10.0, moved(0))
        assert agent.status.scans == 1
    assert agent.close().scans == 1  # closed before: the summary stays
    assert any((tmp_path / "state").iterdir())


@pytest.mark.slow
def test_agent_is_closed_after_an_error() -> None:
    with (
        pytest.raises(RuntimeError, match="the driver has failed"),
        live_agent(AgentSettings("yard"), "http://127.0.0.1:1", wait=0.1) as agent,
    ):
        raise RuntimeError("the driver has failed")
    assert agent.close().scans == 0
