"""IMU of a bag, in the axes of the LiDAR."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.inspection.inspect import inspect_source
from placecell.sources.bags import BagSource
from placecell.sources.catalog import open_source
from placecell.sources.imu import GRAVITY
from tests.placecell.sources.bags.bag_builders import (
    FORMATS,
    PERIOD_NS,
    START_NS,
    Message,
    cloud_message,
    cloud_of,
    imu_message,
    transforms_message,
    xyz,
)

TILT = Rotation.from_euler("x", 10.0, degrees=True)
"""The LiDAR in the level world."""
MOUNTED = Rotation.from_euler("z", 90.0, degrees=True)
"""The IMU in the LiDAR's frame."""
UP = TILT.inv().apply([0.0, 0.0, 1.0])
SCANS = 25
RNG = np.random.default_rng(1)
FLOOR = np.pad(RNG.uniform(-12, 12, (6000, 2)), ((0, 0), (0, 1)), constant_values=-1.4)
SCAN = TILT.inv().apply(FLOOR + RNG.normal(0, 0.005, FLOOR.shape))
START = START_NS * 1e-9


def recorded(
    encoding: str,
    size: float = GRAVITY,
    tf: bool = True,
    orientation: bool = False,
    late_ns: int = 0,
    topics: Sequence[str] = ("/imu",),
    force: Sequence[float] | None = None,
) -> list[Message]:
    """Return clouds, transforms, and an IMU of 100 Hz on a tilted robot that stands."""
    made: list[Message] = []
    if tf:
        mount = np.eye(4)
        mount[:3, :3] = MOUNTED.as_matrix()
        edges = [("base_link", "lidar", np.eye(4)), ("lidar", "imu", mount)]
        made.append(("/tf_static", START_NS, transforms_message(edges, START_NS, encoding)))
    turned = TILT * MOUNTED if tf else TILT
    quaternion = turned.as_quat().tolist() if orientation else None
    measured = turned.inv().apply([0.0, 0.0, size]) if force is None else np.array(force)
    for topic in topics:
        for number in range(10 * SCANS):
            stamp = START_NS + number * PERIOD_NS // 10
            message: Any = imu_message(
                measured, np.zeros(3), stamp - late_ns, encoding, "imu", quaternion
            )
            made.append((topic, stamp, message))
    for number in range(SCANS):
        stamp = START_NS + number * PERIOD_NS
        made.append(
            ("/points", stamp, cloud_message(cloud_of(xyz(SCAN), stamp_ns=stamp), encoding))
        )
    return sorted(made, key=lambda each: each[1])


def write(folder: Path, name: str, **how: Any) -> BagSource:
    encoding, writer = FORMATS[name]
    source = open_source(writer(folder / name, recorded(encoding, **how)))
    assert isinstance(source, BagSource)
    return source


@pytest.mark.parametrize("name", ["ros1.bag", "ros2_sqlite", "ros2.mcap"])
def test_measurements_are_in_the_axes_of_the_lidar(tmp_path: Path, name: str) -> None:
    source = write(tmp_path, name, orientation=True)
    imu = source.imu(START, START + 1.0)
    assert imu is not None
    np.testing.assert_allclose(imu.accelerations, np.tile(GRAVITY * UP, (len(imu), 1)), atol=1e-9)
    assert imu.ups is not None
    np.testing.assert_allclose(imu.ups, np.tile(UP, (len(imu), 1)), atol=1e-9)
    assert imu.how == "tf: lidar -> imu"
    assert imu.rate_hz == pytest.approx(100)
    assert len(imu.between(START, START + 0.995)) == 100


def test_missing_transform_and_orientation_are_told(tmp_path: Path) -> None:
    imu = write(tmp_path, "ros1.bag", tf=False).imu(START, START + 1)
    assert imu is not None
    assert imu.how == "identity: no transform from 'lidar' to 'imu'"
    assert imu.ups is None
    np.testing.assert_allclose(imu.accelerations[0], GRAVITY * UP, atol=1e-9)


def test_accelerations_in_g_become_meters(tmp_path: Path) -> None:
    imu = write(tmp_path, "ros2.mcap", size=1.0).imu(START, START + 1)
    assert imu is not None
    np.testing.assert_allclose(imu.accelerations[0], GRAVITY * UP, atol=1e-9)


def test_clock_of_the_imu_is_moved_to_that_of_the_scans(tmp_path: Path) -> None:
    imu = write(tmp_path, "ros1.bag", late_ns=500 * 10**9).imu(START, START + 1)
    assert imu is not None
    assert imu.stamps[0] == pytest.approx(START, abs=1e-3)


def test_bag_without_an_imu_has_none(tmp_path: Path) -> None:
    source = write(tmp_path, "ros1.bag", topics=())
    assert source.imu(START, START + 1) is None
    assert inspect_source(source.path, 3).as_dict()["imu"] is None


def test_imu_that_only_writes_zeros_is_none(tmp_path: Path) -> None:
    assert write(tmp_path, "ros1.bag", force=[0, 0, 0]).imu(START, START + 1) is None
    assert write(tmp_path, "ros2.mcap", force=[np.nan] * 3).imu(START, START + 1) is None


def test_doctor_tells_what_levels_and_compares_imu_and_ground(tmp_path: Path) -> None:
    found = inspect_source(write(tmp_path, "ros1.bag").path, 3).as_dict()
    assert found["leveled_by"] == "imu"
    assert found["imu"]["topic"] == "/imu"
    assert found["imu"]["tilt_deg"] == pytest.approx(10.0, abs=0.1)
    assert found["tilt_deg"] == pytest.approx(10.0, abs=0.5)
    assert not [each for each in found["problems"] if "IMU" in each["what"]]


def test_doctor_warns_of_a_wrong_mount(tmp_path: Path) -> None:
    found = inspect_source(write(tmp_path, "ros1.bag", force=[GRAVITY, 0, 0]).path, 3).as_dict()
    (told,) = [each for each in found["problems"] if "IMU" in each["what"]]
    assert told["severity"] == "warning"
    assert "differ by" in told["what"]


def test_doctor_tells_why_the_imu_does_not_level(tmp_path: Path) -> None:
    found = inspect_source(write(tmp_path, "ros1.bag", force=[3.0, 0, GRAVITY]).path, 3).as_dict()
    assert found["leveled_by"] == "ground"
    (told,) = [each for each in found["problems"] if "IMU" in each["what"]]
    assert "the mean acceleration is 10.26 m/s^2; expected 9.81" in told["what"]
