"""Poses in bags: odometry, poses, paths, tf, and the sensor's pose on the robot."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.sources.bags import Bag, Mcap, Ros1Bag, read_poses
from placecell.sources.catalog import open_source
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import ScanOptions, use_scan_options
from tests.placecell.sources.bags.bag_builders import (
    ODOMETRY,
    PERIOD_NS,
    START_NS,
    TRANSFORMS,
    Message,
    cloud_message,
    cloud_of,
    header,
    odometry_message,
    pose_of,
    transforms_message,
    typestore,
    write_mcap,
    write_ros1,
    write_ros2,
    xyz,
)

COUNT = 8


def pose(x: float, y: float, z: float, yaw: float, roll: float = 0.0) -> Float64:
    """Return a transform."""
    made = np.eye(4)
    made[:3, :3] = Rotation.from_euler("xyz", (roll, 0.0, yaw), degrees=True).as_matrix()
    made[:3, 3] = (x, y, z)
    return made


WAY = np.array([pose(n, 0.1 * n * n, 0.0, 5 * n) for n in range(COUNT)])
"""Poses of the robot."""
MOUNT = pose(0.3, -0.2, 1.5, 90, 3)
"""Pose of the sensor on the robot, in two parts."""
MAST, HEAD = pose(0.3, -0.2, 1.0, 0), np.linalg.inv(pose(0.3, -0.2, 1.0, 0)) @ MOUNT


def stamp(index: int) -> int:
    return START_NS + index * PERIOD_NS


def clouds(encoding: str = "cdr", offset_ns: int = 0) -> list[Message]:
    """Return clouds; `offset_ns` is the difference of their headers to the time of recording."""
    points = np.random.default_rng(0).normal(size=(20, 3))
    return [
        (
            "/points",
            stamp(n),
            cloud_message(cloud_of(xyz(points), stamp_ns=stamp(n) + offset_ns), encoding),
        )
        for n in range(COUNT)
    ]


def odometry(
    encoding: str = "cdr",
    way: Sequence[Float64] = tuple(WAY),
    child: str = "base_link",
    covariances: Sequence[Float64 | None] = (None,) * COUNT,
) -> list[Message]:
    return [
        (
            "/odom",
            stamp(n),
            odometry_message(each, stamp(n), encoding, child=child, covariance=covariances[n]),
        )
        for n, each in enumerate(way)
    ]


def static(*edges: tuple[str, str, Float64], encoding: str = "cdr") -> list[Message]:
    return [("/tf_static", stamp(0), transforms_message(edges, stamp(0), encoding))]


MOUNTED = (("base_link", "mast", MAST), ("mast", "lidar", HEAD))


def moving_tf(*edges: tuple[str, str, Sequence[Float64]], encoding: str = "cdr") -> list[Message]:
    """Return transforms with one pose a scan."""
    return [
        (
            "/tf",
            stamp(n),
            transforms_message([(a, b, poses[n]) for a, b, poses in edges], stamp(n), encoding),
        )
        for n in range(COUNT)
    ]


@pytest.mark.parametrize("encoding", ["ros1", "cdr"])
def test_odometry_and_static_transforms_give_the_sensors_poses(
    encoding: str, tmp_path: Path
) -> None:
    messages = static(*MOUNTED, encoding=encoding) + clouds(encoding) + odometry(encoding)
    if encoding == "ros1":
        source: Ros1Bag | Mcap = Ros1Bag(write_ros1(tmp_path / "a.bag", messages))
    else:
        source = Mcap(write_mcap(tmp_path / "a.mcap", messages))
    trajectory = source.trajectory()
    assert trajectory is not None
    assert trajectory.stamps is not None
    assert_allclose(trajectory.poses, WAY @ MOUNT, atol=1e-12)
    assert_allclose(trajectory.stamps, source.stamps)
    assert (trajectory.frame, trajectory.world) == ("lidar", "odom")
    found = source.extrinsic()
    assert found.found
    assert found.how == "tf: base_link -> mast -> lidar"
    assert_allclose(found.transform, MOUNT, atol=1e-12)
    body = source.poses.body
    assert body is not None
    assert body.frame == "base_link"
    assert any("'/odom'" in note for note in source.notes())


def stated(index: int) -> Float64:
    return np.diag([0.1, 0.1, 0.1, 0.0, 0.0, 0.01]) * (1 + index)


def test_covariances_of_the_odometry_become_those_of_the_sensor(tmp_path: Path) -> None:
    beside = pose(2, 0, 1, 0)
    messages = (
        static(("base_link", "lidar", beside))
        + clouds()
        + odometry(covariances=list(map(stated, range(COUNT))))
    )
    found = Mcap(write_mcap(tmp_path / "a.mcap", messages)).trajectory()
    assert found is not None
    assert found.covariances is not None
    across = WAY[:, :2, 1]  # left of the robot
    sideways = 2**2 * 0.01 * (1 + np.arange(COUNT))
    assert_allclose(
        np.einsum("ni,nij,nj->n", across, found.covariances[:, :2, :2], across),
        0.1 * (1 + np.arange(COUNT)) + sideways,
    )
    assert_allclose(found.covariances[:, 5, 5], 0.01 * (1 + np.arange(COUNT)))


@pytest.mark.parametrize("lacking", [range(COUNT), [3]], ids=["all", "one"])
def test_odometry_whose_covariance_is_empty_has_none(tmp_path: Path, lacking: list[int]) -> None:
    known = [None if n in lacking else stated(n) for n in range(COUNT)]
    messages = clouds() + odometry(covariances=known)
    found = Mcap(write_mcap(tmp_path / "a.mcap", messages)).trajectory()
    assert found is not None
    assert found.covariances is None


def test_sensor_is_found_over_a_common_parent(tmp_path: Path) -> None:
    """The frame of the poses lies beside the sensor's, not above it."""
    imu = pose(1, 0, 0, 180)
    edges = (("chassis", "imu", imu), ("chassis", "lidar", MOUNT))
    messages = static(*edges) + clouds() + odometry(child="imu")
    source = Mcap(write_mcap(tmp_path / "a.mcap", messages))
    assert_allclose(source.extrinsic().transform, np.linalg.inv(imu) @ MOUNT, atol=1e-12)
    assert source.extrinsic().how == "tf: imu -> chassis -> lidar"


def test_fixed_joint_on_tf_counts_as_static(tmp_path: Path) -> None:
    """robot_state_publisher of ROS 1 repeats fixed joints on /tf."""
    joints = moving_tf(("base_link", "lidar", [MOUNT] * COUNT))
    source = Mcap(write_mcap(tmp_path / "a.mcap", joints + clouds() + odometry()))
    assert_allclose(source.extrinsic().transform, MOUNT, atol=1e-12)


def test_joint_that_moves_is_told(tmp_path: Path) -> None:
    joints = moving_tf(("base_link", "lidar", [pose(0, 0, 1, 9 * n) for n in range(COUNT)]))
    source = Mcap(write_mcap(tmp_path / "a.mcap", joints + clouds() + odometry()))
    assert not source.extrinsic().found
    assert "changes at the joint 'lidar'" in source.extrinsic().how


def test_missing_link_gives_the_robots_poses_and_is_told(tmp_path: Path) -> None:
    messages = static(("base_link", "camera", MAST)) + clouds() + odometry()
    source = Mcap(write_mcap(tmp_path / "a.mcap", messages))
    trajectory = source.trajectory()
    assert trajectory is not None
    assert_allclose(trajectory.poses, WAY, atol=1e-12)
    assert trajectory.frame == "base_link"
    assert "no transform from 'base_link' to 'lidar'" in source.extrinsic().how
    assert "--extrinsic" in source.extrinsic().how


def test_poses_of_the_sensor_need_no_transform(tmp_path: Path) -> None:
    source = Mcap(write_mcap(tmp_path / "a.mcap", clouds() + odometry(child="/lidar")))
    assert source.extrinsic().found
    assert source.extrinsic().how == "identity: the poses are those of 'lidar'"


def test_transforms_give_poses_from_map_to_sensor(tmp_path: Path) -> None:
    """map -> odom jumps, odom -> base_link moves, base_link -> lidar is fixed."""
    jumps = [pose(5, 0, 0, 0) if n < 4 else pose(5.5, 0, 0, 2) for n in range(COUNT)]
    messages = (
        static(*MOUNTED, ("earth", "map", pose(0, 0, 9, 0)))
        + moving_tf(("map", "odom", jumps), ("odom", "base_link", list(WAY)))
        + clouds()
    )
    source = Mcap(write_mcap(tmp_path / "a.mcap", messages))
    trajectory = source.trajectory()
    assert trajectory is not None
    assert_allclose(trajectory.poses, np.array(jumps) @ WAY @ MOUNT, atol=1e-9)
    assert (trajectory.frame, trajectory.world) == ("lidar", "map")
    assert any("map <- odom <- base_link" in note for note in source.notes())


def test_transforms_are_interpolated_at_the_times_of_the_finest(tmp_path: Path) -> None:
    slow = [
        ("/tf", stamp(n), transforms_message([("map", "odom", pose(n, 0, 0, 0))], stamp(n), "cdr"))
        for n in (0, 4)
    ]
    messages: list[Message] = slow + moving_tf(("odom", "lidar", list(WAY)))
    found = read_poses(Bag(write_mcap(tmp_path / "a.mcap", messages)), "lidar", "/tf")
    assert found.body is not None
    assert len(found.body) == 5
    assert_allclose(found.body.poses[:, 0, 3], WAY[:5, 0, 3] + np.arange(5), atol=1e-6)


def test_loop_of_transforms_is_refused(tmp_path: Path) -> None:
    edges = (("a", "b", MAST), ("b", "c", MAST), ("c", "a", MAST), ("a", "lidar", MAST))
    source = Mcap(write_mcap(tmp_path / "a.mcap", static(*edges) + clouds()))
    with pytest.raises(DriveError, match="form a loop: lidar -> a -> c -> b -> a"):
        source.trajectory()


def test_frame_with_two_parents_is_told(tmp_path: Path) -> None:
    messages = moving_tf(("odom", "lidar", list(WAY))) + static(("base_link", "lidar", MAST))
    found = read_poses(Bag(write_mcap(tmp_path / "a.mcap", messages)), "lidar")
    assert found.body is not None
    assert found.body.world == "odom"
    assert any("has two parents in tf, 'odom' and 'base_link'" in each for each in found.remarks)


def test_odometry_that_never_moves_is_not_used(tmp_path: Path) -> None:
    still = odometry(way=[WAY[3]] * COUNT)
    source = Mcap(write_mcap(tmp_path / "a.mcap", clouds() + still))
    assert source.trajectory() is None
    assert any("'/odom' never move (8 poses within 0.000 m)" in note for note in source.notes())
    with use_scan_options(ScanOptions(odometry="odom")):
        stated = Mcap(source.path)
    trajectory = stated.trajectory()
    assert trajectory is not None
    assert len(trajectory) == COUNT
    assert any("because it was stated" in note for note in stated.notes())


def test_other_topics_with_poses_are_named_and_can_be_stated(tmp_path: Path) -> None:
    store = typestore("cdr")
    stamped = store.types["geometry_msgs/msg/PoseStamped"]
    covariance = store.types["geometry_msgs/msg/PoseWithCovariance"]
    with_covariance = store.types["geometry_msgs/msg/PoseWithCovarianceStamped"]
    path = store.types["nav_msgs/msg/Path"]
    shifted = WAY + np.array([[0, 0, 0, 7.0]] + [[0.0] * 4] * 3)
    messages: list[Message] = odometry() + clouds() + moving_tf(("map", "lidar", list(shifted)))
    poses: list[Any] = []
    for n, each in enumerate(shifted):
        poses.append(stamped(header(store, stamp(n), "map"), pose_of(store, each)))
        messages.append(("/pose", stamp(n), poses[-1]))
        amcl = with_covariance(
            header(store, stamp(n), "map"), covariance(pose_of(store, each), np.zeros(36))
        )
        messages.append(("/amcl_pose", stamp(n), amcl))
        messages.append(("/path", stamp(n), path(header(store, stamp(n), "map"), list(poses))))
    found_path = write_mcap(tmp_path / "a.mcap", messages)
    source = Mcap(found_path)
    source.trajectory()
    assert "Others: /pose, /amcl_pose, /tf, /path. State another" in "\n".join(source.notes())
    for topic in ("/pose", "/amcl_pose", "/path", "/tf"):
        with use_scan_options(ScanOptions(odometry=topic)):
            trajectory = Mcap(found_path).trajectory()
        assert trajectory is not None
        assert_allclose(trajectory.poses, shifted, atol=1e-9)
        assert trajectory.world == "map"
    with (
        use_scan_options(ScanOptions(odometry="/points")),
        pytest.raises(DriveError, match="has messages of type sensor_msgs/PointCloud2; expected p"),
    ):
        Mcap(found_path).trajectory()


def test_path_without_times_is_used_only_if_it_is_stated(tmp_path: Path) -> None:
    store = typestore("cdr")
    stamped = store.types["geometry_msgs/msg/PoseStamped"]
    poses = [stamped(header(store, 0, "map"), pose_of(store, each)) for each in WAY]
    message = store.types["nav_msgs/msg/Path"](header(store, stamp(0), "map"), poses)
    bag = Bag(write_mcap(tmp_path / "a.mcap", [("/path", stamp(0), message)]))
    unused = read_poses(bag)
    assert unused.body is None
    assert any("the path '/path' has no times" in remark for remark in unused.remarks)
    found = read_poses(bag, wanted="/path")
    assert found.body is not None
    assert found.body.stamps is None
    assert found.body.world == "map"
    assert_allclose(found.body.poses, WAY, atol=1e-12)


def test_clocks_of_clouds_and_odometry_are_compared_by_the_times_of_recording(
    tmp_path: Path,
) -> None:
    """The sensor counts from its start; the odometry from the epoch."""
    source = Mcap(write_mcap(tmp_path / "a.mcap", clouds(offset_ns=10**9 - START_NS) + odometry()))
    trajectory = source.trajectory()
    assert trajectory is not None
    assert trajectory.stamps is not None
    assert_allclose(trajectory.stamps, source.stamps, atol=1e-6)
    assert any("clock of '/odom' is" in note for note in source.notes())


def test_invalid_poses_are_left_out_and_told(tmp_path: Path) -> None:
    messages = odometry()
    for index, value in ((2, np.nan), (5, np.inf)):
        topic, time, message = messages[index]
        position = replace(message.pose.pose.position, x=value)
        inner = replace(message.pose, pose=replace(message.pose.pose, position=position))
        messages[index] = (topic, time, replace(message, pose=inner))
    found = read_poses(Bag(write_mcap(tmp_path / "a.mcap", messages)), "lidar")
    assert found.body is not None
    assert len(found.body) == COUNT - 2
    assert any("2 of 8 poses of '/odom' have no finite numbers" in each for each in found.remarks)


def test_odometry_without_times_gets_those_of_recording(tmp_path: Path) -> None:
    messages: list[Message] = [
        ("/odom", stamp(n), odometry_message(each, 0, "cdr")) for n, each in enumerate(WAY)
    ]
    found = read_poses(Bag(write_mcap(tmp_path / "a.mcap", messages)), "lidar")
    assert found.body is not None
    assert found.body.stamps is not None
    assert_allclose(found.body.stamps, [stamp(n) * 1e-9 for n in range(COUNT)])
    assert any("headers of '/odom' have no times" in each for each in found.remarks)


@pytest.mark.parametrize("name", ["a.bag", "a_sqlite", "a.mcap"])
def test_topics_without_messages_are_passed_over(name: str, tmp_path: Path) -> None:
    """A recorder lists the topics that it waited for."""
    path = tmp_path / name
    kept = clouds("ros1" if name == "a.bag" else "cdr")
    if name == "a.bag":
        write_ros1(path, kept, empty=(("/tf", TRANSFORMS), ("/odom", ODOMETRY)))
    elif name == "a_sqlite":
        write_ros2(path, kept, empty=(("/tf", TRANSFORMS), ("/odom", ODOMETRY)))
    else:
        write_mcap(path, kept, empty=(("/tf", TRANSFORMS), ("/odom", ODOMETRY)))
    source = open_source(path)
    assert source.trajectory() is None
    assert len(source) == COUNT


def test_bag_without_poses_has_no_trajectory(tmp_path: Path) -> None:
    source = Mcap(write_mcap(tmp_path / "a.mcap", clouds()))
    assert source.trajectory() is None
    assert not source.extrinsic().found
    with use_scan_options(ScanOptions(odometry="/tf")):
        stated = Mcap(source.path)
    with pytest.raises(DriveError, match="no moving chain of frames"):
        stated.trajectory()
