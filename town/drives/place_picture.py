"""Picture of one scan of each place: `python -m town.drives.place_picture FILE`."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from placecell.core.types import Float32
from town.drives.sensor_picture import HEIGHTS, through_camera
from town.places import INDOOR, PLACES, build_place
from town.sensing.sensors import sensor

SEED = 7
SENSOR = "os1-128"

ALONG = 30.0
"""Position of the sensor along the route, meters."""

CUT = 2.5
"""Height above the floor from which an indoor scan is not drawn: the ceiling hides the rooms."""


def scan_in(name: str) -> Float32:
    """Return one scan in a place, (n, 4), with z above the ground below the sensor."""
    kind = PLACES[name]
    lidar = sensor(SENSOR)
    lidar = replace(lidar, height=min(lidar.height, kind.sensor_height))
    place, route = build_place(name, SEED, 2 * ALONG)
    distances = np.array([ALONG])
    pose = route.poses(distances, lidar.height)[0]
    sweep = route.poses(ALONG + kind.spacing * lidar.sweep_times(), lidar.height)
    scene = place.scenes(SEED, lidar.max_range).around(pose[:2, 3])
    points = lidar.scan(scene, sweep, pose, np.random.default_rng(SEED))
    points[:, 2] += lidar.height
    return points[points[:, 2] < CUT] if name == INDOOR else points


def draw_places(file: Path) -> None:
    """Draw one scan of each place, obliquely from behind and colored by height.

    Args:
        file: PNG file to write.
    """
    figure = Figure(figsize=(10, 5.2), layout="constrained")
    axes = figure.subplots(2, 3)
    for panel in axes.flat[len(PLACES) :]:
        panel.axis("off")
    for panel, name in zip(axes.flat, PLACES, strict=False):
        points = scan_in(name)
        right, up, depth = through_camera(points)
        order = np.argsort(-depth)
        order = order[depth[order] > 1.0]
        drawn = panel.scatter(
            right[order],
            up[order],
            c=points[order, 2],
            s=0.25,
            linewidths=0,
            cmap="turbo",
            vmin=HEIGHTS[0],
            vmax=HEIGHTS[1],
        )
        panel.set(xlim=(-0.75, 0.75), ylim=(-0.4, 0.6), aspect="equal", xticks=[], yticks=[])
        panel.set_title(name, fontsize="medium")
    figure.colorbar(drawn, ax=axes, label="height above the ground, meters", shrink=0.6)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=76)


if __name__ == "__main__":
    draw_places(Path(sys.argv[1]))
