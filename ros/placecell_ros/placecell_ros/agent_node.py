"""The agent as a ROS 2 node: clouds and odometry in, `map -> odom` out."""

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, TypeVar

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from placecell_ros.conversions import (
    cloud_of,
    diagnostic_message,
    odometry_of,
    pose_from,
    pose_message,
    transform_message,
    transforms_of,
)
from placecell_ros.parameters import NodeParameters, read_parameters
from robot.node.messages import CertainPose, Diagnostic, StampedTransform
from robot.node.node import NodeAgent, RobotNode

T = TypeVar("T")
OpenAgent = Callable[[NodeParameters], AbstractContextManager[NodeAgent]]


class RosPublisher:
    """Publisher of the node's messages on topics of ROS 2."""

    def __init__(self, node: Node) -> None:
        self._transforms = node.create_publisher(TFMessage, "/tf", QoSProfile(depth=100))
        self._poses = node.create_publisher(PoseWithCovarianceStamped, "~/pose", 10)
        self._states = node.create_publisher(DiagnosticArray, "/diagnostics", 10)

    def transform(self, transform: StampedTransform) -> None:
        """Publish `map -> odom`."""
        publish(self._transforms, transform_message(transform))

    def pose(self, pose: CertainPose) -> None:
        """Publish the pose of the robot in the map."""
        publish(self._poses, pose_message(pose))

    def diagnostic(self, diagnostic: Diagnostic) -> None:
        """Publish the state."""
        publish(self._states, diagnostic_message(diagnostic))


def publish(publisher: Any, message: Any) -> None:
    """Publish a message; while ROS shuts down, nobody is there to receive it."""
    try:
        publisher.publish(message)
    except Exception:
        if rclpy.ok():
            raise


class AgentNode(Node):
    """Node that runs the agent in a thread of its own.

    It subscribes to `points`, `odom`, `/tf_static` and `/initialpose`, publishes `/tf`, `~/pose`
    and `/diagnostics`, and offers the service `~/localize`.
    """

    def __init__(self, open_agent: OpenAgent | None = None) -> None:
        """Read the parameters and start the agent.

        Args:
            open_agent: opens the agent for the run; None: an agent with a link to the service.

        Raises:
            ValueError: a parameter has an impossible value.
        """
        super().__init__("placecell")
        self.failure: Exception | None = None
        self._stop = threading.Event()
        self._opened = (open_agent or agent_with_link)(read := read_parameters(self))
        agent = self._opened.__enter__()
        self._agent = agent
        tell = self.get_logger().info
        self._robot = RobotNode(agent, RosPublisher(self), read.node, tell)
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        # Odometry at 200 Hz must not be lost while a cloud is converted.
        steps = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
        sensor = qos_profile_sensor_data
        self._receive(PointCloud2, "points", cloud_of, self._robot.on_cloud, sensor)
        self._receive(Odometry, "odom", odometry_of, self._robot.on_odometry, steps)
        self._receive(TFMessage, "/tf_static", transforms_of, self._on_static, latched)
        self._receive(
            PoseWithCovarianceStamped, "/initialpose", pose_from, self._robot.on_initial_pose, 10
        )
        self.create_service(Trigger, "~/localize", self._on_localize)
        self._thread = threading.Thread(target=self._run, name="placecell-agent")
        self._thread.start()

    def close(self) -> None:
        """Stop the agent, send what the link allows, and close the state folder."""
        self._stop.set()
        self._thread.join()
        self._opened.__exit__(None, None, None)

    def _run(self) -> None:
        try:
            self._robot.run(self._stop)
        except Exception as error:  # the main thread raises it
            self.failure = error
            self.get_logger().fatal(f"The agent has failed: {error!r}")
            rclpy.try_shutdown()

    def _receive(
        self,
        kind: Any,
        topic: str,
        convert: Callable[[Any], T],
        give: Callable[[T], None],
        quality: Any,
    ) -> None:
        """Give each message of a topic to the agent's node."""

        def receive(message: Any) -> None:
            try:
                converted = convert(message)
            except ValueError as error:
                self.get_logger().warning(f"{topic}: {error}")
            else:
                give(converted)

        self.create_subscription(kind, topic, receive, quality)

    def _on_static(self, transforms: list[StampedTransform]) -> None:
        for each in transforms:
            self._robot.on_static_transform(each)

    def _on_localize(self, _: Any, response: Any) -> Any:
        self._robot.on_localize()
        response.success = True
        response.message = (
            f"A pose is requested at the next scan; now: {self._agent.status.state.value}."
        )
        return response


def agent_with_link(parameters: NodeParameters) -> AbstractContextManager[NodeAgent]:
    """Open an agent with a link to the service."""
    from robot.live import live_agent

    return live_agent(parameters.agent, parameters.service, parameters.key, parameters.wait)


def main(arguments: list[str] | None = None) -> None:
    """Run the node until ROS shuts down."""
    rclpy.init(args=arguments)
    node = None
    try:
        node = AgentNode()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.close()
            node.destroy_node()
        rclpy.try_shutdown()
    if node is not None and node.failure is not None:
        raise node.failure
