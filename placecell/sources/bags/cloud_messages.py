"""Messages with clouds: PointCloud2, Livox CustomMsg, and the types that are like them.

Each becomes a `PointCloud2`, so that one decoder reads all of them.
"""

import base64
import binascii
import json
import struct
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from placecell.core.types import Float64
from placecell.sources.bags.pointcloud2 import PointCloud2, PointField
from placecell.sources.bags.wire import Wire
from placecell.sources.errors import DriveError

XYZ = tuple(PointField(axis, 4 * number, 7) for number, axis in enumerate("xyz"))
LIVOX = (
    PointField("offset_time", 0, 6),
    *(PointField(axis, 4 + 4 * number, 7) for number, axis in enumerate("xyz")),
    PointField("reflectivity", 16, 2),
    PointField("tag", 17, 2),
    PointField("line", 18, 2),
)
LIVOX_BYTES = 19
FOXGLOVE_TYPES = {1: 2, 2: 1, 3: 4, 4: 3, 5: 6, 6: 5, 7: 7, 8: 8}
"""Datatype of sensor_msgs/PointField of each numeric type of Foxglove."""


def point_cloud2(wire: Wire) -> PointCloud2:
    """Read a sensor_msgs/PointCloud2."""
    stamp, frame = wire.header()
    height, width = wire.u32(), wire.u32()
    fields = wire.sequence(lambda: point_field(wire), 13)
    big = wire.u8() != 0
    point_step, row_step = wire.u32(), wire.u32()
    return PointCloud2(fields, big, point_step, row_step, width, height, wire.bytes(), stamp, frame)


def point_field(wire: Wire) -> PointField:
    """Read a sensor_msgs/PointField."""
    return PointField(wire.string(), wire.u32(), wire.u8(), wire.u32())


def livox(wire: Wire) -> PointCloud2:
    """Read a CustomMsg of livox_ros_driver or livox_ros_driver2."""
    stamp, frame = wire.header()
    timebase = wire.value("Q")
    wire.u32()  # point_num, which the length of the list repeats
    wire.take(4, "lidar_id and rsvd")
    count = wire.u32()
    step = LIVOX_BYTES if wire.ros1 else LIVOX_BYTES + 1  # CDR aligns offset_time
    data = wire.take(max(0, count * step - (step - LIVOX_BYTES)), f"a list of {count} points")
    if len(data) < count * step:  # The last point has no padding behind it.
        data = memoryview(bytes(data) + b"\0")
    big = wire.order == ">"
    return PointCloud2(LIVOX, big, step, count * step, count, 1, data, stamp or timebase, frame)


def point_cloud(wire: Wire) -> PointCloud2:
    """Read a sensor_msgs/PointCloud, which PointCloud2 replaced."""
    stamp, frame = wire.header()
    count = wire.u32()
    data = wire.take(12 * count, f"a list of {count} points")
    return PointCloud2(XYZ, wire.order == ">", 12, 12 * count, count, 1, data, stamp, frame)


def foxglove_wire(wire: Wire) -> PointCloud2:
    """Read a foxglove_msgs/PointCloud."""
    stamp, frame = wire.time_ns(), wire.string()
    check_pose(wire.doubles(7), wire.where)
    step = wire.u32()
    fields = wire.sequence(lambda: foxglove_field(wire.string(), wire.u32(), wire.u8()), 9)
    return packed_cloud(fields, step, wire.bytes(), stamp, frame, wire.where)


def foxglove_field(name: str, offset: int, kind: int) -> PointField:
    """Return a field from foxglove.PackedElementField."""
    return PointField(name, offset, FOXGLOVE_TYPES.get(kind, 0))


def packed_cloud(
    fields: list[PointField],
    step: int,
    data: bytes | memoryview,
    stamp: int,
    frame: str,
    where: str,
) -> PointCloud2:
    """Return a cloud of which the data alone tells the number of points."""
    if not step or len(data) % step:
        raise DriveError(
            f"{where}: {len(data)} bytes of data are no whole number of points of {step} bytes "
            "(point_stride). The message is damaged; record it again"
        )
    count = len(data) // step
    return PointCloud2(fields, False, step, len(data), count, 1, data, stamp, frame)


def check_pose(pose: Float64, where: str) -> None:
    """Check that the origin of a Foxglove cloud is that of its frame.

    Raises:
        DriveError: the pose (x, y, z, quaternion x, y, z, w) is not the identity.
    """
    if not np.allclose(pose[:6], 0, atol=1e-9):
        raise DriveError(
            f"{where}: the cloud has a pose {np.round(pose, 4).tolist()} in its frame; expected "
            "the identity. Convert the clouds to the sensor's frame"
        )


def foxglove_json(data: bytes, where: str) -> PointCloud2:
    """Read a foxglove.PointCloud from JSON."""
    try:
        content = json.loads(data)
        stamp = content.get("timestamp") or {}
        pose = content.get("pose") or {}
        values = [
            float((pose.get(part) or {}).get(axis, 0))
            for part, axes in (("position", "xyz"), ("orientation", "xyzw"))
            for axis in axes
        ]
        fields = [
            foxglove_field(str(each["name"]), int(each["offset"]), int(each["type"]))
            for each in content["fields"]
        ]
        step = int(content["point_stride"])
        points = base64.b64decode(content["data"])
        seconds, nanoseconds = int(stamp.get("sec", 0)), int(stamp.get("nsec", 0))
    except (
        AttributeError,
        KeyError,
        OverflowError,
        RecursionError,
        TypeError,
        ValueError,
        binascii.Error,
    ) as error:
        raise DriveError(
            f"{where}: the message is no foxglove.PointCloud in JSON ({error!r}). It is damaged; "
            "record it again"
        ) from error
    check_pose(np.array(values), where)
    if step < 0 or any(field.offset < 0 for field in fields):
        raise DriveError(f"{where}: the message has negative offsets; record it again")
    frame = str(content.get("frame_id", ""))
    return packed_cloud(fields, step, points, seconds * 10**9 + nanoseconds, frame, where)


def protobuf_fields(data: memoryview, where: str) -> Iterator[tuple[int, Any]]:
    """Yield number and value of each field of a protobuf message.

    Raises:
        DriveError: the message is damaged.
    """
    at = 0

    def varint() -> int:
        nonlocal at
        value = shift = 0
        while True:
            if at >= len(data) or shift > 63:
                raise DriveError(f"{where}: the protobuf message is damaged; record it again")
            byte = data[at]
            at += 1
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    while at < len(data):
        key = varint()
        kind = key & 7
        if kind == 0:
            yield key >> 3, varint()
            continue
        size = {1: 8, 5: 4}.get(kind)
        if kind == 2:
            size = varint()
        if size is None or at + size > len(data):
            raise DriveError(f"{where}: the protobuf message is damaged; record it again")
        value = data[at : at + size]
        at += size
        if kind == 2:
            yield key >> 3, value
        else:
            yield key >> 3, struct.unpack("<d" if size == 8 else "<I", value)[0]


def foxglove_protobuf(data: bytes, where: str) -> PointCloud2:
    """Read a foxglove.PointCloud from protobuf; numbers of fields as in its definition."""
    stamp, frame, step, points = 0, "", 0, memoryview(b"")
    fields = []
    pose = np.zeros(7)

    def part(value: Any) -> dict[int, Any]:
        if not isinstance(value, memoryview):
            raise DriveError(f"{where}: the message is no foxglove.PointCloud; record it again")
        return dict(protobuf_fields(value, where))

    def number(value: Any) -> int:
        if not isinstance(value, int):
            raise DriveError(f"{where}: the message is no foxglove.PointCloud; record it again")
        return value

    def text(value: Any) -> str:
        return bytes(value).decode(errors="replace") if isinstance(value, memoryview) else ""

    for key, value in protobuf_fields(memoryview(data), where):
        if key == 1:
            time = part(value)
            stamp = number(time.get(1, 0)) * 10**9 + number(time.get(2, 0))
        elif key == 2:
            frame = text(value)
        elif key == 3:
            for at, inner in ((0, part(value).get(1)), (3, part(value).get(2))):
                for axis, coordinate in part(inner).items() if inner is not None else ():
                    if 1 <= axis <= 4 and isinstance(coordinate, float) and at + axis <= 7:
                        pose[at + axis - 1] = coordinate
        elif key == 4:
            step = number(value)
        elif key == 5:
            each = part(value)
            fields.append(
                foxglove_field(text(each.get(1)), number(each.get(2, 0)), number(each.get(3, 0)))
            )
        elif key == 6 and isinstance(value, memoryview):
            points = value
    check_pose(pose, where)
    return packed_cloud(fields, step, points, stamp, frame, where)


WIRE_CLOUDS: dict[str, Callable[[Wire], PointCloud2]] = {
    "sensor_msgs/PointCloud2": point_cloud2,
    "livox_ros_driver/CustomMsg": livox,
    "livox_ros_driver2/CustomMsg": livox,
    "livox_interfaces/CustomMsg": livox,
    "sensor_msgs/PointCloud": point_cloud,
    "foxglove_msgs/PointCloud": foxglove_wire,
}
"""Reader of each type of message with a cloud, serialized as ROS 1 or CDR."""

OTHER_CLOUDS: dict[tuple[str, str], Callable[[bytes, str], PointCloud2]] = {
    ("foxglove.PointCloud", "json"): foxglove_json,
    ("foxglove.PointCloud", "protobuf"): foxglove_protobuf,
}
"""Reader of each type of message with a cloud, in other encodings."""


def is_cloud(kind: str) -> bool:
    """Return whether messages of the type hold clouds."""
    return kind in WIRE_CLOUDS or kind == "foxglove.PointCloud"


def read_cloud(data: bytes | memoryview, kind: str, encoding: str, where: str) -> PointCloud2:
    """Read a message with a cloud.

    Raises:
        DriveError: the message is damaged, or its encoding is not known.
    """
    if kind in WIRE_CLOUDS and encoding in ("ros1", "cdr"):
        return WIRE_CLOUDS[kind](Wire(data, encoding, where))
    other = OTHER_CLOUDS.get((kind, encoding))
    if other is None:
        raise DriveError(
            f"{where}: messages of the type {kind} are encoded as {encoding!r}; expected 'ros1' "
            "or 'cdr' (for foxglove.PointCloud 'protobuf' or 'json'). Convert the file, for "
            "example with 'mcap convert', or record PointCloud2"
        )
    return other(bytes(data), where)
