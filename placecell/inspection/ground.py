"""Sensor height, tilt and direction of up of a source, from the ground in its scans."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Float64
from placecell.odometry.ground_plane import (
    UP,
    GroundPlane,
    NoGroundError,
    find_common_ground,
    rotation_between,
)

AXES = {
    "x": (1.0, 0.0, 0.0),
    "-x": (-1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "-z": (0.0, 0.0, -1.0),
}
"""Directions of up besides z."""
FLAT, WIDE = 0.8, 0.9
"""Largest and smallest sine of the points' angles to the plane across a spinning sensor's axis."""
AHEAD = 0.7
"""Smallest cosine to the z axis of the points of a camera, which looks along it."""
CLEARLY = 2.0
"""Ratio of areas from which another axis points up rather than z."""
USUAL_HEIGHTS = (0.2, 3.5)
"""Usual heights of sensors above the ground, meters."""
UNITS = {"mm": 0.001, "cm": 0.01}
NONE = np.zeros((0, 3), np.float32)
LOOKED_AT = 5
"""Most scans that the ground is sought in."""


@dataclass(frozen=True, slots=True)
class SensorMount:
    """Mount of the sensor above the ground.

    Attributes:
        ground: ground in the sensor's frame; None if none is seen near the z axis.
        reason: why there is none.
        up_axis: axis of the sensor's frame that points up; "" if unknown.
        unit: unit of the coordinates in which a ground is seen, if it is not meters; "" otherwise.
    """

    ground: GroundPlane | None
    reason: str = ""
    up_axis: str = "z"
    unit: str = ""


def find_mount(clouds: Sequence[Float32]) -> SensorMount:
    """Find the sensor's height and tilt, and whether z points up and meters are the unit."""
    some = [clouds[int(i)] for i in np.linspace(0, len(clouds) - 1, min(len(clouds), LOOKED_AT))]
    ground: GroundPlane | None = None
    reason = "There is no scan."
    try:
        ground = find_common_ground(some)
    except NoGroundError as error:
        reason = str(error)
    axes = possible_ups(some)
    for name in axes:
        try:
            found = find_common_ground(some, AXES[name])
        except NoGroundError:
            continue
        if ground is None or found.area > CLEARLY * ground.area:
            return SensorMount(found, up_axis=name)
    if ground is None and axes == ["-y"]:
        return SensorMount(None, reason, "-y")
    if ground is not None:
        return SensorMount(ground)
    for unit, scale in UNITS.items():
        scaled = [(cloud * scale).astype(np.float32) for cloud in some]
        try:
            height = find_common_ground(scaled).height
        except NoGroundError:
            continue
        if USUAL_HEIGHTS[0] <= height <= USUAL_HEIGHTS[1]:
            return SensorMount(None, reason, "", unit)
    return SensorMount(None, reason, "")


def possible_ups(clouds: Sequence[Float32]) -> list[str]:
    """Return the axes besides z that may point up, by the pattern of the scans.

    A wall is as good a ground as a floor; so the ground alone does not tell the axis. A spinning
    sensor sees all around its axis. A camera sees along z, and its y axis points down.
    """
    points = np.concatenate([cloud[:: max(1, len(cloud) // 20_000)] for cloud in clouds] or [NONE])
    if not len(points):
        return []
    with np.errstate(over="ignore"):  # A damaged scan may have points at any distance.
        sines = points / np.maximum(np.linalg.norm(points, axis=1), 1e-6)[:, None]
    if np.quantile(sines[:, 2], 0.05) > AHEAD / 2 and np.median(sines[:, 2]) > AHEAD:
        return ["-y"]
    reach = np.minimum(np.quantile(sines, 0.98, axis=0), -np.quantile(sines, 0.02, axis=0))
    across = np.quantile(np.abs(sines), 0.95, axis=0)
    axis = int(across.argmin())
    others = [each for each in range(3) if each != axis]
    if across[axis] > FLAT or reach[others].min() < WIDE:
        return []
    return {0: ["x", "-x"], 1: ["-y", "y"], 2: ["-z"]}[axis]


def world_tilt(ground: GroundPlane, poses: Float64) -> float:
    """Return the angle between up in the ground and the z axis of the poses' world, degrees.

    Args:
        ground: ground in the sensor's frame.
        poses: sensor-to-world transforms of scans all over the drive, float64 (n, 4, 4).
    """
    up = (poses[:, :3, :3] @ ground.up).mean(axis=0)
    return float(np.degrees(np.arccos(np.clip(up[2] / np.linalg.norm(up), -1, 1))))


def leveled(points: Float32, mount: SensorMount) -> Float32:
    """Return points in a frame with z up and the sensor in the origin, as far as up is known."""
    up = mount.ground.up if mount.ground is not None else np.array(UP)
    return np.asarray(points @ rotation_between(up, np.array(UP)).T.astype(np.float32))
