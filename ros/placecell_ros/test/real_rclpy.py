"""Run the node with a real rclpy: a second node sends odometry, a cloud and a pose, and receives.

`tests/ros/test_real_rclpy.py` starts it. It prints what it received as JSON.
"""

import json
import sys
import time
import types
from array import array
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "client"), str(ROOT / "ros" / "placecell_ros")]

import rclpy  # noqa: E402
from builtin_interfaces.msg import Time  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.qos import qos_profile_sensor_data  # noqa: E402
from sensor_msgs.msg import PointCloud2, PointField  # noqa: E402
from std_msgs.msg import Header  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

from tests.robot.node.node_fakes import Opened, cloud  # noqa: E402

try:
    from tf2_msgs.msg import TFMessage
except ImportError:
    # The wheels of rclpy come without tf2_msgs: /tf then carries single transforms.
    class TFMessage(TransformStamped):
        """Transform in place of a list of one."""

        def __init__(self, transforms: list[Any]) -> None:
            (one,) = transforms
            super().__init__(
                header=one.header, child_frame_id=one.child_frame_id, transform=one.transform
            )

    # rclpy converts a message by the name of its class.
    TFMessage.__name__, TFMessage.__module__ = "TransformStamped", TransformStamped.__module__
    sys.modules["tf2_msgs"] = types.ModuleType("tf2_msgs")
    sys.modules["tf2_msgs.msg"] = types.ModuleType("tf2_msgs.msg")
    sys.modules["tf2_msgs.msg"].TFMessage = TFMessage  # type: ignore[attr-defined]

from placecell_ros.agent_node import AgentNode  # noqa: E402

ARGUMENTS = ["", "--ros-args", "-p", "map:=yard", "-p", "robot:=ann", "-p", "wait:=2.5"]
ARGUMENTS += ["-p", "extrinsic:=0 0 1.5 0 0 0", "-p", "use_sim_time:=false"]
SECONDS = 20.0


def stamp(seconds: float) -> Time:
    return Time(sec=int(seconds), nanosec=round((seconds % 1) * 1e9))


def odometry(seconds: float, x: float) -> Odometry:
    header = Header(stamp=stamp(seconds), frame_id="odom")
    message = Odometry(header=header, child_frame_id="base_link")
    message.pose.pose.position.x = x
    return message


def cloud_message(seconds: float) -> PointCloud2:
    given = cloud(seconds)
    fields = [
        PointField(name=each.name, offset=each.offset, datatype=each.datatype, count=1)
        for each in given.fields
    ]
    return PointCloud2(
        header=Header(stamp=stamp(seconds), frame_id="lidar"),
        height=1,
        width=3,
        fields=fields,
        is_bigendian=False,
        point_step=12,
        row_step=36,
        data=array("B", bytes(given.data)),
        is_dense=True,
    )


def main() -> None:
    """Run both nodes, and print what the second one received."""
    rclpy.init(args=ARGUMENTS)
    opened = Opened()
    node, other = AgentNode(opened), Node("other")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.add_node(other)
    received: dict[str, list[Any]] = {"pose": [], "tf": [], "diagnostics": []}
    keep = {name: listed.append for name, listed in received.items()}
    other.create_subscription(PoseWithCovarianceStamped, "/placecell/pose", keep["pose"], 10)
    other.create_subscription(TFMessage, "/tf", keep["tf"], 100)
    other.create_subscription(DiagnosticArray, "/diagnostics", keep["diagnostics"], 10)
    odom = other.create_publisher(Odometry, "odom", 10)  # reliable, as most robots send it
    points = other.create_publisher(PointCloud2, "points", qos_profile_sensor_data)
    initial = other.create_publisher(PoseWithCovarianceStamped, "/initialpose", 5)
    client = other.create_client(Trigger, "/placecell/localize")

    def until(condition: Any) -> None:
        end = time.monotonic() + SECONDS
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f"Received in {SECONDS:g} s: {received}")
            executor.spin_once(timeout_sec=0.05)

    until(lambda: all(each.get_subscription_count() for each in (odom, points, initial)))
    until(lambda: odom.get_subscription_count() and client.service_is_ready())
    odom.publish(odometry(10.0, 2.0))
    points.publish(cloud_message(10.0))
    until(lambda: received["pose"])
    odom.publish(odometry(10.1, 2.0))
    until(lambda: received["tf"] and received["diagnostics"])
    given = PoseWithCovarianceStamped(header=Header(stamp=stamp(10.0), frame_id="map"))
    given.pose.pose.orientation.w = 1.0
    given.pose.covariance = [0.25] + 35 * [0.0]
    initial.publish(given)
    until(lambda: opened.agent.initial_poses)
    future = client.call_async(Trigger.Request())
    until(future.done)
    node.close()
    node.destroy_node()
    other.destroy_node()
    rclpy.try_shutdown()
    pose, transform = received["pose"][0], received["tf"][0]
    transform = getattr(transform, "transforms", [transform])[0]
    status = received["diagnostics"][-1].status[0]
    found = {
        "map": opened.parameters.agent.map,
        "wait": opened.parameters.wait,
        "x": pose.pose.pose.position.x,
        "variance": pose.pose.covariance[0],
        "frames": [transform.header.frame_id, transform.child_frame_id],
        "level": status.level[0],
        "state": status.message,
        "service": future.result().success,
        "closed": opened.closed,
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
