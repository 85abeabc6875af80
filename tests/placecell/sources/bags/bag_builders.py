"""Bags with clouds, odometry and transforms, written by `rosbags` and `mcap`."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from rosbags import rosbag1, rosbag2
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from placecell.sources.bags.pointcloud2 import PointCloud2, PointField

LIVOX_POINT = """
uint32 offset_time
float32 x
float32 y
float32 z
uint8 reflectivity
uint8 tag
uint8 line
"""
LIVOX_MESSAGE = """
std_msgs/Header header
uint64 timebase
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
livox_ros_driver2/CustomPoint[] points
"""
LIVOX = "livox_ros_driver2/msg/CustomMsg"
CLOUD = "sensor_msgs/msg/PointCloud2"
ODOMETRY = "nav_msgs/msg/Odometry"
TRANSFORMS = "tf2_msgs/msg/TFMessage"
TRANSFORM_DEFINITION = "geometry_msgs/TransformStamped[] transforms\n"
STORES = {"ros1": Stores.ROS1_NOETIC, "cdr": Stores.ROS2_HUMBLE}
START_NS = 1_700_000_000_123_456_789
PERIOD_NS = 100_000_000


@cache
def typestore(encoding: str) -> Typestore:
    """Return the types of a ROS version, with Livox's and tf2's."""
    store = get_typestore(STORES[encoding])
    types = {
        **get_types_from_msg(LIVOX_POINT, "livox_ros_driver2/msg/CustomPoint"),
        **get_types_from_msg(LIVOX_MESSAGE, LIVOX),
    }
    if TRANSFORMS not in store.fielddefs:
        types |= get_types_from_msg(TRANSFORM_DEFINITION, TRANSFORMS)
    store.register(types)
    return store


def serialized(message: Any, encoding: str) -> bytes:
    """Serialize a message by `rosbags`."""
    store = typestore(encoding)
    kind = message.__msgtype__
    if encoding == "ros1":
        return bytes(store.serialize_ros1(message, kind))
    return bytes(store.serialize_cdr(message, kind))


def header(store: Typestore, stamp_ns: int, frame: str) -> Any:
    """Return a std_msgs/Header."""
    time = store.types["builtin_interfaces/msg/Time"](
        sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9
    )
    kind = store.types["std_msgs/msg/Header"]
    if "seq" in kind.__annotations__:
        return kind(seq=0, stamp=time, frame_id=frame)
    return kind(stamp=time, frame_id=frame)


@dataclass(frozen=True)
class Layout:
    """How the points of a cloud are written.

    Attributes:
        types: NumPy type, without byte order, of each field.
        order: order of the fields.
        gap: bytes of padding before each field.
        row_gap: bytes of padding behind each row.
        big: whether the values are big-endian.
        rows: rows of an organized cloud.
    """

    types: dict[str, str]
    order: Sequence[str] = ()
    gap: int = 0
    row_gap: int = 0
    big: bool = False
    rows: int = 1


DATATYPES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}
PLAIN = Layout({"x": "f4", "y": "f4", "z": "f4"})


def cloud_of(
    columns: Mapping[str, NDArray[Any]],
    layout: Layout = PLAIN,
    stamp_ns: int = START_NS,
    frame: str = "lidar",
) -> PointCloud2:
    """Write columns as a cloud; this is the encoder to the decoder under test."""
    names = list(layout.order or layout.types)
    fields, at = [], 0
    for name in names:
        at += layout.gap
        kind = layout.types[name]
        fields.append(PointField(name, at, DATATYPES[kind]))
        at += int(kind[1])
    step = at + layout.gap
    count = len(next(iter(columns.values())))
    width = count // layout.rows
    assert width * layout.rows == count
    row_step = width * step + layout.row_gap
    data = np.full((layout.rows, row_step), 0xA5, np.uint8)
    for each in fields:
        kind = (">" if layout.big else "<") + layout.types[each.name]
        with np.errstate(invalid="ignore", over="ignore"):
            values = columns[each.name].astype(kind).reshape(layout.rows, width)
        for row in range(layout.rows):
            cells = data[row, : width * step].reshape(width, step)
            size = each.size
            cells[:, each.offset : each.offset + size] = (
                np.ascontiguousarray(values[row]).view(np.uint8).reshape(width, size)
            )
    return PointCloud2(
        fields, layout.big, step, row_step, width, layout.rows, data.tobytes(), stamp_ns, frame
    )


def xyz(points: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """Return the columns of points (n, 3)."""
    return dict(zip("xyz", np.asarray(points).T, strict=True))


def cloud_message(cloud: PointCloud2, encoding: str) -> Any:
    """Return the message of a cloud."""
    store = typestore(encoding)
    point_field = store.types["sensor_msgs/msg/PointField"]
    return store.types[CLOUD](
        header=header(store, cloud.stamp_ns, cloud.frame),
        height=cloud.height,
        width=cloud.width,
        fields=[
            point_field(name=f.name, offset=f.offset, datatype=f.datatype, count=f.count)
            for f in cloud.fields
        ],
        is_bigendian=cloud.is_bigendian,
        point_step=cloud.point_step,
        row_step=cloud.row_step,
        data=np.frombuffer(cloud.data, np.uint8),
        is_dense=False,
    )


def livox_message(
    points: NDArray[np.float32], offsets: NDArray[np.uint32], stamp_ns: int, encoding: str
) -> Any:
    """Return a CustomMsg of Livox."""
    store = typestore(encoding)
    point = store.types["livox_ros_driver2/msg/CustomPoint"]
    return store.types[LIVOX](
        header=header(store, stamp_ns, "livox_frame"),
        timebase=stamp_ns,
        point_num=len(points),
        lidar_id=1,
        rsvd=np.zeros(3, np.uint8),
        points=[
            point(int(time), float(x), float(y), float(z), 10, 0, n % 4)
            for n, (time, (x, y, z)) in enumerate(zip(offsets, points, strict=True))
        ],
    )


def pose_of(store: Typestore, pose: NDArray[np.float64]) -> Any:
    """Return a geometry_msgs/Pose."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
    position = [float(value) for value in pose[:3, 3]]
    return store.types["geometry_msgs/msg/Pose"](
        position=store.types["geometry_msgs/msg/Point"](*position),
        orientation=store.types["geometry_msgs/msg/Quaternion"](x, y, z, w),
    )


def odometry_message(
    pose: NDArray[np.float64],
    stamp_ns: int,
    encoding: str,
    frame: str = "odom",
    child: str = "base_link",
    covariance: NDArray[np.float64] | None = None,
) -> Any:
    """Return a nav_msgs/Odometry; an unknown covariance is zeros."""
    store = typestore(encoding)
    vector = store.types["geometry_msgs/msg/Vector3"]
    twist = store.types["geometry_msgs/msg/Twist"](vector(0.0, 0.0, 0.0), vector(0.0, 0.0, 0.0))
    empty = np.zeros(36)
    stated = empty if covariance is None else covariance.reshape(36)
    return store.types[ODOMETRY](
        header=header(store, stamp_ns, frame),
        child_frame_id=child,
        pose=store.types["geometry_msgs/msg/PoseWithCovariance"](pose_of(store, pose), stated),
        twist=store.types["geometry_msgs/msg/TwistWithCovariance"](twist, empty),
    )


def imu_message(
    acceleration: NDArray[np.float64],
    rate: NDArray[np.float64],
    stamp_ns: int,
    encoding: str,
    frame: str = "imu",
    orientation: Sequence[float] | None = None,
) -> Any:
    """Return a sensor_msgs/Imu; without an orientation, its covariance says so."""
    store = typestore(encoding)
    vector = store.types["geometry_msgs/msg/Vector3"]
    unknown = np.zeros(9)
    unknown[0] = 0.0 if orientation is not None else -1.0
    return store.types["sensor_msgs/msg/Imu"](
        header=header(store, stamp_ns, frame),
        orientation=store.types["geometry_msgs/msg/Quaternion"](*(orientation or (0, 0, 0, 0))),
        orientation_covariance=unknown,
        angular_velocity=vector(*rate.tolist()),
        angular_velocity_covariance=np.zeros(9),
        linear_acceleration=vector(*acceleration.tolist()),
        linear_acceleration_covariance=np.zeros(9),
    )


def transforms_message(
    edges: Sequence[tuple[str, str, NDArray[np.float64]]], stamp_ns: int, encoding: str
) -> Any:
    """Return a tf2_msgs/TFMessage of transforms parent, child, pose of the child."""
    store = typestore(encoding)
    transforms = []
    for parent, child, pose in edges:
        plain = pose_of(store, pose)
        transforms.append(
            store.types["geometry_msgs/msg/TransformStamped"](
                header=header(store, stamp_ns, parent),
                child_frame_id=child,
                transform=store.types["geometry_msgs/msg/Transform"](
                    translation=store.types["geometry_msgs/msg/Vector3"](
                        plain.position.x, plain.position.y, plain.position.z
                    ),
                    rotation=plain.orientation,
                ),
            )
        )
    return store.types[TRANSFORMS](transforms=transforms)


Message = tuple[str, int, Any]
"""Topic, time of recording in nanoseconds, and message."""
Ros1Compression = Literal["none", "lz4", "bz2"]


def write_ros1(
    path: Path,
    messages: Sequence[Message],
    compression: Ros1Compression = "none",
    chunk_bytes: int = 1 << 20,
    empty: Sequence[tuple[str, str]] = (),
) -> Path:
    """Write a ROS 1 bag; `empty` are topics and types without messages."""
    store = typestore("ros1")
    writer = rosbag1.Writer(path)
    writer.chunk_threshold = chunk_bytes
    if compression != "none":
        writer.set_compression(rosbag1.Writer.CompressionFormat[compression.upper()])
    with writer:
        connections: dict[str, Any] = {}
        for topic, kind in empty:
            writer.add_connection(topic, kind, typestore=store)
        for topic, time, message in messages:
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            data = store.serialize_ros1(message, kind)
            writer.write(connections[topic], time, data)
    return path


def write_ros2(
    path: Path,
    messages: Sequence[Message],
    storage: Literal["sqlite3", "mcap"] = "sqlite3",
    compression: Literal["none", "file", "message", "storage"] = "none",
    empty: Sequence[tuple[str, str]] = (),
) -> Path:
    """Write a ROS 2 bag; `empty` are topics and types without messages."""
    store = typestore("cdr")
    plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
    writer = rosbag2.Writer(path, version=9, storage_plugin=plugin)
    if compression != "none":
        writer.set_compression(CompressionMode[compression.upper()], CompressionFormat.ZSTD)
    with writer:
        connections: dict[str, Any] = {}
        for topic, kind in empty:
            writer.add_connection(topic, kind, typestore=store)
        for topic, time, message in messages:
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], time, store.serialize_cdr(message, kind))
    return path


def write_mcap(
    path: Path,
    messages: Sequence[Message],
    encoding: str = "cdr",
    compression: Literal["none", "lz4", "zstd"] = "zstd",
    chunked: bool = True,
    indexed: bool = True,
    chunk_bytes: int = 1 << 20,
    empty: Sequence[tuple[str, str]] = (),
) -> Path:
    """Write an MCAP file with the profile of ROS 1 or ROS 2.

    Topics and types of `empty` have no messages.
    """
    from mcap.writer import CompressionType, IndexType, Writer

    with path.open("wb") as file:
        writer = Writer(
            file,
            chunk_size=chunk_bytes,
            compression=CompressionType[compression.upper()],
            use_chunking=chunked,
            index_types=IndexType.ALL if indexed else IndexType.NONE,
            use_summary_offsets=indexed,
            use_statistics=indexed,
            repeat_channels=indexed,
            repeat_schemas=indexed,
        )
        writer.start(profile="ros1" if encoding == "ros1" else "ros2", library="tests")
        channels: dict[str, int] = {}
        for topic, kind in empty:
            writer.register_channel(topic, encoding, writer.register_schema(kind, "ros2msg", b""))
        for topic, time, message in messages:
            kind = message.__msgtype__
            if topic not in channels:
                name = kind.replace("/msg/", "/") if encoding == "ros1" else kind
                schema = writer.register_schema(
                    name, "ros1msg" if encoding == "ros1" else "ros2msg", b""
                )
                channels[topic] = writer.register_channel(topic, encoding, schema)
            writer.add_message(channels[topic], time, serialized(message, encoding), time)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


BagWriter = Callable[[Path, Sequence[Message]], Path]
FORMATS: dict[str, tuple[str, BagWriter]] = {
    "ros1.bag": ("ros1", write_ros1),
    "ros1_lz4.bag": ("ros1", lambda p, m: write_ros1(p, m, "lz4")),
    "ros1_bz2.bag": ("ros1", lambda p, m: write_ros1(p, m, "bz2")),
    "ros2_sqlite": ("cdr", write_ros2),
    "ros2_sqlite_file_zstd": ("cdr", lambda p, m: write_ros2(p, m, compression="file")),
    "ros2_sqlite_message_zstd": ("cdr", lambda p, m: write_ros2(p, m, compression="message")),
    "ros2_mcap": ("cdr", lambda p, m: write_ros2(p, m, "mcap")),
    "ros2_mcap_storage_zstd": ("cdr", lambda p, m: write_ros2(p, m, "mcap", "storage")),
    "ros2_mcap_file_zstd": ("cdr", lambda p, m: write_ros2(p, m, "mcap", "file")),
    "ros2.mcap": ("cdr", write_mcap),
    "ros2_lz4.mcap": ("cdr", lambda p, m: write_mcap(p, m, compression="lz4")),
    "ros2_plain.mcap": ("cdr", lambda p, m: write_mcap(p, m, compression="none")),
    "ros2_no_index.mcap": ("cdr", lambda p, m: write_mcap(p, m, indexed=False)),
    "ros2_no_chunks.mcap": ("cdr", lambda p, m: write_mcap(p, m, chunked=False)),
    "ros1.mcap": ("ros1", lambda p, m: write_mcap(p, m, "ros1")),
}
"""Serialization and writer of each kind of bag, by the name of its file or folder."""


def write_split(folder: Path, messages: Sequence[Message], parts: int = 3) -> Path:
    """Write a ROS 2 bag in several MCAP files with zstd, as `ros2 bag record` splits it."""
    folder.mkdir()
    names = []
    for part in range(parts):
        names.append(f"{folder.name}_{part}.mcap")
        first, last = (len(messages) * each // parts for each in (part, part + 1))
        write_mcap(folder / names[-1], messages[first:last])
    listed = "".join(f"    - {name}\n" for name in names)
    (folder / "metadata.yaml").write_text(
        "rosbag2_bagfile_information:\n"
        "  version: 5\n"
        "  storage_identifier: mcap\n"
        f"  relative_file_paths:\n{listed}"
    )
    return folder


PADDED = Layout(
    {"x": "f4", "y": "f4", "z": "f4", "intensity": "f4", "t": "u4", "ring": "u2"},
    order=("ring", "x", "y", "z", "t", "intensity"),
    gap=2,
    row_gap=6,
)
"""Padding between all values and behind the rows."""
LAYOUTS = {"padded": PADDED, "big-endian": replace(PADDED, big=True, gap=0)}
MOUNT = np.array(
    [[0.0, -1.0, 0.0, 0.4], [1.0, 0.0, 0.0, -0.1], [0.0, 0.0, 1.0, 1.7], [0.0, 0.0, 0.0, 1.0]]
)
"""Pose of the sensor on the robot, in the transforms of `drive_messages`."""


def drive_messages(
    scans: Sequence[NDArray[np.float32]],
    poses: Sequence[NDArray[np.float64]],
    encoding: str,
    layout: Layout = PADDED,
    stamps_ns: Sequence[int] | None = None,
) -> list[Message]:
    """Return clouds with NaN and zero points, odometry of the robot, and tf to the sensor.

    Args:
        scans: points of each scan.
        poses: poses of the sensor.
        encoding: `ros1` or `cdr`.
        layout: how the points are written.
        stamps_ns: time of each scan.
    """
    stamps = stamps_ns or [START_NS + number * PERIOD_NS for number in range(len(scans))]
    static = transforms_message([("base_link", "lidar", MOUNT)], stamps[0], encoding)
    messages: list[Message] = [("/tf_static", stamps[0], static)]
    on_robot = np.linalg.inv(MOUNT)
    for scan, pose, stamp in zip(scans, poses, stamps, strict=True):
        points = np.insert(scan, slice(0, len(scan), 1 + len(scan) // 5), np.nan, axis=0)
        points = np.insert(points, slice(2, len(points), 1 + len(points) // 9), 0, axis=0)
        count = len(points)
        columns: dict[str, NDArray[Any]] = dict(xyz(points))
        columns["intensity"] = np.arange(count)
        columns["t"] = np.linspace(0, 99e6, count).astype(np.uint32)
        columns["ring"] = np.arange(count) % 64
        cloud = cloud_of(columns, layout, stamp)
        odometry = odometry_message(pose @ on_robot, stamp, encoding)
        messages.append(("/odom", stamp, odometry))
        messages.append(("/points", stamp, cloud_message(cloud, encoding)))
    return messages


DRIVES: dict[str, tuple[str, BagWriter]] = {
    "drive.bag": ("ros1", write_ros1),
    "drive_sqlite": ("cdr", write_ros2),
    "drive_mcap_split_zstd": ("cdr", write_split),
}
"""Serialization and writer of each kind of bag that a drive is compared in."""
