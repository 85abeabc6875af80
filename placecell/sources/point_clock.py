"""Clock of the points' times: unit and origin, found once for all scans of a source.

A field named `t` or `timestamp` holds seconds, milliseconds, microseconds or nanoseconds, and
counts from the scan's stamp, from the epoch, or from the start of the sensor. No format states
which. A sweep lasts about 0.1 s, and the units differ by factors of 1000, so the spread of the
times within a scan tells the unit. The clock is found from several scans: a scan of few points has
a small spread.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float64
from placecell.trajectories.times import SECONDS, TimeUnit, unit_since_epoch

SHORTEST, LONGEST_GUESS = 0.001, 1.0
"""Shortest and longest plausible sweep if its unit is not known, seconds: exactly one unit fits.
A unit that is too small does less harm than one that is too large: points hardly move in 1 ms."""
LONGEST = 1.9
"""Longest plausible sweep in a known unit, seconds."""
SWEEPS_A_PERIOD = 1.5
"""Largest plausible sweep, periods of the scans."""
SAME_CLOCK = 2.0
"""Largest difference between the points' clock and the stamps' if they are one, seconds."""
FARTHEST = 10.0
"""Largest plausible distance of a point's time from its scan's stamp, seconds."""
NANOSECONDS: dict[TimeUnit, int] = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}

Origin = Literal["stamp", "epoch", "first"]


@dataclass(frozen=True, slots=True)
class PointClock:
    """Clock of the points' times.

    Attributes:
        unit: unit of the values.
        origin: `stamp` if they are relative to the scan's stamp, `epoch` if they are absolute on
            the stamps' clock, `first` if they are absolute on another clock: then the first point
            is taken to be at the stamp.
    """

    unit: TimeUnit
    origin: Origin

    @np.errstate(all="ignore")  # Any bits may stand for a time.
    def seconds(self, raw: NDArray[Any], stamp_ns: int = 0) -> Float64:
        """Return times relative to the stamp, float64, seconds; implausible values become 0."""
        if not len(raw):
            return np.zeros(0)
        scale = SECONDS[self.unit]
        if self.origin == "stamp":
            times = raw.astype(np.float64) * scale
        else:
            values, base = from_base(raw, lowest=self.origin == "first")
            times = values * scale
            if self.origin == "epoch":
                times += (in_nanoseconds(base, self.unit) - stamp_ns) * 1e-9
        odd = ~(np.abs(times) <= FARTHEST)
        if odd.any():
            times[odd] = 0.0
        return times

    def __str__(self) -> str:
        origin = {
            "stamp": "relative to the stamp",
            "epoch": "absolute, on the stamps' clock",
            "first": "on a clock of their own; the first point is taken to be at the stamp",
        }
        return f"{self.unit}, {origin[self.origin]}"


def from_base(raw: NDArray[Any], lowest: bool = False) -> tuple[Float64, Any]:
    """Return values minus one of them, float64, and that value, as int or float.

    Integers are subtracted as integers: nanoseconds since the epoch do not fit a float64.
    """
    if raw.dtype.kind in "iu":
        integers = raw.astype(np.int64)
        base = int(integers.min()) if lowest else int(np.sort(integers)[len(integers) // 2])
        return (integers - base).astype(np.float64), base
    values = raw.astype(np.float64)
    finite = values[np.isfinite(values)]
    if not len(finite):
        return np.full(len(values), np.nan), 0.0
    start = float(finite.min()) if lowest else float(np.median(finite))
    return values - start, start


def in_nanoseconds(time: float, unit: TimeUnit) -> int:
    """Return a time in nanoseconds, exactly if it is an integer; 0 if it is beyond all times."""
    value = time * NANOSECONDS[unit]
    return int(value) if isfinite(value) else 0


@np.errstate(all="ignore")
def find_clock(
    samples: Sequence[tuple[NDArray[Any], int]],
    period: float | None = None,
    unit: TimeUnit | None = None,
) -> PointClock | None:
    """Find unit and origin of the times of several scans.

    Args:
        samples: raw times of the usable points of a scan, with its stamp in nanoseconds.
        period: median time between scans, seconds, if known.
        unit: unit that the field's name states.

    Returns:
        None if all times of a scan are equal or no unit makes them a plausible sweep.
    """
    spreads, middles = [], []
    for raw, stamp_ns in samples:
        if len(raw) < 2:
            continue
        values, base = from_base(raw)
        finite = values[np.isfinite(values)]
        if len(finite) < 2:
            continue
        low, high = np.quantile(finite, (0.01, 0.99))
        spreads.append(float(high - low))
        middles.append((base, stamp_ns))
    positive = [spread for spread in spreads if spread > 0]
    if not positive:
        return None
    spread = float(np.median(positive))
    found = unit or unit_since_epoch([float(base) for base, _ in middles])
    longest = LONGEST if found else LONGEST_GUESS
    if found is None and period:
        longest = min(LONGEST_GUESS, max(SWEEPS_A_PERIOD * period, 2 * SHORTEST))
    units = [
        each
        for each in ([found] if found else SECONDS)
        if (0 if found else SHORTEST) <= spread * SECONDS[each] <= longest
    ]
    if not units:
        return None
    sweep = spread * SECONDS[units[0]]
    relative = [abs(float(base)) * SECONDS[units[0]] for base, _ in middles]
    if np.median(relative) <= 2 * sweep + 0.05:
        return PointClock(units[0], "stamp")
    apart = [
        abs(in_nanoseconds(base, units[0]) - stamp_ns) * 1e-9
        for base, stamp_ns in middles
        if stamp_ns
    ]
    same = bool(apart) and float(np.median(apart)) <= SAME_CLOCK
    return PointClock(units[0], "epoch" if same else "first")
