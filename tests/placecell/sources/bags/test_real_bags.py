"""Bags of real users, checked against independent readers: rosbags, struct and evo's figures."""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_typestore

import placecell
from placecell.sources.bags import Bag, Ros1Bag, read_poses
from placecell.sources.catalog import open_source
from placecell.sources.errors import DriveError

pytestmark = pytest.mark.recorded

REAL = Path(placecell.__file__).resolve().parents[2] / "shared" / "real"


def real(name: str) -> Path:
    """Return a real file, or skip the test where it is absent."""
    path = REAL / name
    if not path.exists():
        pytest.skip(f"no real files: ../shared/real/{name} is absent")
    return path


def ros1_messages(path: Path, topic: str) -> Iterator[Any]:
    """Yield the messages of a topic as rosbags reads them."""
    store = get_typestore(Stores.ROS1_NOETIC)
    with rosbag1.Reader(path) as reader:
        connections = [each for each in reader.connections if each.topic == topic]
        for connection, _, raw in reader.messages(connections):
            yield store.deserialize_ros1(raw, connection.msgtype)


def test_luminar_is_read_as_rosbags_and_struct_read_it() -> None:
    """Front view only, 32 bytes a point with gaps, two uint32 for the times."""
    source = open_source(real("embag_luminar_pointcloud2_ros1.bag"))
    assert isinstance(source, Ros1Bag)
    assert source.frame == "luminar_lidar"
    messages = list(ros1_messages(source.path, "/luminar_pointcloud"))
    assert len(source) == len(messages) == 5
    for index, message in enumerate(messages):
        scan = source.scan(index)
        rows = message.data.reshape(message.width, 32)
        assert_array_equal(scan.points, rows[:, :12].copy().view("<f4"))
        stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        seconds, nanoseconds = rows[:, 20:28].copy().view("<u4").astype(np.int64).T
        assert scan.times is not None
        assert_allclose(scan.times, (seconds * 10**9 + nanoseconds - stamp) * 1e-9, atol=1e-9)
        assert scan.stamp == pytest.approx(stamp * 1e-9, abs=1e-6)
        first = struct.unpack_from("<3f4xf2IH", message.data.tobytes())
        assert scan.points[0].tolist() == list(first[:3])
        assert scan.times[0] == pytest.approx(first[4] + first[5] * 1e-9 - scan.stamp, abs=1e-6)
    assert [len(source.scan(index).points) for index in range(5)] == [
        35707,
        36055,
        36267,
        36457,
        36336,
    ]


def test_odometry_of_luminars_bag_that_never_moves_is_told() -> None:
    source = open_source(real("embag_luminar_pointcloud2_ros1.bag"))
    assert source.trajectory() is None
    assert any(
        "'/base_pose_ground_truth' never move (5 poses within 0.000 m)" in note
        for note in source.notes()
    )


@pytest.mark.parametrize(
    ("name", "topic", "kind", "driver"),
    [
        ("nebula_velodyne_vlp16", "/velodyne_packets", "velodyne_msgs/VelodyneScan", "velodyne_p"),
        ("ouster_512x10_raw.bag", "/os_node0/lidar_packets", "ouster_ros/PacketMsg", "ouster_ros"),
    ],
)
def test_raw_packets_are_refused_with_the_way_to_clouds(
    name: str, topic: str, kind: str, driver: str
) -> None:
    path = real(name)
    with pytest.raises(DriveError) as refused:
        open_source(path)
    message = str(refused.value)
    assert message.startswith(f"{path}: the topic {topic!r} has raw packets of the sensor ({kind})")
    assert "Expected sensor_msgs/PointCloud2" in message
    assert driver in message
    assert "record the topic with the clouds" in message


def test_topics_of_raw_bags_are_counted_as_rosbags_counts_them() -> None:
    path = real("ouster_512x10_raw.bag")
    with rosbag1.Reader(path) as one:
        assert counts(Bag(path)) == {name: info.msgcount for name, info in one.topics.items()}
    path = real("nebula_velodyne_vlp16")
    with rosbag2.Reader(path) as two:
        assert counts(Bag(path)) == {name: info.msgcount for name, info in two.topics.items()}


def counts(bag: Bag) -> dict[str, int]:
    return {topic.name: len(topic) for topic in bag.topics}


def test_mcap_without_clouds_is_refused_and_its_poses_are_read() -> None:
    from mcap.reader import make_reader

    path = real("nav2_turtlebot.mcap")
    with pytest.raises(DriveError, match=r"nav2_turtlebot.mcap: no topic has clouds.*Topics: /am"):
        open_source(path)
    store = get_typestore(Stores.ROS2_HUMBLE)
    with path.open("rb") as file:
        messages: list[Any] = [
            store.deserialize_cdr(message.data, "nav_msgs/msg/Odometry")
            for _, _, message in make_reader(file).iter_messages(topics=["/odom"])
        ]
    found = read_poses(Bag(path), "base_scan")
    assert found.body is not None
    assert found.body.stamps is not None
    assert (found.body.frame, found.body.world) == ("base_link", "odom")
    assert len(found.body) == len(messages) == 2639
    positions = [[getattr(m.pose.pose.position, axis) for axis in "xyz"] for m in messages]
    assert_array_equal(found.body.poses[:, :3, 3], positions)
    stamps = [m.header.stamp.sec + m.header.stamp.nanosec * 1e-9 for m in messages]
    assert_allclose(found.body.stamps, stamps, atol=1e-6)
    assert any("Others: /amcl_pose, /tf" in remark for remark in found.remarks)
    assert "no transform from 'base_link' to 'base_scan'" in found.extrinsic.how


def test_chain_of_transforms_agrees_with_the_poses_of_amcl() -> None:
    """tf holds AMCL's correction, so both topics place the robot within centimeters."""
    bag = Bag(real("nav2_turtlebot.mcap"))
    tree, amcl = (read_poses(bag, "", topic).body for topic in ("/tf", "/amcl_pose"))
    assert tree is not None
    assert amcl is not None
    assert tree.stamps is not None
    assert amcl.stamps is not None
    assert tree.world == amcl.world == "map"
    inside = (amcl.stamps > tree.stamps[0]) & (amcl.stamps < tree.stamps[-1])
    assert inside.sum() > 100
    for axis in range(2):
        at = np.interp(amcl.stamps[inside], tree.stamps, tree.poses[:, axis, 3])
        assert np.abs(at - amcl.poses[inside, axis, 3]).max() < 0.15
