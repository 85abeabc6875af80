"""Scans from bags of all kinds."""

import base64
import json
import pickle
import shutil
import struct
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from numpy.typing import NDArray

from placecell.core.types import Float32
from placecell.sources.bags import BagSource, Mcap, Ros1Bag, Ros2Bag
from placecell.sources.bags.cloud_messages import read_cloud
from placecell.sources.bags.pointcloud2 import decode
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import ScanOptions, use_scan_options
from tests.placecell.sources.bags.bag_builders import (
    FORMATS,
    PERIOD_NS,
    PLAIN,
    START_NS,
    BagWriter,
    Layout,
    Message,
    cloud_message,
    cloud_of,
    livox_message,
    odometry_message,
    serialized,
    write_mcap,
    write_ros1,
    write_ros2,
    xyz,
)

CLASSES = (Ros1Bag, Ros2Bag, Mcap)
ODD = Layout(
    {"x": "f4", "y": "f4", "z": "f4", "t": "u4", "ring": "u2"},
    order=("ring", "z", "t", "x", "y"),
    gap=3,
    row_gap=5,
    big=True,
    rows=2,
)


def open_bag(path: Path) -> BagSource:
    """Open a bag by the one class that recognizes it."""
    (found,) = [each for each in CLASSES if each.recognizes(path)]
    return found(path)


def scans(count: int = 4, points: int = 600) -> list[Float32]:
    """Return random scans with points that are NaN or zero."""
    random = np.random.default_rng(1)
    made = []
    for _ in range(count):
        scan = random.normal(0, 20, (points, 3)).astype(np.float32)
        scan[::50] = 0
        scan[7, 1] = np.nan
        made.append(scan)
    return made


def usable(scan: Float32) -> Float32:
    kept: Float32 = scan[np.isfinite(scan).all(axis=1) & (scan != 0).any(axis=1)]
    return kept


def messages(
    clouds: Sequence[Float32], encoding: str, layout: Layout = PLAIN, topic: str = "/points"
) -> list[Message]:
    """Return messages of clouds, with an odometry message between them."""
    made: list[Message] = []
    for number, points in enumerate(clouds):
        stamp = START_NS + number * PERIOD_NS
        columns: dict[str, NDArray[np.generic]] = dict(xyz(points))
        columns["t"] = np.linspace(0, 99e6, len(points)).astype(np.uint32)
        columns["ring"] = np.arange(len(points)) % 16
        cloud = cloud_of(columns, layout, stamp)
        made.append((topic, stamp + 30_000_000, cloud_message(cloud, encoding)))
        made.append(("/odom", stamp, odometry_message(np.eye(4), stamp, encoding)))
    return made


@pytest.mark.parametrize("name", FORMATS)
def test_every_container_gives_the_same_points_bit_for_bit(name: str, tmp_path: Path) -> None:
    encoding, write = FORMATS[name]
    clouds = scans()
    source = open_bag(write(tmp_path / name, messages(clouds, encoding, ODD)))
    assert len(source) == len(clouds)
    assert source.frame == "lidar"
    assert list(source.fields) == ["ring", "z", "t", "x", "y"]
    assert source.stamps_ns.tolist() == [START_NS + n * PERIOD_NS for n in range(len(clouds))]
    for index in (2, 0, 3, 1):
        scan = source.scan(index)
        assert scan.points.tobytes() == usable(clouds[index]).tobytes()
        assert scan.times is not None
        assert len(scan.times) == len(scan.points)
        assert 0 <= scan.times.min() < scan.times.max() <= 0.099
        assert scan.stamp == source.stamps[index]
        assert (scan.read, scan.not_finite, scan.zeros) == (600, 1, 12)
    assert [(topic.name, len(topic)) for topic in source.topics()] == [("/odom", 4), ("/points", 4)]
    assert source.topics()[1].rate_hz == pytest.approx(10)
    assert len({source.scan_hash(index) for index in range(4)}) == 4
    assert source.scan_hash(0) == open_bag(source.path).scan_hash(0)


def test_hash_of_a_scan_is_the_same_in_another_container(tmp_path: Path) -> None:
    clouds = scans(2)
    one = open_bag(write_ros1(tmp_path / "a.bag", messages(clouds, "ros1")))
    other = open_bag(write_mcap(tmp_path / "b.mcap", messages(clouds, "cdr", ODD)))
    assert one.scan_hash(1) == other.scan_hash(1)


def test_source_can_be_pickled(tmp_path: Path) -> None:
    source = open_bag(write_mcap(tmp_path / "b.mcap", messages(scans(2), "cdr")))
    source.scan(1)
    copy = pickle.loads(pickle.dumps(source))
    assert_array_equal(copy.scan(0).points, source.scan(0).points)


def test_parts_in_a_folder_are_one_recording(tmp_path: Path) -> None:
    """Parts are ordered by time, even if their names are not."""
    clouds = scans(12, 50)
    for encoding, suffix in (("ros1", ".bag"), ("cdr", ".mcap")):
        folder = tmp_path / suffix[1:]
        folder.mkdir()
        all_messages = messages(clouds, encoding)
        for part in range(3):
            some = all_messages[8 * part : 8 * part + 8]
            if encoding == "ros1":
                write_ros1(folder / f"run_{part + 9}.bag", some)
            else:
                write_mcap(folder / f"run_{part + 9}.mcap", some)
        source = open_bag(folder)
        assert len(source) == 12
        for index, points in enumerate(clouds):
            assert_array_equal(source.scan(index).points, usable(points))


def test_split_of_a_ros2_bag_that_is_missing_is_told(tmp_path: Path) -> None:
    folder = write_ros2(tmp_path / "run", messages(scans(2), "cdr"), "mcap")
    (part,) = folder.glob("*.mcap")
    text = (folder / "metadata.yaml").read_text()
    (folder / "metadata.yaml").write_text(
        text.replace(f"- {part.name}", f"- {part.name}\n    - run_1.mcap", 1)
    )
    assert any("run_1.mcap" in note for note in open_bag(folder).notes())


def test_file_of_a_ros2_bag_is_read_without_metadata(tmp_path: Path) -> None:
    clouds = scans(2)
    folder = write_ros2(tmp_path / "run", messages(clouds, "cdr"))
    (folder / "metadata.yaml").unlink()
    (part,) = folder.glob("*.db3")
    for path in (folder, part):
        source = open_bag(path)
        assert isinstance(source, Ros2Bag)
        assert_array_equal(source.scan(1).points, usable(clouds[1]))


def test_decompressed_copy_beside_a_compressed_file_is_used_once(tmp_path: Path) -> None:
    folder = write_ros2(tmp_path / "run", messages(scans(2), "cdr"), "mcap", "file")
    (packed,) = folder.glob("*.zstd")
    plain = write_mcap(tmp_path / "plain.mcap", messages(scans(3), "cdr"))
    shutil.copy(plain, packed.with_suffix(""))
    assert len(open_bag(folder)) == 3


def test_livox_messages_are_read(tmp_path: Path) -> None:
    points = usable(scans(1)[0])
    offsets = np.linspace(0, 99_000_000, len(points)).astype(np.uint32)
    for encoding in ("ros1", "cdr"):
        message = livox_message(points, offsets, START_NS, encoding)
        path = write_mcap(
            tmp_path / f"{encoding}.mcap", [("/livox/lidar", START_NS, message)], encoding
        )
        source = open_bag(path)
        scan = source.scan(0)
        assert_array_equal(scan.points, points)
        assert scan.times is not None
        assert_allclose(scan.times, offsets * 1e-9)
        assert source.frame == "livox_frame"


def test_topic_is_chosen_by_points_and_by_frame_and_said(tmp_path: Path) -> None:
    """A registered cloud has more points, but in the frame of the map."""
    small, large = scans(2, 100), scans(2, 300)
    everything = messages(small, "cdr", topic="/front") + messages(large, "cdr", topic="/roof")
    registered = cloud_of(xyz(scans(1, 600)[0]), stamp_ns=START_NS, frame="map")
    everything.append(("/registered", START_NS, cloud_message(registered, "cdr")))
    path = write_mcap(tmp_path / "a.mcap", everything)
    source = open_bag(path)
    assert source.cloud_topic.name == "/roof"
    note = "\n".join(source.notes())
    assert "'/roof'" in note
    assert "'/front' (sensor_msgs/PointCloud2, 2 messages, 100 points each" in note
    with use_scan_options(ScanOptions(topic="front")):
        assert open_bag(path).cloud_topic.name == "/front"
    with use_scan_options(ScanOptions(topic="/registered")):
        assert any("frame that stands still" in note for note in open_bag(path).notes())
    with (
        use_scan_options(ScanOptions(topic="/odom")),
        pytest.raises(DriveError, match=r"nav_msgs/Odometry .* Topics with clouds: /front, "),
    ):
        open_bag(path)
    with (
        use_scan_options(ScanOptions(topic="/nothing")),
        pytest.raises(DriveError, match="has no topic '/nothing'"),
    ):
        open_bag(path)


def test_lidar_is_chosen_before_a_depth_camera_with_more_points(tmp_path: Path) -> None:
    camera = cloud_of(xyz(scans(1, 900)[0]), stamp_ns=START_NS, frame="camera_depth_optical_frame")
    made = messages(scans(1, 100), "cdr")
    made.append(("/camera/points", START_NS, cloud_message(camera, "cdr")))
    assert open_bag(write_mcap(tmp_path / "a.mcap", made)).cloud_topic.name == "/points"


def test_metadata_without_files_is_told(tmp_path: Path) -> None:
    folder = write_ros2(tmp_path / "run", messages(scans(1), "cdr"))
    (folder / "run.db3").unlink()
    with pytest.raises(DriveError, match=r"no file of a bag is there .*lists run.db3, which are"):
        open_bag(folder)


@pytest.mark.parametrize(
    ("name", "encoding", "schema", "stated"),
    [
        ("sensor_msgs::msg::dds_::PointCloud2_", "cdr", "omgidl", "cdr"),
        ("sensor_msgs/msg/PointCloud2", "cdr", "ros2idl", ""),
        ("sensor_msgs/PointCloud2", "ros1", "ros1msg", ""),
    ],
)
def test_types_and_encodings_of_other_recorders_are_read(
    name: str, encoding: str, schema: str, stated: str, tmp_path: Path
) -> None:
    from mcap.writer import Writer

    points = usable(scans(1)[0])
    data = serialized(cloud_message(cloud_of(xyz(points)), encoding), encoding)
    with (tmp_path / "a.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/a", stated, writer.register_schema(name, schema, b""))
        writer.add_message(channel, START_NS, data, START_NS)
        writer.finish()  # type: ignore[no-untyped-call]
    assert_array_equal(open_bag(tmp_path / "a.mcap").scan(0).points, points)


@pytest.mark.parametrize("stamp", [0, START_NS])
def test_time_of_recording_is_used_where_headers_have_none(stamp: int, tmp_path: Path) -> None:
    """The headers of all messages have the time 0, or the same time."""
    made: list[Message] = [
        ("/points", START_NS + n, cloud_message(cloud_of(xyz(scan), stamp_ns=stamp), "cdr"))
        for n, scan in enumerate(scans(3))
    ]
    source = open_bag(write_mcap(tmp_path / "a.mcap", made))
    assert source.stamps_ns.tolist() == [START_NS, START_NS + 1, START_NS + 2]
    assert any("3 of 3 clouds" in note for note in source.notes())


def test_scans_are_ordered_by_their_headers(tmp_path: Path) -> None:
    clouds = scans(4)
    made = messages(clouds, "ros1")
    topic, time, message = made[0]
    made[0] = (topic, time + 10**9, message)  # recorded late
    source = open_bag(write_ros1(tmp_path / "a.bag", made))
    assert (np.diff(source.stamps) > 0).all()
    assert_array_equal(source.scan(0).points, usable(clouds[0]))


def test_points_without_usable_times_are_told(tmp_path: Path) -> None:
    layout = Layout(PLAIN.types | {"ring": "u2"})
    made = messages(scans(2), "cdr", layout)
    assert open_bag(write_mcap(tmp_path / "none.mcap", made)).notes() == []
    timed = Layout(PLAIN.types | {"time": "f4"})
    cloud = cloud_of(xyz(scans(1)[0]) | {"time": np.zeros(600)}, timed)
    path = write_mcap(tmp_path / "zero.mcap", [("/a", START_NS, cloud_message(cloud, "cdr"))])
    source = open_bag(path)
    assert source.scan(0).times is None
    assert any("The times of points (time) are all equal" in note for note in source.notes())


def test_integers_are_scaled_by_the_unit(tmp_path: Path) -> None:
    layout = Layout(dict.fromkeys("xyz", "i4"))
    cloud = cloud_of(xyz(usable(scans(1)[0]) * 1000), layout)
    path = write_mcap(tmp_path / "a.mcap", [("/a", START_NS, cloud_message(cloud, "cdr"))])
    assert any("integers" in note for note in open_bag(path).notes())
    with use_scan_options(ScanOptions(unit="mm")):
        source = open_bag(path)
    assert source.notes() == []
    assert_allclose(source.scan(0).points, usable(scans(1)[0]), atol=1e-3)


def test_damaged_message_is_named_and_others_are_read(tmp_path: Path) -> None:
    made = messages(scans(3), "cdr")
    made[2] = (made[2][0], made[2][1], replace(made[2][2], width=10**9))
    source = open_bag(write_mcap(tmp_path / "a.mcap", made))
    with pytest.raises(DriveError, match=r"a.mcap: topic '/points', message 1: .*1000000000"):
        source.scan(1)
    assert len(source.scan(2).points)


def foxglove_json(points: Float32) -> bytes:
    fields = [{"name": axis, "offset": 4 * n, "type": 7} for n, axis in enumerate("xyz")]
    return json.dumps(
        {
            "timestamp": {"sec": START_NS // 10**9, "nsec": START_NS % 10**9},
            "frame_id": "lidar",
            "pose": {"position": {"x": 0, "y": 0, "z": 0}, "orientation": {"w": 1}},
            "point_stride": 12,
            "fields": fields,
            "data": base64.b64encode(points.tobytes()).decode(),
        }
    ).encode()


def proto(number: int, value: bytes | int | float) -> bytes:
    """Return a field of a protobuf message; integers as fixed32, floats as doubles."""
    if isinstance(value, int):
        return bytes([number << 3 | 5]) + struct.pack("<I", value)
    if isinstance(value, float):
        return bytes([number << 3 | 1]) + struct.pack("<d", value)
    size, length = len(value), b""
    while size > 127:
        length += bytes([size & 127 | 128])
        size >>= 7
    return bytes([number << 3 | 2]) + length + bytes([size]) + value


def varint(number: int, value: int) -> bytes:
    digits = b""
    while value > 127:
        digits += bytes([value & 127 | 128])
        value >>= 7
    return bytes([number << 3]) + digits + bytes([value])


def foxglove_protobuf(points: Float32, x: float = 0.0) -> bytes:
    time = varint(1, START_NS // 10**9) + varint(2, START_NS % 10**9)
    fields = b"".join(
        proto(5, proto(1, axis.encode()) + proto(2, 4 * n) + varint(3, 7))
        for n, axis in enumerate("xyz")
    )
    pose = proto(1, proto(1, x)) + proto(2, proto(4, 1.0))
    return (
        proto(1, time)
        + proto(2, b"lidar")
        + proto(3, pose)
        + proto(4, 12)
        + fields
        + proto(6, points.tobytes())
    )


def write_foxglove(path: Path, data: bytes, encoding: str) -> Path:
    from mcap.writer import Writer

    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("foxglove.PointCloud", encoding, b"")
        channel = writer.register_channel("/cloud", encoding, schema)
        writer.add_message(channel, START_NS, data, START_NS)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def test_clouds_of_foxglove_are_read(tmp_path: Path) -> None:
    points = usable(scans(1)[0])
    for encoding, data in (
        ("json", foxglove_json(points)),
        ("protobuf", foxglove_protobuf(points)),
    ):
        source = open_bag(write_foxglove(tmp_path / f"{encoding}.mcap", data, encoding))
        assert_array_equal(source.scan(0).points, points)
        assert source.stamps_ns.tolist() == [START_NS]
        assert source.frame == "lidar"


def test_cloud_of_foxglove_in_cdr_is_read() -> None:
    points = usable(scans(1)[0])
    fields = b"".join(
        struct.pack("<I2sxxIBxxx", 2, axis.encode() + b"\0", 4 * n, 7)
        for n, axis in enumerate("xyz")
    )
    data = (
        bytes.fromhex("00010000")
        + struct.pack("<iII6sxx4x", 5, 6, 6, b"lidar\0")
        + struct.pack("<7d", 0, 0, 0, 0, 0, 0, 1)
        + struct.pack("<II", 12, 3)
        + fields
        + struct.pack("<I", points.nbytes)
        + points.tobytes()
    )
    cloud = read_cloud(data, "foxglove_msgs/PointCloud", "cdr", "test")
    assert (cloud.stamp_ns, cloud.frame) == (5_000_000_006, "lidar")
    assert_array_equal(decode(cloud, "test").points, points)


def test_point_cloud_of_old_drivers_is_read() -> None:
    points = usable(scans(1)[0])
    data = struct.pack("<IIII5sI", 1, 5, 6, 5, b"lidar", len(points)) + points.tobytes()
    cloud = read_cloud(data + bytes(4), "sensor_msgs/PointCloud", "ros1", "test")
    assert (cloud.stamp_ns, cloud.frame) == (5_000_000_006, "lidar")
    assert_array_equal(decode(cloud, "test").points, points)


def test_foxglove_cloud_with_a_pose_or_unknown_encoding_is_refused(tmp_path: Path) -> None:
    points = scans(1)[0]
    path = write_foxglove(tmp_path / "a.mcap", foxglove_protobuf(points, 2.0), "protobuf")
    with pytest.raises(DriveError, match=r"has a pose \[2.0, "):
        open_bag(path)
    path = write_foxglove(tmp_path / "b.mcap", b"", "flatbuffer")
    with pytest.raises(DriveError, match="encoded as 'flatbuffer'; expected 'ros1' or 'cdr'"):
        open_bag(path)


@pytest.mark.parametrize("encoding", ["json", "protobuf"])
def test_damaged_foxglove_message_is_refused(encoding: str, tmp_path: Path) -> None:
    whole = foxglove_json if encoding == "json" else foxglove_protobuf
    data = whole(scans(1, 9)[0])
    for cut in range(0, len(data), 7):
        path = write_foxglove(tmp_path / f"{cut}.mcap", data[:cut], encoding)
        with pytest.raises(DriveError):
            open_bag(path)


def test_bag_without_clouds_is_refused_with_its_topics(tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "a.mcap", messages(scans(1), "cdr")[1:])
    with pytest.raises(DriveError, match=r"no topic has clouds.*Topics: /odom \(nav_msgs/Odom"):
        open_bag(path)


def test_other_files_are_not_recognized(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("#ROSBAG is the first word of this text")
    (tmp_path / "empty").mkdir()
    for path in (tmp_path / "a.txt", tmp_path / "empty", tmp_path / "absent"):
        assert not any(each.recognizes(path) for each in CLASSES)


@pytest.mark.parametrize("name", ["a.bag", "a.db3", "a.mcap"])
def test_damaged_begin_of_a_file_is_told(name: str, tmp_path: Path) -> None:
    for content in (b"", b"nothing of the kind" * 9):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(DriveError, match=name):
            open_bag(tmp_path / name)


def test_old_bag_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.bag").write_bytes(b"#ROSBAG V1.2\n" + bytes(99))
    with pytest.raises(DriveError, match=r"version '1\.2'; expected 2\.0"):
        open_bag(tmp_path / "a.bag")


CHUNK = 20_000
CUT: dict[str, tuple[str, BagWriter]] = {
    "none.bag": ("ros1", lambda p, m: write_ros1(p, m, chunk_bytes=CHUNK)),
    "lz4.bag": ("ros1", lambda p, m: write_ros1(p, m, "lz4", CHUNK)),
    "bz2.bag": ("ros1", lambda p, m: write_ros1(p, m, "bz2", CHUNK)),
    "zstd.mcap": ("cdr", lambda p, m: write_mcap(p, m, chunk_bytes=CHUNK)),
    "no_index.mcap": ("cdr", lambda p, m: write_mcap(p, m, indexed=False, chunk_bytes=CHUNK)),
    "no_chunks.mcap": ("cdr", lambda p, m: write_mcap(p, m, chunked=False)),
}


@pytest.mark.parametrize("name", CUT)
def test_cut_file_gives_the_messages_before_the_cut(name: str, tmp_path: Path) -> None:
    """A recorder that was killed leaves a file without index, and with half a message."""
    encoding, write = CUT[name]
    clouds = scans(12)
    path = write(tmp_path / name, messages(clouds, encoding))
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 3 // 4])
    source = open_bag(path)
    assert 5 <= len(source) < 12
    for index in range(len(source)):
        assert_array_equal(source.scan(index).points, usable(clouds[index]))
    assert any("no usable index" in note for note in source.notes())


def test_bag_that_was_not_closed_is_read(tmp_path: Path) -> None:
    """rosbag writes the size of the last chunk when it is closed; until then it is 0."""
    clouds = scans(3)
    path = write_ros1(tmp_path / "a.bag", messages(clouds, "ros1"))
    content = bytearray(path.read_bytes())
    index_pos = content.index(b"index_pos=") + len(b"index_pos=")
    content[index_pos : index_pos + 8] = bytes(8)
    chunk = content.index(b"compression=none")
    size = content.index(b"size=", chunk)
    (length,) = struct.unpack_from("<I", content, size + 9)
    content[size + 5 : size + 13] = bytes(8)
    path.write_bytes(content[: size + 13 + length - 40])
    source = open_bag(path)
    assert len(source) == 3
    assert_array_equal(source.scan(2).points, usable(clouds[2]))
