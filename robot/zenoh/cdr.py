"""Messages as CDR: read by the decoders of bags, written by the type store of `rosbags`."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from placecell.core.types import Float64
from placecell.sources.bags.cloud_messages import point_cloud2
from placecell.sources.bags.pointcloud2 import PointCloud2
from placecell.sources.bags.pose_messages import StampedPose, odometry, pose_stamped, transforms
from placecell.sources.bags.wire import Wire
from placecell.sources.errors import DriveError
from robot.node.messages import CertainPose, Diagnostic, StampedTransform, pose_of, values_of

CLOUD = "sensor_msgs/msg/PointCloud2"
ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
POSE = "geometry_msgs/msg/PoseWithCovarianceStamped"
DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"


@cache
def type_store() -> Any:
    """Return the definitions of the messages; they are equal in all ROS 2 since Humble."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_HUMBLE)


def type_hash(kind: str) -> str:
    """Return the hash of a type, as REP-2011 defines it."""
    return str(type_store().hash_rihs01(kind))


# Reading.


def read_cloud(data: bytes, where: str) -> PointCloud2:
    """Read a sensor_msgs/PointCloud2.

    Raises:
        DriveError: the message is damaged.
    """
    return point_cloud2(Wire(data, "cdr", where))


def read_odometry(data: bytes, where: str) -> StampedTransform:
    """Read a nav_msgs/Odometry.

    Raises:
        DriveError: the message is damaged, or its pose is none.
    """
    message = next(odometry(Wire(data, "cdr", where)))
    return replace(stamped(message, where), covariance=message.covariance)


def read_transforms(data: bytes, where: str) -> list[StampedTransform]:
    """Read a tf2_msgs/TFMessage.

    Raises:
        DriveError: the message is damaged, or a pose is none.
    """
    return [stamped(each, where) for each in transforms(Wire(data, "cdr", where))]


def read_pose(data: bytes, where: str) -> CertainPose:
    """Read a geometry_msgs/PoseWithCovarianceStamped.

    Raises:
        DriveError: the message is damaged, or its pose is none.
    """
    wire = Wire(data, "cdr", where)
    found = stamped(next(pose_stamped(wire)), where)
    covariance = wire.doubles(36).reshape(6, 6)
    return CertainPose(found.stamp_ns, found.parent, found.pose, covariance)


def stamped(message: StampedPose, where: str) -> StampedTransform:
    """Return a transform with a checked pose."""
    try:
        pose: Float64 = pose_of(message.values)
    except ValueError as error:
        raise DriveError(f"{where}: {error}") from error
    return StampedTransform(message.stamp_ns, message.parent, message.child, pose)


# Writing.


def write(kind: str, message: Any) -> bytes:
    """Serialize a message of the type store."""
    return bytes(type_store().serialize_cdr(message, kind))


def new(kind: str, *values: Any) -> Any:
    """Return a message of the type store; values in the order of its definition."""
    return type_store().types[kind](*values)


def header(stamp_ns: int, frame: str) -> Any:
    """Return a std_msgs/Header."""
    seconds, nanoseconds = divmod(stamp_ns, 10**9)
    stamp = new("builtin_interfaces/msg/Time", seconds, nanoseconds)
    return new("std_msgs/msg/Header", stamp, frame)


def geometry_pose(pose: Float64) -> Any:
    """Return a geometry_msgs/Pose."""
    values = values_of(pose)
    return new(
        "geometry_msgs/msg/Pose",
        new("geometry_msgs/msg/Point", *values[:3]),
        new("geometry_msgs/msg/Quaternion", *values[3:]),
    )


def write_transforms(transforms: list[StampedTransform]) -> bytes:
    """Write a tf2_msgs/TFMessage."""
    messages = []
    for each in transforms:
        values = values_of(each.pose)
        transform = new(
            "geometry_msgs/msg/Transform",
            new("geometry_msgs/msg/Vector3", *values[:3]),
            new("geometry_msgs/msg/Quaternion", *values[3:]),
        )
        messages.append(
            new(
                "geometry_msgs/msg/TransformStamped",
                header(each.stamp_ns, each.parent),
                each.child,
                transform,
            )
        )
    return write(TRANSFORMS, new(TRANSFORMS, messages))


def write_pose(pose: CertainPose) -> bytes:
    """Write a geometry_msgs/PoseWithCovarianceStamped."""
    covariance = np.ascontiguousarray(pose.covariance, np.float64).reshape(36)
    certain = new("geometry_msgs/msg/PoseWithCovariance", geometry_pose(pose.pose), covariance)
    return write(POSE, new(POSE, header(pose.stamp_ns, pose.frame), certain))


def write_diagnostics(diagnostic: Diagnostic) -> bytes:
    """Write a diagnostic_msgs/DiagnosticArray with one status."""
    values = [new("diagnostic_msgs/msg/KeyValue", *each) for each in diagnostic.values]
    status = new(
        "diagnostic_msgs/msg/DiagnosticStatus",
        int(diagnostic.level),
        diagnostic.name,
        diagnostic.message,
        diagnostic.hardware,
        values,
    )
    return write(DIAGNOSTICS, new(DIAGNOSTICS, header(diagnostic.stamp_ns, ""), [status]))


def write_odometry(transform: StampedTransform) -> bytes:
    """Write a nav_msgs/Odometry without a twist; an unknown covariance is zeros."""
    zeros = np.zeros(36)
    covariance = zeros if transform.covariance is None else transform.covariance.reshape(36)
    vector = new("geometry_msgs/msg/Vector3", 0.0, 0.0, 0.0)
    return write(
        ODOMETRY,
        new(
            ODOMETRY,
            header(transform.stamp_ns, transform.parent),
            transform.child,
            new("geometry_msgs/msg/PoseWithCovariance", geometry_pose(transform.pose), covariance),
            new(
                "geometry_msgs/msg/TwistWithCovariance",
                new("geometry_msgs/msg/Twist", vector, vector),
                zeros,
            ),
        ),
    )


def write_cloud(cloud: PointCloud2) -> bytes:
    """Write a sensor_msgs/PointCloud2."""
    fields = [
        new("sensor_msgs/msg/PointField", each.name, each.offset, each.datatype, each.count)
        for each in cloud.fields
    ]
    data = np.frombuffer(cloud.data, np.uint8)
    return write(
        CLOUD,
        new(
            CLOUD,
            header(cloud.stamp_ns, cloud.frame),
            cloud.height,
            cloud.width,
            fields,
            cloud.is_bigendian,
            cloud.point_step,
            cloud.row_step,
            data,
            True,
        ),
    )
