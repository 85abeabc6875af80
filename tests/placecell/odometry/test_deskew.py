"""Deskewing by hand: straight motion, turns, and times beyond the poses."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.odometry.deskew import SensorMotion, deskew


def motion(speed: float, turn: float, times: Float64) -> SensorMotion:
    """Return poses that move along x, and turn about z by `turn` rad/s."""
    poses = np.tile(np.eye(4), (len(times), 1, 1))
    poses[:, :3, :3] = Rotation.from_euler("z", (turn * times)[:, None]).as_matrix()
    poses[:, 0, 3] = speed * times
    return SensorMotion(times, poses)


def test_point_measured_later_is_moved_ahead() -> None:
    """At 10 m/s, a point measured 0.05 s after the scan was seen from 0.5 m farther ahead."""
    points = np.array([[5, 1, 2], [5, 1, 2], [5, 1, 2]], np.float32)
    found = deskew(
        points, np.array([0.0, 0.05, -0.05]), 1.0, motion(10, 0, np.array([0.0, 1.0, 2.0]))
    )
    assert found == pytest.approx(np.array([[5, 1, 2], [5.5, 1, 2], [4.5, 1, 2]]), abs=1e-6)


def test_turning_sensor_sees_one_point_at_many_angles() -> None:
    times = np.linspace(-0.05, 0.05, 201)
    turning = motion(0, 1.5, np.arange(0, 2, 0.1))
    angles = -1.5 * times  # a point straight ahead at the scan's time
    points = np.stack([20 * np.cos(angles), 20 * np.sin(angles), 0 * times], 1).astype(np.float32)
    found = deskew(points, times, 1.0, turning)
    assert found == pytest.approx(np.tile([20, 0, 0], (201, 1)), abs=1e-4)


def test_motion_goes_on_beyond_the_poses() -> None:
    steady = motion(10, 0.5, np.array([0.0, 0.1, 0.2]))
    found = steady.at(np.array([-0.1, 0.3]))
    assert found[:, 0, 3] == pytest.approx([-1, 3])
    turned = Rotation.from_matrix(found[:, :3, :3]).as_euler("xyz")[:, 2]
    assert turned == pytest.approx([-0.05, 0.15])
    assert steady.covers(-0.5, 0.5)
    assert not steady.covers(-1.5, 0.2)
    assert not steady.covers(0.0, 1.5)


def test_poses_without_usable_times_are_no_motion() -> None:
    poses = np.tile(np.eye(4), (3, 1, 1))
    assert SensorMotion.of(None, poses) is None
    assert SensorMotion.of(np.array([0.0, 0.0, 1.0]), poses) is None
    assert SensorMotion.of(np.array([0.0]), poses[:1]) is None
    assert SensorMotion.of(np.array([0.0, 0.5, 1.0]), poses) is not None


def test_no_points_and_equal_times() -> None:
    still = motion(10, 0, np.array([0.0, 1.0]))
    assert deskew(np.zeros((0, 3), np.float32), np.zeros(0), 0.0, still).shape == (0, 3)
    points = np.ones((2, 3), np.float32)
    found = deskew(points, np.array([0.1, 0.1]), 0.0, still)
    assert found == pytest.approx(np.array([[2, 1, 1], [2, 1, 1]]), abs=1e-6)
