"""Writer of drives through the town, in the layout of the KITTI odometry benchmark."""

import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from placecell.core.types import Float64
from placecell.datasets.drive import read_table
from placecell.datasets.labels import FOLDER, write_codes
from placecell.segmentation.pipeline import Progress, silent
from placecell.sources.errors import DriveError
from placecell.trajectories.poses import as_transforms, check_rotations
from town.city import City
from town.drives.oncoming import Oncoming
from town.geometry.scene import Layers, Scene, Scenes, Surfaces
from town.places.place import Place
from town.sensing.lidar import HDL_64E, SWEEP_SECONDS, Lidar
from town.sensing.odometry import ODOMETRY_FILE, Odometry
from town.streets.route import Route
from town.town import Town

SENSOR_TO_CAMERA = np.array(
    [
        [4.276802385584e-04, -9.999672484946e-01, -8.084491683471e-03, -1.198459927713e-02],
        [-7.210626507497e-03, 8.081198471645e-03, -9.999413164504e-01, -5.403984729748e-02],
        [9.999738645903e-01, 4.859485810390e-04, -7.206933692422e-03, -2.921968648686e-01],
        [0.0, 0.0, 0.0, 1.0],
    ]
)
"""`Tr` of KITTI's sequence 00: sensor to left camera. Poses are written for that camera."""

ORIGIN_FILE = "origin.txt"

FILES = ("calib.txt", "poses.txt", ODOMETRY_FILE, "times.txt", ORIGIN_FILE)


def write_drive(
    folder: Path,
    town: Town | City | Place,
    route: Route,
    *,
    traffic_seed: int,
    scans: int,
    spacing: float = 1.0,
    noise_seed: int | Sequence[int] = 0,
    odometry: Odometry | None = None,
    oncoming: float = 0.0,
    lidar: Lidar = HDL_64E,
    speed: float | None = None,
    distortion: bool = False,
    labels: bool = False,
    overwrite: bool = False,
    progress: Progress = silent,
) -> Path:
    """Simulate a drive along a route and write it.

    The folder then has `velodyne/NNNNNN.bin` (float32 x, y, z, reflectance; sensor frame),
    `poses.txt` and `calib.txt` (left camera, as in KITTI) and `times.txt`. A file that KITTI does
    not have is `origin.txt`: the 3x4 transform, in row-major order, from the drive's world frame to
    the town frame. So drives of one town can be compared in one true frame.

    The drive's world frame (that of the poses, as `placecell.datasets` reads them) has its origin
    at the sensor of the first scan and its x axis along the first heading. It is level, because a
    robot knows the direction of gravity; so the first pose has the slope of the street.

    With `distortion`, a scan is the raw sweep: each point is in the sensor frame at its own time.
    The files have a fifth column, the time of each point in seconds from the scan's time in
    `times.txt`. A scan's time and pose are always those of the middle of its sweep.

    With an odometry, `poses_odometry.txt` has the estimated poses in the form of `poses.txt`. The
    first pose is exact. `KittiOdometry(folder, ODOMETRY_FILE)` reads them.

    Args:
        folder: folder of the drive, created if it is missing.
        town: town, large town or place.
        route: route of the robot.
        traffic_seed: seed of the parked cars and people.
        scans: number of scans.
        spacing: distance between scans along the lane, meters.
        noise_seed: seed of sensor noise and odometry errors, or several numbers.
        odometry: errors of the odometry; None for no odometry.
        oncoming: number of oncoming cars per kilometer of the route.
        lidar: simulated sensor.
        speed: speed of the robot, m/s; None for `spacing` meters in a sweep of 0.1 s.
        distortion: write raw sweeps with the time of each point.
        labels: also write `labels/NNNNNN.label` (see `placecell.datasets.labels`), which changes no
            other file.
        overwrite: replace the drive in the folder.
        progress: function that shows the progress.

    Returns:
        The folder.

    Raises:
        FileExistsError: The folder is not empty, and `overwrite` is not set.
        ValueError: The route is too short, or the number of scans or cars or the speed is out of
            range.
    """
    check(folder, route, scans, spacing, overwrite, speed)
    noise_seeds = [noise_seed] if isinstance(noise_seed, int) else list(noise_seed)
    cars = Oncoming.draw(route, oncoming, traffic_seed)
    clear(folder)
    distances = scan_distances(scans, spacing)
    poses = route.poses(distances, lidar.height)
    scenes = town.scenes(traffic_seed, lidar.max_range)
    times = scan_times(scans, spacing, speed)
    swept = spacing if speed is None else speed * SWEEP_SECONDS
    for scan in progress(range(scans), scans, f"scans of {folder.name}"):
        rng = np.random.default_rng([*noise_seeds, scan])
        sweep = route.poses(distances[scan] + swept * lidar.sweep_times(), lidar.height)
        scene = seen_from(poses[scan, :2, 3], scenes, cars, float(times[scan]))
        if distortion:
            points, hits = lidar.raw_scan_and_hits(scene, sweep, rng, float(times[scan]))
        else:
            points, hits = lidar.scan_and_hits(scene, sweep, poses[scan], rng, float(times[scan]))
        (folder / "velodyne" / f"{scan:06d}.bin").write_bytes(points.astype("<f4").tobytes())
        if labels:
            write_codes(folder, f"{scan:06d}", scene.codes[hits])
    origin = levelled(poses[0])
    (folder / "poses.txt").write_text(matrix_lines(as_camera(poses, origin)))
    if odometry is not None:
        believed = odometry.poses(poses, noise_seeds[0])
        (folder / ODOMETRY_FILE).write_text(matrix_lines(as_camera(believed, origin)))
    (folder / ORIGIN_FILE).write_text(matrix_lines(origin[None]))
    (folder / "calib.txt").write_text("Tr: " + matrix_lines(SENSOR_TO_CAMERA[None]))
    (folder / "times.txt").write_text("".join(f"{time:.6e}\n" for time in times))
    return folder


def seen_from(place: Float64, scenes: Scenes, cars: Oncoming, time: float) -> Surfaces:
    """Return the surfaces in range of a place (2,) at a time, seconds."""
    standing = scenes.around(place)
    moving = cars.around(place, time)
    return Layers(standing, Scene(moving)) if len(moving) else standing


def scan_distances(scans: int, spacing: float) -> Float64:
    """Return the position of each scan along the lane, (scans,), meters.

    A sweep extends by half of the spacing to both sides of its scan's pose.
    """
    return np.asarray(spacing * (np.arange(scans, dtype=np.float64) + 0.5))


def scan_times(scans: int, spacing: float, speed: float | None) -> Float64:
    """Return the time of the middle of each scan's sweep, (scans,), seconds from the first.

    Args:
        scans: number of scans.
        spacing: distance between scans, meters.
        speed: speed of the robot, m/s; None if each sweep begins where the last one ended.
    """
    if speed is None:
        return np.asarray(np.arange(scans) / (1 / SWEEP_SECONDS))
    return np.asarray(np.arange(scans) * (spacing / speed))


def check(
    folder: Path,
    route: Route,
    scans: int,
    spacing: float,
    overwrite: bool,
    speed: float | None = None,
) -> None:
    """Check that a drive can be written.

    Raises:
        FileExistsError: The folder is not empty, and `overwrite` is not set.
        ValueError: The route is too short, the number of scans is not positive, or the sweeps
            would overlap.
    """
    fastest = spacing / SWEEP_SECONDS
    if speed is not None and not 0 < speed <= fastest * (1 + 1e-9):
        raise ValueError(
            f"Invalid speed {speed} m/s: a sweep takes {SWEEP_SECONDS} s, so scans {spacing} m "
            f"apart need a speed above 0 and at most {fastest:g} m/s."
        )
    if scans < 1:
        raise ValueError(f"Invalid number of scans: expected at least 1, not {scans}")
    if route.length() < scans * spacing:
        raise ValueError(
            f"the route is {route.length():.1f} m long: too short for {scans} scans "
            f"{spacing} m apart"
        )
    if folder.is_dir() and any(folder.iterdir()) and not overwrite:
        raise FileExistsError(
            f"{folder} is not empty: give another folder, or overwrite=True to replace its drive"
        )


def clear(folder: Path) -> None:
    """Create the folder, or remove the files of the drive in it."""
    # Remove only the files of a drive, including all scans of a longer drive.
    for scans in ("velodyne", FOLDER):
        if (folder / scans).is_dir():
            shutil.rmtree(folder / scans)
    for name in FILES:
        (folder / name).unlink(missing_ok=True)
    (folder / "velodyne").mkdir(parents=True)


def as_camera(poses: Float64, origin: Float64) -> Float64:
    """Return KITTI's left-camera poses (n, 4, 4) of sensor poses in the town frame.

    Args:
        poses: (n, 4, 4), sensor to town.
        origin: (4, 4), the drive's world to town.
    """
    to_world = SENSOR_TO_CAMERA @ np.linalg.inv(origin)
    return np.asarray(to_world @ poses @ np.linalg.inv(SENSOR_TO_CAMERA))


def levelled(pose: Float64) -> Float64:
    """Return a pose (4, 4) with the same position and heading, and without roll and pitch."""
    heading = np.arctan2(pose[1, 0], pose[0, 0])
    level = np.eye(4)
    level[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
    level[:3, 3] = pose[:3, 3]
    return level


def matrix_lines(transforms: Iterable[Float64]) -> str:
    """Return one line per transform: its upper 3x4 matrix in row-major order."""
    return "".join(
        " ".join(f"{value:.12e}" for value in transform[:3].ravel()) + "\n"
        for transform in transforms
    )


def read_origin(folder: Path) -> Float64:
    """Read the world-to-town transform of a drive, (4, 4), from its `origin.txt`.

    Raises:
        DriveError: The folder is no drive of a town, or the file is no transform.
    """
    file = folder / ORIGIN_FILE
    what = (
        "the 3x4 transform from the drive's world to the town frame, row by row: 12 numbers in one "
        "line, as 'placecell town' writes it, or in three"
    )
    in_three = file.is_file() and len(file.read_bytes().splitlines()) == 3
    table = read_table(file, 4 if in_three else 12, what)
    if table.size != 12:
        raise DriveError(f"{file}: {table.size} numbers; it must hold {what}")
    origin = as_transforms(table.reshape(1, 12))
    check_rotations(origin, file)
    return np.asarray(origin[0])
