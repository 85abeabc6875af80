"""Parameters of the node: the settings of the agent and of its node, and the service."""

import os
import uuid
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any, Protocol, get_type_hints

from placecell.trajectories.extrinsic import parse_extrinsic
from robot.core.settings import AgentSettings
from robot.node.settings import NodeSettings

SIMPLE = (bool, int, float, str)
NAMES = tuple[str, ...]
"""Setting that is a text of names here: an empty list has no type in ROS 2."""
KEY_VARIABLE = "PLACECELL_KEY"
OWN: dict[str, Any] = {"service": "http://127.0.0.1:8000", "extrinsic": "", "wait": 5.0}
"""Parameters that are no settings: address of the service, the sensor's pose on the robot's base
(empty: from /tf_static), seconds in which the rest is sent at the end."""
DEFAULTS: dict[str, Any] = {"map": "", "session": ""}
"""Values in place of the settings' defaults. A new session begins with each start, because the
odometry of most robots restarts with them."""


class ParameterNode(Protocol):
    """Node that declares parameters, as rclpy's does."""

    def declare_parameter(self, name: str, value: Any) -> Any:
        """Declare a parameter, and return it with its value."""


@dataclass(frozen=True)
class NodeParameters:
    """Parameters of the node.

    Attributes:
        agent: settings of the agent.
        node: settings of the node.
        service: address of the service.
        key: API key, from the environment variable `PLACECELL_KEY`: parameters can be read by all.
        wait: time in which the rest is sent at the end, seconds.
    """

    agent: AgentSettings
    node: NodeSettings
    service: str
    key: str | None
    wait: float


def kind_of(hint: Any) -> Any:
    """Return the type of a parameter that holds a setting; None if no parameter can."""
    if hint in SIMPLE:
        return hint
    return str if hint in (Path | None, str | None, NAMES) else None


def defaults_of(settings: Any) -> dict[str, Any]:
    """Return name and default of each setting that a parameter can hold."""
    hints = get_type_hints(settings)
    found = {}
    for each in fields(settings):
        kind = kind_of(hints[each.name])
        if kind is not None:
            default = DEFAULTS.get(each.name, each.default)
            found[each.name] = kind("" if default in (MISSING, None, ()) else default)
    return found


def all_defaults() -> dict[str, Any]:
    """Return name and default of each parameter."""
    return OWN | defaults_of(AgentSettings) | defaults_of(NodeSettings)


def settings_of(settings: Any, values: dict[str, Any], **more: Any) -> Any:
    """Build settings from the values of parameters; an empty text stands for none."""
    hints = get_type_hints(settings)
    given = dict(more)
    for name in defaults_of(settings):
        value: Any = values[name]
        if hints[name] == NAMES:
            value = tuple(value.replace(",", " ").split())
        elif hints[name] not in SIMPLE:
            value = value or None
        if hints[name] == Path | None and value:
            value = Path(value).expanduser()
        given.setdefault(name, value)
    return settings(**given)


def read_parameters(node: ParameterNode) -> NodeParameters:
    """Declare and read all parameters.

    Raises:
        ValueError: a value is out of its range; the message names it.
    """
    defaults = all_defaults()
    values = {name: node.declare_parameter(name, defaults[name]).value for name in defaults}
    if not values["map"]:
        raise ValueError("The parameter 'map' is empty. Set it to the name of a map.")
    mount = parse_extrinsic(values["extrinsic"]) if values["extrinsic"] else None
    session = values["session"] or uuid.uuid4().hex[:16]
    return NodeParameters(
        settings_of(AgentSettings, values, session=session),
        settings_of(NodeSettings, values, mount=mount),
        values["service"],
        os.environ.get(KEY_VARIABLE) or None,
        values["wait"],
    )
