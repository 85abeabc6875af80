"""Content of one point cloud file, before it becomes a scan."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, nan
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float32, Float64
from placecell.sources.errors import DriveError
from placecell.sources.point_clock import PointClock, find_clock
from placecell.sources.point_times import is_time, time_fields
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import METERS, Unit
from placecell.trajectories.times import TimeUnit

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
UNIT = re.compile(r"^(.*?)[ _]*(?:[\[(](m|cm|mm|ft)[\])]|_(m|cm|mm|ft))$")


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
class CloudClock:
    """Field that holds the times of points, and its clock."""

    field: str
    clock: PointClock


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
        shown = printable(", ".join(fields[:20]))[:400] or "none"
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
    cloud: Cloud,
    file: Path,
    stamp: float = nan,
    scale: float = 1.0,
    shift: Float64 | None = None,
    clock: CloudClock | None = None,
) -> tuple[LidarScan, Float64]:
    """Turn the content of a file into a scan.

    Args:
        file: named by errors.
        stamp: time of the scan, seconds; NaN if unknown.
        scale: meters a unit of the coordinates.
        shift: subtracted from the coordinates, meters; None: found from them.
        clock: clock of the points' times; None: they have none.

    Returns:
        The scan, and the shift, float64 (3,), meters.

    Raises:
        DriveError: x, y or z is missing, or a field has another length.
    """
    points, shift = positions(cloud, file, scale, shift)
    raw, _ = point_times_of(cloud).get(clock.field, (None, None)) if clock else (None, None)
    scan = LidarScan.of(points, raw, stamp)
    if clock is None or scan.times is None:
        return scan, shift
    with np.errstate(all="ignore"):
        times = clock.clock.seconds(scan.times, nanoseconds(stamp))
    return replace(scan, times=times), shift


def positions(
    cloud: Cloud, file: Path, scale: float = 1.0, shift: Float64 | None = None
) -> tuple[Float32, Float64]:
    """Return all points, float32 (n, 3), meters, and the shift that was subtracted from them.

    Raises:
        DriveError: x, y or z is missing.
    """
    axes, _ = needed_fields(list(cloud.values), file)
    scale *= axes.scale
    columns = [cloud.values[name] for name in axes.names]
    exact = scale == 1.0 and all(each.dtype.newbyteorder("=") == np.float32 for each in columns)
    if exact and (shift is None or not shift.any()):
        # float32 files have lost what a shift would keep.
        points = np.empty((len(columns[0]), 3), np.float32)
        for axis, column in enumerate(columns):
            points[:, axis] = column
        return points, np.zeros(3)
    with np.errstate(all="ignore"):
        wide = np.stack([np.asarray(each, np.float64) for each in columns], axis=1) * scale
        shift = find_shift(wide) if shift is None else shift
        points = (wide - shift).astype(np.float32)
    # A point without an echo is at 0; the shift must not turn it into a point.
    points[(wide == 0).all(axis=1)] = 0
    return points, shift


def point_times_of(cloud: Cloud) -> dict[str, tuple[NDArray[Any], TimeUnit | None]]:
    """Return the fields of a cloud that are times; CloudCompare writes `scalar_` before names."""
    return time_fields({key.removeprefix("scalar_"): each for key, each in cloud.values.items()})


def find_cloud_clock(
    clouds: Sequence[tuple[Cloud, Path, float]], period: float | None = None
) -> CloudClock | None:
    """Find the field with the points' times, and its clock, from several files of a source.

    Args:
        clouds: content, file and stamp of some scans.
        period: time from one scan to the next, seconds; None if unknown.
    """
    fields = [point_times_of(cloud) for cloud, _, _ in clouds]
    names = {name: unit for each in fields for name, (_, unit) in each.items()}
    points = [positions(cloud, file)[0] for cloud, file, _ in clouds] if names else []
    for name, unit in names.items():
        samples = []
        for each, cloud_points, (_, _, stamp) in zip(fields, points, clouds, strict=True):
            if name in each:
                usable = LidarScan.of(cloud_points, each[name][0]).times
                if usable is not None and len(usable):
                    samples.append((usable, nanoseconds(stamp)))
        with np.errstate(all="ignore"):
            clock = find_clock(samples, period, unit)
        if clock is not None:
            return CloudClock(name, clock)
    return None


def nanoseconds(stamp: float) -> int:
    """Return a stamp in nanoseconds; 0 if it is unknown."""
    return round(stamp * 1e9) if isfinite(stamp) else 0


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


def reason_of(error: BaseException) -> str:
    """Return a library's message in one line of printable characters, for an error."""
    return printable(str(error).split("\n")[0].strip()[:160] or type(error).__name__)


def printable(text: str) -> str:
    """Return a text with a question mark for each sign that a terminal cannot show."""
    return "".join(sign if sign.isprintable() else "?" for sign in text)
