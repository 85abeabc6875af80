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

from placecell.core.types import Bool, Float32, Float64, Int64

AZIMUTH, ELEVATION = 1.0, 2.0
"""Size of a direction, degrees. The beams of a sparse sensor are up to 2 degrees apart."""

LOWEST = -90.0
"""Lowest elevation, degrees."""

MARGIN = 0.5
"""Distance behind a point from which a return shows that the point is gone, meters."""

FEWEST, JUDGED = 10, 0.25
"""Smallest number, and smallest share of a segment's points, that the scan must judge."""

GONE = 0.5
"""Share of the judged points that are gone, from which the segment has moved."""


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
        azimuths, elevations = round(360 / AZIMUTH), round(-2 * LOWEST / ELEVATION)
        ranges = np.full((azimuths, elevations), np.inf, dtype=np.float32)
        columns, rows, distances = directions(points)
        # With one index, NumPy is six times as fast as with two.
        np.minimum.at(ranges.reshape(-1), columns * elevations + rows, distances)
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
        if not len(ends):
            return np.zeros(0, dtype=bool)
        columns, rows, distances = directions(points)
        known = np.isfinite(self.ranges[columns, rows])
        nearest = self.around[columns, rows]
        judged = known & (nearest > distances - MARGIN)
        gone = known & (nearest > distances + MARGIN)
        starts = np.concatenate([[0], ends[:-1]])
        judged_points = np.add.reduceat(judged, starts, dtype=np.int64)
        enough = judged_points >= np.maximum(FEWEST, JUDGED * (ends - starts))
        return np.asarray(
            enough & (np.add.reduceat(gone, starts, dtype=np.int64) >= GONE * judged_points)
        )


def directions(points: Float32) -> tuple[Int64, Int64, Float32]:
    """Return the azimuth's and the elevation's number, int64 (n,), and the range of each point."""
    distances = np.sqrt(np.einsum("ij,ij->i", points, points))
    azimuth = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    with np.errstate(invalid="ignore", divide="ignore"):  # a point at the sensor has no elevation
        elevation = np.degrees(np.arcsin(np.clip(points[:, 2] / distances, -1, 1)))
    columns = np.floor(azimuth / AZIMUTH).astype(np.int64)
    columns += round(360 / AZIMUTH) * (columns < 0)
    rows = np.floor((np.nan_to_num(elevation) - LOWEST) / ELEVATION).astype(np.int64)
    return columns, np.minimum(rows, round(-2 * LOWEST / ELEVATION) - 1), distances


def in_sensor_frame(points: Float32, pose: Float64) -> Float32:
    """Return points of the frame of a pose (4, 4) in its sensor's frame, float32 (n, 3)."""
    return (points - pose[:3, 3].astype(np.float32)) @ pose[:3, :3].astype(np.float32)
