"""Time stamps: their unit, and their order."""

import math
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Literal

import numpy as np

from placecell.core.types import Float64

TimeUnit = Literal["s", "ms", "us", "ns"]

SECONDS: dict[TimeUnit, float] = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
UNIT_NAMES: dict[TimeUnit, str] = {
    "s": "seconds",
    "ms": "milliseconds",
    "us": "microseconds",
    "ns": "nanoseconds",
}

EPOCH = (9e8, 4.2e9)
"""Times since 1970, seconds: from 1998 to 2103. Those of two units never overlap."""
STEPS = (5e-4, 20.0)
"""Plausible time from one pose to the next, seconds (median)."""
USUAL_STEP = 0.05
LONGEST_STEP = 600.0
"""Longest plausible time from one pose to the next since 1970, seconds (median)."""


def unit_since_epoch(values: Sequence[float]) -> TimeUnit | None:
    """Return the unit in which all values are times since 1970; None if there is none."""
    for unit, size in SECONDS.items():
        if all(EPOCH[0] <= value * size <= EPOCH[1] for value in values):
            return unit
    return None


def find_unit(times: Float64) -> TimeUnit:
    """Return the unit of times, told by their magnitude and by the time between them.

    Times since 1970 have a magnitude for each unit. Times since some other moment are seconds,
    unless the steps are too long for it.
    """
    median = float(np.median(np.abs(times)))
    steps = np.diff(np.sort(times))
    steps = steps[steps > 0]
    step = float(np.median(steps)) if len(steps) else 0.0
    since_epoch = unit_since_epoch([median])
    if since_epoch and step * SECONDS[since_epoch] <= LONGEST_STEP:
        return since_epoch
    able = [unit for unit, size in SECONDS.items() if STEPS[0] <= step * size <= STEPS[1]]
    if not able or "s" in able:
        return "s"
    return min(able, key=lambda unit: abs(math.log10(step * SECONDS[unit] / USUAL_STEP)))


def parse_clock(text: str) -> float | None:
    """Return a date with a time, such as 2011-09-30 12:40:59.5, as seconds since 1970, or None."""
    if ":" not in text or "-" not in text:
        return None
    head, dot, fraction = text.replace("Z", "").partition(".")
    try:
        found = datetime.fromisoformat(head if not dot else f"{head}.{fraction[:6]:0<6}")
    except ValueError:
        return None
    return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()


def in_order(stamps: Float64, poses: Float64) -> tuple[Float64, Float64, Sequence[str]]:
    """Sort poses by time and drop those that repeat a time; return remarks on both."""
    remarks = list[str]()
    if (np.diff(stamps) < 0).any():
        at = int((np.diff(stamps) < 0).argmax()) + 1
        remarks.append(f"the times are not in order, first at pose {at}; the poses are sorted")
    found, first = np.unique(stamps, return_index=True)
    if len(found) < len(stamps):
        remarks.append(f"{len(stamps) - len(found)} poses repeat a time; the first of each counts")
    return found, poses[first], remarks
