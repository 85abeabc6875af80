"""Up by an IMU: still, in motion, by orientations, and refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.odometry import source_odometry
from placecell.odometry.deskew import SensorMotion
from placecell.odometry.gravity import NotLevelError, angle_deg, find_gravity
from placecell.odometry.source_odometry import level
from placecell.sources.imu import GRAVITY, ImuSamples
from tests.placecell.datasets.source_fakes import MemorySource

TILT = Rotation.from_euler("yx", [20.0, -8.0], degrees=True)
"""Rotation of the sensor in the level world at the start."""
UP = TILT.inv().apply([0, 0, 1.0])
"""Up in the frame of the first scan."""
SECONDS = 6.0


def driven(
    braking: float = 0.0, turning: float = 0.0, bias: tuple[float, float, float] = (0, 0, 0)
) -> tuple[ImuSamples, SensorMotion]:
    """Return what an IMU measures on a drive that begins at 10 m/s, and the sensor's poses.

    Args:
        braking: deceleration ahead, m/s^2.
        turning: yaw rate, rad/s.
        bias: error of the accelerations, m/s^2.
    """
    stamps = np.arange(0, SECONDS, 0.01)

    def at(times: Float64) -> tuple[Float64, Rotation]:
        speed = 10.0 - braking * times
        yaw = turning * times
        steps = np.diff(times, prepend=times[0])
        ahead = np.stack([speed * np.cos(yaw), speed * np.sin(yaw), 0 * times], axis=1)
        return np.cumsum(ahead * steps[:, None], axis=0), Rotation.from_euler("z", yaw[:, None])

    fine = np.arange(0, SECONDS, 0.001)
    places, turns = at(fine)
    velocity = np.gradient(places, fine, axis=0)
    acceleration = np.gradient(velocity, fine, axis=0)
    rows = np.searchsorted(fine, stamps)
    sensor = turns[rows] * TILT
    forces = sensor.inv().apply(acceleration[rows] + [0, 0, GRAVITY]) + bias
    scans = np.searchsorted(fine, np.arange(0.0, SECONDS, 0.1))
    poses = np.tile(np.eye(4), (len(scans), 1, 1))
    poses[:, :3, :3] = (TILT.inv() * turns[scans] * TILT).as_matrix()
    poses[:, :3, 3] = TILT.inv().apply(places[scans])
    rates = np.tile([0, 0, turning], (len(stamps), 1))
    ups = sensor.inv().apply([0, 0, 1.0])
    imu = ImuSamples("/imu", stamps, forces, rates, ups, np.eye(4), "tf: lidar -> imu")
    return imu, SensorMotion(fine[scans], poses)


@pytest.mark.parametrize(("braking", "turning"), [(0, 0), (1.5, 0), (0.5, 0.3), (-2.0, -0.8)])
def test_up_is_found_whatever_the_motion(braking: float, turning: float) -> None:
    imu, motion = driven(braking, turning)
    found = find_gravity(replace(imu, ups=None), motion)
    assert angle_deg(found.up, UP) < 0.3
    assert found.tilt_deg == pytest.approx(21.5, abs=0.5)
    assert "accelerations of '/imu'" in found.how


def test_unknown_motion_is_refused() -> None:
    imu, _ = driven(braking=3.0)
    with pytest.raises(NotLevelError, match=r"the mean acceleration is 10.25 m/s.2; expected 9.81"):
        find_gravity(replace(imu, ups=None), None)
    imu, _ = driven(turning=0.2)
    with pytest.raises(NotLevelError, match=r"the robot turns at 0.20 rad"):
        find_gravity(imu, None)
    imu, _ = driven()
    swung = Rotation.from_euler("x", np.linspace(0, 0.4, len(imu))[:, None])
    with pytest.raises(NotLevelError, match="the mean acceleration turns by 10"):
        find_gravity(replace(imu, accelerations=swung.apply(imu.accelerations), ups=None), None)


def test_robot_that_stands_needs_no_poses() -> None:
    imu, _ = driven()
    assert angle_deg(find_gravity(imu, None).up, UP) < 0.01


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_orientations_are_used_where_accelerations_are_wrong(sign: float) -> None:
    imu, motion = driven(bias=(0, 0, 1.0))
    assert imu.ups is not None
    found = find_gravity(replace(imu, ups=sign * imu.ups), motion)
    assert angle_deg(found.up, UP) < 0.01
    assert "orientations of '/imu'" in found.how
    with pytest.raises(NotLevelError, match="the mean acceleration is 10"):
        find_gravity(replace(imu, ups=None), motion)
    tumbling = Rotation.from_euler("x", np.linspace(0, 1, len(imu))[:, None]).apply(imu.ups)
    with pytest.raises(NotLevelError, match="its orientations turn by"):
        find_gravity(replace(imu, ups=tumbling), motion)


def test_few_measurements_are_refused() -> None:
    imu, motion = driven()
    with pytest.raises(NotLevelError, match=r"has 10 measurements in 0.1 s of the first scans"):
        find_gravity(imu.between(1.0, 1.095), motion)
    with pytest.raises(NotLevelError, match="has 0 measurements"):
        find_gravity(replace(imu, stamps=imu.stamps + 100), motion)


class WithImu(MemorySource):
    """A source whose IMU is given."""

    measured: ImuSamples | None = None

    def imu(self, first: float, last: float) -> ImuSamples | None:
        return None if self.measured is None else self.measured.between(first, last)


def floor(up: Float64, height: float) -> list[list[float]]:
    """Return points of a floor below a sensor in whose frame up is given."""
    random = np.random.default_rng(3)
    flat = np.pad(random.uniform(-12, 12, (8000, 2)), ((0, 0), (0, 1)), constant_values=-height)
    turn, _ = Rotation.align_vectors(up[None], [[0, 0, 1.0]])
    rows: list[list[float]] = turn.apply(flat).tolist()
    return rows


def leveled(
    imu: ImuSamples | None, points: list[list[float]], motion: SensorMotion
) -> tuple[Float64, str]:
    """Return up in the world of the first scan, and what was told."""
    count = len(motion.stamps)
    source = WithImu([points] * count, motion.stamps.tolist())
    source.measured = imu
    said: list[str] = []
    up, _ = level(source, np.tile(np.eye(4), (count, 1, 1)), said.append)
    return up, " ".join(said)


def test_imu_levels_before_the_ground_and_is_told() -> None:
    imu, motion = driven()
    slope = Rotation.from_euler("x", 6.0, degrees=True).apply(UP)
    up, said = leveled(imu, floor(slope, 1.5), motion)
    assert angle_deg(up, UP) < 0.01
    assert "leveled by imu: 571 accelerations of '/imu' in 5.7 s, mounted by tf: lidar" in said
    assert "1.50 m above the ground and tilted by 21.5 degrees" in said


def test_refused_imu_is_told_and_the_ground_levels() -> None:
    imu, motion = driven(bias=(0, 0, 1.0))
    up, said = leveled(replace(imu, ups=None), floor(UP, 1.5), motion)
    assert angle_deg(up, UP) < 0.5
    assert "the IMU is not used to level the world: the mean acceleration is" in said
    assert "leveled by the ground" in said


def test_imu_that_points_down_is_told_and_the_ground_levels() -> None:
    imu, motion = driven()
    wrong = replace(imu, accelerations=-imu.accelerations, ups=None)
    up, said = leveled(wrong, floor(UP, 1.5), motion)
    assert angle_deg(up, UP) < 0.5
    assert "the IMU points up into the ground" in said


def test_scans_without_times_use_no_imu() -> None:
    source = WithImu([[[1.0, 0, 0]]] * 2, [float("nan")] * 2)
    source.measured = driven()[0]
    assert source_odometry.gravity_of(source, np.tile(np.eye(4), (2, 1, 1)), print) is None


def test_folder_of_clouds_has_no_imu(tmp_path: Path) -> None:
    assert MemorySource([[[1.0, 0, 0]]], [0.0]).imu(0.0, 1.0) is None
