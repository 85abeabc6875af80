"""VIEWPOINT of PCD files: where the sensor stood.

PCL calls it the sensor's origin and orientation. Its viewer and `pcl_transform_from_viewpoint` move
the points by it: they are in the sensor's frame, and VIEWPOINT is the sensor's pose in the world.
Other programs write points that are in the world's frame already, with the place of the sensor
among them; PCL's estimation of normals takes them so. A LiDAR has its densest points near itself,
which tells the two apart where the sensor is not at the origin.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from placecell.core.types import Bool, Float32, Float64
from placecell.sources.clouds.cloud import HEAD
from placecell.sources.clouds.pcd import IDENTITY, parse_header
from placecell.sources.errors import DriveError
from placecell.trajectories.poses import of_quaternions

NEAR_ORIGIN = 2.0
"""Distance of a sensor from the origin up to which the points do not tell their frame, meters."""


def read_viewpoints(files: Sequence[Path], scale: float) -> Float64:
    """Return the pose of the sensor at each PCD file, float64 (files, 4, 4), meters.

    A file without a valid VIEWPOINT has the identity.

    Args:
        files: the files; only their headers are read.
        scale: meters a unit of the coordinates.
    """
    values = np.array([viewpoint_of(file) for file in files])
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.linalg.norm(values[:, 3:], axis=1)
    valid = np.isfinite(values).all(axis=1) & (np.abs(lengths - 1) < 0.05)
    values[~valid] = IDENTITY
    return of_quaternions(values[:, :3] * scale, values[:, [4, 5, 6, 3]])


def viewpoint_of(file: Path) -> tuple[float, ...]:
    """Return position and quaternion w, x, y, z of a file's VIEWPOINT."""
    try:
        with file.open("rb") as stream:
            return parse_header(stream.read(HEAD + 1), file).viewpoint
    except (DriveError, OSError):  # The scan raises it again.
        return IDENTITY


def stated(poses: Float64) -> Bool:
    """Return whether each pose is not the identity, bool (n,)."""
    return np.asarray(np.abs(poses - np.eye(4)).max(axis=(1, 2)) > 1e-9)


def in_world(poses: Float64, clouds: Sequence[Float32]) -> bool:
    """Return whether points are in the world's frame already.

    Args:
        poses: pose of the sensor at each cloud, float64 (n, 4, 4).
        clouds: points of each, float32 (points, 3), as in the file, meters.
    """
    votes = 0
    for pose, points in zip(poses, clouds, strict=True):
        place = pose[:3, 3]
        if len(points) and np.linalg.norm(place) > NEAR_ORIGIN:
            near_sensor = np.median(np.linalg.norm(points - place, axis=1))
            near_origin = np.median(np.linalg.norm(points.astype(np.float64), axis=1))
            votes += 1 if near_sensor < near_origin else -1
    return votes > 0


def to_sensor(points: Float32, pose: Float64, shift: Float64) -> Float32:
    """Move points from the world's frame to the sensor's.

    Args:
        points: float32 (n, 3), meters, less `shift`.
        pose: pose of the sensor, float64 (4, 4).
        shift: float64 (3,), meters.
    """
    return ((points - (pose[:3, 3] - shift)) @ pose[:3, :3]).astype(np.float32)
