"""Decoder of sensor_msgs/PointCloud2, for every container that holds one.

The message states name, offset, type and count of each value of a point. Drivers make full use of
that: padding between values, points and rows, any order, float64 coordinates, big-endian data,
overlapping fields that nobody reads. A header may also contradict its data; then a `DriveError`
names both. Values are views into the message; only coordinates and times are copied.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell.sources.errors import DriveError
from placecell.sources.point_clock import PointClock, find_clock
from placecell.sources.point_times import NAMES, split_name
from placecell.sources.scan import LidarScan
from placecell.trajectories.times import TimeUnit

TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""NumPy type of each datatype of sensor_msgs/PointField."""
AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class PointField:
    """Value of a point: name, offset in bytes, datatype of sensor_msgs/PointField, and count."""

    name: str
    offset: int
    datatype: int
    count: int = 1

    @property
    def type(self) -> str | None:
        """Return the NumPy type, without byte order; None for an unknown datatype."""
        return TYPES.get(self.datatype)

    @property
    def size(self) -> int:
        """Return the bytes of one element; 0 for an unknown datatype."""
        return int(self.type[1]) if self.type else 0

    @property
    def end(self) -> int:
        """Return the offset behind the value. Some drivers write a count of 0 for 1."""
        return self.offset + self.size * max(self.count, 1)

    def __str__(self) -> str:
        counted = f"[{self.count}]" if self.count != 1 else ""
        return f"{self.name} ({self.type or f'datatype {self.datatype}'}{counted} at {self.offset})"


@dataclass(frozen=True, slots=True)
class PointCloud2:
    """A message of type sensor_msgs/PointCloud2.

    Attributes:
        fields: values of each point.
        is_bigendian: byte order of the values.
        point_step: bytes from a point to the next.
        row_step: bytes from a row to the next.
        width: points of a row.
        height: rows.
        data: bytes of all points.
        stamp_ns: time of the header, nanoseconds; 0 if the driver did not set it.
        frame: coordinate frame of the header.
    """

    fields: Sequence[PointField]
    is_bigendian: bool
    point_step: int
    row_step: int
    width: int
    height: int
    data: bytes | memoryview
    stamp_ns: int = 0
    frame: str = ""

    @property
    def count(self) -> int:
        """Return the number of points that the header states."""
        return self.width * self.height

    def rows(self, where: str) -> tuple[int, int, int]:
        """Return rows, points a row and bytes from a row to the next, as the data has them.

        Raises:
            DriveError: the data has less than the header states.
        """
        have, row = len(self.data), self.width * self.point_step
        stated = f"{self.height} x {self.width} points of {self.point_step} bytes"
        if not self.count:
            if have:
                raise DriveError(
                    f"{where}: the header states {stated}, but the data has {have} bytes. The "
                    f"header is wrong; {REPAIR}"
                )
            return 0, 0, 0
        if not self.point_step:
            raise DriveError(f"{where}: the header states {stated}. The header is wrong; {REPAIR}")
        if self.height == 1:
            step, need = row, row
        else:
            # A row_step too small for a row is a driver's mistake; such data has no gaps.
            step = self.row_step if self.row_step >= row else row
            need = (self.height - 1) * step + row
            if need > have and self.height * row == have:
                step, need = row, have
        if need > have:
            raise DriveError(
                f"{where}: the header states {stated} in rows of {self.row_step} bytes, {need} "
                f"bytes in all, but the data has {have}. The message is cut short or its header "
                f"is wrong; {REPAIR}"
            )
        return self.height, self.width, step

    def column(self, field: PointField, where: str, element: int = 0) -> NDArray[Any]:
        """Return a field of all points, (rows, points a row): a view into the data.

        Raises:
            DriveError: the field does not fit the points or has an unknown type.
        """
        rows, width, step = self.rows(where)
        if field.type is None:
            raise DriveError(
                f"{where}: the type of the field {field} is unknown; expected 1 (int8) to 8 "
                f"(float64). {REPAIR.capitalize()}"
            )
        if field.end > self.point_step:
            raise DriveError(
                f"{where}: the field {field} ends at byte {field.end} of points of "
                f"{self.point_step} bytes. The header is wrong; {REPAIR}"
            )
        kind = (">" if self.is_bigendian else "<") + field.type
        if not rows:
            return np.empty((0, 0), kind)
        at = field.offset + element * field.size
        return np.ndarray((rows, width), kind, self.data, at, (step, self.point_step))


REPAIR = "check the driver that publishes the topic, or record it again"


def axes_of(cloud: PointCloud2, where: str) -> list[PointField]:
    """Return the fields x, y and z.

    Raises:
        DriveError: one is missing, stands twice, or overlaps another field.
    """
    names = [field.name for field in cloud.fields]
    if not set(AXES) <= set(names):
        names = [name.lower() for name in names]
    listed = ", ".join(map(str, cloud.fields)) or "none"
    for axis in AXES:
        if names.count(axis) != 1:
            found = "has no field" if axis not in names else "has several fields"
            raise DriveError(
                f"{where}: the cloud {found} {axis!r}. Its fields are: {listed}. Expected x, y and "
                "z once each; choose another topic with --topic"
            )
    axes = [cloud.fields[names.index(axis)] for axis in AXES]
    for field, other in ((axes[0], axes[1]), (axes[0], axes[2]), (axes[1], axes[2])):
        if overlap(field, other):
            raise DriveError(
                f"{where}: the fields {field} and {other} overlap. The header is wrong; {REPAIR}"
            )
    return axes


def overlap(field: PointField, other: PointField) -> bool:
    """Return whether two fields share bytes."""
    return field.offset < other.end and other.offset < field.end


@np.errstate(all="ignore")  # Any bits may stand for a number.
def coordinates(cloud: PointCloud2, where: str, scale: float = 1.0) -> NDArray[np.float32]:
    """Return x, y and z of all points, float32 (n, 3), times `scale`.

    Raises:
        DriveError: the header contradicts itself or the data.
    """
    axes = axes_of(cloud, where)
    rows, width, step = cloud.rows(where)
    if not rows:
        return np.empty((0, 3), np.float32)
    columns = [cloud.column(field, where) for field in axes]
    first = axes[0].offset
    packed = all(f.type == "f4" and f.offset == first + 4 * n for n, f in enumerate(axes))
    if packed and axes[2].offset + 4 <= cloud.point_step:
        blocks = np.ndarray((rows, width), "V12", cloud.data, first, (step, cloud.point_step))
        points = blocks.copy().view(columns[0].dtype).reshape(-1, 3)
    else:
        points = np.stack(columns, axis=2).reshape(-1, 3)
    if scale != 1.0:
        points = points * scale
    return points.astype(np.float32, copy=False)  # float64 beyond float32 becomes infinite


@dataclass(frozen=True, slots=True)
class TimeField:
    """Field, or pair of fields with seconds and nanoseconds, that holds the points' times.

    Attributes:
        names: of the field or of the two fields.
        unit: unit that the name states.
    """

    names: tuple[str, ...]
    unit: TimeUnit | None = None

    def __str__(self) -> str:
        return " and ".join(self.names)


def time_fields(fields: Sequence[PointField]) -> list[TimeField]:
    """Return the candidates for the points' times, pairs first."""
    named = [(field, split_name(field.name)) for field in fields if field.size >= 2]
    named = [(field, found) for field, found in named if found[0] in NAMES]
    pairs = [
        TimeField((seconds.name, nanoseconds.name), "ns")
        for seconds, (base, unit) in named
        for nanoseconds, (other, other_unit) in named
        if base == other and (unit, other_unit) == ("s", "ns") and seconds.type in ("i4", "u4")
        if nanoseconds.type in ("i4", "u4")
    ]
    paired = {name for pair in pairs for name in pair.names}
    return pairs + [
        TimeField((field.name,), unit) for field, (base, unit) in named if field.name not in paired
    ]


@np.errstate(all="ignore")
def raw_times(cloud: PointCloud2, where: str, time: TimeField) -> NDArray[Any] | None:
    """Return the times of all points as they stand in the message; None if it has none.

    Nanoseconds since the epoch do not fit the datatypes of PointField. Drivers write them as two
    uint32 (seconds and nanoseconds, or the halves of an integer), or as the bits of a float64.
    """
    by_name = {field.name: field for field in cloud.fields}
    if not set(time.names) <= set(by_name):
        return None
    fields = [by_name[name] for name in time.names]
    columns = [cloud.column(field, where).reshape(-1) for field in fields]
    if len(columns) == 1 and fields[0].type == "u4" and fields[0].count == 2:
        columns.append(cloud.column(fields[0], where, 1).reshape(-1))
    if len(columns) == 2:
        first, second = (column.astype(np.int64) for column in columns)
        if len(time.names) == 1 and len(first) and np.ptp(second) <= 1 < np.ptp(first):
            return first + (second << 32)
        return first * 10**9 + second
    values = columns[0]
    if fields[0].type == "f8" and len(values):
        sizes = np.abs(values[np.isfinite(values)])
        if len(sizes) and 0 < sizes.max() < 1e-150:  # No time is so small: bits of an integer.
            return values.view(values.dtype.str.replace("f", "i")).astype(np.int64)
    return values.copy()


def decode(
    cloud: PointCloud2,
    where: str,
    clock: tuple[TimeField, PointClock] | None = None,
    scale: float = 1.0,
) -> LidarScan:
    """Decode a cloud; points that are NaN or zero are dropped together with their times.

    Args:
        where: file, topic and message, for errors.
        clock: field with the points' times, and their clock, from `cloud_clock`.
        scale: meters a unit.

    Raises:
        DriveError: the header contradicts itself or the data.
    """
    points = coordinates(cloud, where, scale)
    stamp = cloud.stamp_ns * 1e-9
    raw = raw_times(cloud, where, clock[0]) if clock else None
    if raw is None or clock is None:
        return LidarScan.of(points, None, stamp)
    scan = LidarScan.of(points, raw, stamp)
    assert scan.times is not None
    return replace(scan, times=clock[1].seconds(scan.times, cloud.stamp_ns))


def cloud_clock(
    clouds: Sequence[PointCloud2], where: str, period: float | None = None
) -> tuple[TimeField, PointClock] | None:
    """Find the field with the points' times, and their clock, from several clouds of a topic."""
    for time in time_fields(clouds[0].fields) if clouds else ():
        clock = find_clock(list(time_samples(clouds, where, time)), period, time.unit)
        if clock:
            return time, clock
    return None


def time_samples(
    clouds: Sequence[PointCloud2], where: str, time: TimeField
) -> Iterator[tuple[NDArray[Any], int]]:
    """Yield the raw times of the usable points of each cloud, with its stamp.

    A cloud whose field of times is damaged does not help; its scan raises the error.
    """
    for cloud in clouds:
        try:
            raw = raw_times(cloud, where, time)
        except DriveError:
            continue
        if raw is not None:
            scan = LidarScan.of(coordinates(cloud, where), raw, 0.0)
            if scan.times is not None:
                yield scan.times, cloud.stamp_ns
