"""Range requests (RFC 9110, 14): one part of a file, for resumed downloads and single columns."""

import re
from dataclasses import dataclass

from fastapi import Request

from service.core.problems import Problem

_RANGE = re.compile(r"bytes\s*=\s*(\d{0,18})\s*-\s*(\d{0,18})", re.IGNORECASE)
"""A single range. Several ranges and other units do not match; the answer is the whole file."""


@dataclass(frozen=True, slots=True)
class ByteRange:
    """Part of a file.

    Attributes:
        first: offset of the first byte.
        size: number of bytes.
        total: size of the file, bytes.
    """

    first: int
    size: int
    total: int

    @property
    def content_range(self) -> str:
        """Return the header Content-Range of the part."""
        return f"bytes {self.first}-{self.first + self.size - 1}/{self.total}"


def asked_range(request: Request, tag: str) -> str | None:
    """Return the range that a request asks for; None if it asks for the whole file.

    Args:
        request: the HTTP request.
        tag: ETag of the file without quotes. If-Range with another tag or a date asks for the
            whole file.
    """
    asked = request.headers.get("range")
    # RFC 9110 defines ranges for GET only.
    if asked is None or request.scope["state"].get("is_head"):
        return None
    since = request.headers.get("if-range")
    if since is not None and since.strip() != f'"{tag}"':
        return None
    return asked


def range_of(asked: str, total: int) -> ByteRange | None:
    """Return the part of a file that a Range header names; None for the whole file.

    Raises:
        Problem: 416 if the file has no byte of the range.
    """
    parts = _RANGE.fullmatch(asked.strip())
    if parts is None or not any(parts.groups()):
        return None
    first, last = parts.groups()
    if not first:
        size = min(int(last), total)
        start = total - size
    else:
        start = int(first)
        if last and int(last) < start:
            return None
        size = (min(int(last) + 1, total) if last else total) - start
    if size <= 0:
        raise Problem(
            416,
            "range-not-satisfiable",
            f"The file has {total} bytes, and none of them is in the range {asked!r:.80}. Request "
            "bytes of the file, or the whole file without the header Range.",
            headers={"Content-Range": f"bytes */{total}"},
        )
    return ByteRange(start, size, total)
