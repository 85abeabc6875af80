"""The parts of the node: odometry buffer, frames, messages."""

import numpy as np
import pytest

from robot.node.frames import StaticFrames
from robot.node.messages import StampedTransform, pose_of, values_of
from robot.node.odometry_buffer import OdometryBuffer
from tests.robot.node.node_fakes import moved, odometry


def test_pose_outside_the_odometry_or_in_a_gap_is_unknown() -> None:
    buffer = OdometryBuffer()
    assert buffer.at(10.0) is None
    assert buffer.is_before(10.0)
    for at in (10.0, 10.1, 11.0):
        buffer.add(odometry(at, at))
    assert buffer.at(9.9) is None
    assert buffer.at(11.1) is None
    assert buffer.at(10.5) is None  # between two poses that are 0.9 s apart
    assert not buffer.is_before(10.5)
    between = buffer.at(10.05)
    assert between is not None
    assert between[0, 3] == pytest.approx(10.05)


def test_repeated_and_late_poses_are_ignored_and_old_ones_forgotten() -> None:
    buffer = OdometryBuffer()
    for at in (10.0, 10.1, 10.1, 10.05, 10.2):
        assert not buffer.add(odometry(at, at))
    assert len(buffer) == 3
    buffer.add(odometry(20.15, 0))
    assert len(buffer) == 2


def test_restarted_clock_forgets_the_poses() -> None:
    buffer = OdometryBuffer()
    buffer.add(odometry(100.0, 1))
    assert buffer.add(odometry(5.0, 2))
    assert buffer.newest == 5.0
    assert len(buffer) == 1


def test_motion_covers_a_sweep() -> None:
    buffer = OdometryBuffer()
    assert buffer.motion(0, 1, np.eye(4)) is None
    for number in range(10):
        buffer.add(odometry(0.1 * number, number))
    motion = buffer.motion(0.25, 0.35, moved(0, 0, 2))
    assert motion is not None
    assert motion.stamps == pytest.approx([0.2, 0.3, 0.4])
    assert motion.poses[:, 2, 3].tolist() == [2, 2, 2]
    after = buffer.motion(0.95, 1.05, np.eye(4))
    assert after is not None
    assert after.stamps == pytest.approx([0.8, 0.9])


def test_frames_of_two_branches_are_connected() -> None:
    frames = StaticFrames()
    frames.add(StampedTransform(0, "robot", "base", moved(1)))
    frames.add(StampedTransform(0, "robot", "mast", moved(3)))
    frames.add(StampedTransform(0, "mast", "lidar", moved(0, 0, 2)))
    pose = frames.pose("lidar", "base")
    assert pose is not None
    assert pose[:3, 3].tolist() == [2, 0, 2]
    assert frames.pose("camera", "base") is None
    same = frames.pose("base", "base")
    assert same is not None
    assert same.tolist() == np.eye(4).tolist()


def test_loop_of_frames_ends() -> None:
    frames = StaticFrames()
    frames.add(StampedTransform(0, "b", "a", moved(1)))
    frames.add(StampedTransform(0, "a", "b", moved(1)))
    assert frames.pose("a", "elsewhere") is None


def test_pose_survives_its_numbers() -> None:
    values = np.array([1, 2, 3, 0, 0, np.sqrt(0.5), np.sqrt(0.5)])
    assert values_of(pose_of(values)) == pytest.approx(values.tolist())


@pytest.mark.parametrize(
    "values", [[0, 0, 0, 0, 0, 0, 0], [np.nan, 0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0, 2]]
)
def test_numbers_that_are_no_pose_are_refused(values: list[float]) -> None:
    with pytest.raises(ValueError, match="expected finite numbers and a quaternion of length 1"):
        pose_of(np.array(values, float))
