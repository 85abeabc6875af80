"""Writer of MCAP files for Foxglove and ROS 2: clouds and poses as ROS messages."""

import struct
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from placecell.core.types import Float64, UInt8
from placecell.export.content import ExportContent
from placecell.export.poses import as_rows

LINE = "=" * 80
TIME = f"{LINE}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
HEADER = f"{LINE}\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n{TIME}"
CLOUD = (
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
    "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"
    f"{HEADER}{LINE}\nMSG: sensor_msgs/PointField\nuint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\n"
    "uint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\n"
    "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"
)
POSE = (
    f"std_msgs/Header header\ngeometry_msgs/Pose pose\n{HEADER}{LINE}\nMSG: geometry_msgs/Pose\n"
    "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
    f"{LINE}\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"
    f"{LINE}\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
)
FIELDS = (("x", 7), ("y", 7), ("z", 7), ("rgb", 6), ("id", 6), ("robot", 6), ("group", 6))
"""Name and data type of each value of a point: 7 is float32, 6 is uint32; 4 bytes each."""
POINTS_A_MESSAGE = 500_000
"""Most points of a message; a large map is written in parts, each on its own topic."""


class CdrWriter:
    """Serializer of ROS 2 messages: little-endian CDR, each value aligned to its size."""

    def __init__(self) -> None:
        self.content = bytearray(b"\x00\x01\x00\x00")

    def add(self, kind: str, *values: float | bool) -> None:
        """Append numbers of a type of `struct`."""
        size = struct.calcsize(kind)
        self.content += bytes(-(len(self.content) - 4) % size)
        self.content += struct.pack(f"<{len(values)}{kind}", *values)

    def text(self, value: str) -> None:
        """Append a string."""
        content = value.encode() + b"\x00"
        self.add("I", len(content))
        self.content += content

    def header(self, stamp_ns: int, frame: str) -> None:
        """Append a std_msgs/Header."""
        self.add("i", stamp_ns // 10**9)
        self.add("I", stamp_ns % 10**9)
        self.text(frame)


def cloud_message(table: bytes, count: int, stamp_ns: int, frame: str) -> bytes:
    """Serialize a sensor_msgs/PointCloud2."""
    step = 4 * len(FIELDS)
    cdr = CdrWriter()
    cdr.header(stamp_ns, frame)
    cdr.add("I", 1, count, len(FIELDS))
    for index, (name, kind) in enumerate(FIELDS):
        cdr.text(name)
        cdr.add("I", 4 * index)
        cdr.add("B", kind)
        cdr.add("I", 1)
    cdr.add("?", False)
    cdr.add("I", step, step * count, len(table))
    cdr.content += table
    cdr.add("?", True)
    return bytes(cdr.content)


def pose_message(row: Float64, stamp_ns: int, frame: str) -> bytes:
    """Serialize a geometry_msgs/PoseStamped."""
    cdr = CdrWriter()
    cdr.header(stamp_ns, frame)
    cdr.add("d", *row.tolist())
    return bytes(cdr.content)


def point_rows(content: ExportContent, color: UInt8, part: slice) -> bytes:
    """Return some points as bytes, with the values of `FIELDS`."""
    owners = content.owners[part]
    wide = color[owners].astype(np.uint32)
    table = np.empty((len(owners), len(FIELDS)), "<u4")
    table[:, :3] = content.points[part].astype("<f4").view("<u4")
    table[:, 3] = (wide[:, 0] << 16) | (wide[:, 1] << 8) | wide[:, 2]
    table[:, 4] = content.ids[owners]
    table[:, 5] = content.robot[owners]
    table[:, 6] = content.groups[owners]
    return table.tobytes()


def parts_of(count: int) -> Iterable[slice]:
    """Return the parts of the points that are one message each."""
    return [
        slice(first, min(first + POINTS_A_MESSAGE, count))
        for first in range(0, max(count, 1), POINTS_A_MESSAGE)
    ]


def write_mcap(content: ExportContent, color: UInt8, file: Path) -> None:
    """Write the segments as PointCloud2 on /segments, and the captures as poses on /poses."""
    from mcap.writer import CompressionType, Writer

    frame = content.frame or "map"
    stamps = np.round(content.stamps * 1e9).astype(np.int64)
    stamps = np.maximum(stamps, 0)
    start = int(stamps[0]) if len(stamps) else 0
    with file.open("wb") as stream:
        writer = Writer(stream, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="placecell")
        cloud = writer.register_schema("sensor_msgs/msg/PointCloud2", "ros2msg", CLOUD.encode())
        pose = writer.register_schema("geometry_msgs/msg/PoseStamped", "ros2msg", POSE.encode())
        for number, part in enumerate(parts_of(len(content.points))):
            topic = "/segments" if number == 0 else f"/segments_{number}"
            channel = writer.register_channel(topic, "cdr", cloud)
            table = point_rows(content, color, part)
            count = len(table) // (4 * len(FIELDS))
            writer.add_message(channel, start, cloud_message(table, count, start, frame), start)
        channel = writer.register_channel("/poses", "cdr", pose)
        for stamp, row in zip(stamps.tolist(), as_rows(content.poses), strict=True):
            writer.add_message(channel, stamp, pose_message(row, stamp, frame), stamp)
        writer.finish()  # type: ignore[no-untyped-call]
