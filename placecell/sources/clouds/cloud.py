"""Content of one point cloud file, before it becomes a scan."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float32, Float64
from placecell.sources.errors import DriveError
from placecell.sources.point_times import is_time, point_times
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import METERS, Unit

FAR = 10_000.0
"""Distance of a cloud from the origin from which it is shifted, meters: float32 resolves 1 mm at
10 km, and 6 cm at the coordinates of a map projection (500 km)."""
STEP = 100.0
"""Grid of shifts, meters; round numbers can be written down."""
HEAD = 65_536
"""Longest header, and longest line of text, bytes."""
ALLOWED_GROWTH = 100
"""Largest plausible ratio of a decompressed file; clouds of sensors reach 2 to 25."""
ALWAYS_ALLOWED = 64 * 2**20
"""Decompressed bytes that are allowed at any ratio."""

AXIS = re.compile(
    r"(?:scalar_|//)?(pos(?:ition)?|points?|p|pt|coord(?:inate)?s?|cartesian|)[_.: ]?([xyz])"
    r"(?:_?coord(?:inate)?)?"
)
VELOVIEW = re.compile(r"points(?:_m_xyz)?:([012])")
UNIT = re.compile(r"^(.*?)[ _]*(?:[\[(](m|cm|mm)[\])]|_(m|cm|mm))$")


@dataclass(frozen=True, slots=True)
class Cloud:
    """Values of a file's points.

    Attributes:
        values: an array (n,) for each field that was read; the coordinates are among them.
        fields: names of all fields, in the file's order.
        remarks: what is odd about the file, and how it was read.
    """

    values: Mapping[str, NDArray[Any]]
    fields: tuple[str, ...]
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Axes:
    """Names of the fields that hold x, y and z, and their unit in meters."""

    names: tuple[str, str, str]
    scale: float = 1.0


def find_axes(fields: Sequence[str]) -> Axes | None:
    """Find the coordinates among the names of fields; None if there are none.

    Names such as `X`, `pos_x`, `Points:0`, `//X` and `x [mm]` are understood.
    """
    found: dict[tuple[str, float], dict[str, str]] = {}
    for field in fields:
        plain = field.strip().strip("\"'").strip().lower()
        scale = 1.0
        if match := UNIT.match(plain):
            plain, scale = match[1], METERS[cast(Unit, match[2] or match[3])]
        if match := VELOVIEW.fullmatch(plain):
            prefix, axis = "points:", "xyz"[int(match[1])]
        elif match := AXIS.fullmatch(plain):
            prefix, axis = match[1], match[2]
        else:
            continue
        found.setdefault((prefix, scale), {}).setdefault(axis, field)
    for (_, scale), axes in found.items():
        if len(axes) == 3:
            return Axes((axes["x"], axes["y"], axes["z"]), scale)
    return None


def needed_fields(fields: Sequence[str], file: Path) -> tuple[Axes, list[str]]:
    """Return the coordinates, and the names of the fields that a scan needs: those and times.

    Raises:
        DriveError: a coordinate is missing.
    """
    axes = find_axes(fields)
    if axes is None:
        shown = ", ".join(fields[:20]) or "none"
        raise DriveError(
            f"{file}: the points have no x, y and z; the fields are {shown}. Rename the fields of "
            "the coordinates to x, y and z"
        )
    times = [name for name in fields if is_time(name.removeprefix("scalar_"))]
    return axes, [*axes.names, *(name for name in times if name not in axes.names)]


def find_shift(coordinates: Float64) -> Float64:
    """Return what to subtract from coordinates, float64 (n, 3), so that float32 can hold them.

    Returns:
        Float64 (3,), meters, multiples of 100 m; zeros if the coordinates are small.
    """
    finite = coordinates[np.isfinite(coordinates).all(axis=1)]
    if not len(finite):
        return np.zeros(3)
    middle = np.median(finite, axis=0)
    if np.abs(middle).max() < FAR or not np.isfinite(middle).all():
        return np.zeros(3)
    return np.asarray(np.round(middle / STEP) * STEP)


def as_scan(
    cloud: Cloud, file: Path, stamp: float, scale: float, shift: Float64 | None
) -> tuple[LidarScan, Float64]:
    """Turn the content of a file into a scan.

    Args:
        file: named by errors.
        stamp: time of the scan, seconds; NaN if unknown.
        scale: meters a unit of the coordinates.
        shift: subtracted from the coordinates, meters; None: found from them.

    Returns:
        The scan, and the shift, float64 (3,), meters.

    Raises:
        DriveError: x, y or z is missing, or a field has another length.
    """
    axes, _ = needed_fields(list(cloud.values), file)
    scale *= axes.scale
    columns = [cloud.values[name] for name in axes.names]
    with np.errstate(all="ignore"):
        exact = scale == 1.0 and all(each.dtype.newbyteorder("=") == np.float32 for each in columns)
        if exact and (shift is None or not shift.any()):
            # float32 files have lost what a shift would keep.
            points, shift = stack(columns), np.zeros(3)
        else:
            wide = np.stack([np.asarray(each, np.float64) for each in columns], axis=1) * scale
            shift = find_shift(wide) if shift is None else shift
            points = (wide - shift).astype(np.float32) if shift.any() else wide.astype(np.float32)
        # A point without an echo is at 0; the shift must not turn it into a point.
        if shift.any():
            points[(wide == 0).all(axis=1)] = 0
        usable = np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)
    fields = {name.removeprefix("scalar_"): values for name, values in cloud.values.items()}
    times = point_times(fields, stamp, usable)
    return LidarScan.of(points, times, stamp), shift


def stack(columns: Sequence[NDArray[Any]]) -> Float32:
    """Stack three float32 columns as points (n, 3)."""
    points = np.empty((len(columns[0]), 3), np.float32)
    for axis, column in enumerate(columns):
        points[:, axis] = column
    return points


def read_content(file: Path) -> bytes:
    """Read a file.

    Raises:
        DriveError: missing, unreadable or empty.
    """
    try:
        content = file.read_bytes()
    except OSError as error:
        raise DriveError(f"{file}: cannot be read ({error.strerror})") from error
    if not content:
        raise DriveError(f"{file}: holds no points (0 bytes)")
    return content


def check_growth(file: Path, compressed: int, claimed: int) -> None:
    """Refuse a compressed file that claims to be implausibly large when decompressed.

    Raises:
        DriveError: the claim is over 100 times the file and over 64 MiB.
    """
    if claimed > max(ALLOWED_GROWTH * compressed, ALWAYS_ALLOWED):
        raise DriveError(
            f"{file}: {compressed:,} bytes claim to hold {claimed:,} bytes of points, over "
            f"{ALLOWED_GROWTH} times as many; the file is damaged. Write it again"
        )


def cut_short(file: Path, what: str, found: int, expected: int) -> DriveError:
    """Return the error for a file that ends before its last point."""
    return DriveError(
        f"{file}: cut short: the header states {expected:,} {what}, but the file has {found:,}. "
        "Copy or write the file again"
    )
