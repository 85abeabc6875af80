"""The KITTI raw layout: velodyne_points/data/*.bin and oxts/data/*.txt (GPS and inertial)."""

from datetime import datetime
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.text_files import read_lines
from placecell.core.types import Float64
from placecell.datasets.drive import Drive, check_motion, find_scans, read_table
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import current_scan_options
from placecell.trajectories.poses import check_rotations

EARTH_RADIUS = 6_378_137.0
"""Equatorial radius of WGS 84, meters, as in KITTI's development kit."""

OXTS_COLUMNS = 30


class KittiRaw(Drive):
    """A synchronized drive of KITTI raw (`2011_09_30_drive_0018_sync`).

    Poses come from `oxts` by the Mercator projection of KITTI's development kit
    (`convertOxtsToPose.m`). `calib_imu_to_velo.txt`, in the drive's folder or in its parent (the
    date), transforms them from the inertial unit to the sensor. The world is the sensor's frame at
    the first scan.
    """

    name = "KITTI raw"
    layout = "velodyne_points/data/*.bin, oxts/data/*.txt, calib_imu_to_velo.txt"
    scan_folder = "velodyne_points"

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.scan_files = find_scans(folder / "velodyne_points" / "data")
        # Some drives lack a few scans (2011_09_26_drive_0009): each scan's *number* needs an oxts
        # file.
        oxts_files = [folder / "oxts" / "data" / f"{file.stem}.txt" for file in self.scan_files]
        rows = []
        for file in oxts_files:
            table = read_table(file, OXTS_COLUMNS, "the oxts record of its scan: 30 numbers")
            if len(table) != 1:
                raise DriveError(f"{file}: {len(table)} records; there must be one")
            rows.append(table[0])
        records = np.stack(rows)
        check_oxts(records, oxts_files)
        inertial = oxts_to_poses(records)
        inertial_to_sensor = read_rigid_calibration(find_calibration(folder))
        poses = inertial @ np.linalg.inv(inertial_to_sensor)
        self.origin = np.zeros(3)
        self.poses = np.linalg.inv(poses[0]) @ poses
        self.times = read_timestamps(
            folder / "velodyne_points" / "timestamps.txt",
            [int(file.stem) for file in self.scan_files],
        )
        remarks = check_motion(
            self.poses,
            self.times,
            folder / "oxts" / "data",
            folder / "velodyne_points" / "timestamps.txt",
        )
        for remark in remarks:
            current_scan_options().tell(remark)
        self.examine()

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        return (folder / "velodyne_points" / "data").is_dir()


def check_oxts(records: Float64, files: list[Path]) -> None:
    """Check that positions are in degrees and orientations in radians.

    Raises:
        DriveError: A latitude, longitude or angle is out of range.
    """
    ranges = (
        ("latitude", 90.0, "degrees, at most 90"),
        ("longitude", 180.0, "degrees, at most 180"),
        ("altitude", 1e5, "meters"),
        ("roll", 2 * np.pi, "radians; this looks like degrees"),
        ("pitch", 2 * np.pi, "radians; this looks like degrees"),
        ("yaw", 2 * np.pi + 0.1, "radians; this looks like degrees"),
    )
    for column, (name, most, expected) in enumerate(ranges):
        bad = np.abs(records[:, column]) > most
        if bad.any():
            at = int(bad.argmax())
            raise DriveError(
                f"{files[at]}: its {name} is {records[at, column]:g}; expected {expected}"
            )


def oxts_to_poses(records: Float64) -> Float64:
    """Return inertial-unit-to-world transforms (n, 4, 4) of oxts records (n, 30).

    The Mercator projection uses the first record's latitude. The rotation is R_z(yaw) R_y(pitch)
    R_x(roll). World frame: x east, y north, z up.
    """
    latitude, longitude, altitude, roll, pitch, yaw = records[:, :6].T
    scale = np.cos(np.radians(latitude[0]))
    east = scale * EARTH_RADIUS * np.radians(longitude)
    north = scale * EARTH_RADIUS * np.log(np.tan(np.pi / 4 + np.radians(latitude) / 2))
    poses = np.tile(np.eye(4), (len(records), 1, 1))
    poses[:, :3, :3] = Rotation.from_euler("ZYX", np.stack([yaw, pitch, roll], axis=1)).as_matrix()
    poses[:, :3, 3] = np.stack([east, north, altitude], axis=1)
    return poses


def find_calibration(folder: Path) -> Path:
    """Return the drive's `calib_imu_to_velo.txt`, from its folder or from its date's folder.

    Raises:
        DriveError: The file is missing.
    """
    places = [folder / "calib_imu_to_velo.txt", folder.parent / "calib_imu_to_velo.txt"]
    for file in places:
        if file.exists():
            return file
    raise DriveError(
        f"{places[0]}: missing, and not in {folder.parent} either; it comes with the calibration "
        "archive of the drive's date"
    )


def read_rigid_calibration(file: Path) -> Float64:
    """Read `R` and `T` of a KITTI raw calibration file as a transform, float64 (4, 4).

    Raises:
        DriveError: `R` or `T` is missing or malformed, or `R` is no rotation.
    """
    try:
        entries = {
            key.strip(): values.split()
            for key, colon, values in (
                line.partition(":") for line in read_lines(file, "'R:' and 'T:'")
            )
            if colon
        }
        rotation = np.array(entries["R"], dtype=np.float64).reshape(3, 3)
        translation = np.array(entries["T"], dtype=np.float64).reshape(3)
    except DriveError:
        raise
    except (KeyError, ValueError) as error:
        raise DriveError(f"{file}: needs 'R:' with 9 numbers and 'T:' with 3 ({error})") from error
    transform = np.eye(4)
    transform[:3, :3] = rotation
    transform[:3, 3] = translation
    if not np.isfinite(transform).all():
        raise DriveError(f"{file}: a value is not finite (NaN or infinity)")
    check_rotations(transform[None], file)
    return transform


def read_timestamps(file: Path, numbers: list[int]) -> Float64:
    """Return the time since the first scan of each of these scans, float64 (n,), seconds.

    Raises:
        DriveError: The file is missing or malformed, or has too few lines.
    """
    lines = read_lines(file, "the time of each scan")
    try:
        # Nanoseconds are cut to microseconds, the most that datetime takes.
        stamps = [datetime.fromisoformat(lines[number].strip()[:26]) for number in numbers]
    except (ValueError, IndexError) as error:
        raise DriveError(
            f"{file}: needs a time a scan, such as 2011-09-30 12:40:59.5 ({error})"
        ) from error
    return np.array([(stamp - stamps[0]).total_seconds() for stamp in stamps])
