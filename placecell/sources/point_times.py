"""Names of the fields that hold the times of points; they vary by driver."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell.trajectories.times import TimeUnit

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
) -> dict[str, tuple[NDArray[Any], TimeUnit | None]]:
    """Return the fields that are times, by name, with the unit that their names state.

    Whole seconds and their fraction in two fields, such as `time_sec` and `time_nsec`, come first,
    as one field of 64-bit nanoseconds or microseconds.
    """
    times: dict[str, tuple[NDArray[Any], TimeUnit | None]] = {}
    parts: dict[tuple[str, TimeUnit], str] = {}
    for name, values in fields.items():
        key, unit = split_name(name)
        if key not in NAMES:
            continue
        times[name] = values, unit
        if unit is not None and values.dtype.kind in "iu" and len(values):
            parts[key, unit] = name
    for (key, unit), name in parts.items():
        seconds = parts.get((key, "s"))
        per_second = PER_SECOND.get(unit)
        if per_second is None or seconds is None:
            continue
        whole, rest = fields[seconds], fields[name]
        if rest.max() < per_second and whole.max() < 2**32:
            total = whole.astype(np.int64) * per_second + rest.astype(np.int64)
            times = {f"{seconds} and {name}": (total, unit)} | times
    return times
