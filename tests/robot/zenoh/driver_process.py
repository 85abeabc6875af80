"""Process that publishes a drive over Zenoh, as the drivers of a robot do: clouds and odometry.

Usage: python -m tests.robot.zenoh.driver_process ENDPOINT DRIVE

It drives to and fro until its input ends. The odometry frame is shifted against the drive's.
"""

import sys
import threading
import time
from itertools import chain, cycle
from pathlib import Path

import numpy as np

from placecell.datasets import open_drive
from placecell.sources.bags.pointcloud2 import PointCloud2
from robot.node.messages import StampedTransform
from robot.zenoh import cdr
from robot.zenoh.address import ZenohAddress
from robot.zenoh.bus import ZenohBus
from robot.zenoh.node import LATCHED, SENSOR, topic
from tests.robot.node.node_fakes import FIELDS, moved

PERIOD = 0.2
"""Time between two scans, seconds."""
START = 1_700_000_000.0
SHIFT = np.eye(4)
"""Pose of the drive's frame in the odometry frame."""
SHIFT[:3] = [[0.0, -1.0, 0.0, 12.0], [1.0, 0.0, 0.0, -7.0], [0.0, 0.0, 1.0, 0.0]]
MOUNT = moved(0.5, 0.0, 1.0)
"""Pose of the LiDAR on the robot's base."""


def main(endpoint: str, folder: str) -> None:
    """Publish until the input ends."""
    ended = threading.Event()

    def wait_for_the_end() -> None:
        sys.stdin.read()
        ended.set()

    threading.Thread(target=wait_for_the_end, daemon=True).start()
    drive = open_drive(Path(folder))
    address = ZenohAddress(connect=(endpoint,))
    with ZenohBus("driver", 0, connect=[endpoint]) as bus:
        clouds = bus.publisher(topic(address, address.points, cdr.CLOUD, SENSOR))
        odometries = bus.publisher(topic(address, address.odom, cdr.ODOMETRY, SENSOR))
        statics = bus.publisher(topic(address, address.tf_static, cdr.TRANSFORMS, LATCHED))
        mount = StampedTransform(0, "base_link", "lidar", MOUNT)
        statics.put(cdr.write_transforms([mount]))
        there = range(len(drive))
        begun = time.monotonic()
        for number, index in enumerate(cycle(chain(there, reversed(there)))):
            stamp_ns = round((START + number * PERIOD) * 1e9)
            pose = SHIFT @ drive.poses[index] @ np.linalg.inv(MOUNT)
            odometry = StampedTransform(stamp_ns, "odom", "base_link", pose)
            points = np.ascontiguousarray(drive.scan(index), np.float32)
            size = 12 * len(points)
            cloud = PointCloud2(
                FIELDS, False, 12, size, len(points), 1, points.tobytes(), stamp_ns, "lidar"
            )
            clouds.put(cdr.write_cloud(cloud))
            odometries.put(cdr.write_odometry(odometry))
            if ended.wait(max(0.0, begun + number * PERIOD - time.monotonic())):
                return


if __name__ == "__main__":
    main(*sys.argv[1:])
