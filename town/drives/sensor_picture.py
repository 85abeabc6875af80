"""Picture of one scan of each sensor: `python -m town.drives.sensor_picture FILE`."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure

from placecell.core.types import Float32
from town.geometry.scene import Scene
from town.sensing.lidar import Lidar
from town.sensing.sensors import SENSORS
from town.streets.route import Route
from town.town import Town

SEED = 7
ALONG = 130.0
"""Position of all sensors along the route, meters: a street with houses, trees and parked cars."""

CAMERA = (-22.0, 20.0)
"""Position of the camera along the sensor's x axis and above the ground, meters."""

TILT = np.radians(40.0)
"""Angle of the camera's axis below the horizon, radians."""

HEIGHTS = (-0.5, 8.0)
"""Heights above the ground at the ends of the color scale, meters."""


def scan_of(lidar: Lidar, scene: Scene, route: Route) -> Float32:
    """Return one scan in the small town, (n, 4), with z above the ground below the sensor."""
    sweep = route.poses(ALONG + lidar.sweep_times(), lidar.height)
    pose = route.poses(np.array([ALONG]), lidar.height)[0]
    points = lidar.scan(scene, sweep, pose, np.random.default_rng(SEED))
    points[:, 2] += lidar.height
    return points


def through_camera(points: Float32) -> tuple[Float32, Float32, Float32]:
    """Project points by a pinhole camera behind the sensor that looks down ahead.

    Args:
        points: (n, 3), x ahead, y left, z above the ground.

    Returns:
        Right and up in the picture, in focal lengths, and the distance along the axis, meters.
    """
    ahead, above = points[:, 0] - CAMERA[0], points[:, 2] - CAMERA[1]
    depth = np.cos(TILT) * ahead - np.sin(TILT) * above
    up = np.sin(TILT) * ahead + np.cos(TILT) * above
    return -points[:, 1] / depth, up / depth, depth


def draw_scan(panel: Axes, points: Float32, size: float) -> PathCollection:
    """Draw a scan, obliquely from behind and colored by height.

    Args:
        panel: axes to draw in.
        points: (n, 4), as `scan_of` returns them.
        size: area of a point, square points.
    """
    right, up, depth = through_camera(points)
    order = np.argsort(-depth)
    order = order[depth[order] > 1.0]
    panel.set(xlim=(-0.75, 0.75), ylim=(-0.4, 0.6), aspect="equal", xticks=[], yticks=[])
    return panel.scatter(
        right[order],
        up[order],
        c=points[order, 2],
        s=size,
        linewidths=0,
        cmap="turbo",
        vmin=HEIGHTS[0],
        vmax=HEIGHTS[1],
    )


def draw_sensors(file: Path) -> None:
    """Draw one scan of each sensor, obliquely from behind and colored by height.

    Args:
        file: PNG file to write.
    """
    town = Town.build(SEED)
    route = Route.wander(town.plan, town.terrain, 200.0, SEED)
    scene = Scene(town.mesh(traffic_seed=SEED))
    figure = Figure(figsize=(10, 9), layout="constrained")
    axes = figure.subplots(4, 3)
    for place in axes.flat[len(SENSORS) :]:
        place.axis("off")
    for place, (name, lidar) in zip(axes.flat, SENSORS.items(), strict=False):
        points = scan_of(lidar, scene, route)
        drawn = draw_scan(place, points, size=0.2)
        place.set_title(f"{name}: {len(points):,} points", fontsize="medium")
    figure.colorbar(drawn, ax=axes, label="height above the ground, meters", shrink=0.5)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=76)


if __name__ == "__main__":
    draw_sensors(Path(sys.argv[1]))
