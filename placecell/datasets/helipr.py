"""The layout of HeLiPR (Jung et al. 2024): LiDAR/SENSOR/STAMP.bin and LiDAR_GT/*SENSOR_gt.txt."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from placecell.core.types import Float32
from placecell.datasets.drive import Drive, check_motion, find_scans, read_table, size_of
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import current_scan_options
from placecell.trajectories.times import TimeUnit

XYZ = [("x", "<f4"), ("y", "<f4"), ("z", "<f4")]

RECORDS: dict[str, np.dtype[np.void]] = {
    "Ouster": np.dtype(
        [
            *XYZ,
            ("intensity", "<f4"),
            ("t", "<u4"),
            ("reflectivity", "<u2"),
            ("ring", "<u2"),
            ("ambient", "<u2"),
        ]
    ),
    "Velodyne": np.dtype([*XYZ, ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")]),
    "Avia": np.dtype(
        [*XYZ, ("reflectivity", "u1"), ("tag", "u1"), ("line", "u1"), ("offset_time", "<u4")]
    ),
    "Aeva": np.dtype(
        [
            *XYZ,
            ("reflectivity", "<f4"),
            ("velocity", "<f4"),
            ("time_offset_ns", "<i4"),
            ("line_index", "u1"),
            ("intensity", "<f4"),
        ]
    ),
}
"""Packed values of a point, per sensor."""

TIME_FIELDS = {
    "Ouster": "t",
    "Velodyne": "time",
    "Avia": "offset_time",
    "Aeva": "time_offset_ns",
}
"""Time of a point from the time of its scan, per sensor: nanoseconds, of the Velodyne seconds."""

EARLY_AEVA = np.dtype([each for each in RECORDS["Aeva"].descr if each[0] != "intensity"])
LAST_EARLY_AEVA = 1_691_936_557_946_849_179
"""Scans of the Aeva up to this time, nanoseconds, have no intensity."""

POSE = "a time in nanoseconds, a position and a quaternion a line: t x y z qx qy qz qw"


class HeLiPR(Drive):
    """One sensor of a sequence of HeLiPR, such as Town01/LiDAR/Ouster.

    The sensors are Ouster (OS2-128), Velodyne (VLP-16), Avia and Aeva. The name of a scan is its
    time. The poses are the sensor's, in UTM coordinates in `global_SENSOR_gt.txt`, else in the
    sequence's own frame in `SENSOR_gt.txt`. A scan without a pose is left out. Scans are
    deskewed by the times of their points.
    """

    name = "HeLiPR"
    layout = "SEQUENCE/LiDAR/SENSOR/*.bin, SEQUENCE/LiDAR_GT/[global_]SENSOR_gt.txt"

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        if folder.name not in RECORDS:
            raise DriveError(
                f"{folder}: not a sensor of HeLiPR. Expected a folder {', '.join(RECORDS)}"
            )
        truth = folder.parent.parent / "LiDAR_GT"
        pose_file = truth / f"global_{folder.name}_gt.txt"
        self.georeferenced = pose_file.is_file()
        if not self.georeferenced:
            pose_file = truth / f"{folder.name}_gt.txt"
        table = read_table(pose_file, 8, POSE)
        files = find_scans(folder)
        # Both sides are rounded alike: a float64 has steps of 256 ns at these times.
        row_of = {stamp: row for row, stamp in enumerate(table[:, 0].tolist())}
        rows = [row_of.get(float(int(file.stem)), -1) for file in files]
        self.scan_files = [file for file, row in zip(files, rows, strict=True) if row >= 0]
        if not self.scan_files:
            raise DriveError(f"{pose_file}: no scan of {folder} has a pose with its time")
        if missing := rows.count(-1):
            current_scan_options().tell(
                f"{folder}: {missing} of {len(files)} scans have no pose in {pose_file.name}; they "
                "are left out"
            )
        chosen = table[[row for row in rows if row >= 0]]
        norms = np.linalg.norm(chosen[:, 4:], axis=1)
        if (np.abs(norms - 1) > 1e-2).any():
            raise DriveError(f"{pose_file}: a quaternion has no length of 1; it must hold {POSE}")
        poses = np.tile(np.eye(4), (len(chosen), 1, 1))
        poses[:, :3, :3] = Rotation.from_quat(chosen[:, 4:]).as_matrix()
        self.origin = chosen[0, 1:4].copy()
        poses[:, :3, 3] = chosen[:, 1:4] - self.origin
        self.poses = poses
        stamps = np.array([int(file.stem) for file in self.scan_files])
        self.times = (stamps - stamps[0]) * 1e-9
        for remark in check_motion(poses, self.times, pose_file, folder):
            current_scan_options().tell(remark)
        self.options = current_scan_options()
        sizes = [size_of(file) for file in self.scan_files]
        self.check_sizes([self.record_of(index).itemsize for index in range(len(self))], sizes)
        self.tell_clock()

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        return folder.parent.name == "LiDAR" and (folder.parent.parent / "LiDAR_GT").is_dir()

    @property
    def title(self) -> str:
        """Name of the sequence and of the sensor, such as Town01-Ouster."""
        return f"{self.folder.parent.parent.name}-{self.folder.name}"

    def record_of(self, index: int) -> np.dtype[np.void]:
        """Return the values of a point of a scan."""
        file = self.scan_files[index]
        early = self.folder.name == "Aeva" and int(file.stem) <= LAST_EARLY_AEVA
        return EARLY_AEVA if early else RECORDS[self.folder.name]

    def read_points(self, index: int) -> Float32:
        """Read the points of a scan file, float32 (n, 3), meters; values may be not finite."""
        points = self.read_records(index)
        return np.stack([points[axis] for axis in "xyz"], axis=1)

    @property
    def time_field(self) -> str:
        return TIME_FIELDS[self.folder.name]

    @property
    def time_unit(self) -> TimeUnit:
        return "s" if self.folder.name == "Velodyne" else "ns"

    def raw_times(self, index: int) -> NDArray[Any]:
        return self.read_records(index)[self.time_field]

    def read_records(self, index: int) -> NDArray[np.void]:
        """Read all values of a scan's points.

        Raises:
            DriveError: the file is missing, unreadable, empty or cut short.
        """
        file, record = self.scan_files[index], self.record_of(index)
        try:
            content = file.read_bytes()
        except OSError as error:
            raise DriveError(f"{file}: cannot be read ({error.strerror})") from error
        if not content or len(content) % record.itemsize:
            raise DriveError(
                f"{file}: {len(content)} bytes is no whole number of points of the "
                f"{self.folder.name} ({record.itemsize} bytes each)"
            )
        return np.frombuffer(content, record)
