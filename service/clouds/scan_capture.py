"""Capture of a map, made of one segmented scan at a known pose."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from placecell_client import CompactMap, Delta

from placecell.core.segments import stored_extents
from placecell.core.types import Float64, UInt32
from service.clouds.segmented_scan import SegmentedScan
from service.core.problems import Problem
from service.inference.describer import Descriptors
from service.inference.model_registry import Model

MOST_POINTS = 65_535
"""Largest values of the columns `extents`, decimeters, and `points`."""


@dataclass(frozen=True, slots=True)
class LevelPose:
    """Pose of a level sensor in a map.

    Attributes:
        x: position, meters; so are y and z.
        y: see x.
        z: see x.
        yaw: angle about the z axis, radians.
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0

    @property
    def position(self) -> Float64:
        """Return the position, float64 (3,), meters."""
        return np.array([self.x, self.y, self.z])

    @property
    def rotation(self) -> Float64:
        """Return the rotation from the sensor's frame to the map's, float64 (3, 3)."""
        cosine, sine = cos(self.yaw), sin(self.yaw)
        return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, slots=True)
class ScanOrigin:
    """Origin of a scan: robot, time and pose.

    Attributes:
        robot: name of the robot.
        time: time of the scan, seconds.
        pose: pose of the sensor in the map.
    """

    robot: str
    time: float
    pose: LevelPose


def check_segmented(scan: SegmentedScan) -> None:
    """Refuse a scan without segments.

    Raises:
        Problem: 422; the detail holds the scan's problems.
    """
    if not scan.clouds:
        raise Problem(
            422, "no-usable-segment", f"The scan has no segment. {' '.join(scan.problems)}"
        )


def edit_with(
    scan: SegmentedScan,
    descriptors: Descriptors,
    origin: ScanOrigin,
    model: Model,
    frame: str,
    first_id: int,
    before: CompactMap | None,
) -> Delta:
    """Return the edit that adds a scan's segments to a map as one capture.

    Args:
        scan: the segments.
        descriptors: their descriptors, by the model.
        origin: robot, time and pose of the scan.
        model: model of the map.
        frame: name of the map's coordinate frame.
        first_id: id of the first segment; the others follow.
        before: segments of the map, whose optional columns the edit keeps; None for a new map.
    """
    usable = descriptors.usable
    count = len(usable)
    rotation, position = origin.pose.rotation, origin.pose.position
    clouds = [scan.clouds[index] @ rotation.T for index in usable]
    extents = np.array([np.ptp(cloud, axis=0) for cloud in clouds])
    half = origin.pose.yaw / 2
    changed = CompactMap(
        model_id=model.id,
        preprocessing=model.manifest.preprocessing["version"],
        frame=frame,
        codes=descriptors.codes[usable],
        centroids=np.array([cloud.mean(axis=0) for cloud in clouds]) + position,
        ids=ids_from(first_id, count),
        robots=(origin.robot,),
        robot=np.zeros(count, np.uint16),
        frame_index=np.zeros(count, np.uint32),
        frame_times=np.array([origin.time]),
        frame_positions=position[None],
        frame_orientations=np.array([[0.0, 0.0, sin(half), cos(half)]], np.float32),
        extents=stored_extents(extents) if before is None or before.extents is not None else None,
        points=np.array([min(len(cloud), MOST_POINTS) for cloud in clouds], np.uint16)
        if before is None or before.points is not None
        else None,
        classes=descriptors.classes[usable]
        if descriptors.classes is not None and (before is None or before.classes is not None)
        else None,
    )
    return Delta(changed, np.zeros(0, np.uint32))


def ids_from(first: int, count: int) -> UInt32:
    """Return consecutive ids, uint32 (count,)."""
    return np.arange(first, first + count, dtype=np.uint32)
