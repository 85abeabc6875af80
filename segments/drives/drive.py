"""A drive: a sequence of LiDAR scans, each with the sensor's pose."""

import hashlib
from abc import ABC, abstractmethod
from pathlib import Path
from typing import ClassVar

import numpy as np

from segments.types import Float32, Float64


class DriveError(ValueError):
    """A drive that cannot be read; the message names the file and what to do."""


class Drive(ABC):
    """A sequence of scans with sensor poses, times and hashes.

    Attributes:
        folder: where the drive lies.
        scan_files: one Velodyne file a scan: float32 x, y, z, reflectance; metres, sensor frame.
        poses: sensor-to-world transforms, float64 (scans, 4, 4); the world is z-up, and its origin
            is the sensor at the first scan: clouds are float32, which is half a metre coarse at
            map coordinates of 5,000 km.
        origin: where the world's origin lies in the frame of the file's poses, float64 (3,).
        times: seconds, float64 (scans,).
    """

    name: ClassVar[str]
    layout: ClassVar[str]

    folder: Path
    scan_files: list[Path]
    poses: Float64
    origin: Float64
    times: Float64

    @classmethod
    @abstractmethod
    def recognises(cls, folder: Path) -> bool:
        """Whether the folder has this layout."""

    def __len__(self) -> int:
        return len(self.scan_files)

    def scan(self, index: int) -> Float32:
        """Points of one scan, float32 (n, 3), metres, sensor frame.

        Raises:
            DriveError: the file is cut short, or holds a value that is not finite.
        """
        return read_velodyne(self.scan_files[index])

    def scan_hash(self, index: int) -> str:
        """SHA-256 of a scan's file, shortened to 16 hex digits: a scan's identity."""
        return hashlib.sha256(self.scan_files[index].read_bytes()).hexdigest()[:16]

    def path_length(self) -> float:
        """Metres driven."""
        return float(np.linalg.norm(np.diff(self.poses[:, :3, 3], axis=0), axis=1).sum())


def read_velodyne(file: Path) -> Float32:
    """Read a KITTI Velodyne file: float32 (n, 3), metres, sensor frame.

    Raises:
        DriveError: missing, empty, cut short, or with values that are not finite.
    """
    try:
        values = np.fromfile(file, dtype="<f4")
    except OSError as error:
        raise DriveError(f"{file}: cannot be read ({error.strerror})") from error
    if file.stat().st_size % 16:
        raise DriveError(
            f"{file}: {file.stat().st_size} bytes is no whole number of points "
            "(16 bytes each: float32 x, y, z, reflectance); it is cut short or of another kind"
        )
    if values.size == 0:
        raise DriveError(f"{file}: holds no points")
    points = np.ascontiguousarray(values.reshape(-1, 4)[:, :3])
    if not np.isfinite(points).all():
        bad = int(np.count_nonzero(~np.isfinite(points).all(axis=1)))
        raise DriveError(f"{file}: {bad} of {len(points)} points are not finite (NaN or infinity)")
    return points


def find_scans(folder: Path) -> list[Path]:
    """Velodyne files of a folder, in the order of their numbers, which may have gaps.

    Raises:
        DriveError: there are none, or one has a name that is no number.
    """
    files = sorted(folder.glob("*.bin"))
    if not files:
        raise DriveError(f"{folder}: holds no scans (*.bin)")
    if not all(file.stem.isdecimal() for file in files):
        odd = next(file for file in files if not file.stem.isdecimal())
        raise DriveError(f"{odd}: a scan's name must be its number, such as 000000.bin")
    # By number, not by name: 10.bin comes after 9.bin.
    return sorted(files, key=lambda file: int(file.stem))


def read_table(file: Path, columns: int, what: str) -> Float64:
    """Read a text file of numbers, `columns` a line: float64 (lines, columns).

    Raises:
        DriveError: missing, unreadable as numbers, of another width, or not finite.
    """
    try:
        lines = file.read_text().splitlines()
    except FileNotFoundError as error:
        raise DriveError(f"{file}: missing; it must hold {what}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise DriveError(f"{file}: cannot be read ({error})") from error
    rows = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            row = [float(value) for value in line.split()]
        except ValueError as error:
            raise DriveError(f"{file}, line {number}: {error}; it must hold {what}") from error
        if len(row) != columns:
            raise DriveError(f"{file}, line {number}: {len(row)} values; it must hold {what}")
        rows.append(row)
    table = np.array(rows, dtype=np.float64).reshape(-1, columns)
    if not np.isfinite(table).all():
        raise DriveError(f"{file}: a value is not finite (NaN or infinity)")
    return table


def check_rotations(poses: Float64, file: Path) -> None:
    """Refuse poses whose rotation part is no rotation (a sign of another file format).

    Raises:
        DriveError: some rotation is not orthonormal to within 1e-3, or is a reflection.
    """
    rotation = poses[:, :3, :3]
    off = np.abs(rotation @ rotation.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    off = np.maximum(off, np.where(np.linalg.det(rotation) > 0, 0.0, 2.0))
    if (off > 1e-3).any():
        raise DriveError(f"{file}, pose {int(off.argmax())}: its left 3x3 block is no rotation")
