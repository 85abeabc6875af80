"""A drive: a sequence of LiDAR scans, each with the sensor's pose."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from placecell.core.text_files import read_lines
from placecell.core.types import Float32, Float64
from placecell.odometry.deskew import SensorMotion, deskew
from placecell.sources.errors import DriveError
from placecell.sources.file_hash import file_hash
from placecell.sources.point_clock import PointClock, find_clock
from placecell.sources.point_layout import KITTI, PointLayout, find_layout, implausible
from placecell.sources.point_times import split_name
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import ScanOptions, current_scan_options
from placecell.trajectories.times import TimeUnit

SHOWN = 5
"""Largest number of scans that a message names."""

CLOCK_SCANS = 5
"""Number of scans that tell the clock of the points' times."""


@dataclass(slots=True)
class Dropouts:
    """Scans and points of a drive that could not be used.

    Attributes:
        skipped: why, of each scan that gives no points.
        dropped: how many points were not finite, of each other scan that had any.
    """

    skipped: dict[int, str] = field(default_factory=dict)
    dropped: dict[int, int] = field(default_factory=dict)

    def within(self, scans: range) -> tuple[tuple[int, ...], int]:
        """Return the indices of these scans that were skipped, and how many points were dropped."""
        skipped = tuple(sorted(index for index in self.skipped if index in scans))
        return skipped, sum(count for index, count in self.dropped.items() if index in scans)


class Drive(ABC):
    """A sequence of scans with sensor poses, times and hashes.

    Attributes:
        folder: folder of the drive.
        scan_files: file of each scan's points.
        poses: sensor-to-world transforms, float64 (scans, 4, 4). The world frame is z-up, and its
            origin is the sensor at the first scan: float32 points have a resolution of only half a
            meter at map coordinates of 5,000 km.
        origin: world origin in the frame of the file's poses, float64 (3,), meters.
        times: time of each scan, float64 (scans,), seconds.
        options: options for reading the files.
        point_layout: layout of the scan files.
        georeferenced: whether all drives of a place share the frame of the file's poses, such as
            UTM coordinates.
    """

    name: ClassVar[str]
    layout: ClassVar[str]
    scan_folder: ClassVar[str] = ""
    """Folder inside the drive's folder that a reader of scans alone opens."""

    folder: Path
    scan_files: list[Path]
    poses: Float64
    origin: Float64
    times: Float64
    options: ScanOptions = ScanOptions()
    point_layout: PointLayout = KITTI
    georeferenced: bool = False

    @classmethod
    @abstractmethod
    def recognizes(cls, folder: Path) -> bool:
        """Return whether the folder has this layout."""

    @classmethod
    def has_poses(cls, folder: Path) -> bool:  # noqa: ARG003
        """Return whether a folder of this layout has the drive's poses."""
        return True

    def __len__(self) -> int:
        return len(self.scan_files)

    @property
    def covariances(self) -> Float64 | None:
        """Covariance of each scan's pose, float64 (scans, 6, 6) (`Trajectory.covariances`)."""
        return None

    def scan_name(self, index: int) -> str:
        """Return the name of a scan in messages about the drive."""
        return self.scan_files[index].name

    def scan_path(self, index: int) -> str:
        """Return the file of a scan in messages, or its number in the drive's file."""
        return str(self.scan_files[index])

    @property
    def title(self) -> str:
        """Name of the drive in recordings and reports."""
        return self.folder.name

    @cached_property
    def dropouts(self) -> Dropouts:
        """Dropouts of the scans that were read so far."""
        return Dropouts()

    def examine(self) -> None:
        """Find the layout of the scans and report what their sizes show, before any work begins.

        Raises:
            DriveError: the layout is not sure, most scans cannot be used, or one cannot and the
                options are strict.
        """
        self.options = current_scan_options()
        sizes = [size_of(file) for file in self.scan_files]
        self.point_layout = find_layout(self.scan_files, sizes, self.options)
        if self.point_layout.columns != KITTI.columns or self.point_layout.dtype != KITTI.dtype:
            how = "as stated" if self.options.states_layout else "found from their values"
            self.options.tell(f"{self.folder}: scans have {self.point_layout}, {how}")
        self.tell_clock()
        self.check_sizes([self.point_layout.point_bytes] * len(sizes), sizes)

    def tell_clock(self) -> None:
        """Tell whether points have times, and whether the scans are deskewed by them."""
        if self.clock is not None:
            done = "deskewed by the poses" if self.options.deskew else "not deskewed, as stated"
            self.options.tell(
                f"{self.folder}: points have times ({self.clock}); the scans are {done}"
            )

    def check_sizes(self, point_bytes: Sequence[int], sizes: Sequence[int]) -> None:
        """Skip the scans whose size shows that they cannot be used.

        Args:
            point_bytes: bytes of a point, per scan.
            sizes: bytes of each scan file; -1 if it cannot be read.

        Raises:
            DriveError: most scans cannot be used, or one cannot and the options are strict.
        """
        for index, (each, size) in enumerate(zip(point_bytes, sizes, strict=True)):
            if size <= 0 or size % each:
                self.skip(index, size_problem(size))
        self.check_usable(range(len(self)))
        if self.dropouts.skipped:
            self.options.tell(f"{self.folder}: {self.summary(range(len(self)))}")

    def scan(self, index: int) -> Float32:
        """Return the points of a scan, float32 (n, 3), meters, sensor frame; none if unusable.

        Points that are not finite are dropped, and beams without an echo (0, 0, 0). `dropouts`
        counts the former, and unusable scans.

        Raises:
            DriveError: the options are strict, and the scan cannot be used or has points that are
                not finite.
        """
        try:
            scan = self.read_scan(index)
            check_points(scan, self.scan_path(index))
        except DriveError as error:
            why = str(error).removeprefix(f"{self.scan_path(index)}: ")
            self.skip(index, why.removeprefix(f"{self.folder}: "))
            return np.zeros((0, 3), np.float32)
        if scan.not_finite:
            if self.options.strict:
                raise DriveError(
                    f"{self.scan_path(index)}: {scan.not_finite} of {scan.read} points are not "
                    "finite (NaN or infinity). Without --strict they are dropped"
                )
            self.dropouts.dropped[index] = scan.not_finite
        if scan.times is None:
            return scan.points
        return self.deskewed(scan.points, scan.times, index)

    def read_scan(self, index: int) -> LidarScan:
        """Read a scan, with times relative to the drive's time of the scan if it is deskewed.

        Raises:
            DriveError: the scan is missing, unreadable, empty or cut short.
        """
        points = self.read_points(index)
        times = self.read_times(index) if self.options.deskew else None
        return LidarScan.of(points, times, float(self.times[index]))

    @cached_property
    def motion(self) -> SensorMotion | None:
        """Motion of the sensor; None if the times of the scans do not ascend."""
        return SensorMotion.of(self.times, self.poses)

    def deskewed(self, points: Float32, times: Float64, index: int) -> Float32:
        """Return points that are moved to the time of their scan.

        Args:
            points: float32 (n, 3), meters, sensor frame.
            times: float64 (n,), relative to the scan's, seconds.
            index: index of the scan.
        """
        stamp = float(self.times[index])
        if self.motion is None or not len(points):
            return points
        if not self.motion.covers(stamp + float(times.min()), stamp + float(times.max())):
            return points
        return deskew(points, times, stamp, self.motion)

    def read_points(self, index: int) -> Float32:
        """Read the points of a scan file, float32 (n, 3), meters; values may be not finite.

        Raises:
            DriveError: the file is missing, unreadable, empty or cut short.
        """
        return self.point_layout.read(self.scan_files[index])

    def read_times(self, index: int) -> Float64 | None:
        """Read the time of each point of a scan file, relative to the scan's, seconds, or None.

        Raises:
            DriveError: the file is missing, unreadable, empty or cut short.
        """
        if self.time_field is None or self.clock is None:
            return None
        return self.clock.seconds(self.raw_times(index), round(float(self.times[index]) * 1e9))

    @property
    def time_field(self) -> str | None:
        """Name of the values that are the points' times; None if the scans have none."""
        column = self.point_layout.time_column
        return None if column is None else self.point_layout.columns[column]

    @property
    def time_unit(self) -> TimeUnit | None:
        """Unit that the name of `time_field` states; None if it states none."""
        return None if self.time_field is None else split_name(self.time_field)[1]

    def raw_times(self, index: int) -> NDArray[Any]:
        """Read the values of `time_field` of a scan file.

        Raises:
            DriveError: the file is missing, unreadable, empty or cut short.
        """
        table = self.point_layout.read_table(self.scan_files[index])
        return table[:, self.point_layout.time_column]

    @cached_property
    def clock(self) -> PointClock | None:
        """Clock of the points' times, found from several scans; None if there is none."""
        if self.time_field is None:
            return None
        samples = []
        for index in np.unique(np.linspace(0, len(self) - 1, CLOCK_SCANS).astype(int)).tolist():
            with suppress(DriveError):  # The scan is skipped when it is read.
                samples.append((self.raw_times(index), round(float(self.times[index]) * 1e9)))
        period = float(np.median(np.diff(self.times))) if len(self) > 1 else None
        return find_clock(samples, period, self.time_unit)

    @property
    def content(self) -> str:
        """Content of a scan's file, for messages."""
        return str(self.point_layout)

    def skip(self, index: int, why: str) -> None:
        """Record that a scan cannot be used.

        Raises:
            DriveError: the options are strict.
        """
        if self.options.strict:
            raise DriveError(f"{self.scan_path(index)}: {why}. Without --strict it is skipped")
        self.dropouts.skipped[index] = why

    def check_usable(self, scans: range) -> None:
        """Refuse a drive if more than half of these scans cannot be used.

        Raises:
            DriveError: More than half of the scans cannot be used.
        """
        skipped, _ = self.dropouts.within(scans)
        if 2 * len(skipped) > len(scans):
            raise DriveError(
                f"{self.folder}: {self.summary(scans)}. Over half of the scans cannot be used. "
                "The folder is incomplete, or the scans have another layout (--columns, --dtype)"
            )

    def summary(self, scans: range) -> str:
        """Summarize the skipped scans, with reasons, and the dropped points."""
        skipped, dropped = self.dropouts.within(scans)
        words = []
        if skipped:
            some = ", ".join(
                f"{self.scan_name(index)}: {self.dropouts.skipped[index]}"
                for index in skipped[:SHOWN]
            )
            more = f", and {len(skipped) - SHOWN} more" if len(skipped) > SHOWN else ""
            words.append(f"{len(skipped)} of {len(scans)} scans skipped ({some}{more})")
        if dropped:
            words.append(f"{dropped:,} points dropped (NaN or infinity)")
        return "; ".join(words)

    def scan_hash(self, index: int) -> str:
        """Return a scan's identity (see `file_hash`)."""
        return file_hash(self.scan_files[index], self.folder.name)

    def path_length(self) -> float:
        """Return the length of the path, meters."""
        return float(np.linalg.norm(np.diff(self.poses[:, :3, 3], axis=0), axis=1).sum())


def size_of(file: Path) -> int:
    """Return a file's size in bytes; -1 if it cannot be read."""
    try:
        return file.stat().st_size if file.is_file() else -1
    except OSError:
        return -1


def size_problem(size: int) -> str:
    """Return why a file of this size cannot be used."""
    if size < 0:
        return "missing or not a file"
    return f"{size} bytes is no whole number of points" if size else "no points (0 bytes)"


def check_points(scan: LidarScan, name: str) -> None:
    """Refuse a scan without usable points.

    Raises:
        DriveError: no point is left, or most values are no coordinates.
    """
    if not len(scan.points):
        if not scan.read:
            raise DriveError(f"{name}: holds no points")
        raise DriveError(
            f"{name}: all {scan.read} points are not finite (NaN or infinity) or lie at (0, 0, 0), "
            "where beams without an echo are"
        )
    if implausible(scan.points) > 0.4:
        raise DriveError(
            f"{name}: most values are not coordinates; the file is damaged or of another kind"
        )


def read_velodyne(file: Path) -> Float32:
    """Read a KITTI Velodyne file: float32 (n, 3), meters, sensor frame.

    Raises:
        DriveError: missing, empty, cut short, or with values that are not finite.
    """
    points = KITTI.read(file)
    if not np.isfinite(points).all():
        bad = int(np.count_nonzero(~np.isfinite(points).all(axis=1)))
        raise DriveError(f"{file}: {bad} of {len(points)} points are not finite (NaN or infinity)")
    return points


def find_scans(folder: Path) -> list[Path]:
    """Return the Velodyne files of a folder, ordered by number. Numbers may be missing.

    Raises:
        DriveError: The folder has no scans, or a file's name is no number.
    """
    files = sorted(folder.glob("*.bin"))
    if not files:
        raise DriveError(f"{folder}: holds no scans (*.bin)")
    if not all(file.stem.isdecimal() for file in files):
        odd = next(file for file in files if not file.stem.isdecimal())
        raise DriveError(f"{odd}: a scan's name must be its number, such as 000000.bin")
    # By number, not by name: 10.bin comes after 9.bin.
    return sorted(files, key=lambda file: int(file.stem))


WIDTHS = {
    7: "position and quaternion",
    8: "a TUM trajectory: time, position, quaternion",
    16: "4x4 matrices",
}
"""Pose tables of other programs, by the count of numbers per line."""


def read_table(file: Path, columns: int, what: str) -> Float64:
    """Read a text file of numbers, `columns` a line: float64 (lines, columns).

    Raises:
        DriveError: missing, unreadable as numbers, of another width, or not finite.
    """
    rows = []
    for number, line in enumerate(read_lines(file, what), start=1):
        if not line.strip():
            continue
        try:
            row = [float(value) for value in line.split()]
        except ValueError as error:
            raise DriveError(f"{file}, line {number}: {error}; it must hold {what}") from error
        if len(row) != columns:
            looks = ""
            if columns == 12 and len(row) in WIDTHS:
                looks = f" (as of {WIDTHS[len(row)]}; convert it, for example with 'evo_traj')"
            raise DriveError(
                f"{file}, line {number}: {len(row)} values{looks}; it must hold {what}"
            )
        rows.append(row)
    table = np.array(rows, dtype=np.float64).reshape(-1, columns)
    if not np.isfinite(table).all():
        bad = int(np.flatnonzero(~np.isfinite(table).all(axis=1))[0])
        raise DriveError(f"{file}: a value is not finite (NaN or infinity), first in row {bad}")
    return table


def check_motion(poses: Float64, times: Float64, pose_file: Path, time_file: Path) -> list[str]:
    """Check the units of poses and times; return remarks on odd but possible values.

    Raises:
        DriveError: times are no seconds, most of them are equal, or the sensor would be faster than
            anything that drives.
    """
    if len(poses) < 2:
        return []
    steps = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
    waits = np.diff(times)
    wait, step = float(np.median(waits)), float(np.median(steps))
    slow = wait >= 10 and step >= 0.05 and step / wait < 0.05
    if wait > 1e4 or np.abs(times).max() > 1e11 or slow:
        units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3}
        unit = next((one for one, size in units.items() if wait * size >= 0.005), "ms")
        if np.abs(times).max() > 1e11 and wait < 1e4:
            unit = next((one for one, size in LARGEST_TIMES if np.abs(times).max() > size), "ms")
        name = {"ns": "nanoseconds", "us": "microseconds", "ms": "milliseconds"}[unit]
        raise DriveError(
            f"{time_file}: {wait:,.6g} between two scans (median), so the times are likely {name}, "
            f"not seconds. State --time-unit {unit}, or convert the file to seconds"
        )
    if wait == 0:
        raise DriveError(
            f"{time_file}: {np.count_nonzero(waits == 0)} of {len(times)} scans have the time "
            f"of the scan before ({times[int((waits == 0).argmax())]:.6g}). Each scan needs its "
            "own time in seconds: correct the times, or the messages that the recorder repeated"
        )
    remarks = []
    moving = steps > 0.02
    if moving.any() and wait > 0:
        timed = moving & (waits > 0)
        speed = float(np.median(steps[timed] / waits[timed])) if timed.any() else 0.0
        if speed > FASTEST:
            raise DriveError(
                f"{pose_file}: {speed:,.0f} m/s between scans (median), faster than any vehicle: "
                f"the poses are not in meters (millimeters?), or {time_file.name} is not in seconds"
            )
    if (waits < 0).any():
        first = int((waits < 0).argmax()) + 1
        remarks.append(f"{time_file}: time decreases at scan {first}")
    climbed = float(np.abs(np.diff(poses[:, 2, 3])).sum())
    if steps.sum() > 10 and climbed > 0.7 * steps.sum():
        remarks.append(
            f"{pose_file}: the drive moves more vertically than horizontally, so the world's z may "
            "not be up. Check whether these are camera poses without the Tr to the sensor"
        )
    return remarks


LARGEST_TIMES = (("ns", 1e17), ("us", 1e14))
"""Units whose Unix times are above a value, when the times between scans do not tell."""

FASTEST = 400.0
"""Highest plausible speed, m/s; in millimeters a walk of 1 m/s gives 1,000."""
