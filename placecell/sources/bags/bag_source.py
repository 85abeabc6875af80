"""Scans from the clouds of a bag."""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import ClassVar

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.sources.bags.bag_poses import BagPoses, Extrinsic, read_poses
from placecell.sources.bags.cloud_messages import is_cloud, read_cloud
from placecell.sources.bags.containers import mcap_file, ros1_file, sqlite_file
from placecell.sources.bags.containers.bag import METADATA, Bag, bag_files, kind_of
from placecell.sources.bags.containers.container import BagTopic, Container
from placecell.sources.bags.imu import read_imu
from placecell.sources.bags.pointcloud2 import (
    PointCloud2,
    TimeField,
    axes_of,
    cloud_clock,
    coordinates,
    decode,
    time_fields,
)
from placecell.sources.bags.wire import CDR_ORDERS
from placecell.sources.errors import DriveError
from placecell.sources.imu import ImuSamples
from placecell.sources.point_clock import PointClock
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import METERS, current_scan_options
from placecell.sources.source import ScanSource
from placecell.trajectories.trajectory import Trajectory

SAMPLES = 5
"""Clouds that tell the points' clock and a topic's size, evenly spread."""
HEAD = 16
"""Bytes of a message that hold its stamp."""
WORLD_FRAMES = ("map", "odom", "world", "earth", "camera_init", "global", "utm", "local", "enu")
"""Usual names of frames that stand still; a cloud in one is no sensor's scan."""

PACKETS = re.compile(
    r"velodyne|ouster|hesai|pandar|rslidar|robosense|nebula|innovusion|seyond|sick|livox|aeva",
    re.IGNORECASE,
)
PACKET_TYPES = re.compile(r"/\w*(scan|packets?|udpframe)\w*$", re.IGNORECASE)
DRIVERS = {
    "velodyne": "the driver's node velodyne_pointcloud",
    "ouster": "the driver ouster_ros (its launch file 'replay')",
    "hesai": "the driver hesai_ros_driver (source_type 3: packets of ROS)",
    "pandar": "the driver hesai_ros_driver (source_type 3: packets of ROS)",
    "rslidar": "the driver rslidar_sdk (msg_source 2: packets of ROS)",
    "robosense": "the driver rslidar_sdk (msg_source 2: packets of ROS)",
    "nebula": "the driver nebula_ros (launch_hw:=false)",
}


@dataclass(frozen=True, slots=True, eq=False)
class CloudTopic:
    """Topic with clouds, and some of its clouds.

    Attributes:
        topic: the topic.
        samples: some clouds, evenly spread, that could be read.
        error: why none could.
    """

    topic: BagTopic
    samples: Sequence[PointCloud2]
    error: DriveError | None = None

    @property
    def points(self) -> float:
        """Return the mean number of points."""
        return float(np.mean([cloud.count for cloud in self.samples])) if self.samples else 0.0

    @property
    def frame(self) -> str:
        """Return the frame of the clouds."""
        return self.samples[0].frame if self.samples else ""

    @property
    def of_camera(self) -> bool:
        """Return whether a depth camera made the clouds: they may have more points."""
        return self.frame.lower().endswith(("optical_frame", "optical"))

    @property
    def in_world(self) -> bool:
        """Return whether the clouds lie in a frame that stands still, as registered ones do."""
        return self.frame.rpartition("/")[2].lower() in WORLD_FRAMES

    def __str__(self) -> str:
        frame = f", frame {self.frame!r}" if self.frame else ""
        return (
            f"{self.topic.name!r} ({self.topic.type}, {len(self.topic)} messages, "
            f"{self.points:,.0f} points each{frame})"
        )


def spread(count: int) -> list[int]:
    """Return some of `count` indices, evenly spread."""
    indices: list[int] = np.unique(np.linspace(0, count - 1, SAMPLES).astype(int)).tolist()
    return indices


def sampled(bag: Bag, topic: BagTopic) -> CloudTopic:
    """Read some clouds of a topic."""
    clouds = []
    failure = None
    for index in spread(len(topic)):
        where = bag.where(topic, index)
        try:
            cloud = read_cloud(bag.read(topic, index), topic.type, topic.encoding, where)
            axes_of(cloud, where)
            cloud.rows(where)
            clouds.append(cloud)
        except DriveError as error:
            failure = failure or error
    return CloudTopic(topic, clouds, None if clouds else failure)


def choose_topic(bag: Bag, wanted: str | None) -> tuple[CloudTopic, list[CloudTopic]]:
    """Choose the topic with the clouds, and return it with all others that have clouds.

    Without a wish: a topic in the frame of a sensor rather than of the world, of a LiDAR rather
    than of a camera, then the one with the most points a cloud.

    Raises:
        DriveError: there is no such topic, or none with clouds.
    """
    topics = [topic for topic in bag.topics if is_cloud(topic.type) and len(topic)]
    if wanted:
        topic = bag.topic(wanted)
        if topic is None or topic not in topics:
            found = (
                f"has no topic {wanted!r}"
                if topic is None
                else f"has {len(topic)} messages of type {topic.type} on the topic {wanted!r}"
            )
            raise DriveError(
                f"{bag.path}: {found}. Topics with clouds: "
                f"{', '.join(each.name for each in topics) or 'none'}. State one with --topic"
            )
        chosen = sampled(bag, topic)
        return chosen, [CloudTopic(each, ()) for each in topics if each is not topic]
    if not topics:
        raise no_clouds(bag)
    found_topics = [sampled(bag, topic) for topic in topics]
    found_topics.sort(
        key=lambda each: (not each.samples, each.in_world, each.of_camera, -each.points)
    )
    if not found_topics[0].samples:
        raise found_topics[0].error or no_clouds(bag)
    return found_topics[0], found_topics[1:]


def no_clouds(bag: Bag) -> DriveError:
    """Return the error for a bag without clouds, with the way to get some."""
    topics = [topic for topic in bag.topics if len(topic)]
    packets = [
        topic
        for topic in topics
        if PACKETS.search(topic.type + topic.name) and PACKET_TYPES.search(topic.type)
    ]
    listed = ", ".join(f"{topic.name} ({topic.type})" for topic in topics[:12]) or "none"
    if packets:
        topic = max(packets, key=lambda each: ("imu" not in each.name.lower(), len(each)))
        maker = next((name for name in DRIVERS if name in (topic.type + topic.name).lower()), "")
        driver = DRIVERS.get(maker, "the sensor's driver")
        return DriveError(
            f"{bag.path}: the topic {topic.name!r} has raw packets of the sensor ({topic.type}), "
            f"and no topic has clouds. Expected sensor_msgs/PointCloud2 or Livox CustomMsg. Play "
            f"the bag through {driver}, record the topic with the clouds, and use that bag"
        )
    flat = [topic.name for topic in topics if topic.type == "sensor_msgs/LaserScan"]
    more = f" {flat[0]!r} is a 2D scan, which has no segments in 3D." if flat else ""
    return DriveError(
        f"{bag.path}: no topic has clouds.{more} Expected sensor_msgs/PointCloud2, Livox CustomMsg "
        f"or foxglove.PointCloud. Topics: {listed}. Record the sensor's clouds as well."
        + "".join(f" {remark}." for remark in bag.remarks[:3])
    )


def integers(cloud: PointCloud2) -> bool:
    """Return whether the coordinates are integers."""
    return all(field.type in ("i2", "u2", "i4", "u4") for field in axes_of(cloud, ""))


def stamp_of(head: bytes | memoryview | None, topic: BagTopic) -> int:
    """Return the stamp at the begin of a serialized message, nanoseconds; 0 if there is none."""
    if head is None:
        return 0
    starts_with_time = topic.type.startswith("foxglove")
    if topic.encoding == "ros1":
        at, order = (0 if starts_with_time else 4), "<"
    else:
        at, order = 4, CDR_ORDERS.get(bytes(head[:2]), "")
    if not order or len(head) < at + 8:
        return 0
    seconds, nanoseconds = np.frombuffer(head[at : at + 8], order + "u4").tolist()
    return seconds * 10**9 + nanoseconds if nanoseconds < 10**9 else 0


class BagSource(ScanSource):
    """Scans of a bag. Opening reads the index and the stamps; `scan` reads one message.

    The topic is `ScanOptions.topic`, or the one that `choose_topic` finds. Scans are ordered by the
    stamps of their headers.

    Attributes:
        bag: the bag.
        cloud_topic: topic with the clouds.
        stamps_ns: time of each scan, int64 (scans,), nanoseconds, ascending.

    Raises:
        DriveError: the bag cannot be read or has no clouds.
    """

    bag: Bag
    stamps_ns: Int64

    def __init__(self, path: Path) -> None:
        options = current_scan_options()
        self.path = path
        self.bag = Bag(path)
        self.scale = METERS[options.unit]
        self.odometry_topic = options.odometry_topic
        chosen, others = choose_topic(self.bag, options.topic)
        self.cloud_topic = chosen.topic
        self.frame = chosen.frame
        if not chosen.samples:
            raise chosen.error or no_clouds(self.bag)
        first = chosen.samples[0]
        self.fields = [field.name for field in first.fields]
        self.time_fields = time_fields(first.fields)
        self.remarks = list(self.bag.remarks)
        if others:
            self.remarks.append(
                f"Clouds are read from the topic {chosen}. Others: "
                f"{', '.join(str(each) for each in others)}. State another with --topic"
            )
        if chosen.in_world:
            self.remarks.append(
                f"The clouds of {chosen} lie in a frame that stands still; expected the sensor's "
                "frame. Choose the sensor's own topic with --topic, if the bag has it"
            )
        if integers(first) and options.unit == "m":
            self.remarks.append(
                f"The clouds of {chosen.topic.name!r} have integers for x, y, z; they are read as "
                "meters. State another unit with --unit"
            )
        self.find_stamps()

    def find_stamps(self) -> None:
        """Read the stamps of all headers, and order the scans by them."""
        topic = self.cloud_topic
        stamps = np.array(list(self.header_stamps()), np.int64)
        unset = stamps == 0
        if len(stamps) > 1 and not unset.all() and (stamps == stamps[0]).all():
            unset[:] = True
        if unset.any():
            self.remarks.append(
                f"{int(unset.sum())} of {len(stamps)} clouds of {topic.name!r} have no time in "
                "their header, or all the same; the time of recording is used for them"
            )
        stamps = np.where(unset, topic.times, stamps)
        self.order = np.argsort(stamps, kind="stable")
        self.stamps_ns = stamps[self.order]
        self.stamps = self.stamps_ns.astype(np.float64) * 1e-9

    def header_stamps(self) -> Iterator[int]:
        """Yield the stamp of each message; 0 for one that has none or is damaged."""
        topic = self.cloud_topic
        if topic.encoding in ("ros1", "cdr"):
            for head in self.bag.contents(topic, HEAD):
                yield stamp_of(head, topic)
            return
        for index in range(len(topic)):
            try:
                yield self.message(index).stamp_ns
            except DriveError:
                yield 0

    def message(self, index: int) -> PointCloud2:
        """Read a cloud, by its number in the topic."""
        topic = self.cloud_topic
        data = self.bag.read(topic, index)
        return read_cloud(data, topic.type, topic.encoding, self.bag.where(topic, index))

    @cached_property
    def clock(self) -> tuple[TimeField, PointClock] | None:
        """Field with the points' times, and their clock; None if there are none."""
        steps = np.diff(self.stamps)
        period = float(np.median(steps[steps > 0])) if (steps > 0).any() else None
        where = f"{self.path}: topic {self.cloud_topic.name!r}"
        clouds = []
        for index in spread(len(self)):
            with suppress(DriveError):  # The scan raises it again.
                cloud = self.cloud(index)
                coordinates(cloud, where)
                clouds.append(cloud)
        return cloud_clock(clouds, where, period)

    def scan(self, index: int) -> LidarScan:
        where = self.bag.where(self.cloud_topic, int(self.order[index]))
        return decode(self.cloud(index), where, self.clock, self.scale)

    def cloud(self, index: int) -> PointCloud2:
        """Read the message of a scan, with the scan's stamp."""
        message = self.message(int(self.order[index]))
        return replace(message, stamp_ns=int(self.stamps_ns[index]))

    def scan_hash(self, index: int) -> str:
        """Return the identity of a scan's points; it is the same in another container."""
        return sha256(self.scan(index).points.data).hexdigest()[:16]

    @cached_property
    def poses(self) -> BagPoses:
        """Poses in the bag, and the pose of the sensor on the robot.

        Raises:
            DriveError: the topic that was stated has no poses, or the transforms form a loop.
        """
        return read_poses(self.bag, self.frame, self.odometry_topic, self.clocks)

    @property
    def clocks(self) -> tuple[Float64, Float64]:
        """Stamps and times of recording of the scans, float64 (scans,), seconds."""
        return self.stamps, self.cloud_topic.times[self.order].astype(np.float64) * 1e-9

    def imu(self, first: float, last: float) -> ImuSamples | None:
        return read_imu(self.bag, self.frame, self.clocks, (first, last))

    def trajectory(self) -> Trajectory | None:
        """Return the sensor's poses; those of the robot if the bag has no transform to the sensor.

        `ScanOptions.odometry` states the topic. `poses.body` has the robot's poses, and `extrinsic`
        the sensor's pose on the robot.
        """
        return self.poses.sensor

    def extrinsic(self) -> Extrinsic:
        """Return the pose of the sensor on the robot, and how it was found."""
        return self.poses.extrinsic

    def topics(self) -> Sequence[BagTopic]:
        """Return all topics of the bag: name, type, number and rate of messages."""
        return self.bag.topics

    def notes(self) -> Sequence[str]:
        posed = self.poses.remarks if "poses" in self.__dict__ else ()
        return [*self.remarks, *self.time_notes(), *posed]

    def time_notes(self) -> Iterator[str]:
        """Yield a remark about the points' times."""
        if self.time_fields and self.clock is None:
            yield (
                f"The times of points ({', '.join(map(str, self.time_fields))}) are all equal, or "
                "no unit makes them a sweep; scans are not deskewed"
            )
        elif self.clock and self.clock[1].origin == "first":
            yield f"The times of points ({self.clock[0]}) are {self.clock[1]}"


def opens_as(path: Path, kind: type[Container]) -> bool:
    """Return whether a file, or the files of a folder, are of a kind."""
    return any(kind_of(file) is kind for file in bag_files(path)[:1])


def describes_bag(metadata: Path) -> bool:
    """Return whether a file is the `metadata.yaml` of a ROS 2 bag."""
    try:
        return "rosbag2_bagfile_information" in metadata.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False


class Ros1Bag(BagSource):
    """A ROS 1 bag, or a folder with the parts of one."""

    format: ClassVar[str] = "ROS 1 bag"

    @classmethod
    def recognizes(cls, path: Path) -> bool:
        return opens_as(path, ros1_file.Ros1File)


class Ros2Bag(BagSource):
    """A ROS 2 bag: a folder with `metadata.yaml`, or SQLite files without it."""

    format: ClassVar[str] = "ROS 2 bag"

    @classmethod
    def recognizes(cls, path: Path) -> bool:
        if opens_as(path, sqlite_file.SqliteFile):
            return True
        if opens_as(path, mcap_file.McapFile):
            return (path / METADATA).is_file()
        return not bag_files(path) and describes_bag(path / METADATA)


class Mcap(BagSource):
    """An MCAP file, or a folder with the parts of one."""

    format: ClassVar[str] = "MCAP"

    @classmethod
    def recognizes(cls, path: Path) -> bool:
        if (path / METADATA).is_file():
            return False
        return opens_as(path, mcap_file.McapFile)
