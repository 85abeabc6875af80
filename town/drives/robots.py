"""Drives of several robots in one town, for place recognition between robots."""

from dataclasses import replace
from pathlib import Path
from string import ascii_lowercase

import numpy as np

from placecell.segmentation.pipeline import Progress, silent
from town.city import City
from town.drives.drive import check, write_drive
from town.places.catalog import STREETS, build_place, kind_of
from town.places.indoor.floor import DIFFERING
from town.places.place import Place
from town.sensing.lidar import HDL_64E, Lidar
from town.sensing.odometry import Odometry
from town.streets.route import Route, arc_lengths
from town.town import Town


def two_robots(
    folder: Path,
    seed: int = 7,
    scans: int = 120,
    *,
    spacing: float | None = None,
    place: str = STREETS,
    floor: int = 0,
    differing: float = DIFFERING,
    lidar: Lidar = HDL_64E,
    other_lidar: Lidar | None = None,
    mount: float | None = None,
    columns: int | None = None,
    speed: float | None = None,
    distortion: bool = False,
    oncoming: float = 0.0,
    labels: bool = False,
    overwrite: bool = False,
    progress: Progress = silent,
) -> tuple[Path, Path]:
    """Write `robot_a` and `robot_b`: the same way in opposite directions, with other cars.

    Args:
        folder: parent folder of both drives.
        seed: seed of town, route, parked cars and noise.
        scans: number of scans of each drive.
        spacing: distance between scans, meters; None for the place's own.
        place: name of the place, see `town.places`.
        floor: number of the floor of an indoor place.
        differing: share of the furniture that differs between floor 0 and another floor, 0 to 1.
        lidar: simulated sensor.
        other_lidar: sensor of robot B; None for that of robot A.
        mount: height of the sensor above the ground, meters; None for the lower one of the sensor's
            own and the usual one of the place.
        columns: number of azimuth steps; None for the sensor's own.
        speed: speed of the robots, m/s; None for `spacing` meters in a sweep of 0.1 s.
        distortion: write raw sweeps with the time of each point.
        oncoming: number of oncoming cars per kilometer.
        labels: also write the class of each point.
        overwrite: replace existing drives.
        progress: function that shows the progress.

    Returns:
        The folders of the two drives.

    Raises:
        FileExistsError: A drive exists, and `overwrite` is not set.
        ValueError: There is no such place or floor, or the sensor is mounted too high for it.
    """
    kind = kind_of(place)
    spacing = kind.spacing if spacing is None else spacing
    town, route = way_through(place, seed, scans, spacing, mount, floor, differing)
    lidars = [mounted(each, place, mount, columns) for each in (lidar, other_lidar or lidar)]
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
            lidar=lidars[number],
            speed=speed,
            distortion=distortion,
            oncoming=oncoming,
            labels=labels,
            overwrite=overwrite,
            progress=progress,
        )
        drives.append(drive)
    return drives[0], drives[1]


def one_robot(
    folder: Path,
    seed: int,
    scans: int,
    *,
    place: str = STREETS,
    lidar: Lidar = HDL_64E,
    opposite: bool = False,
    labels: bool = False,
    other_cars: bool = False,
    progress: Progress = silent,
) -> Path:
    """Write `robot_a` or `robot_b` only; the files are the same as those of `two_robots`.

    Args:
        folder: parent folder of the drive.
        seed: seed of town, route, parked cars and noise.
        scans: number of scans.
        place: name of the place, see `town.places`.
        lidar: simulated sensor.
        opposite: write robot B, which drives in the opposite direction.
        labels: also write the class of each point.
        other_cars: drive the same way on another day, when all parked cars and people changed (see
            `Town.other_cars`), with other sensor noise.
        progress: function that shows the progress.

    Returns:
        The folder of the drive.
    """
    spacing = kind_of(place).spacing
    town, route = way_through(place, seed, scans, spacing)
    number = 2 * seed + opposite
    return write_drive(
        folder / ("robot_b" if opposite else "robot_a"),
        replace(town, other_cars=other_cars),
        route.reversed() if opposite else route,
        traffic_seed=number,
        noise_seed=[number, 1] if other_cars else number,
        scans=scans,
        spacing=spacing,
        lidar=mounted(lidar, place),
        labels=labels,
        progress=progress,
    )


def way_through(
    place: str,
    seed: int,
    scans: int,
    spacing: float,
    mount: float | None = None,
    floor: int = 0,
    differing: float = DIFFERING,
) -> tuple[Town | Place, Route]:
    """Build a place and the route of `two_robots`, whose arguments these are.

    Raises:
        ValueError: There is no such place or floor, or the sensor is mounted too high for it.
    """
    kind = kind_of(place)
    if mount is not None and mount > kind.headroom:
        raise ValueError(
            f"Invalid mount {mount} m: a sensor passes everywhere in the place {place!r} up to "
            f"{kind.headroom} m."
        )
    # The inner lane of a turn is shorter than the center line.
    town, route = build_place(place, seed, 1.08 * scans * spacing + 4.0, floor, differing)
    return town, (route if place == STREETS else fitted(route, scans * spacing))


def mounted(
    lidar: Lidar, place: str, mount: float | None = None, columns: int | None = None
) -> Lidar:
    """Return a sensor as `two_robots` mounts it, whose arguments these are."""
    return replace(
        lidar,
        columns=lidar.columns if columns is None else columns,
        height=min(lidar.height, kind_of(place).sensor_height) if mount is None else mount,
    )


def fitted(route: Route, meters: float) -> Route:
    """Return the start of a route whose lanes have at least this length in both directions.

    So robot B begins where robot A ends, and no earlier.

    Args:
        route: route that is long enough.
        meters: length of the drives, meters.
    """
    for length in np.arange(meters, arc_lengths(route.center)[-1], 0.5):
        start = route.cut(0.0, float(length))
        if min(start.length(), start.reversed().length()) >= meters:
            return start
    return route


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
    other_lidar: Lidar | None = None,
    odometry: Odometry | None = None,
    oncoming: float = 0.0,
    speed: float | None = None,
    distortion: bool = False,
    labels: bool = False,
    overwrite: bool = False,
    progress: Progress = silent,
) -> list[Path]:
    """Write `robot_a`, `robot_b`, ... along one route of a large town.

    Every second robot drives in the opposite direction and lane. Parked cars, oncoming cars and
    odometry errors differ for each robot.

    Args:
        folder: parent folder of the drives.
        city: the town.
        route: route of the robots.
        robots: number of robots, 1 to 26.
        start: start of each robot on its path, meters along the center line.
        scans: number of scans of each drive; None for the rest of the route.
        spacing: distance between scans, meters.
        lidar: simulated sensor.
        other_lidar: sensor of every second robot; None for that of the others.
        odometry: errors of the odometry; None for no odometry.
        oncoming: number of oncoming cars per kilometer.
        speed: speed of the robots, m/s; None for `spacing` meters in a sweep of 0.1 s.
        distortion: write raw sweeps with the time of each point.
        labels: also write the class of each point.
        overwrite: replace existing drives.
        progress: function that shows the progress.

    Returns:
        The folders of the drives.

    Raises:
        FileExistsError: A drive exists, and `overwrite` is not set.
        ValueError: The number of robots, scans or cars is out of range, or the route is too short.
    """
    if not 1 <= robots <= len(ascii_lowercase):
        raise ValueError(
            f"Invalid number of robots: expected 1 to {len(ascii_lowercase)}, not {robots}"
        )
    drives = [folder / f"robot_{ascii_lowercase[number]}" for number in range(robots)]
    ways = [way_of(number, route, scans, spacing, start) for number in range(robots)]
    for drive, (way, count) in zip(drives, ways, strict=True):
        # Check all before the first drive, which may take hours.
        check(drive, way, count, spacing, overwrite, speed)
    for number, (drive, (way, count)) in enumerate(zip(drives, ways, strict=True)):
        write_drive(
            drive,
            city,
            way,
            traffic_seed=number,
            noise_seed=len(ascii_lowercase) * city.seed + number,
            scans=count,
            spacing=spacing,
            lidar=(other_lidar or lidar) if number % 2 else lidar,
            odometry=odometry,
            oncoming=oncoming,
            speed=speed,
            distortion=distortion,
            labels=labels,
            overwrite=overwrite,
            progress=progress,
        )
    return drives


def way_of(
    number: int, route: Route, scans: int | None, spacing: float, start: float = 0.0
) -> tuple[Route, int]:
    """Return a robot's route, reversed for every second robot, and its number of scans.

    Args:
        number: number of the robot, from 0.
        route: route of the first robot.
        scans: number of scans; None for the rest of the route.
        spacing: distance between scans, meters.
        start: start on the route, meters along the center line.

    Raises:
        ValueError: The route ends before the start.
    """
    way = route.reversed() if number % 2 else route
    if start:
        way = way.cut(start, max(arc_lengths(way.center)[-1] - start, spacing))
    return way, int(way.length() / spacing) if scans is None else scans
