"""Robots in one town: the case that place recognition between robots is for."""

from dataclasses import replace
from pathlib import Path
from string import ascii_lowercase

from placecell.segmentation.pipeline import Progress, silent
from town.city import City
from town.drives.drive import check, write_drive
from town.sensing.lidar import HDL_64E, Lidar
from town.sensing.odometry import Odometry
from town.streets.route import Route, arc_lengths
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
        spacing: meters between scans.
        columns: azimuth steps of the sensor.
        overwrite: replace drives that are there.
        progress: wraps the loops over the scans.

    Returns:
        the two drives' folders.

    Raises:
        FileExistsError: a drive is there already, and `overwrite` is not set.
    """
    town = Town.build(seed)
    # The inner lane of a turn is shorter than the center line.
    length = 1.08 * scans * spacing + 4.0
    route = Route.wander(town.plan, town.terrain, length + 20.0, seed).cut(
        start=10.0, length=length
    )
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


def several_robots(
    folder: Path,
    city: City,
    route: Route,
    robots: int,
    *,
    start: float = 0.0,
    scans: int | None = None,
    spacing: float = 1.0,
    lidar: Lidar = HDL_64E,
    odometry: Odometry | None = None,
    oncoming: float = 0.0,
    overwrite: bool = False,
    progress: Progress = silent,
) -> list[Path]:
    """Drives `robot_a`, `robot_b`, ... along one route of a large town.

    Every second robot drives the other way, so in the other lane. For each, other cars are parked
    and others come towards it, and its odometry errs in its own way.

    Args:
        folder: gets the drives.
        robots: how many, up to 26.
        start: where on its way each begins, meters along the middle of the street.
        scans: of each drive; all the rest of the route unless given.
        spacing: meters between scans.
        odometry: how it errs, of all of them, if they have one.
        oncoming: cars that come the other way, a kilometer.
        overwrite: replace drives that are there.
        progress: wraps the loops over the scans.

    Returns:
        the drives' folders.

    Raises:
        FileExistsError: a drive is there already, and `overwrite` is not set.
        ValueError: no such number of robots, scans or cars, or the route is too short.
    """
    if not 1 <= robots <= len(ascii_lowercase):
        raise ValueError(f"there can be 1 to {len(ascii_lowercase)} robots, not {robots}")
    drives = [folder / f"robot_{ascii_lowercase[number]}" for number in range(robots)]
    ways = [way_of(number, route, scans, spacing, start) for number in range(robots)]
    for drive, (way, count) in zip(drives, ways, strict=True):
        # Before the first of them is driven, which may take hours.
        check(drive, way, count, spacing, overwrite)
    for number, (drive, (way, count)) in enumerate(zip(drives, ways, strict=True)):
        write_drive(
            drive,
            city,
            way,
            traffic_seed=number,
            noise_seed=len(ascii_lowercase) * city.seed + number,
            scans=count,
            spacing=spacing,
            lidar=lidar,
            odometry=odometry,
            oncoming=oncoming,
            overwrite=overwrite,
            progress=progress,
        )
    return drives


def way_of(
    number: int, route: Route, scans: int | None, spacing: float, start: float = 0.0
) -> tuple[Route, int]:
    """The way that a robot takes, every second one backwards, and how many scans it takes there.

    Args:
        start: where on it the robot begins, meters along the middle of the street.

    Raises:
        ValueError: the route ends before.
    """
    way = route.reversed() if number % 2 else route
    if start:
        way = way.cut(start, max(arc_lengths(way.center)[-1] - start, spacing))
    return way, int(way.length() / spacing) if scans is None else scans
