"""Agent on a live source: with a link to the service, and an orderly end."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager

from robot.agent import RobotAgent
from robot.core.settings import AgentSettings
from robot.outputs.output import AgentOutput
from robot.service_link import ServiceLink, robot_client

ASKING_SECONDS = 3.0
"""Time limit of a request for the pose; a later answer is of little use."""


@contextmanager
def live_agent(
    settings: AgentSettings,
    service: str,
    key: str | None = None,
    wait: float = 10.0,
    outputs: Sequence[AgentOutput] = (),
) -> Iterator[RobotAgent]:
    """Open an agent for a block; at its end, send the rest and close the agent.

    Args:
        settings: settings of the agent.
        service: address of the service; it need not be reachable.
        key: API key.
        wait: longest time to send the rest, seconds. What is left stays in the state folder.
        outputs: receivers of poses, fixes, states and segments.
    """
    with ExitStack() as opened:
        client = opened.enter_context(robot_client(service, key))
        asking = opened.enter_context(robot_client(service, key, timeout=ASKING_SECONDS))
        agent = RobotAgent(settings, ServiceLink(client, asking), outputs)
        opened.callback(agent.close)
        yield agent
        agent.finish()
        agent.wait_for_uploads(wait)
