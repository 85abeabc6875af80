"""The KITTI odometry layout: velodyne/NNNNNN.bin, poses.txt, calib.txt, times.txt."""

from pathlib import Path

import numpy as np

from placecell.core.text_files import read_lines
from placecell.core.types import Float64
from placecell.datasets.drive import Drive, check_motion, find_scans, read_table
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import current_scan_options
from placecell.trajectories.extrinsic import describe_extrinsic, parse_extrinsic
from placecell.trajectories.poses import as_transforms, check_rotations
from placecell.trajectories.times import SECONDS


class KittiOdometry(Drive):
    """A sequence of the KITTI odometry benchmark, or any drive laid out as one.

    `poses.txt` has poses of the left camera. `Tr` of `calib.txt` transforms them to the sensor. If
    the first pose of the file is the identity, the world is the sensor's frame at the first scan:
    x ahead, z up. KITTI has the poses beside the sequences, in `poses/NN.txt`; that file is read
    if the folder has none.
    """

    name = "KITTI odometry"
    layout = "velodyne/*.bin, poses.txt, calib.txt, times.txt"

    def __init__(self, folder: Path, pose_name: str = "poses.txt") -> None:
        """Read poses, calibration and times, and check the sizes of the scans.

        Args:
            folder: folder of the drive.
            pose_name: name of the pose file, for a drive with several.
        """
        self.folder = folder
        self.scan_files = find_scans(folder / "velodyne")
        pose_file = folder / pose_name
        beside = poses_beside(folder)
        if not pose_file.exists() and beside.exists():
            pose_file = beside
        camera = read_table(pose_file, 12, "a 3x4 pose a line, row by row: 12 numbers")
        self.scan_files = with_missing(self.scan_files, len(camera))
        if len(camera) != len(self.scan_files):
            raise DriveError(
                f"{pose_file}: {len(camera)} poses for {len(self.scan_files)} scans in "
                f"{folder / 'velodyne'}; there must be one a scan"
            )
        camera_poses = as_transforms(camera)
        check_rotations(camera_poses, pose_file)
        options = current_scan_options()
        if options.extrinsic is None:
            sensor_to_camera = read_calibration(folder / "calib.txt")
        else:
            sensor_to_camera = parse_extrinsic(options.extrinsic)
            mount = describe_extrinsic(sensor_to_camera)
            options.tell(f"{folder}: the sensor is mounted at {mount}, as stated")
        poses = np.linalg.inv(sensor_to_camera) @ camera_poses @ sensor_to_camera
        self.origin = poses[0, :3, 3].copy()
        poses[:, :3, 3] -= self.origin
        self.poses = poses
        time_file = folder / "times.txt"
        self.times = read_table(time_file, 1, "a time in seconds a line")[:, 0]
        if len(self.times) != len(self.scan_files):
            raise DriveError(
                f"{time_file}: {len(self.times)} times for {len(self.scan_files)} scans"
            )
        if options.time_unit != "s":
            self.times = (self.times - self.times[0]) * SECONDS[options.time_unit]
        for remark in check_motion(self.poses, self.times, pose_file, time_file):
            options.tell(remark)
        self.examine()

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        return (folder / "velodyne").is_dir()

    @classmethod
    def has_poses(cls, folder: Path) -> bool:
        return (folder / "poses.txt").exists() or poses_beside(folder).exists()


def poses_beside(folder: Path) -> Path:
    """Return the file that has the poses of a sequence in KITTI's own archives."""
    return folder.parent.parent / "poses" / f"{folder.name}.txt"


def with_missing(files: list[Path], poses: int) -> list[Path]:
    """Return the scan files from number 0 on, including missing ones.

    So a missing scan that has a pose is skipped, and the drive remains usable.
    """
    numbers = [int(file.stem) for file in files]
    if len(files) < poses and numbers[0] == 0 and numbers[-1] == poses - 1:
        there = dict(zip(numbers, files, strict=True))
        if len(there) == len(files):
            first = files[0]
            return [
                there.get(number, first.with_name(f"{number:0{len(first.stem)}d}.bin"))
                for number in range(poses)
            ]
    return files


def read_calibration(file: Path) -> Float64:
    """Read `Tr` of a calib.txt: the transform from sensor to left camera, float64 (4, 4).

    Raises:
        DriveError: The file or its `Tr` is missing, or `Tr` is no rigid transform.
    """
    how = (
        "add a line 'Tr: ' with the 12 numbers of the 3x4 transform from the sensor's frame to "
        "the poses' frame (KITTI's is in the calibration archive of the odometry benchmark; "
        "'Tr: 1 0 0 0 0 1 0 0 0 0 1 0' if the poses are the sensor's own)"
    )
    if not file.exists():
        raise DriveError(f"{file}: missing; {how}")
    for line in read_lines(file, "the sensor's calibration"):
        key, _, values = line.partition(":")
        if key.strip() != "Tr":
            continue
        try:
            row = np.array([float(value) for value in values.split()])
        except ValueError as error:
            raise DriveError(f"{file}: Tr: {error}; {how}") from error
        if row.shape != (12,) or not np.isfinite(row).all():
            raise DriveError(f"{file}: Tr must be 12 finite numbers; {how}")
        transform = as_transforms(row[None])
        check_rotations(transform, file)
        return np.asarray(transform[0])
    raise DriveError(
        f"{file}: has no 'Tr' (the image-only archives of KITTI lack it), so the poses cannot be "
        f"moved from the camera to the sensor; {how}"
    )
