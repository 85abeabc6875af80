"""Messages as CDR, against the type store of rosbags."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("rosbags", reason="rosbags is not installed: pip install 'placecell[zenoh]'")

from placecell.sources.bags.pointcloud2 import decode
from placecell.sources.errors import DriveError
from robot.node.messages import (
    CertainPose,
    Diagnostic,
    DiagnosticLevel,
    StampedTransform,
    pose_of,
    values_of,
)
from robot.zenoh import cdr
from tests.robot.node.node_fakes import cloud

POSE = pose_of(np.array([1.5, -2.5, 0.25, 0, 0, 0.6, 0.8]))
STAMP = 1_700_000_000_123_456_789


def load(data: bytes, kind: str) -> Any:
    """Return a message as rosbags reads it."""
    return cdr.type_store().deserialize_cdr(data, kind)


def test_transform_reads_back() -> None:
    data = cdr.write_transforms([StampedTransform(STAMP, "map", "odom", POSE)])
    assert data[:4] == b"\x00\x01\x00\x00"
    (each,) = load(data, cdr.TRANSFORMS).transforms
    assert (each.header.frame_id, each.child_frame_id) == ("map", "odom")
    assert (each.header.stamp.sec, each.header.stamp.nanosec) == (1_700_000_000, 123_456_789)
    assert each.transform.rotation.z == pytest.approx(0.6)
    (back,) = cdr.read_transforms(data, "/tf")
    assert (back.stamp_ns, back.parent, back.child) == (STAMP, "map", "odom")
    assert back.pose == pytest.approx(POSE)


def test_pose_reads_back_with_its_covariance() -> None:
    covariance = np.arange(36, dtype=float).reshape(6, 6)
    data = cdr.write_pose(CertainPose(STAMP, "map", POSE, covariance))
    assert load(data, cdr.POSE).pose.covariance.tolist() == list(range(36))
    back = cdr.read_pose(data, "/initialpose")
    assert (back.stamp_ns, back.frame) == (STAMP, "map")
    assert back.pose == pytest.approx(POSE)
    assert np.array_equal(back.covariance, covariance)


def test_odometry_reads_back() -> None:
    data = cdr.write_odometry(StampedTransform(STAMP, "odom", "base_link", POSE))
    assert load(data, cdr.ODOMETRY).child_frame_id == "base_link"
    back = cdr.read_odometry(data, "/odom")
    assert (back.parent, back.child) == ("odom", "base_link")
    assert back.pose == pytest.approx(POSE)
    assert back.covariance is None
    covariance = np.diag([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    given = StampedTransform(STAMP, "odom", "base_link", POSE, covariance)
    back = cdr.read_odometry(cdr.write_odometry(given), "/odom")
    assert back.covariance is not None
    assert np.array_equal(back.covariance, covariance)


def test_cloud_reads_back() -> None:
    given = cloud(12.5)
    data = cdr.write_cloud(given)
    assert load(data, cdr.CLOUD).width == 3
    back = cdr.read_cloud(data, "/points")
    assert (back.stamp_ns, back.frame) == (given.stamp_ns, "lidar")
    assert decode(back, "").points.tolist() == decode(given, "").points.tolist()


def test_diagnostics_are_written() -> None:
    values = (("state", "tracking"), ("link", "online"))
    diagnostic = Diagnostic(STAMP, DiagnosticLevel.WARN, "placecell", "no link", "ann", values)
    message = load(cdr.write_diagnostics(diagnostic), cdr.DIAGNOSTICS)
    (status,) = message.status
    assert (status.level, status.name, status.message) == (1, "placecell", "no link")
    assert status.hardware_id == "ann"
    assert [(each.key, each.value) for each in status.values] == list(values)


def test_damaged_messages_are_refused() -> None:
    data = cdr.write_pose(CertainPose(STAMP, "map", POSE, np.eye(6)))
    with pytest.raises(DriveError, match="/initialpose: values of 288 bytes"):
        cdr.read_pose(data[:-1], "/initialpose")
    with pytest.raises(DriveError, match="expected the header of CDR"):
        cdr.read_odometry(b"", "/odom")
    data = cdr.write_odometry(StampedTransform(0, "odom", "base", POSE))
    quaternion = np.array(values_of(POSE)[3:]).tobytes()
    assert quaternion in data
    with pytest.raises(DriveError, match="a quaternion of length 1"):
        cdr.read_odometry(data.replace(quaternion, bytes(32)), "/odom")
