"""MCAP file of a run, for Foxglove: clouds, segments, poses, and `map -> odom`."""

from pathlib import Path

import numpy as np

from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64, UInt8, UInt32
from placecell.export.content import colors
from placecell.export.mcap_file import (
    CLOUD,
    FIELDS,
    HEADER,
    LINE,
    POSE,
    CdrWriter,
    cloud_message,
    pose_message,
)
from placecell.export.poses import as_rows
from robot.core.map_to_odom import MapToOdom
from robot.core.status import Fix
from robot.outputs.output import NoOutput

TRANSFORMS = (
    f"geometry_msgs/TransformStamped[] transforms\n{LINE}\nMSG: geometry_msgs/TransformStamped\n"
    f"std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n{HEADER}"
    f"{LINE}\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\n"
    f"geometry_msgs/Quaternion rotation\n{LINE}\nMSG: geometry_msgs/Vector3\n"
    "float64 x\nfloat64 y\nfloat64 z\n"
    f"{LINE}\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
)
GRAY = 0xA0A0A0
"""Color of the points of a scan."""
ODOM, MAP = "odom", "map"


class McapOutput(NoOutput):
    """MCAP file with ROS 2 messages.

    `/scan` and `/segments` are the clouds at keyframes, `/pose` is the sensor at each scan in the
    odometry frame, `/fixes` are the accepted fixes in the map, and `/tf` has `map -> odom`.
    """

    def __init__(self, file: Path) -> None:
        """Open the file; an existing one is replaced.

        Raises:
            OSError: the file cannot be written.
        """
        from mcap.writer import CompressionType, Writer

        self.path = file
        file.parent.mkdir(parents=True, exist_ok=True)
        self._stream = file.open("wb")
        self._writer = writer = Writer(self._stream, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="placecell")
        cloud = writer.register_schema("sensor_msgs/msg/PointCloud2", "ros2msg", CLOUD.encode())
        pose = writer.register_schema("geometry_msgs/msg/PoseStamped", "ros2msg", POSE.encode())
        tf = writer.register_schema("tf2_msgs/msg/TFMessage", "ros2msg", TRANSFORMS.encode())
        self._channels = {
            topic: writer.register_channel(topic, "cdr", schema)
            for topic, schema in (
                ("/scan", cloud),
                ("/segments", cloud),
                ("/pose", pose),
                ("/fixes", pose),
                ("/tf", tf),
            )
        }
        self._is_keyframe = False

    def segments(self, time: float, segments: Segments, ids: Int64) -> None:
        """Write the segments of a keyframe, each in its own color."""
        color = colors(ids)[segments.owners]
        table = point_table(segments.points, packed(color), ids[segments.owners])
        self._add("/segments", time, cloud_message(table, len(segments.points), _ns(time), ODOM))
        self._is_keyframe = True

    def scan(
        self, time: float, points: Float32, odom_pose: Float64, map_to_odom: MapToOdom | None
    ) -> None:
        """Write the pose of a scan, and its points at a keyframe."""
        stamp = _ns(time)
        if self._is_keyframe:
            self._is_keyframe = False
            moved = (points @ odom_pose[:3, :3].T + odom_pose[:3, 3]).astype(np.float32)
            count = len(moved)
            table = point_table(moved, np.full(count, GRAY, np.uint32), np.zeros(count, np.int64))
            self._add("/scan", time, cloud_message(table, count, stamp, ODOM))
        self._add("/pose", time, pose_message(as_rows(odom_pose[None])[0], stamp, ODOM))
        if map_to_odom is not None:
            self._add("/tf", time, transform_message(map_to_odom.transform, stamp))

    def fix(self, fix: Fix) -> None:
        """Write an accepted fix."""
        if fix.accepted:
            row = as_rows(fix.pose[None])[0]
            self._add("/fixes", fix.time, pose_message(row, _ns(fix.time), MAP))

    def close(self) -> None:
        """Write the index and close the file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._stream.close()

    def _add(self, topic: str, time: float, message: bytes) -> None:
        self._writer.add_message(self._channels[topic], _ns(time), message, _ns(time))


def transform_message(transform: Float64, stamp_ns: int) -> bytes:
    """Serialize a tf2_msgs/TFMessage with `map -> odom`."""
    cdr = CdrWriter()
    cdr.add("I", 1)
    cdr.header(stamp_ns, MAP)
    cdr.text(ODOM)
    cdr.add("d", *as_rows(transform[None])[0].tolist())
    return bytes(cdr.content)


def point_table(points: Float32, color: UInt32, ids: Int64) -> bytes:
    """Return points as bytes, with the values of `FIELDS`; the last two are 0."""
    table = np.zeros((len(points), len(FIELDS)), "<u4")
    table[:, :3] = points.astype("<f4").view("<u4")
    table[:, 3] = color
    table[:, 4] = ids
    return table.tobytes()


def packed(color: UInt8) -> UInt32:
    """Return colors (n, 3) as one number each."""
    wide = color.astype(np.uint32)
    return np.asarray((wide[:, 0] << 16) | (wide[:, 1] << 8) | wide[:, 2])


def _ns(time: float) -> int:
    return max(0, round(time * 1e9))
