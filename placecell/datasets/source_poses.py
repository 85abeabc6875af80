"""Poses of a source's scans: from a file, from the source's own topics, or by odometry."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.odometry.source_odometry import odometry_of
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import KISS_ICP, NO_ODOMETRY, ScanOptions
from placecell.sources.source import ScanSource
from placecell.trajectories.extrinsic import describe_extrinsic, parse_extrinsic
from placecell.trajectories.reading import read_trajectory
from placecell.trajectories.scan_poses import ScanPoses, poses_of_scans
from placecell.trajectories.trajectory import Trajectory

UPRIGHT = 0.5
"""Smallest absolute z of the sensor's z axis in the frame of the poses, unless it is a camera's."""
STILL = 1e-9
"""Largest change of poses that never move, meters."""

GIVE_POSES = (
    "Give poses with --poses FILE (KITTI, TUM, EuRoC, CSV or g2o), or with --odometry TOPIC for a "
    "bag, or compute them with --odometry kiss-icp"
)


@dataclass(frozen=True, slots=True)
class SourcePoses:
    """Poses of the sensor at the scans that have one.

    Attributes:
        name: origin of the poses, for messages.
        scans: index of each scan with a pose, int64 (k,).
        poses: sensor to world, float64 (k, 4, 4).
        stamps: time of each scan, seconds, or None.
        track: all poses of the sensor that are known, or None.
    """

    name: str
    scans: Int64
    poses: Float64
    stamps: Float64 | None
    track: Trajectory | None


def find_poses(source: ScanSource, options: ScanOptions) -> SourcePoses:
    """Find the poses of a source's scans, and tell what was used.

    Raises:
        DriveError: there are none, or they do not fit the scans.
    """
    trajectory, name = own_trajectory(source, options)
    if trajectory is None:
        return by_odometry(source, options)
    for remark in trajectory.remarks:
        options.tell(f"{name}: {remark}")
    mount = mount_of(source, trajectory, name, options)
    found = poses_of_scans(trajectory, source.stamps, name, options.pose_offset)
    for remark in found.remarks:
        options.tell(remark)
    options.tell(
        f"{source.path}: {len(found.scans)} of {len(source)} scans have a pose, from {name}"
    )
    return on_sensor(found, mount, name)


def own_trajectory(source: ScanSource, options: ScanOptions) -> tuple[Trajectory | None, str]:
    """Return the poses that are given or that the source has, and their origin.

    Raises:
        DriveError: the file cannot be read, or the stated topic has no poses.
    """
    if options.poses is not None:
        return read_poses(options.poses), str(options.poses)
    if options.odometry == KISS_ICP:
        return None, ""
    trajectory = source.trajectory()
    stated = options.odometry_topic
    name = f"the topic {stated}" if stated else "the source's own poses"
    if trajectory is None and stated:
        raise DriveError(
            f"{source.path}: has no poses on {stated}; {source.format} has none. {GIVE_POSES}"
        )
    if trajectory is not None and not stated and len(source) > 1 and is_still(trajectory):
        options.tell(
            f"{source.path}: its own poses never change, so they are not used. State the topic "
            "with --odometry to use them"
        )
        return None, ""
    if trajectory is not None and trajectory.frame:
        name += f" ({trajectory.frame} in {trajectory.world or 'its own world'})"
    return trajectory, name


def read_poses(file: Path) -> Trajectory:
    """Read a trajectory file; a bag gives the poses on its topics.

    Raises:
        DriveError: the file cannot be read, or the bag has no poses.
    """
    if not file.exists() or not is_binary(file):
        return read_trajectory(file)
    from placecell.sources.catalog import is_source, open_source

    if is_source(file):
        trajectory = open_source(file).trajectory()
        if trajectory is None:
            raise DriveError(f"{file}: has no poses. {GIVE_POSES}")
        return trajectory
    return read_trajectory(file)


def is_binary(file: Path) -> bool:
    """Return whether a path is a folder, or a file that is no text."""
    if file.is_dir():
        return True
    with file.open("rb") as opened:
        return b"\0" in opened.read(4096)


def is_still(trajectory: Trajectory) -> bool:
    """Return whether all poses are the same."""
    return bool(np.ptp(trajectory.poses, axis=0).max() < STILL)


def mount_of(
    source: ScanSource, trajectory: Trajectory, name: str, options: ScanOptions
) -> Float64:
    """Return the transform from the sensor to the frame of the poses, and tell its origin.

    Raises:
        DriveError: the stated one cannot be read.
    """
    if options.extrinsic is not None:
        mount = parse_extrinsic(options.extrinsic)
        options.tell(f"{name}: the sensor is mounted at {describe_extrinsic(mount)}, as stated")
        return mount
    if trajectory.frame and trajectory.frame == source.frame:
        options.tell(f"{name}: the poses are those of the sensor's frame {source.frame!r}")
    elif trajectory.frame:
        options.tell(
            f"{name}: the mount of {source.frame or 'the sensor'} on {trajectory.frame} is not "
            "known; the poses are taken as the sensor's. State it with --extrinsic"
        )
    else:
        options.tell(
            f"{name}: the poses are taken as the sensor's. State its mount with --extrinsic if "
            "they are another frame's"
        )
    return np.eye(4)


def on_sensor(found: ScanPoses, mount: Float64, name: str) -> SourcePoses:
    """Move poses from their frame to the sensor on it.

    Poses of a camera have a world whose z is not up: the sensor's own frame replaces it.
    """
    poses, track = found.poses, found.track
    if abs(mount[2, 2]) < UPRIGHT:
        to_sensor = np.linalg.inv(mount)
        poses = to_sensor @ poses
        track = track and replace(track, poses=to_sensor @ track.poses)
    track = track and replace(track, poses=track.poses @ mount)
    return SourcePoses(name, found.scans, poses @ mount, found.stamps, track)


def by_odometry(source: ScanSource, options: ScanOptions) -> SourcePoses:
    """Compute the poses from the scans themselves.

    Raises:
        DriveError: odometry is not wanted, or not possible.
    """
    if len(source) == 1:
        options.tell(f"{source.path}: one scan; its pose is the origin")
        return SourcePoses("one scan", np.zeros(1, np.int64), np.eye(4)[None], source.stamps, None)
    if options.odometry == NO_ODOMETRY:
        raise DriveError(f"{source.path}: has no poses, and --odometry none. {GIVE_POSES}")
    found = odometry_of(source, options.deskew, options.progress, options.tell)
    stamps = source.stamps if np.isfinite(source.stamps).all() else None
    scans = np.arange(len(source))
    return SourcePoses(KISS_ICP, scans, found.poses, stamps, Trajectory(found.poses, stamps))
