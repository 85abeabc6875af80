"""Poses of a source's scans: from a file, from the source's own topics, or by odometry."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.odometry.source_odometry import odometry_of
from placecell.sources.bags import Bag, BagSource, Mcap, Ros1Bag, Ros2Bag
from placecell.sources.bags import read_poses as read_bag_poses
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import KISS_ICP, NO_ODOMETRY, RKO_LIO, ScanOptions
from placecell.sources.source import ScanSource
from placecell.trajectories.extrinsic import describe_extrinsic, parse_extrinsic
from placecell.trajectories.reading import read_trajectory
from placecell.trajectories.scan_poses import ScanPoses, poses_of_scans
from placecell.trajectories.trajectory import Trajectory

UPRIGHT = 0.5
"""Smallest absolute z of the sensor's z axis in the frame of the poses, unless it is a camera's."""
STILL = 1e-9
"""Largest change of poses that never move, meters."""

BAGS = (Ros1Bag, Ros2Bag, Mcap)

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


@dataclass(frozen=True, slots=True)
class FoundPoses:
    """Poses before they are matched to the scans.

    Attributes:
        name: origin of the poses, for messages.
        trajectory: the poses.
        mount: transform from the sensor's frame to the frame of the poses, (4, 4).
        how: how the mount was found.
    """

    name: str
    trajectory: Trajectory
    mount: Float64
    how: str


def find_poses(source: ScanSource, options: ScanOptions) -> SourcePoses:
    """Find the poses of a source's scans, and tell what was used.

    Raises:
        DriveError: there are none, or they do not fit the scans.
    """
    given = given_poses(source, options)
    if given is None:
        return by_odometry(source, options)
    for remark in given.trajectory.remarks:
        options.tell(prefixed(given.name, remark))
    options.tell(f"{given.name}: {given.how}")
    found = poses_of_scans(given.trajectory, source.stamps, given.name, options.pose_offset)
    for remark in found.remarks:
        options.tell(remark)
    origin = "" if given.name == str(source.path) else f", from {given.name}"
    options.tell(f"{source.path}: {len(found.scans)} of {len(source)} scans have a pose{origin}")
    return on_sensor(found, given.mount, given.name)


def prefixed(name: str, text: str) -> str:
    """Return a remark that begins with the name of its origin."""
    return text if text.startswith(name) else f"{name}: {text}"


def given_poses(source: ScanSource, options: ScanOptions) -> FoundPoses | None:
    """Return the poses that are stated or that the source has, with the sensor's mount.

    None if odometry is wanted or needed.

    Raises:
        DriveError: the file cannot be read, the stated topic has no poses, or the mount is wrong.
    """
    if options.poses is not None:
        return with_mount(source, read_poses(options.poses), str(options.poses), options)
    if options.odometry in (KISS_ICP, RKO_LIO) or (
        options.odometry == NO_ODOMETRY and isinstance(source, BagSource)
    ):
        return None
    stated = options.odometry_topic
    name = f"{source.path}, topic {stated}" if stated else f"{source.path}"
    if isinstance(source, BagSource):
        for remark in source.poses.remarks:
            options.tell(prefixed(str(source.path), remark))
        # A stated mount is that on the robot; else the bag's transforms tell it.
        if options.extrinsic is None and source.poses.sensor is not None:
            how = f"mount of the sensor by {source.poses.extrinsic.how}"
            return FoundPoses(name, source.poses.sensor, np.eye(4), how)
        trajectory = source.poses.body
    else:
        trajectory = source.trajectory()
    if trajectory is None and stated:
        raise DriveError(
            f"{source.path}: has no poses on {stated}; {source.format} has none. {GIVE_POSES}"
        )
    if trajectory is not None and not stated and len(source) > 1 and is_still(trajectory):
        options.tell(
            f"{source.path}: its own poses never change, so they are not used. State the topic "
            "with --odometry to use them"
        )
        return None
    return None if trajectory is None else with_mount(source, trajectory, name, options)


def with_mount(
    source: ScanSource, trajectory: Trajectory, name: str, options: ScanOptions
) -> FoundPoses:
    """Return poses with the mount that is stated; else the poses are taken as the sensor's.

    Raises:
        DriveError: the stated mount cannot be read.
    """
    mount = np.eye(4)
    if options.extrinsic is not None:
        mount = parse_extrinsic(options.extrinsic)
        how = f"the sensor is mounted at {describe_extrinsic(mount)}, as stated"
    elif trajectory.frame and trajectory.frame == source.frame:
        how = f"the poses are those of the sensor's frame {source.frame!r}"
    elif trajectory.frame:
        how = (
            f"the mount of {source.frame or 'the sensor'} on {trajectory.frame} is not known; the "
            "poses are taken as the sensor's. State it with --extrinsic"
        )
    else:
        how = (
            "the poses are taken as the sensor's. State its mount with --extrinsic if they are "
            "another frame's"
        )
    return FoundPoses(name, trajectory, mount, how)


def read_poses(file: Path) -> Trajectory:
    """Read a trajectory file; a bag gives the poses on its topics.

    Raises:
        DriveError: the file cannot be read, or the bag has no poses.
    """
    if any(kind.recognizes(file) for kind in BAGS):
        body = read_bag_poses(Bag(file)).body
        if body is None:
            raise DriveError(f"{file}: has no poses that move. {GIVE_POSES}")
        return body
    return read_trajectory(file)


def is_still(trajectory: Trajectory) -> bool:
    """Return whether all poses are the same."""
    return bool(np.ptp(trajectory.poses, axis=0).max() < STILL)


def on_sensor(found: ScanPoses, mount: Float64, name: str) -> SourcePoses:
    """Move poses from their frame to the sensor on it.

    Poses of a camera have a world whose z is not up: the sensor's own frame replaces it.
    """
    poses, track = found.poses, found.track
    if abs(mount[2, 2]) < UPRIGHT:
        to_sensor = np.linalg.inv(mount)
        poses = to_sensor @ poses
        track = track and replace(track, poses=to_sensor @ track.poses, covariances=None)
    track = track and track.mounted(mount)
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
        raise DriveError(
            f"{source.path}: has no poses to use: --odometry none uses neither those in a bag nor "
            "kiss-icp. Give poses with --poses FILE (KITTI, TUM, EuRoC, CSV or g2o), or omit "
            "--odometry"
        )
    method = RKO_LIO if options.odometry == RKO_LIO else KISS_ICP
    found = odometry_of(source, options.deskew, options.progress, options.tell, method)
    stamps = source.stamps if np.isfinite(source.stamps).all() else None
    scans = np.arange(len(source))
    return SourcePoses(method, scans, found.poses, stamps, Trajectory(found.poses, stamps))
