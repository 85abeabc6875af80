"""Two robots in one town: the case that place recognition between robots is for."""

from dataclasses import replace
from pathlib import Path

from segments.extraction import Progress, silent
from town.drive import write_drive
from town.lidar import HDL_64E
from town.route import Route
from town.town import Town


def two_robots(
    folder: Path,
    seed: int = 7,
    scans: int = 120,
    *,
    spacing: float = 1.0,
    columns: int = 1000,
    overwrite: bool = False,
    progress: Progress = silent,
) -> tuple[Path, Path]:
    """Drives `robot_a` and `robot_b`: the same streets, the other way, other cars parked.

    Args:
        folder: gets both drives.
        seed: of the town, the route, the parked cars and the noise.
        scans: of each drive.
        spacing: metres between scans.
        columns: azimuth steps of the sensor.
        overwrite: replace drives that are there.
        progress: wraps the loops over the scans.

    Returns:
        the two drives' folders.

    Raises:
        FileExistsError: a drive is there already, and `overwrite` is not set.
    """
    town = Town.build(seed)
    # The inner lane of a turn is shorter than the centre line.
    length = 1.08 * scans * spacing + 4.0
    route = Route.wander(town, length + 20.0, seed).cut(start=10.0, length=length)
    lidar = replace(HDL_64E, columns=columns)
    drives = []
    for number, (name, way) in enumerate([("robot_a", route), ("robot_b", route.reversed())]):
        drive = write_drive(
            folder / name,
            town,
            way,
            traffic_seed=2 * seed + number,
            noise_seed=2 * seed + number,
            scans=scans,
            spacing=spacing,
            lidar=lidar,
            overwrite=overwrite,
            progress=progress,
        )
        drives.append(drive)
    return drives[0], drives[1]
