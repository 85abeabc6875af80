"""Trajectories in tables with a header: columns by their names, in any order and unit."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from placecell.core.errors import DriveError
from placecell.core.types import Float64
from placecell.trajectories.poses import (
    as_transforms,
    check_quaternions,
    check_rotations,
    of_euler,
    of_quaternions,
)
from placecell.trajectories.table import TextTable
from placecell.trajectories.times import SECONDS, UNIT_NAMES, find_unit, in_order, parse_clock
from placecell.trajectories.trajectory import Trajectory

LENGTHS = {"m": 1.0, "meter": 1.0, "meters": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0}
ANGLES = {"rad": 1.0, "radian": 1.0, "radians": 1.0}
ANGLES |= dict.fromkeys(("deg", "degree", "degrees", "°"), np.pi / 180)
TIMES: dict[str, float] = {str(unit): size for unit, size in SECONDS.items()}
TIMES |= {"sec": 1.0, "secs": 1.0, "seconds": 1.0, "msec": 1e-3, "usec": 1e-6, "nsec": 1e-9}
TIMES |= {"milliseconds": 1e-3, "microseconds": 1e-6, "nanoseconds": 1e-9, "nanosec": 1e-9}

WORD = r"(?:.*_)?(?:position|pos|translation|trans|location|loc)"
PATTERNS: dict[str, tuple[str, ...]] = {
    "position": (rf"(?:{WORD}_?|[tp]_?|p_\w+_)?(?P<part>[xyz])",),
    "east": (r"(?P<part>easting|east|northing|north|up|altitude|alt|height|elevation)",),
    "quaternion": (
        r"(?:.*_)?(?:quaternion|quat|orientation|ori|rotation|rot|q)_?(?P<part>[wxyz])",
        r"q_\w+_(?P<part>[wxyz])",
    ),
    "euler": (r"(?:.*_)?(?P<part>roll|pitch|yaw)", r"(?P<part>theta|psi)"),
    "matrix": (r"(?:r|rot|m|t|h|tf|pose|transform)_?(?P<part>[0-4]_?[0-4])",),
    "stamp": (
        r"(?P<part>timestamps?|time_?stamps?|times?|stamp|t|secs?|seconds|epoch)",
        r"(?:.*_)(?P<part>stamp|timestamp|time)",
    ),
    "sec": (r"(?:.*_)?(?:stamp|time|header)_(?P<part>secs?|sec)", r"(?P<part>secs)"),
    "nsec": (r"(?:.*_)?(?P<part>nsecs?|nanosecs?|nanoseconds)",),
}
"""Names of the columns of each quantity, after `plain_name`."""

EASTING = {"east": 0, "easting": 0, "north": 1, "northing": 1}
AXES = "xyz"


@dataclass(frozen=True, slots=True)
class NamedColumn:
    """A column of a quantity: its place in the table, its part of the quantity, its unit."""

    place: int
    part: str
    unit: str


@dataclass(slots=True)
class NamedColumns:
    """Columns of a table by quantity.

    Attributes:
        found: columns of each quantity, by part.
    """

    found: dict[str, dict[str, NamedColumn]] = field(default_factory=dict)

    @classmethod
    def of(cls, names: Sequence[str]) -> "NamedColumns":
        """Assign each name to the quantity that it fits; the first name of a part counts."""
        columns = cls()
        for place, name in enumerate(names):
            base, unit = plain_name(name)
            for quantity, part in quantities(base):
                parts = columns.found.setdefault(quantity, {})
                parts.setdefault(part, NamedColumn(place, part, unit))
        return columns

    def parts(self, quantity: str, names: Sequence[str]) -> list[NamedColumn] | None:
        """Return the columns of these parts of a quantity, or None if one is missing."""
        there = self.found.get(quantity, {})
        return [there[name] for name in names] if all(name in there for name in names) else None


def plain_name(name: str) -> tuple[str, str]:
    """Return a name in lower case with underscores, and its unit; "" if it states none.

    The unit stands in brackets, or after an underscore at the end.
    """
    text = name.strip().lower()
    unit = ""
    if match := re.search(r"[\[(]([^\])]*)[\])]", text):
        unit = match[1].strip()
        text = text[: match.start()] + text[match.end() :]
    text = re.sub(r"[^a-z0-9]+", "_", text).strip("_")
    if not unit and (match := re.fullmatch(r"(.+)_([a-z]+)", text)):
        known = set(LENGTHS) | set(ANGLES) | {"ms", "us", "ns", "s"}
        if match[2] in known:
            text, unit = match[1], match[2]
    return text, unit


def quantities(name: str) -> Iterator[tuple[str, str]]:
    """Yield each quantity and part that a plain name fits."""
    for quantity, patterns in PATTERNS.items():
        for pattern in patterns:
            if match := re.fullmatch(pattern, name):
                yield quantity, match["part"].replace("_", "")
                break


def of_names(table: TextTable) -> Trajectory:
    """Build a trajectory of a table with a header.

    Raises:
        DriveError: columns are missing, or a value is wrong.
    """
    columns = NamedColumns.of(table.names)
    remarks = list[str]()
    poses = of_matrix(table, columns)
    if poses is None:
        positions = positions_of(table, columns)
        if quaternion := columns.parts("quaternion", ("x", "y", "z", "w")):
            values = table.numbers([each.place for each in quaternion])
            check_quaternions(values, table.file, table.line_numbers)
            poses = of_quaternions(positions, values)
        else:
            poses = of_euler(positions, angles_of(table, columns, remarks))
    stamps = stamps_of(table, columns, remarks)
    if stamps is not None:
        stamps, poses, order = in_order(stamps, poses)
        remarks += order
    return Trajectory(poses, stamps, remarks=tuple(remarks))


def missing(table: TextTable, what: str) -> DriveError:
    """Return the error of a table that lacks columns."""
    names = ", ".join(table.names)
    return DriveError(
        f"{table.file}: the header names no {what} (found {names[:200]}). Expected x, y, z, and a "
        "rotation: qx, qy, qz, qw, or roll, pitch, yaw; a time such as timestamp. Rename the "
        "columns"
    )


def lengths(table: TextTable, columns: Sequence[NamedColumn]) -> Float64:
    """Return columns as meters.

    Raises:
        DriveError: a unit is not known.
    """
    scales = []
    for each in columns:
        if each.unit not in LENGTHS and each.unit:
            raise DriveError(
                f"{table.file}: the column {table.names[each.place]!r} has the unit "
                f"{each.unit!r}, expected {', '.join(LENGTHS)}. Convert the file to meters"
            )
        scales.append(LENGTHS.get(each.unit, 1.0))
    return table.numbers([each.place for each in columns]) * scales


def positions_of(table: TextTable, columns: NamedColumns) -> Float64:
    """Return the positions, float64 (rows, 3), meters; z is 0 if the table has none.

    Raises:
        DriveError: x or y is missing.
    """
    if named := columns.parts("position", AXES) or columns.parts("position", "xy"):
        values = lengths(table, named)
        return np.pad(values, ((0, 0), (0, 3 - values.shape[1])))
    world: dict[int, NamedColumn] = {}
    for part, column in columns.found.get("east", {}).items():
        world.setdefault(EASTING.get(part, 2), column)
    if {0, 1} <= world.keys():
        values = np.zeros((len(table.rows), 3))
        for axis, column in world.items():
            values[:, axis] = lengths(table, [column])[:, 0]
        return values
    raise missing(table, "position")


def angles_of(table: TextTable, columns: NamedColumns, remarks: list[str]) -> Float64:
    """Return roll, pitch and yaw, float64 (rows, 3), radians; without roll and pitch they are 0.

    Raises:
        DriveError: yaw is missing.
    """
    named = columns.found.get("euler", {})
    yaw = named.get("yaw") or named.get("psi") or named.get("theta")
    if yaw is None:
        raise missing(table, "rotation")
    angles = np.zeros((len(table.rows), 3))
    chosen = [(0, named.get("roll")), (1, named.get("pitch")), (2, yaw)]
    for axis, column in chosen:
        if column is not None:
            angles[:, axis] = table.numbers([column.place])[:, 0]
    units = {column.unit for _, column in chosen if column is not None and column.unit}
    if unknown := units - ANGLES.keys():
        raise DriveError(
            f"{table.file}: angles have the unit {min(unknown)!r}, expected rad or deg. Convert "
            "them"
        )
    if units:
        for axis, column in chosen:
            if column is not None:
                angles[:, axis] *= ANGLES[column.unit or next(iter(units))]
    elif np.abs(angles).max() > 2 * np.pi + 0.1:
        angles = np.radians(angles)
        remarks.append(f"the angles are degrees: they reach {np.degrees(np.abs(angles).max()):.0f}")
    else:
        remarks.append(
            "the angles are taken as radians: the header states no unit. State it in the header, "
            "such as yaw_deg, if they are degrees"
        )
    return angles


def of_matrix(table: TextTable, columns: NamedColumns) -> Float64 | None:
    """Return poses of columns that name the cells of a 3x4 or 4x4 matrix, or of 3x3 and position.

    Raises:
        DriveError: the matrix is no rotation.
    """
    for first in (0, 1):
        cells = [
            f"{row}{column}"
            for row in range(first, first + 3)
            for column in range(first, first + 4)
        ]
        whole = columns.parts("matrix", cells)
        rotation = columns.parts("matrix", [each for each in cells if int(each[1]) < first + 3])
        if whole:
            poses = as_transforms(table.numbers([each.place for each in whole]))
        elif rotation and columns.parts("position", AXES):
            poses = as_transforms(np.zeros((len(table.rows), 12)))
            values = table.numbers([each.place for each in rotation])
            poses[:, :3, :3] = values.reshape(-1, 3, 3)
            poses[:, :3, 3] = positions_of(table, columns)
        else:
            continue
        check_rotations(poses, table.file)
        return poses
    return None


def stamps_of(table: TextTable, columns: NamedColumns, remarks: list[str]) -> Float64 | None:
    """Return the times, float64 (rows,), seconds; None if the table has none.

    Raises:
        DriveError: a time is no number, or its unit is not known.
    """
    seconds, nanoseconds = (columns.found.get(name) for name in ("sec", "nsec"))
    if seconds and nanoseconds:
        parts = [next(iter(each.values())).place for each in (seconds, nanoseconds)]
        return np.asarray(table.numbers(parts) @ np.array([1.0, 1e-9]))
    found = columns.found.get("stamp") or columns.found.get("sec")
    if not found:
        return None
    # A message's own stamp comes before the time at which it was recorded.
    column = found.get("stamp") or next(iter(found.values()))
    if parse_clock(table.rows[0][column.place] if column.place < len(table.rows[0]) else ""):
        return clock_times(table, column.place)
    times = table.numbers([column.place])[:, 0]
    if column.unit and column.unit not in TIMES:
        raise DriveError(
            f"{table.file}: the column {table.names[column.place]!r} has the unit "
            f"{column.unit!r}, expected s, ms, us or ns. Convert the times to seconds"
        )
    return scaled(times, column.unit, remarks)


def scaled(times: Float64, unit: str, remarks: list[str]) -> Float64:
    """Return times as seconds; find the unit if none is stated."""
    if unit:
        return times * TIMES[unit]
    found = find_unit(times)
    if found != "s":
        remarks.append(f"the times are {UNIT_NAMES[found]}, told by their magnitude")
    return times * SECONDS[found]


def clock_times(table: TextTable, place: int) -> Float64:
    """Return dates with times as seconds since 1970.

    Raises:
        DriveError: a cell is no date.
    """
    found = []
    for row, line in zip(table.rows, table.lines, strict=True):
        seconds = parse_clock(row[place]) if place < len(row) else None
        if seconds is None:
            raise DriveError(
                f"{table.file}, line {line}: expected a date with a time as in the first line"
            )
        found.append(seconds)
    return np.array(found)
