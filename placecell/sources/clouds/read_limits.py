"""Limits for reading point cloud files of unknown origin: a small file may claim or hold much."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from math import inf
from pathlib import Path

from placecell.sources.errors import DriveError

LINE_BREAKS = b"\n\r\v\f\x1c\x1d\x1e\x85\xa8\xa9()"
"""Bytes that are a line break, or a part of one, in any encoding of text that readers decode."""
LONGEST_LINE = 32_768
"""Largest plausible size of a point's line of text, bytes."""


class TooLargeError(DriveError):
    """Point cloud file that is larger than the limits."""


@dataclass(frozen=True, slots=True)
class ReadLimits:
    """Limits of a file.

    Attributes:
        points: largest number of points.
        content_bytes: largest size of the decompressed points, bytes.
    """

    points: float = inf
    content_bytes: float = inf


_current: ContextVar[ReadLimits] = ContextVar("read_limits", default=ReadLimits())  # noqa: B039 -- frozen


@contextmanager
def reading_within(limits: ReadLimits) -> Iterator[None]:
    """Limit the point cloud files that are read inside the block."""
    token = _current.set(limits)
    try:
        yield
    finally:
        _current.reset(token)


def check_points(file: Path, points: int) -> None:
    """Refuse a file before its points are decoded.

    Raises:
        TooLargeError: it states more points than the limit.
    """
    limit = _current.get().points
    if points > limit:
        raise TooLargeError(
            f"{file}: has {points:,} points; the limit is {limit:,}. Thin it out, for example to "
            "one point for each voxel of 0.1 m"
        )


def check_bytes(file: Path, claimed: int) -> None:
    """Refuse a file before it is decompressed.

    Raises:
        TooLargeError: it claims to become larger than the limit.
    """
    limit = _current.get().content_bytes
    if claimed > limit:
        raise TooLargeError(
            f"{file}: its points claim to have {claimed:,} bytes; the limit is {limit:,}. Write "
            "the file with fewer points or fewer fields"
        )


def check_text(file: Path, content: bytes) -> None:
    """Refuse text before it is split: each line, and each value, is a Python object for a while.

    Raises:
        TooLargeError: it has more lines or values than points within the limit have.
    """
    limit = _current.get().points
    if limit == inf:
        return
    lines = len(content) - len(content.translate(None, LINE_BREAKS))
    if lines > 2 * limit + 1000:  # a line may end with two bytes
        raise TooLargeError(
            f"{file}: has about {lines:,} lines; the limit is {limit:,} points. Thin it out, for "
            "example to one point for each voxel of 0.1 m"
        )
    longest = max(map(len, content.replace(b"\r", b"\n").split(b"\n")), default=0)
    if longest > LONGEST_LINE:
        raise TooLargeError(
            f"{file}: a line has {longest:,} bytes; expected a point a line. Write the file again"
        )
