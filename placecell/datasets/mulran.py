"""The layout of MulRan: Ouster/STAMP.bin and global_pose.csv (Kim et al. 2020)."""

import warnings
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64, Int64
from placecell.datasets.drive import Drive, check_motion, find_scans
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import current_scan_options
from placecell.trajectories.interpolation import interpolate, lies_between
from placecell.trajectories.poses import as_transforms, check_rotations

POSES = "global_pose.csv"

LARGEST_GAP = 0.2
"""Largest time between two poses that a scan's pose is interpolated from, seconds."""


def base_to_ouster() -> Float64:
    """Return the sensor's pose on the vehicle (4, 4), of MulRan's calib_base2ouster.txt."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("xyz", (0.0001, 0.0003, 179.6654), degrees=True).as_matrix()
    pose[:3, 3] = (1.7042, -0.021, 1.8047)
    return pose


class MulRan(Drive):
    """A sequence of MulRan, such as KAIST01: an OS1-64 on a car.

    `global_pose.csv` has the vehicle's poses at 100 Hz: the time in nanoseconds and a 3x4 matrix in
    UTM coordinates. The name of a scan is its time. A scan's pose is interpolated; a scan without a
    pose before and after it is left out. Scans are not deskewed.
    """

    name = "MulRan"
    layout = "Ouster/*.bin, global_pose.csv"
    scan_folder = "Ouster"
    georeferenced = True

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        files = find_scans(folder / "Ouster")
        stamps = np.array([int(file.stem) for file in files])
        pose_file = folder / POSES
        pose_stamps, vehicle = read_poses(pose_file)
        seconds, at = (pose_stamps - pose_stamps[0]) * 1e-9, (stamps - pose_stamps[0]) * 1e-9
        known = lies_between(at, seconds, LARGEST_GAP)
        if not known.any():
            raise DriveError(
                f"{pose_file}: no scan of {folder / 'Ouster'} lies between two of its poses. The "
                "file is of another sequence, or its times are not nanoseconds"
            )
        if not known.all():
            current_scan_options().tell(
                f"{folder}: {int((~known).sum())} of {len(files)} scans have no pose in "
                f"{POSES}; they are left out"
            )
        self.scan_files = [file for file, there in zip(files, known, strict=True) if there]
        stamps = stamps[known]
        poses = interpolate(at[known], seconds, vehicle) @ base_to_ouster()
        self.origin = poses[0, :3, 3].copy()
        poses[:, :3, 3] -= self.origin
        self.poses = poses
        self.times = (stamps - stamps[0]) * 1e-9
        for remark in check_motion(poses, self.times, pose_file, folder / "Ouster"):
            current_scan_options().tell(remark)
        self.examine()

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        return (folder / "Ouster").is_dir() and (folder / POSES).is_file()


def read_poses(file: Path) -> tuple[Int64, Float64]:
    """Read the times, int64 (n,) nanoseconds, and the poses, float64 (n, 4, 4), ordered by time.

    Raises:
        DriveError: the file cannot be read as such.
    """
    what = "a time in nanoseconds and a 3x4 matrix a line: 13 numbers with commas between them"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # An empty file is refused below.
            table = np.loadtxt(file, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise DriveError(f"{file}: {error}; it must hold {what}") from error
    if table.shape[1] != 13 or not np.isfinite(table).all():
        raise DriveError(f"{file}: it must hold {what}, and all of them finite")
    # A float64 has steps of 256 ns at these times.
    stamps, first = np.unique(table[:, 0].astype(np.int64), return_index=True)
    poses = as_transforms(table[first, 1:])
    check_rotations(poses, file)
    return stamps, poses
