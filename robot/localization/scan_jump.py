"""Scan jumps: tells when a scan does not fit the scans before it at the pose of the odometry.

A robot that is carried away sees another place, while its odometry goes on or stands still. The
columns in which objects stand are compared from scan to scan. The share that is found again is
compared with its usual value on this drive, so no threshold depends on the sensor or the place.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Float64, Int64

CELL = 0.5
"""Edge length of a column, meters."""
TALL = 0.7
"""Height of the points in a column from which an object stands in it, meters."""
RANGES = (2.0, 40.0)
"""Nearest and farthest points that are used, meters."""
MOST_POINTS = 10_000
"""Most points of a scan that are used."""
FEWEST_COLUMNS = 30
"""Fewest columns of a scan that say something."""
USUAL_SCANS = 30
"""Number of shares whose median is the usual one."""
LEARNED_SCANS = 5
"""Number of shares from which the usual one is known."""
UNUSUAL = 0.65
"""Share of the usual value below which a scan does not fit."""


@dataclass(frozen=True, slots=True)
class ScanFit:
    """How a scan fits the scans before it.

    Attributes:
        share: share of its columns that are found in the scans before; None if too few.
        fits: whether the share is usual, or nothing contradicts it.
    """

    share: float | None
    fits: bool


class ScanAgreement:
    """Compares each scan with the last accepted ones; each scan is examined, then accepted."""

    def __init__(self) -> None:
        self._shares: deque[float] = deque(maxlen=USUAL_SCANS)
        self._recent: deque[Int64] = deque(maxlen=2)

    def examine(self, columns: Int64) -> ScanFit:
        """Return how a scan fits the accepted scans."""
        if len(columns) < FEWEST_COLUMNS or not self._recent:
            return ScanFit(None, True)
        before = np.concatenate(list(self._recent))
        share = float(np.isin(columns, widened(before)).mean())
        if len(self._shares) < LEARNED_SCANS:
            return ScanFit(share, True)
        return ScanFit(share, share >= UNUSUAL * float(np.median(self._shares)))

    def accept(self, columns: Int64, fit: ScanFit) -> None:
        """Use a scan for the comparison of the next ones."""
        if len(columns) >= FEWEST_COLUMNS:
            self._recent.append(columns)
        if fit.share is not None:
            self._shares.append(fit.share)

    def reset(self) -> None:
        """Forget the scans; the usual share stays that of this sensor."""
        self._recent.clear()


def object_columns(points: Float32, odom_pose: Float64) -> Int64:
    """Return keys of the columns in which objects stand, int64, ascending.

    Args:
        points: float32 (n, 3), meters, in the sensor's frame.
        odom_pose: pose of the sensor in the odometry frame, float64 (4, 4).
    """
    some = points[:: max(1, len(points) // MOST_POINTS)]
    squared = np.einsum("ij,ij->i", some, some)
    some = some[(squared > RANGES[0] ** 2) & (squared < RANGES[1] ** 2)]
    if not len(some):
        return np.zeros(0, dtype=np.int64)
    moved = some @ odom_pose[:3, :3].T + odom_pose[:3, 3]
    cells = np.floor(moved[:, :2] / CELL).astype(np.int64)
    keys = key_of(cells[:, 0], cells[:, 1])
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.diff(keys[order], prepend=keys[order[0]] - 1))
    heights = moved[order, 2]
    tall = np.maximum.reduceat(heights, first) - np.minimum.reduceat(heights, first) > TALL
    return np.asarray(keys[order[first]][tall])


ROW = 1 << 32
"""Distance of the keys of two neighboring columns along x."""


def key_of(x: Int64, y: Int64) -> Int64:
    """Return one key for each column."""
    return np.asarray(x * ROW + y)


def widened(keys: Int64) -> Int64:
    """Return the keys of columns and of their neighbors."""
    steps = np.array([x * ROW + y for x in (-1, 0, 1) for y in (-1, 0, 1)])
    return np.unique(keys[:, None] + steps)
