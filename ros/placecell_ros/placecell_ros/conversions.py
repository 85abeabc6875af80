"""Messages of ROS 2 to and from those of the node."""

from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

from placecell.sources.bags.pointcloud2 import PointCloud2 as Cloud
from placecell.sources.bags.pointcloud2 import PointField
from placecell.sources.bags.pose_messages import frame_name
from placecell.trajectories.covariance import stated_covariance
from robot.node.messages import CertainPose, Diagnostic, StampedTransform, pose_of, values_of


def nanoseconds(stamp: Time) -> int:
    """Return a stamp in nanoseconds."""
    return int(stamp.sec) * 10**9 + int(stamp.nanosec)


def stamp(time_ns: int) -> Time:
    """Return a stamp."""
    seconds, rest = divmod(time_ns, 10**9)
    return Time(sec=seconds, nanosec=rest)


def values(position: Any, orientation: Any) -> Any:
    """Return x, y, z and the quaternion x, y, z, w, float64 (7,)."""
    p, q = position, orientation
    return np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w], dtype=np.float64)


def cloud_of(message: PointCloud2) -> Cloud:
    """Return a cloud; its points stay where they are."""
    fields = [
        PointField(each.name, each.offset, each.datatype, each.count) for each in message.fields
    ]
    return Cloud(
        fields,
        bool(message.is_bigendian),
        message.point_step,
        message.row_step,
        message.width,
        message.height,
        memoryview(message.data),
        nanoseconds(message.header.stamp),
        frame_name(message.header.frame_id),
    )


def odometry_of(message: Odometry) -> StampedTransform:
    """Return the pose of the robot's base in the odometry frame, with its covariance.

    Raises:
        ValueError: the pose has numbers that are not finite, or its quaternion is none.
    """
    pose = message.pose.pose
    return StampedTransform(
        nanoseconds(message.header.stamp),
        frame_name(message.header.frame_id),
        frame_name(message.child_frame_id),
        pose_of(values(pose.position, pose.orientation)),
        stated_covariance(np.array(message.pose.covariance, dtype=np.float64)),
    )


def transforms_of(message: TFMessage) -> list[StampedTransform]:
    """Return the transforms between the robot's frames.

    Raises:
        ValueError: a transform has numbers that are not finite, or its quaternion is none.
    """
    return [
        StampedTransform(
            nanoseconds(each.header.stamp),
            frame_name(each.header.frame_id),
            frame_name(each.child_frame_id),
            pose_of(values(each.transform.translation, each.transform.rotation)),
        )
        for each in message.transforms
    ]


def pose_from(message: PoseWithCovarianceStamped) -> CertainPose:
    """Return a pose with its covariance.

    Raises:
        ValueError: the pose has numbers that are not finite, or its quaternion is none.
    """
    pose = message.pose.pose
    return CertainPose(
        nanoseconds(message.header.stamp),
        frame_name(message.header.frame_id),
        pose_of(values(pose.position, pose.orientation)),
        np.array(message.pose.covariance, dtype=np.float64).reshape(6, 6),
    )


def transform_message(transform: StampedTransform) -> TFMessage:
    """Return the message of a transform."""
    message = TransformStamped()
    message.header.stamp = stamp(transform.stamp_ns)
    message.header.frame_id = transform.parent
    message.child_frame_id = transform.child
    fill(message.transform.translation, message.transform.rotation, transform.pose)
    return TFMessage(transforms=[message])


def pose_message(pose: CertainPose) -> PoseWithCovarianceStamped:
    """Return the message of a pose."""
    message = PoseWithCovarianceStamped()
    message.header.stamp = stamp(pose.stamp_ns)
    message.header.frame_id = pose.frame
    fill(message.pose.pose.position, message.pose.pose.orientation, pose.pose)
    message.pose.covariance = pose.covariance.reshape(36).tolist()
    return message


def diagnostic_message(diagnostic: Diagnostic) -> DiagnosticArray:
    """Return the message of a state."""
    status = DiagnosticStatus()
    status.level = bytes([diagnostic.level])  # rclpy holds a `byte` as bytes
    status.name = diagnostic.name
    status.message = diagnostic.message
    status.hardware_id = diagnostic.hardware
    status.values = [KeyValue(key=key, value=value) for key, value in diagnostic.values]
    message = DiagnosticArray(status=[status])
    message.header.stamp = stamp(diagnostic.stamp_ns)
    return message


def fill(position: Any, orientation: Any, pose: Any) -> None:
    """Write a pose (4, 4) into a position and an orientation."""
    numbers = values_of(pose)
    position.x, position.y, position.z = numbers[:3]
    orientation.x, orientation.y, orientation.z, orientation.w = numbers[3:]
