"""Time of each point of a scan, from fields whose names, units and clocks vary by driver."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Bool, Float64
from placecell.sources.scan_options import SECONDS, TimeUnit

LONGEST_GUESS = 1.0
"""Longest sweep of a unit that is guessed, seconds. Units differ by a factor of 1,000, so exactly
one unit puts a sweep between 1 ms and 1 s. Sensors sweep in 0.02 to 0.2 s, and a unit that is too
small does less harm than one that is too large: the points hardly move in 1 ms."""
LONGEST_SWEEP = 5.0
"""Longest duration that is one sweep, in a known unit, seconds."""
EPOCH = (9.0e8, 4.2e9)
"""Range of times since 1970, seconds: years 1998 to 2103."""
LONGEST_FILE = 3600.0
"""Longest duration of times since 1970 in one file, seconds; a longer one is another clock's:
1,000 to 4,200 s after the start of a sensor, its microseconds look like seconds since 1970."""

NAMES = {
    "t", "time", "times", "timestamp", "timestamps", "stamp", "ts", "dt", "deltat", "deltatime",
    "offsettime", "timeoffset", "pointtime", "pointtimeoffset", "relativetime", "gpstime",
    "utctime",
}  # fmt: skip
"""Names of time fields, without `_` and a suffix for the unit."""
SUFFIXES: dict[str, TimeUnit] = {
    "s": "s", "sec": "s", "secs": "s", "seconds": "s",
    "ms": "ms", "msec": "ms",
    "us": "us", "usec": "us",
    "ns": "ns", "nsec": "ns", "nsecs": "ns", "nanosec": "ns", "nanoseconds": "ns",
}  # fmt: skip
"""Suffixes of names that state the unit, such as `time_ns`."""
ALWAYS_SECONDS = {"gpstime"}
"""Names whose unit is seconds by convention (LAS, PDAL)."""
PER_SECOND: dict[TimeUnit, int] = {"ns": 10**9, "us": 10**6}
EXACT = 2**53
"""Integers from here on lose digits as float64."""


def point_times(
    fields: Mapping[str, NDArray[Any]], stamp: float, usable: Bool | None = None
) -> Float64 | None:
    """Return the time of each point relative to the scan's stamp, float64 (n,), seconds.

    The unit is the one that the field's name states (`time_ns`); else the one that puts the times
    between 1998 and 2103, if they count from 1970; else the one in which the sweep takes from
    1 ms to 1 s. Seconds and their fraction in two fields (`time_sec`, `time_nsec`) are added.

    Times near 0 are relative to the stamp already. Times on the clock of the stamp become relative
    to it. Times on another clock, such as one that counts from the sensor's start, become relative
    to the earliest point.

    Args:
        fields: values of each point, by the field's name; fields that are no times are ignored.
        stamp: time of the scan, seconds; NaN if unknown.
        usable: bool (n,), the points that count; others may have any time. None: all.

    Returns:
        None if no field is a time, all times are equal, or they span no sweep.
    """
    for values, unit in time_fields(fields):
        with np.errstate(all="ignore"):
            found = relative_times(values, unit, stamp, usable)
        if found is not None:
            return found
    return None


def is_time(name: str) -> bool:
    """Return whether a field of this name holds a time of each point."""
    return split_name(name)[0] in NAMES


def split_name(name: str) -> tuple[str, TimeUnit | None]:
    """Split a field's name into its plain form and the unit that it states, if any."""
    plain = re.sub(r"[\s_\-]+", "_", name.strip().lower())
    match = re.fullmatch(r"(.+?)_?[\[(](\w+)[\])]", plain) or re.fullmatch(r"(.+)_(\w+)", plain)
    unit = SUFFIXES.get(match[2]) if match else None
    key = (match[1] if match and unit else plain).replace("_", "")
    return key, unit or ("s" if key in ALWAYS_SECONDS else None)


def time_fields(
    fields: Mapping[str, NDArray[Any]],
) -> list[tuple[NDArray[Any], TimeUnit | None]]:
    """Return the fields that are times, with the unit that their names state.

    Whole seconds and their fraction become one field of 64-bit nanoseconds or microseconds.
    """
    times: list[tuple[NDArray[Any], TimeUnit | None]] = []
    parts: dict[tuple[str, TimeUnit], NDArray[Any]] = {}
    for name, values in fields.items():
        key, unit = split_name(name)
        if key not in NAMES:
            continue
        times.append((values, unit))
        if unit is not None and np.issubdtype(values.dtype, np.integer) and len(values):
            parts[key, unit] = values
    for (key, unit), rest in parts.items():
        whole = parts.get((key, "s"))
        per_second = PER_SECOND.get(unit)
        if per_second is None or whole is None or rest.max() >= per_second or whole.max() >= 2**32:
            continue
        total = whole.astype(np.int64) * per_second + rest.astype(np.int64)
        times.insert(0, (total, unit))
    return times


def relative_times(
    values: NDArray[Any], stated: TimeUnit | None, stamp: float, usable: Bool | None
) -> Float64 | None:
    """Return a time field in seconds relative to the stamp; None if it spans no sweep."""
    origin = 0.0
    if np.issubdtype(values.dtype, np.integer) and len(values) and values.max() > EXACT:
        middle = int(np.sort(values)[len(values) // 2])
        # Integers are subtracted before they become float64, so nanoseconds stay exact.
        values, origin = values.astype(np.int64) - np.int64(min(middle, 2**63 - 1)), float(middle)
    offsets = values.astype(np.float64)
    counted = np.isfinite(offsets)
    if usable is not None:
        counted &= usable
    timed = counted & (offsets != -origin)  # points without an echo often have the time 0
    epoch = unit_since_epoch(offsets[timed], origin)
    if epoch is not None or origin:
        counted = timed
    if not counted.any():
        return None
    first, last = float(offsets[counted].min()), float(offsets[counted].max())
    unit = stated or epoch or unit_of_sweep(last - first)
    if unit is None:
        return None
    scale = SECONDS[unit]
    span, start = (last - first) * scale, (origin + first) * scale
    if not 0 < span <= LONGEST_SWEEP:
        return None
    times = (offsets - first) * scale
    times[~counted] = span / 2
    if abs(start) <= 2 * span:
        return np.asarray(times + start)
    if -span <= stamp - start <= 2 * span:
        return np.asarray(times - (stamp - start))
    return times


def unit_since_epoch(offsets: Float64, origin: float) -> TimeUnit | None:
    """Return the unit in which these are times since 1970; None if they are none."""
    if not len(offsets):
        return None
    middle, span = origin + float(np.median(offsets)), float(np.ptp(offsets))
    for unit, scale in SECONDS.items():
        if EPOCH[0] <= middle * scale <= EPOCH[1] and span * scale <= LONGEST_FILE:
            return unit
    return None


def unit_of_sweep(span: float) -> TimeUnit | None:
    """Return the largest unit in which these times span at most one sweep; None if none does."""
    for unit, scale in SECONDS.items():
        if 0 < span * scale <= LONGEST_GUESS:
            return unit
    return None
