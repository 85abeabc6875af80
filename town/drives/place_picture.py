"""Picture of one scan of each place: `python -m town.drives.place_picture FILE`."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from placecell.core.types import Float32
from town.drives.sensor_picture import draw_scan
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
        drawn = draw_scan(panel, points, size=0.25)
        panel.set_title(name, fontsize="medium")
    figure.colorbar(drawn, ax=axes, label="height above the ground, meters", shrink=0.6)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=76)


if __name__ == "__main__":
    draw_places(Path(sys.argv[1]))
