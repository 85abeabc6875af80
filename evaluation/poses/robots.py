"""Two robots for the demo and the evaluations: from a town, or from one drive."""

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from pathlib import Path

import numpy as np

from evaluation.poses.robot import Robot
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segments import Segments
from placecell.datasets import open_drive
from placecell.localization import Pose
from placecell.segmentation.drive_splits import alternate_blocks, parameters_of
from placecell.segmentation.pipeline import Progress, record
from placecell.segmentation.recording import Recording


def robots_of_town(folder: Path, seed: int, scans: int, progress: Progress) -> tuple[Robot, Robot]:
    """Return two robots that drive the same streets of a synthetic town in opposite directions."""
    from town import read_origin, two_robots

    robots = []
    paths = two_robots(folder, seed=seed, scans=scans, overwrite=True, progress=progress)
    for name, path in zip(("robot A", "robot B"), paths, strict=True):
        drive = open_drive(path)
        recording = record(drive, PROTOCOL_V1, progress=progress)
        robots.append(Robot(name, drive, [recording], read_origin(path)))
    return robots[0], robots[1]


def robots_of_drive(
    folder: Path,
    progress: Progress,
    every: int | None = None,
    protocol: Parameters = PROTOCOL_V1,
) -> tuple[Robot, Robot]:
    """Split one drive into two robots: odd blocks make the map, even blocks the queries.

    Args:
        folder: folder of the drive.
        progress: wraps the loops.
        every: scans from one capture to the next, as `Parameters.for_drive`.
        protocol: parameters of the segmentation.

    Raises:
        ValueError: the drive is too short for a second block.
    """
    drive = open_drive(folder)
    odd, even = alternate_blocks(drive)
    if not even:
        raise ValueError(
            f"{folder}: the drive is too short for a second block. Use a longer drive."
        )
    parameters = parameters_of(odd + even, protocol.for_drive(len(drive), every))

    def robot(name: str, blocks: Sequence[range]) -> Robot:
        recordings = [record(drive, parameters, block, progress) for block in blocks]
        return Robot(name, drive, recordings, np.eye(4))

    return robot("robot A", odd), robot("robot B", even)


def in_own_frame(robot: Robot, frame: Pose) -> Robot:
    """Return the robot with its drive and segments moved into another frame.

    The service then knows nothing about the transform between the frames of the robots.

    Args:
        robot: the robot.
        frame: transform from the robot's frame into the other frame.
    """
    drive = copy(robot.drive)
    drive.poses = frame.matrix @ robot.drive.poses
    return replace(
        robot,
        drive=drive,
        recordings=[_moved(recording, frame) for recording in robot.recordings],
        to_common=robot.to_common @ frame.inverse().matrix,
    )


def _moved(recording: Recording, frame: Pose) -> Recording:
    segments = recording.segments
    points, sensors = (
        frame.apply(each.astype(np.float64)).astype(np.float32)
        for each in (segments.points, segments.sensors)
    )
    return replace(recording, segments=Segments(points, segments.ends, sensors))
