"""The bus and the node on it, in one process, on loopback without multicast."""

import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("zenoh", reason="Zenoh is not installed: pip install 'placecell[zenoh]'")

from robot.node.messages import CertainPose, StampedTransform
from robot.node.settings import NodeSettings
from robot.zenoh import cdr
from robot.zenoh.address import ZenohAddress
from robot.zenoh.bus import BusPublisher, MissingZenohError, ZenohBus, ZenohError
from robot.zenoh.node import LATCHED, RELIABLE, SENSOR, TRANSFORM, run_on_zenoh, topic
from robot.zenoh.rmw import TopicType, attachment, publisher_id
from robot.zenoh.services import TRIGGER, trigger_hash
from tests.robot.node.node_fakes import FakeAgent, cloud, moved, odometry

pytestmark = pytest.mark.slow


def free_endpoint() -> str:
    """Return an endpoint on a port of the loopback interface that is free now."""
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{listening.getsockname()[1]}"


def wait_for(condition: Callable[[], object], seconds: float = 10.0) -> None:
    """Wait until a condition holds.

    Raises:
        AssertionError: it does not hold in time.
    """
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "the condition does not hold in time"
        time.sleep(0.01)


@pytest.fixture
def endpoint() -> str:
    return free_endpoint()


@pytest.fixture
def other(endpoint: str) -> Iterator[ZenohBus]:
    """Another program on the bus."""
    with ZenohBus("driver", 0, listen=[endpoint]) as bus:
        yield bus


def test_messages_come_with_their_attachment(other: ZenohBus, endpoint: str) -> None:
    kind = topic(ZenohAddress(), "/tf", cdr.TRANSFORMS, TRANSFORM)
    samples: list[Any] = []
    other._held.append(other._session.declare_subscriber(kind.key(0), samples.append))
    with ZenohBus("placecell", 0, connect=[endpoint]) as bus:
        publisher = bus.publisher(kind)

        def arrived() -> bool:
            publisher.put(b"\x00\x01\x00\x00")
            time.sleep(0.05)
            return bool(samples)

        wait_for(arrived)
    extra = samples[-1].attachment.to_bytes()
    assert len(extra) == 33
    assert extra[16] == 16
    assert 1 <= int.from_bytes(extra[:8], "little") <= 200


def test_node_and_topics_are_seen_by_their_tokens(other: ZenohBus, endpoint: str) -> None:
    with ZenohBus("placecell", 0, connect=[endpoint]) as bus:
        bus.publisher(topic(ZenohAddress(), "/tf", cdr.TRANSFORMS, TRANSFORM))
        bus.subscribe(topic(ZenohAddress(), "/odom", cdr.ODOMETRY, SENSOR), print)
        wait_for(lambda: other.topics() == {"/tf": "tf2_msgs/msg/TFMessage"})


def test_latched_messages_reach_late_subscriptions(other: ZenohBus, endpoint: str) -> None:
    latched = topic(ZenohAddress(), "/tf_static", cdr.TRANSFORMS, LATCHED)
    other.publisher(latched).put(b"latched")
    received: list[bytes] = []
    with ZenohBus("placecell", 0, connect=[endpoint]) as bus:
        bus.subscribe(latched, received.append)
        wait_for(lambda: received == [b"latched"])


def test_program_that_starts_later_or_again_is_found(endpoint: str) -> None:
    kind = topic(ZenohAddress(), "/tf", cdr.TRANSFORMS, TRANSFORM)
    received: list[bytes] = []
    with ZenohBus("placecell", 0, connect=[endpoint]) as bus:
        bus.subscribe(kind, received.append)
        for start in (b"first", b"again"):
            with ZenohBus("driver", 0, listen=[endpoint]) as driver:
                publisher = driver.publisher(kind)

                def arrived(publisher: BusPublisher = publisher, start: bytes = start) -> bool:
                    publisher.put(start)
                    return start in received

                wait_for(arrived)


def test_port_in_use_is_told(other: ZenohBus, endpoint: str) -> None:
    with pytest.raises(ZenohError, match="Check the endpoints, and that no other program uses"):
        ZenohBus("placecell", 0, listen=[endpoint])


def test_missing_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zenoh", None)
    with pytest.raises(MissingZenohError, match=r"pip install 'placecell\[zenoh\]'"):
        ZenohBus("placecell", 0)


def test_node_localizes_by_the_topics_of_another_program(other: ZenohBus, endpoint: str) -> None:
    address = ZenohAddress(connect=(endpoint,), distro="humble")
    received: list[StampedTransform] = []
    poses: list[CertainPose] = []
    states: list[str] = []

    def take_states(data: bytes) -> None:
        message = cdr.type_store().deserialize_cdr(data, cdr.DIAGNOSTICS)
        states.append(message.status[0].message)

    def take_transforms(data: bytes) -> None:
        received.extend(cdr.read_transforms(data, "/tf"))

    def take_pose(data: bytes) -> None:
        poses.append(cdr.read_pose(data, "/placecell/pose"))

    other.subscribe(topic(address, "/tf", cdr.TRANSFORMS, TRANSFORM), take_transforms)
    other.subscribe(topic(address, "/placecell/pose", cdr.POSE, RELIABLE), take_pose)
    other.subscribe(topic(address, "/diagnostics", cdr.DIAGNOSTICS, RELIABLE), take_states)
    clouds = other.publisher(topic(address, "/points", cdr.CLOUD, SENSOR))
    odometries = other.publisher(topic(address, "/odom", cdr.ODOMETRY, SENSOR))
    given = other.publisher(topic(address, "/initialpose", cdr.POSE, RELIABLE))
    statics = other.publisher(topic(address, "/tf_static", cdr.TRANSFORMS, LATCHED))
    mount = StampedTransform(0, "base_link", "lidar", moved(0, 0, 1.5))
    statics.put(cdr.write_transforms([mount]))

    agent, stop = FakeAgent(), threading.Event()
    arguments = (agent, address, NodeSettings(), stop)
    thread = threading.Thread(target=run_on_zenoh, args=arguments)
    thread.start()
    try:
        at = 100.0
        while not (received and poses and "tracking" in states and agent.initial_poses):
            assert at < 120, (len(agent.scans), received, states)
            odometries.put(cdr.write_odometry(odometry(at, 0.1 * at)))
            clouds.put(cdr.write_cloud(cloud(at)))
            clouds.put(b"damaged")
            given.put(cdr.write_pose(CertainPose(0, "map", moved(3), np.eye(6))))
            time.sleep(0.05)
            at += 0.1
    finally:
        stop.set()
        thread.join(10)
    assert (received[0].parent, received[0].child) == ("map", "odom")
    assert received[0].pose[:3, 3].tolist() == [100, 50, 0]
    assert poses[0].frame == "map"
    assert agent.scans[0][2][2, 3] == 1.5  # the mount of the sensor
    assert agent.initial_poses[0][0][:3, 3].tolist() == [3, 0, 1.5]


@pytest.mark.parametrize("distro", ["", "humble"])
def test_service_of_the_node_requests_a_pose(other: ZenohBus, endpoint: str, distro: str) -> None:
    import zenoh

    agent, stop = FakeAgent(), threading.Event()
    address = ZenohAddress(connect=(endpoint,), node="rover", distro=distro)
    arguments = (agent, address, NodeSettings(), stop)
    thread = threading.Thread(target=run_on_zenoh, args=arguments)
    thread.start()
    # As a client of rmw_zenoh asks.
    type_hash = "TypeHashNotSupported" if distro else trigger_hash()
    service = TopicType("/rover/localize", TRIGGER, type_hash, RELIABLE)
    client = publisher_id("client")
    answers: list[Any] = []

    def call() -> bool:
        replies = other._session.get(
            service.key(0),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            payload=b"\x00\x01\x00\x00\x00",
            attachment=attachment(7, 1, client),
            timeout=2.0,
        )
        answers.extend(reply.ok for reply in replies if reply.ok is not None)
        return bool(answers)

    try:
        wait_for(call)
        wait_for(lambda: agent.requests)
        tokens = other._session.liveliness().get("@ros2_lv/0/**", timeout=2.0)
        servers = [str(each.ok.key_expr) for each in tokens if each.ok is not None]
    finally:
        stop.set()
        thread.join(10)
    assert str(answers[0].key_expr) == service.key(0)
    extra = answers[0].attachment.to_bytes()
    assert (extra[:8], extra[16:]) == ((7).to_bytes(8, "little"), b"\x10" + client)
    content = answers[0].payload.to_bytes()
    assert content[:5] == b"\x00\x01\x00\x00\x01"
    assert content[12:].startswith(b"A pose is requested at the next scan; now: ")
    named = f"SS/%/%/rover/%rover%localize/std_srvs::srv::dds_::Trigger_/{type_hash}/::,10:,:,:,,"
    assert any(each.endswith(named) for each in servers)
