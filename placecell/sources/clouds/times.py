"""Times of scans, from the names of files or from a file of times beside them."""

import re
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from placecell.core.types import Float64
from placecell.trajectories.times import (
    SECONDS,
    TimeUnit,
    find_unit,
    parse_clock,
    unit_since_epoch,
)

TIME_FILES = ("times", "timestamps", "timestamp", "time", "stamps")
SUFFIXES = (".txt", ".csv")
LONGEST = 100 * 2**20
"""Largest file of times that is read, bytes."""
SECONDS_AND_REST = re.compile(r"(?<!\d)(\d{9,10})([._-])(\d{1,9})(?!\d)")
DATE = re.compile(
    r"(?<!\d)(\d{4})[-_.]?(\d\d)[-_.]?(\d\d)[-_.T ]?(\d\d)[-_.:]?(\d\d)[-_.:]?(\d\d)"
    r"(?:[-_.,](\d{1,9}))?(?!\d)"
)


def stamps_of_names(stems: Sequence[str]) -> Float64 | None:
    """Return the times that names state, seconds since 1970; None if they are no times.

    Understood are seconds with a fraction (`1583836591.546391000`), seconds and nanoseconds
    (`cloud_1583836591_546391000`), milliseconds, microseconds, nanoseconds, and dates
    (`2020-03-10_11-36-31_546`). All names must state different times.
    """
    for found in (seconds_and_rest(stems), whole_numbers(stems), dates(stems)):
        if found is not None and len(np.unique(found)) == len(stems):
            return found
    return None


def seconds_and_rest(stems: Sequence[str]) -> Float64 | None:
    """Return times that are written as seconds and their fraction."""
    matches = [SECONDS_AND_REST.search(stem) for stem in stems]
    found = [match for match in matches if match is not None]
    if len(found) < len(stems) or unit_since_epoch([int(each[1]) for each in found]) != "s":
        return None
    digits = {len(match[3]) for match in found}
    if all(match[2] == "." for match in found):
        return np.array([float(f"{match[1]}.{match[3]}") for match in found])
    # One length of 3 or 6 digits is milliseconds or microseconds; else nanoseconds, often
    # without leading zeros.
    scale = 10.0 ** -digits.pop() if digits in ({3}, {6}) else 1e-9
    return np.array([int(match[1]) + int(match[3]) * scale for match in found])


def whole_numbers(stems: Sequence[str]) -> Float64 | None:
    """Return times that are written as one whole number."""
    numbers = [re.findall(r"\d+", stem) for stem in stems]
    if not all(numbers):
        return None
    last = [int(each[-1]) for each in numbers]
    unit = unit_since_epoch(last)
    if unit is None:
        return None
    # Whole seconds and the rest are divided apart: both are exact.
    per_second = round(1 / SECONDS[unit])
    return np.array([n // per_second + n % per_second / per_second for n in last])


def dates(stems: Sequence[str]) -> Float64 | None:
    """Return times that are written as dates, taken as UTC."""
    times = [date_of(stem) for stem in stems]
    return None if None in times else np.array(times, np.float64)


def date_of(text: str) -> float | None:
    """Return the date in a text, seconds since 1970; None if there is none."""
    match = DATE.search(text)
    if match is None:
        return None
    year, month, day, hour, minute, second = (int(part) for part in match.groups()[:6])
    try:
        moment = datetime(year, month, day, hour, minute, second, tzinfo=UTC)
    except ValueError:
        return None
    return moment.timestamp() + (float(f"0.{match[7]}") if match[7] else 0.0)


def stamps_beside(
    files: Sequence[Path], folders: Sequence[Path], stated: TimeUnit
) -> tuple[Float64 | None, str] | None:
    """Read the times of scans from a file beside them.

    Args:
        files: the scans, in their order.
        folders: where the file may be.
        stated: unit that the user states; "s" means: found from the values.

    Returns:
        The stamps or None, and a remark on where they come from or why they are not used; None
        if there is no file of times.
    """
    for folder in folders:
        for name in TIME_FILES:
            for suffix in SUFFIXES:
                file = folder / (name + suffix)
                if file.is_file() and file.stat().st_size < LONGEST:
                    return stamps_in(file, files, stated)
    return None


def stamps_in(file: Path, scans: Sequence[Path], stated: TimeUnit) -> tuple[Float64 | None, str]:
    """Return the stamps that a file of times gives, and a remark."""
    times = read_times(file)
    if times is None:
        return None, f"{file.name} is not used: it is no list of times"
    if len(times) != len(scans):
        numbers = [scan.stem for scan in scans]
        if not all(number.isdecimal() and int(number) < len(times) for number in numbers):
            return None, (
                f"{file.name} is not used: it has {len(times)} times for {len(scans)} scans"
            )
        times = times[[int(number) for number in numbers]]  # some scans are missing
    steps = np.diff(times)
    if (steps < 0).any():
        first = int((steps < 0).argmax()) + 1
        return None, f"{file.name} is not used: time decreases at scan {first}"
    unit = stated if stated != "s" else find_unit(times)
    return times * SECONDS[unit], f"the times of the scans are in {file.name}, in {unit}"


def read_times(file: Path) -> Float64 | None:
    """Return the times in a file, one a line; None if it has none.

    Lines may be dates. Of two columns, a number of the scan or a file's name may be the first.
    """
    try:
        text = file.read_text(encoding="utf-8-sig", errors="replace")
    except OSError:
        return None
    lines = [line.strip() for line in text.splitlines()]
    lines = [line for line in lines if line and not line.startswith(("#", "//", "%"))]
    moments = [parse_clock(line) for line in lines]
    if lines and None not in moments:
        return np.array(moments, np.float64)
    rows = [re.split(r"[\s,;]+", line) for line in lines]
    if rows and number_of(rows[0][0]) is None and number_of(rows[0][-1]) is None:
        rows = rows[1:]  # a header
    for column in (0, 1):
        numbers = [number_of(row[column]) if column < len(row) else None for row in rows]
        if not rows or None in numbers:
            continue
        times = np.array(numbers, np.float64)
        counts = np.arange(len(times))
        if np.isfinite(times).all() and not any(
            np.array_equal(times, counts + first) for first in (0, 1)
        ):
            return times
    return None


def number_of(word: str) -> float | None:
    """Return a word as a number; None if it is none."""
    try:
        return float(word)
    except ValueError:
        return None
