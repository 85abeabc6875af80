"""Two robots meet: the one is told its pose in the other's map, and both maps become one."""

import time
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from placecell_client import Client, ServiceError, encode

from evaluation.poses.report import RIGHT
from evaluation.poses.robot import Robot, clouds
from placecell.core.segments import Segments
from placecell.core.types import Float64
from placecell.localization import Pose
from placecell.segmentation.recording import Recording

SITE = "site"
"""Name of the map of both."""


@dataclass(frozen=True, slots=True)
class PoseAnswer:
    """What the service told of one frame.

    Attributes:
        sensor: float64 (3,), where the robot truly was, metres, in the map's frame.
        place: float64 (3,), where it is by the pose; None: not localised.
        metres, degrees: that the pose is off; infinite without one.
        milliseconds: of the request.
    """

    sensor: Float64
    place: Float64 | None
    meters: float
    degrees: float
    milliseconds: float

    @property
    def is_right(self) -> bool:
        """Whether the pose is as near to the truth as a right one must be."""
        return self.meters <= RIGHT[0] and self.degrees <= RIGHT[1]


@dataclass(frozen=True, slots=True)
class Meeting:
    """What came of it.

    Attributes:
        told: of each frame.
        laid: from the asking robot's frame to the map's, as the merge found it; None: it did not.
        off: metres and degrees between that and the truth, where the robot drove.
        segments: of the site; 0 if there is none.
        repeats: of the asking robot's segments, that the map's already showed.
        refusal: why the maps were not merged, in the service's words; empty if they were.
    """

    told: Sequence[PoseAnswer]
    laid: Pose | None
    off: tuple[float, float]
    segments: int
    repeats: int
    refusal: str = ""

    @property
    def is_told(self) -> bool:
        """Whether the robot was told its right pose anywhere."""
        return any(each.is_right for each in self.told)

    @property
    def is_merged(self) -> bool:
        """Whether the maps lie on each other as near as a right pose must be."""
        return self.off[0] <= RIGHT[0] and self.off[1] <= RIGHT[1]

    def figures(self) -> dict[str, Any]:
        """For the terminal and for JSON."""
        right = [each for each in self.told if each.is_right]
        told = sum(each.place is not None for each in self.told)
        milliseconds = [each.milliseconds for each in self.told]
        return {
            "poses_asked": len(self.told),
            "poses_right": len(right),
            "poses_wrong": told - len(right),
            "not_localised": len(self.told) - told,
            "pose_median_m": _median([each.meters for each in right]),
            "pose_median_deg": _median([each.degrees for each in right]),
            "localize_p50_ms": round(float(np.median(milliseconds)), 1),
            "maps_merged": self.laid is not None,
            "merged_off_m": round(self.off[0], 3) if self.laid else None,
            "merged_off_deg": round(self.off[1], 3) if self.laid else None,
            "segments_in_site": self.segments,
            "repeats_left_out": self.repeats,
        }


def localize_and_merge(
    mapper: Robot,
    asker: Robot,
    client: Client,
    name: str,
    views: Sequence[tuple[int, Segments]],
) -> Meeting:
    """Ask where the robot is, view by view; then upload its map, and merge both.

    Args:
        name: of the mapper's map, which is there.
        views: frames of the asker.
    """
    truth = Pose.of_matrix(mapper.to_common).inverse().after(Pose.of_matrix(asker.to_common))
    told = [_ask(asker, client, name, scan, segments, truth) for scan, segments in views]
    own = asker.name.replace(" ", "_")
    client.put_map(own, encode(asker.build_map(client, frame=asker.name)))
    try:
        merge = client.merge_maps(SITE, [name, own])
    except ServiceError as error:
        if not error.type.endswith(":not-aligned"):
            raise
        (pair,) = client.merge_maps(SITE, [name, own], dry_run=True).alignments
        return Meeting(told, None, (np.inf, np.inf), 0, 0, pair.detail)
    part = merge.parts[1]
    assert part.pose is not None  # else the answer would be that error
    laid = Pose.of_matrix(part.pose.matrix)
    middle = asker.drive.poses[:, :3, 3].mean(axis=0)
    meters, angle = laid.difference(truth, middle)
    off = meters, float(np.degrees(angle))
    return Meeting(told, laid, off, merge.segments, part.repeats)


def _ask(
    asker: Robot, client: Client, name: str, scan: int, segments: Segments, truth: Pose
) -> PoseAnswer:
    started = time.perf_counter()
    answer = client.localize(segments=clouds(segments), sensors=segments.sensors, maps=[name])
    milliseconds = 1e3 * (time.perf_counter() - started)
    sensor = asker.drive.poses[scan, :3, 3]
    here = truth.apply(sensor)
    if answer.best is None or answer.best.pose is None:
        return PoseAnswer(here, None, np.inf, np.inf, milliseconds)
    pose = Pose.of_matrix(answer.best.pose.matrix)
    meters, angle = pose.difference(truth, sensor)
    return PoseAnswer(here, pose.apply(sensor), meters, float(np.degrees(angle)), milliseconds)


def in_own_frame(robot: Robot, frame: Pose) -> Robot:
    """The same robot, with another world: nothing tells how that lies to anybody else's.

    Args:
        frame: from its world to the other.
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


def _median(values: Sequence[float]) -> float | None:
    return round(float(np.median(values)), 3) if values else None
