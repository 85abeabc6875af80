"""A scan: the points of one sweep of a LiDAR."""

from dataclasses import dataclass
from math import nan

import numpy as np

from placecell.core.types import Float32, Float64


@dataclass(frozen=True, slots=True)
class LidarScan:
    """Points of one sweep, with what was dropped while it was read.

    Attributes:
        points: float32 (n, 3), meters, in the sensor's frame; all values are finite.
        times: time of each point relative to `stamp`, float64 (n,), seconds; None if the file has
            none.
        stamp: time of the scan, seconds since the epoch or since the start; NaN if unknown.
        read: number of points in the file, with those that were dropped.
        not_finite: number of points that were dropped because a coordinate is NaN or infinite.
        zeros: number of points that were dropped because x, y and z are 0: beams without an echo.
    """

    points: Float32
    times: Float64 | None = None
    stamp: float = nan
    read: int = 0
    not_finite: int = 0
    zeros: int = 0

    @classmethod
    def of(cls, points: Float32, times: Float64 | None = None, stamp: float = nan) -> "LidarScan":
        """Build a scan from all points of a file; drop unusable points together with their times.

        Args:
            points: float32 (n, 3), meters, in the sensor's frame.
            times: float64 (n,), seconds relative to `stamp`, or None.
            stamp: time of the scan, seconds.
        """
        x, y, z = points.T  # Column by column: eight times as fast as .all(axis=1).
        finite = np.isfinite(x) & np.isfinite(y) & np.isfinite(z)
        echo = (x != 0) | (y != 0) | (z != 0)
        keep = finite & echo
        dropped = not keep.all()
        return cls(
            np.ascontiguousarray(points[keep]) if dropped else points,
            times[keep] if dropped and times is not None else times,
            stamp,
            len(points),
            int(np.count_nonzero(~finite)),
            int(np.count_nonzero(~echo)),
        )
