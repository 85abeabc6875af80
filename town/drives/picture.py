"""Picture of a large town's plan with the drives through it."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from placecell.datasets.kitti_odometry import KittiOdometry
from town.city import City
from town.drives.drive import read_origin
from town.sensing.odometry import ODOMETRY_FILE
from town.streets.network import DESIGNS, OWN
from town.streets.route import Route


def draw_plan(file: Path, city: City, route: Route, drives: Sequence[Path]) -> None:
    """Draw the streets, with those of identical houses in color, the route and the odometry.

    Args:
        file: PNG file to write.
        city: the town.
        route: route of the first robot.
        drives: folders of drives. Their odometry is drawn if they have one.
    """
    figure = Figure(figsize=(7, 7), layout="constrained")
    axes = figure.add_subplot()
    network = city.network
    colors = {OWN: "0.75"} | {design: f"C{design + 1}" for design in range(DESIGNS)}
    for line, design in zip(network.lines(), network.designs.tolist(), strict=True):
        axes.plot(*line.T, color=colors[design], linewidth=6, solid_capstyle="round", alpha=0.6)
    lane = route.lane()
    axes.plot(*lane.T, color="black", linewidth=0.8, label="route of robot A")
    axes.plot(*lane[0], "o", color="black", markersize=5)
    for number, drive in enumerate(drives):
        if (drive / ODOMETRY_FILE).exists():
            believed = read_origin(drive) @ KittiOdometry(drive, ODOMETRY_FILE).poses
            axes.plot(
                *believed[:, :2, 3].T, ":", color=f"C{number}", label=f"odometry of {drive.name}"
            )
    axes.set(aspect="equal", xlabel="meters")
    axes.set_title(title(city, route), fontsize="medium")
    figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=100)


def title(city: City, route: Route) -> str:
    """Return the title of the picture."""
    alike = np.mean(city.network.designs != OWN)
    return (
        f"Town {city.seed}: {city.network.meters():,.0f} m of streets, {alike:.0%} lined by "
        f"identical houses\n(a color a design); the route is {route.length():,.0f} m long"
    )
