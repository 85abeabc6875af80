"""Segmentation of one scan: leveled by its ground, without scans before it."""

from dataclasses import dataclass

import numpy as np

from placecell.core.cancellation import current
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Float32, Float64, Int32
from placecell.inspection.ground import SensorMount, find_mount
from placecell.odometry.ground_plane import UP, rotation_between
from placecell.segmentation.local_map import in_range, voxel_means
from placecell.segmentation.pipeline import segment_rows
from service.clouds.uploaded_cloud import UploadedCloud

GROUND, OTHER = -1, -2
"""Labels of points of the ground, and of points in no segment."""

LEVEL_DEGREES = 1.0
"""Tilt of the ground below which a scan counts as level, degrees."""

JUDGED_POINTS = 200_000
"""Largest number of points that the ground is sought in."""

FARTHEST = 1e6
"""Largest coordinate of a point that is used, meters."""

FEW = 0.5
"""Share of points within range below which a scan gets a remark."""


@dataclass(frozen=True, slots=True, eq=False)
class SegmentedScan:
    """Segments of one scan, in a level frame whose origin is the sensor.

    Attributes:
        clouds: points of each segment, float32 (n, 3), meters.
        voxels: points of the local map, one for each voxel of 0.1 m, float32 (m, 3), meters.
        labels: segment of each of them, or `GROUND`, or `OTHER`, int32 (m,).
        transform: transform from the frame of the file to this frame, float64 (4, 4).
        sensor_height: height of the sensor above the ground, meters; None if no ground was found.
        problems: what is odd about the scan, in sentences.
    """

    clouds: tuple[Float32, ...]
    voxels: Float32
    labels: Int32
    transform: Float64
    sensor_height: float | None
    problems: tuple[str, ...]


def segment_scan(cloud: UploadedCloud, parameters: Parameters = PROTOCOL_V1) -> SegmentedScan:
    """Segment an uploaded scan.

    Raises:
        Cancelled: the request is late, or its client disconnected.
    """
    scan = cloud.scan
    problems = [_sentence(remark) for remark in cloud.remarks]
    if scan.not_finite:
        problems.append(f"{scan.not_finite:,} of {scan.read:,} points are not finite.")
    points = scan.points[(np.abs(scan.points) < FARTHEST).all(axis=1)]
    transform = np.eye(4)
    transform[:3, 3] = -cloud.shift
    if cloud.shift.any() and len(points):
        middle = np.median(points.astype(np.float64), axis=0)
        points = (points - middle).astype(np.float32)
        transform[:3, 3] -= middle
        problems.append(
            "The coordinates are those of a map, not of a sensor. The middle of the points is "
            "taken as the position of the sensor."
        )
    mount = find_mount([points[:: -(-len(points) // JUDGED_POINTS) or 1]])
    current().check()
    rotation = _leveling(mount, problems)
    transform = np.block([[rotation, np.zeros((3, 1))], [np.eye(4)[3:]]]) @ transform
    points = (points @ rotation.T.astype(np.float32)).astype(np.float32)
    near = in_range(points, parameters)
    near = near[np.einsum("ij,ij->i", near[:, :2], near[:, :2]) <= parameters.local_map_radius**2]
    if len(near) < FEW * len(points):
        problems.append(
            f"{len(near):,} of {len(points):,} points are between {parameters.min_range:g} and "
            f"{parameters.local_map_radius:g} m from the sensor; only these are segmented."
        )
    voxels = voxel_means(near, parameters.map_voxel)
    current().check()
    rows, ground = segment_rows(voxels, parameters)
    labels = np.where(ground, GROUND, OTHER).astype(np.int32)
    for index, some in enumerate(rows):
        labels[some] = index
    if not rows:
        problems.append(
            f"No segment has {parameters.min_points} points or more, one for each voxel of "
            f"{parameters.map_voxel:g} m. Send a denser scan, or several scans as one cloud."
        )
    return SegmentedScan(
        clouds=tuple(voxels[some] for some in rows),
        voxels=voxels,
        labels=labels,
        transform=transform,
        sensor_height=None if mount.ground is None else mount.ground.height,
        problems=tuple(problems),
    )


def _leveling(mount: SensorMount, problems: list[str]) -> Float64:
    """Return the rotation (3, 3) that levels a scan; tell problems of its mount."""
    ground = mount.ground
    if mount.unit:
        problems.append(
            f"The coordinates seem to be in {mount.unit}; expected meters. Convert the file."
        )
    elif mount.up_axis not in {"z", ""}:
        problems.append(
            f"The axis {mount.up_axis} of the file points up; expected z. The points are turned."
        )
    elif ground is None:
        problems.append(f"{mount.reason} The axis z is taken as up.")
    elif ground.tilt_deg > LEVEL_DEGREES:
        problems.append(
            f"The sensor is tilted by {ground.tilt_deg:.1f} degrees against the ground. The points "
            "are leveled."
        )
    if ground is None or (mount.up_axis == "z" and ground.tilt_deg <= LEVEL_DEGREES):
        return np.eye(3)
    return rotation_between(ground.up, np.array(UP))


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}{'' if text.endswith('.') else '.'}"
