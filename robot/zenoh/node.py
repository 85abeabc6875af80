"""The agent's node on a Zenoh bus."""

import logging
import threading
from collections.abc import Callable
from typing import TypeVar

from placecell.sources.errors import DriveError
from placecell.sources.scan_options import silent
from robot.node.messages import CertainPose, Diagnostic, StampedTransform
from robot.node.node import NodeAgent, RobotNode
from robot.node.settings import NodeSettings
from robot.zenoh import cdr
from robot.zenoh.address import ZenohAddress
from robot.zenoh.bus import ZenohBus
from robot.zenoh.rmw import NO_HASH, Quality, TopicType
from robot.zenoh.services import TRIGGER, trigger_hash, write_trigger_response

T = TypeVar("T")

SENSOR = Quality(5, best_effort=True)
RELIABLE = Quality(10)
TRANSFORM = Quality(100)
LATCHED = Quality(1, transient_local=True)
REQUESTED = "A pose is requested at the next scan; now: {}."
log = logging.getLogger(__name__)


def topic(address: ZenohAddress, name: str, kind: str, quality: Quality) -> TopicType:
    """Return a topic; other nodes of Humble know no hashes."""
    type_hash = NO_HASH if address.distro == "humble" else cdr.type_hash(kind)
    return TopicType(name, kind, type_hash, quality)


class BusNodePublisher:
    """Publisher of the node's messages on a Zenoh bus."""

    def __init__(self, bus: ZenohBus, address: ZenohAddress) -> None:
        def declare(name: str, kind: str, quality: Quality) -> Callable[[bytes], None]:
            return bus.publisher(topic(address, name, kind, quality)).put

        self._transform = declare(address.tf, cdr.TRANSFORMS, TRANSFORM)
        self._pose = declare(address.pose, cdr.POSE, RELIABLE)
        self._diagnostic = declare(address.diagnostics, cdr.DIAGNOSTICS, RELIABLE)

    def transform(self, transform: StampedTransform) -> None:
        """Publish `map -> odom`."""
        self._transform(cdr.write_transforms([transform]))

    def pose(self, pose: CertainPose) -> None:
        """Publish the pose of the robot in the map."""
        self._pose(cdr.write_pose(pose))

    def diagnostic(self, diagnostic: Diagnostic) -> None:
        """Publish the state."""
        self._diagnostic(cdr.write_diagnostics(diagnostic))


def run_on_zenoh(
    agent: NodeAgent,
    address: ZenohAddress,
    settings: NodeSettings,
    stop: threading.Event,
    tell: Callable[[str], None] = silent,
) -> None:
    """Run the agent on the topics of a Zenoh network until the event is set.

    Args:
        agent: the agent; it stays open.
        address: endpoints and topics.
        settings: settings of the node.
        stop: event that ends the run.
        tell: receives the agent's lines for the user.

    Raises:
        MissingZenohError: Zenoh is not installed.
        ZenohError: the session cannot be opened.
    """
    with ZenohBus(address.node, address.domain, address.connect, address.listen) as bus:
        node = RobotNode(agent, BusNodePublisher(bus, address), settings, tell)

        def subscribe(
            name: str,
            kind: str,
            quality: Quality,
            read: Callable[[bytes, str], T],
            give: Callable[[T], None],
        ) -> None:
            def receive(data: bytes) -> None:
                try:
                    message = read(data, name)
                except DriveError as error:
                    log.warning("%s", error)
                else:
                    give(message)

            bus.subscribe(topic(address, name, kind, quality), receive)

        def give_static(transforms: list[StampedTransform]) -> None:
            for each in transforms:
                node.on_static_transform(each)

        subscribe(address.tf_static, cdr.TRANSFORMS, LATCHED, cdr.read_transforms, give_static)
        subscribe(address.odom, cdr.ODOMETRY, SENSOR, cdr.read_odometry, node.on_odometry)
        subscribe(address.points, cdr.CLOUD, SENSOR, cdr.read_cloud, node.on_cloud)
        subscribe(address.initialpose, cdr.POSE, RELIABLE, cdr.read_pose, node.on_initial_pose)

        def localize(_: bytes) -> bytes:
            node.on_localize()
            return write_trigger_response(True, REQUESTED.format(agent.status.state.value))

        kind_hash = NO_HASH if address.distro == "humble" else trigger_hash()
        name = f"/{address.node}/localize"
        bus.serve(TopicType(name, TRIGGER, kind_hash, RELIABLE), localize)
        node.run(stop)
