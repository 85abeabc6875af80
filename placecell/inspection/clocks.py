"""Times of scans: rate, gaps, and jumps of the clock."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64

GAP = 1.6
"""Intervals between scans that are this many times the usual one are gaps."""
JUMP = 30.0
"""Smallest interval that is a jump of the clock or a pause, seconds."""
LISTED = 20
"""Most gaps that are listed."""


@dataclass(frozen=True, slots=True)
class Clock:
    """Times of scans in the files' order.

    Attributes:
        rate_hz: scans a second; None if unknown.
        interval: usual time between two scans, seconds; None if unknown.
        gaps: scan before each gap, and its length, seconds.
        forward: scan before each jump forward, and its length, seconds.
        backward: scan before each jump backward, and its length, seconds.
        repeated: number of scans with the time of the one before.
        unknown: number of scans without a time.
    """

    rate_hz: float | None
    interval: float | None
    gaps: tuple[tuple[int, float], ...]
    forward: tuple[tuple[int, float], ...]
    backward: tuple[tuple[int, float], ...]
    repeated: int
    unknown: int

    @property
    def lost(self) -> int:
        """Number of scans that are missing in the gaps."""
        if not self.interval:
            return 0
        return sum(round(length / self.interval) - 1 for _, length in self.gaps)


def read_clock(stamps: Float64) -> Clock:
    """Find rate, gaps and jumps in the times of scans, seconds."""
    known = np.isfinite(stamps)
    unknown = int(np.count_nonzero(~known))
    at = np.flatnonzero(known)
    if len(at) < 2:
        return Clock(None, None, (), (), (), 0, unknown)
    steps = np.diff(stamps[at])
    ahead = steps[steps > 0]
    repeated = int(np.count_nonzero(steps == 0))
    if not len(ahead):
        return Clock(None, None, (), (), tuple_of(at, steps, steps < 0), repeated, unknown)
    usual = float(np.median(ahead))
    jumps = steps > max(JUMP, 20 * usual)
    gaps = (steps > GAP * usual) & ~jumps
    return Clock(
        1 / usual,
        usual,
        tuple_of(at, steps, gaps),
        tuple_of(at, steps, jumps),
        tuple_of(at, steps, steps < 0),
        repeated,
        unknown,
    )


def tuple_of(at: np.ndarray, steps: Float64, which: np.ndarray) -> tuple[tuple[int, float], ...]:
    """Return the scan before each of these steps, and the step's length."""
    return tuple((int(at[i]), float(steps[i])) for i in np.flatnonzero(which))
