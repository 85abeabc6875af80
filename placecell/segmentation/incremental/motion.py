"""Motion: which segments moved while the robot saw them.

A moving object leaves a trail in the local map, because the map accumulates scans. The newest scan
looks through the older part of the trail: it has returns behind it, and none from it or before it.
So a segment has moved if the newest scan sees through half of what it can judge. What stands is
hidden at most, never looked through, except at its edges.

The rule compares directions from the sensor, so it depends neither on the number of beams nor on
the odometry's drift (Kim and Kim, 2020, *Remove, then Revert*, compare whole maps in this way).
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Bool, Float32, Float64, Int64

COLUMNS, ROWS = 360, 90
"""Number of azimuths and of elevations: a direction is 1 degree wide and 2 degrees high. The beams
of a sparse sensor are up to 2 degrees apart."""

MARGIN = 0.5
"""Distance behind a point from which a return shows that the point is gone, meters."""

FEWEST, JUDGED = 10, 0.25
"""Smallest number, and smallest share of a segment's points, that the scan must judge."""

GONE = 0.5
"""Share of the judged points that are gone, from which the segment has moved."""

STEPS = 256
"""Number of steps of the tangent from 0 to 1: fewer than two whole degrees begin in a step."""

TANGENTS: Float32 = np.append(np.tan(np.radians(np.arange(46))), np.inf).astype(np.float32)
"""Tangent of each whole degree to 45, and one that no angle reaches."""

FLOORS: Int64 = np.floor(np.degrees(np.arctan(np.arange(STEPS + 1) / STEPS)) + 1e-9).astype(
    np.int64
)
"""Whole degrees at the lower end of each step."""

TINY = np.float32(1e-30)
"""Smallest divisor: a point at the sensor has the angle 0."""


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """How far the sensor sees in each direction, in one scan.

    Attributes:
        ranges: float32 (azimuths, elevations), smallest range of a return in a direction, meters;
            infinite without a return.
        around: float32 (azimuths, elevations), the smallest of the direction and those beside it.
    """

    ranges: Float32
    around: Float32

    @classmethod
    def of(cls, points: Float32) -> Self:
        """Return the sight of a scan.

        Args:
            points: float32 (n, 3), meters, finite, sensor frame.
        """
        ranges = np.full((COLUMNS, ROWS), np.inf, dtype=np.float32)
        _look(np.ascontiguousarray(points), FLOORS, TANGENTS, ranges)
        beside = np.concatenate([ranges[-1:], ranges, ranges[:1]])
        wide = np.minimum(np.minimum(beside[:-2], beside[1:-1]), beside[2:])
        around = wide.copy()
        around[:, 1:] = np.minimum(around[:, 1:], wide[:, :-1])
        around[:, :-1] = np.minimum(around[:, :-1], wide[:, 1:])
        return cls(ranges, around)

    def moved(self, points: Float32, ends: Int64) -> Bool:
        """Return whether each segment has moved, bool (segments,).

        Args:
            points: float32 (n, 3), points of all segments, meters, sensor frame of the scan.
            ends: int64 (segments,), end of each segment's points.
        """
        found = np.zeros(len(ends), dtype=np.bool_)
        points = np.ascontiguousarray(points)
        _judge(points, ends, FLOORS, TANGENTS, self.ranges, self.around, found)
        return found


def directions(points: Float32) -> tuple[Int64, Int64, Float32]:
    """Return the azimuth's and the elevation's number, int64 (n,), and the range of each point."""
    columns, rows = np.empty(len(points), np.int64), np.empty(len(points), np.int64)
    distances = np.empty(len(points), np.float32)
    _directions(np.ascontiguousarray(points), FLOORS, TANGENTS, columns, rows, distances)
    return columns, rows, distances


def in_sensor_frame(points: Float32, pose: Float64) -> Float32:
    """Return points of the frame of a pose (4, 4) in its sensor's frame, float32 (n, 3)."""
    return (points - pose[:3, 3].astype(np.float32)) @ pose[:3, :3].astype(np.float32)


@compiled_part
def _whole_degrees(
    short: np.float32, long: np.float32, floors: Int64, tangents: Float32
) -> tuple[int, int]:
    """Return the angle between two vectors at a right angle and their sum: rounded down and up.

    Args:
        short: length of the shorter vector, across the angle, 0 or more.
        long: length of the longer vector.
        floors: whole degrees at the lower end of each step of the tangent.
        tangents: tangent of each whole degree.
    """
    tangent = short / max(long, TINY)
    degrees = floors[int(tangent * STEPS)]
    degrees += int(tangent >= tangents[degrees + 1])
    return degrees, degrees + int(tangent > tangents[degrees])


@compiled_part
def _direction(
    x: np.float32, y: np.float32, z: np.float32, floors: Int64, tangents: Float32
) -> tuple[int, int, np.float32]:
    """Return the azimuth's and the elevation's number and the range of a point.

    Tables of tangents take a quarter of the time of the inverse trigonometric functions.
    """
    ahead, aside = abs(x), abs(y)
    down, up = _whole_degrees(min(ahead, aside), max(ahead, aside), floors, tangents)
    if aside > ahead:
        down, up = 90 - up, 90 - down
    if x < 0:
        down, up = 180 - up, 180 - down
    column = 360 - up if y < 0 else down
    level = x * x + y * y
    level, height = np.sqrt(level), abs(z)
    distance = np.sqrt(x * x + y * y + z * z)
    down, up = _whole_degrees(min(level, height), max(level, height), floors, tangents)
    if height > level:
        down, up = 90 - up, 90 - down
    row = (90 - up if z < 0 else 90 + down) >> 1
    return column, min(row, ROWS - 1), distance


@compiled
def _directions(
    points: Float32,
    floors: Int64,
    tangents: Float32,
    columns: Int64,
    rows: Int64,
    distances: Float32,
) -> None:
    """Fill the direction and the range of each point, (n,) each."""
    for point in range(len(points)):
        columns[point], rows[point], distances[point] = _direction(
            points[point, 0], points[point, 1], points[point, 2], floors, tangents
        )


@compiled
def _look(points: Float32, floors: Int64, tangents: Float32, ranges: Float32) -> None:
    """Fill the smallest range of each direction, (azimuths, elevations)."""
    for point in range(len(points)):
        column, row, distance = _direction(
            points[point, 0], points[point, 1], points[point, 2], floors, tangents
        )
        ranges[column, row] = min(ranges[column, row], distance)


@compiled
def _judge(
    points: Float32,
    ends: Int64,
    floors: Int64,
    tangents: Float32,
    ranges: Float32,
    around: Float32,
    found: Bool,
) -> None:
    """Fill whether each segment has moved, (segments,)."""
    margin, start = np.float32(MARGIN), 0
    for segment in range(len(ends)):
        judged = gone = 0
        for point in range(start, ends[segment]):
            column, row, distance = _direction(
                points[point, 0], points[point, 1], points[point, 2], floors, tangents
            )
            known, nearest = ranges[column, row] < np.inf, around[column, row]
            judged += int(known & (nearest > distance - margin))
            gone += int(known & (nearest > distance + margin))
        enough = judged >= max(FEWEST, JUDGED * (ends[segment] - start))
        found[segment] = enough and gone >= GONE * judged
        start = ends[segment]
