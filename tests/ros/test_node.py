"""The ROS 2 node, with stand-ins of rclpy and of the agent."""

import sys
import threading
import time
from array import array
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import yaml

from robot.core.settings import AgentSettings
from robot.node.settings import NodeSettings
from tests.robot.node.node_fakes import Opened, cloud

PACKAGE = Path(__file__).resolve().parents[2] / "ros" / "placecell_ros"
STUBS = PACKAGE / "test" / "stubs"
ROS = {
    "builtin_interfaces", "diagnostic_msgs", "geometry_msgs", "launch", "launch_ros", "nav_msgs",
    "placecell_ros", "rclpy", "sensor_msgs", "std_msgs", "std_srvs", "tf2_msgs",
}  # fmt: skip


def forget() -> None:
    """Forget the modules of the stand-ins and of the package."""
    for name in [name for name in sys.modules if name.partition(".")[0] in ROS]:
        del sys.modules[name]


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The package's module `agent_node`, imported with the stand-ins of ROS."""
    forget()
    monkeypatch.syspath_prepend(str(STUBS))
    monkeypatch.syspath_prepend(str(PACKAGE))
    import placecell_ros.agent_node
    import rclpy
    from rclpy.node import Node

    monkeypatch.setattr(Node, "given", {"map": "yard", "extrinsic": "0 0 1.5 0 0 0"})
    rclpy.init()
    yield placecell_ros.agent_node
    forget()


@pytest.fixture
def opened(ros: ModuleType, monkeypatch: pytest.MonkeyPatch) -> Opened:
    opened = Opened()
    monkeypatch.setattr(ros, "agent_with_link", opened)
    return opened


def wait_for(condition: Callable[[], object]) -> None:
    """Wait until a condition holds.

    Raises:
        AssertionError: it does not hold within 5 s.
    """
    end = time.monotonic() + 5
    while not condition():
        assert time.monotonic() < end, "the condition does not hold in time"
        time.sleep(0.01)


def ros_time(seconds: float) -> Any:
    from builtin_interfaces.msg import Time

    return Time(int(seconds), round((seconds % 1) * 1e9))


def ros_cloud(seconds: float) -> Any:
    from sensor_msgs.msg import PointCloud2, PointField
    from std_msgs.msg import Header

    given = cloud(seconds)
    listed = [PointField(each.name, each.offset, each.datatype, 1) for each in given.fields]
    return PointCloud2(
        Header(ros_time(seconds), "lidar"), 1, 3, listed, False, 12, 36, array("B", given.data)
    )


def ros_odometry(seconds: float, x: float) -> Any:
    from nav_msgs.msg import Odometry
    from std_msgs.msg import Header

    message = Odometry(Header(ros_time(seconds), "odom"), "base_link")
    message.pose.pose.position.x = x
    message.pose.covariance = np.diag([x, x, x, 0, 0, 0.1]).ravel().tolist()
    return message


def test_scan_becomes_a_pose_and_a_transform(ros: ModuleType, opened: Opened) -> None:
    node = ros.AgentNode()
    receive = {topic: each[1] for topic, each in node.subscriptions.items()}
    receive["odom"](ros_odometry(10.0, 2.0))
    receive["points"](ros_cloud(10.0))
    wait_for(lambda: node.publishers["~/pose"].messages)
    receive["odom"](ros_odometry(10.1, 2.0))
    node.close()

    points, time_s, pose = opened.agent.scans[0]
    assert points.shape == (3, 3)
    assert time_s == 10.0
    assert pose[:3, 3].tolist() == [2, 0, 1.5]
    (message,) = node.publishers["~/pose"].messages
    assert message.header.frame_id == "map"
    assert message.pose.pose.position.x == 102
    assert message.pose.covariance[0] == 0.01
    (tf,) = node.publishers["/tf"].messages
    (transform,) = tf.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    assert (transform.header.stamp.sec, transform.header.stamp.nanosec) == (10, 300_000_000)
    assert transform.transform.translation.y == 50
    assert transform.transform.rotation.w == 1
    status = node.publishers["/diagnostics"].messages[-1].status[0]
    assert (status.level, status.message) == (b"\0", "tracking")
    (covariance,) = opened.agent.covariances
    assert covariance is not None
    assert np.diag(covariance).tolist() == [2, 2, 2, 0, 0, 0.1]
    assert opened.closed == 1


def test_topics_have_the_quality_of_their_kind(ros: ModuleType, opened: Opened) -> None:
    node = ros.AgentNode()
    node.close()
    quality = {topic: each[2] for topic, each in node.subscriptions.items()}
    assert {*quality} == {"points", "odom", "/tf_static", "/initialpose"}
    for topic in ("points", "odom"):
        assert quality[topic].reliability.name == "BEST_EFFORT"
    assert quality["odom"].depth >= 100
    assert quality["/tf_static"].durability.name == "TRANSIENT_LOCAL"
    assert {*node.publishers} == {"/tf", "~/pose", "/diagnostics"}
    assert {*node.services} == {"~/localize"}


def test_service_requests_a_pose(ros: ModuleType, opened: Opened) -> None:
    node = ros.AgentNode()
    kind, serve = node.services["~/localize"]
    response = serve(None, kind.Response())
    wait_for(lambda: opened.agent.requests)
    node.close()
    assert response.success
    assert response.message == "A pose is requested at the next scan; now: starting."


def test_initial_pose_and_static_transforms_reach_the_agent(
    ros: ModuleType, opened: Opened
) -> None:
    from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
    from rclpy.node import Node
    from std_msgs.msg import Header
    from tf2_msgs.msg import TFMessage

    Node.given = {"map": "yard"}
    node = ros.AgentNode()
    receive = {topic: each[1] for topic, each in node.subscriptions.items()}
    mount = TransformStamped(Header(ros_time(0), "base_link"), "lidar")
    mount.transform.translation.z = 1.0
    receive["/tf_static"](TFMessage([mount]))
    receive["odom"](ros_odometry(10.0, 0.0))
    receive["points"](ros_cloud(10.0))
    wait_for(lambda: opened.agent.scans)
    given = PoseWithCovarianceStamped(Header(ros_time(10), "map"))
    given.pose.pose.position.x = 7.0
    receive["/initialpose"](given)
    wait_for(lambda: opened.agent.initial_poses)
    node.close()
    assert opened.agent.initial_poses[0][0][:3, 3].tolist() == [7, 0, 1]


def test_message_with_a_broken_pose_is_told_and_ignored(ros: ModuleType, opened: Opened) -> None:
    node = ros.AgentNode()
    message = ros_odometry(10.0, float("nan"))
    node.subscriptions["odom"][1](message)
    node.close()
    assert node.logger.lines == [
        "warning: odom: Invalid pose [nan, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]: expected finite numbers "
        "and a quaternion of length 1."
    ]


def test_failure_of_the_agent_ends_the_node(
    ros: ModuleType, opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    import rclpy
    from rclpy.node import Node

    def fail(*_: object) -> None:
        raise RuntimeError("no model")

    monkeypatch.setattr(opened.agent, "on_scan", fail)

    def arrive(node: Any) -> None:
        node.subscriptions["odom"][1](ros_odometry(10.0, 0.0))
        node.subscriptions["points"][1](ros_cloud(10.0))
        wait_for(lambda: not rclpy.ok())

    monkeypatch.setattr(Node, "to_spin", [arrive])
    with pytest.raises(RuntimeError, match="no model"):
        ros.main()
    assert Node.newest is not None
    assert Node.newest.logger.lines == ["fatal: The agent has failed: RuntimeError('no model')"]
    assert opened.closed == 1


def test_shutdown_closes_the_agent(
    ros: ModuleType, opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    import rclpy
    from rclpy.node import Node

    def arrive(node: Any) -> None:
        node.subscriptions["odom"][1](ros_odometry(10.0, 0.0))
        node.subscriptions["points"][1](ros_cloud(10.0))
        wait_for(lambda: opened.agent.scans)
        rclpy.try_shutdown()  # a signal does so; the agent may still publish
        node.subscriptions["odom"][1](ros_odometry(10.1, 0.0))

    monkeypatch.setattr(Node, "to_spin", [arrive])
    ros.main()
    assert Node.newest is not None
    assert Node.newest.is_destroyed
    assert opened.closed == 1
    assert not any(each.name == "placecell-agent" for each in threading.enumerate())


def test_every_setting_is_a_parameter(ros: ModuleType, opened: Opened) -> None:
    from placecell_ros import parameters

    node = ros.AgentNode()
    node.close()
    named = {each.name for kind in (AgentSettings, NodeSettings) for each in fields(kind)}
    complex_ones = {"parameters", "drift", "mount"}  # of the segmentation; the extrinsic
    assert named - {*node.parameters} <= complex_ones
    assert {*node.parameters} - named == {*parameters.OWN}
    assert opened.parameters.agent.map == "yard"
    assert opened.parameters.node.mount[2, 3] == 1.5
    assert opened.parameters.service == "http://127.0.0.1:8000"


def test_parameters_become_settings(
    ros: ModuleType, opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    from rclpy.node import Node

    Node.given = {"map": "yard", "state": "~/state", "keyframe_meters": 3.0, "localize": False}
    Node.given |= {"session": "s-1", "map_frame": "site", "transform_hz": 10.0}
    Node.given |= {"ignore": "movable, sign", "unmapped": "movable"}
    monkeypatch.setenv("PLACECELL_KEY", "k-1")
    monkeypatch.setenv("HOME", "/home/robot")
    ros.AgentNode().close()
    read = opened.parameters
    assert read.key == "k-1"
    assert read.agent.state == Path("/home/robot/state")
    assert (read.agent.keyframe_meters, read.agent.localize) == (3.0, False)
    assert (read.agent.session, read.agent.localize_map) == ("s-1", None)
    assert (read.agent.ignore, read.agent.unmapped) == (("movable", "sign"), ("movable",))
    assert (read.node.map_frame, read.node.transform_hz, read.node.mount) == ("site", 10.0, None)


def test_session_is_new_at_each_start(ros: ModuleType, opened: Opened) -> None:
    sessions = set()
    for _ in range(2):
        ros.AgentNode().close()
        sessions.add(opened.parameters.agent.session)
    assert len(sessions) == 2


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "The parameter 'map' is empty"),
        ({"map": "yard", "keyframe_meters": -1.0}, "Invalid keyframe_meters -1.0"),
        ({"map": "yard", "queue": 0}, "Invalid queue 0"),
        ({"map": "yard", "extrinsic": "1 2"}, "extrinsic"),
    ],
)
def test_impossible_parameters_are_refused(
    ros: ModuleType, opened: Opened, given: dict[str, Any], message: str
) -> None:
    from rclpy.node import Node

    Node.given = given
    with pytest.raises(Exception, match=message):
        ros.AgentNode()


def test_file_of_parameters_has_every_parameter_with_its_default(ros: ModuleType) -> None:
    from placecell_ros import parameters

    content = yaml.safe_load((PACKAGE / "config" / "params.yaml").read_text())
    listed = content["/**"]["ros__parameters"]
    defaults = parameters.all_defaults()
    assert listed == {name: defaults[name] for name in listed}
    assert {*defaults} - {*listed} == {"map", "service"}  # arguments of the launch file


def test_pose_keeps_its_numbers(ros: ModuleType) -> None:
    from geometry_msgs.msg import PoseWithCovarianceStamped
    from placecell_ros.conversions import pose_from, pose_message
    from std_msgs.msg import Header

    message = PoseWithCovarianceStamped(Header(ros_time(1.5), "/map"))
    message.pose.pose.orientation.z, message.pose.pose.orientation.w = 0.6, 0.8
    message.pose.covariance = np.arange(36.0).tolist()
    back = pose_message(pose_from(message))
    assert back.header.frame_id == "map"
    assert back.pose.pose.orientation.z == pytest.approx(0.6)
    assert back.pose.covariance == message.pose.covariance
