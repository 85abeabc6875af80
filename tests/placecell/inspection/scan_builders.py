"""A yard made by hand, and sources of scans of it."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float32, Float64
from tests.placecell.sources.bags.bag_builders import (
    PERIOD_NS,
    START_NS,
    Message,
    cloud_message,
    cloud_of,
    odometry_message,
    transforms_message,
    xyz,
)


def yard(height: float = 1.5, shift: float = 0.0, seed: int = 0) -> Float32:
    """Return points of a level yard with boxes, in a sensor's frame with z up.

    Args:
        height: height of the sensor, meters.
        shift: distance that the sensor has moved along x, meters.
        seed: seed of the noise.
    """
    across, along = np.meshgrid(np.arange(-14, 14, 0.25), np.arange(-14, 14, 0.25))
    ground = np.column_stack([across.ravel(), along.ravel(), np.zeros(across.size)])
    ground = ground[np.hypot(ground[:, 0], ground[:, 1]) > 2.5]
    wall_y, wall_z = np.meshgrid(np.arange(0, 2, 0.1), np.arange(0, 2, 0.1))
    face = np.column_stack([np.zeros(wall_y.size), wall_y.ravel(), wall_z.ravel()])
    boxes = [face + [x, y, 0] for x, y in ((6, 2), (-7, -4), (3, -9), (-5, 8), (9, -3))]
    points = np.concatenate([ground, *boxes]) - [shift, 0, height]
    noise = np.random.default_rng(seed).normal(0, 0.01, points.shape)
    return np.asarray(points + noise, np.float32)


def yards(count: int = 4) -> list[Float32]:
    """Return scans of a sensor that moves 1 m a scan."""
    return [yard(shift=float(index), seed=index) for index in range(count)]


def way(count: int, step: float = 1.0) -> Float64:
    """Return poses along x."""
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, 0, 3] = step * np.arange(count)
    return poses


def write_clouds(folder: Path, clouds: Sequence[NDArray[np.generic]]) -> Path:
    """Write a folder of NumPy files, one a scan."""
    folder.mkdir(parents=True)
    for index, cloud in enumerate(clouds):
        np.save(folder / f"{index:06d}.npy", cloud)
    return folder


def cloud_messages(
    clouds: Sequence[Float32],
    times_ns: Sequence[int] | None = None,
    topic: str = "/points",
    frame: str = "lidar",
) -> list[Message]:
    """Return the messages of clouds, 10 a second."""
    stamps = times_ns or [START_NS + PERIOD_NS * index for index in range(len(clouds))]
    return [
        (
            topic,
            START_NS + PERIOD_NS * index,
            cloud_message(cloud_of(xyz(cloud), stamp_ns=stamp, frame=frame), "ros1"),
        )
        for index, (cloud, stamp) in enumerate(zip(clouds, stamps, strict=True))
    ]


def odometry_messages(poses: Float64) -> list[Message]:
    """Return the messages of poses of base_link, 10 a second."""
    return [
        (
            "/odom",
            START_NS + PERIOD_NS * index,
            odometry_message(pose, START_NS + PERIOD_NS * index, "ros1"),
        )
        for index, pose in enumerate(poses)
    ]


def mount_message(pose: Float64) -> Message:
    """Return the static transform of the sensor on the robot."""
    edges = [("base_link", "lidar", pose)]
    return ("/tf_static", START_NS, transforms_message(edges, START_NS, "ros1"))
