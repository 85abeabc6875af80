"""Decompression of bodies with limits, because a small body can expand to a large one."""

import zlib
from collections.abc import Iterator
from typing import Any

import zstandard

from placecell.core.cancellation import current
from service.core.problems import Problem

CODINGS = ("gzip", "zstd")

WINDOW_BYTES = 8 << 20
"""Largest window of a zstd frame, bytes. RFC 8878 asks every decoder to support this size."""

MEMBERS = 4_096
"""Largest number of gzip members or zstd frames in a body. Even an empty one costs time."""

GZIP_PIECE = 64 << 10
"""Compressed gzip bytes per step. The work can be cancelled after each step."""

ZSTD_PIECE = 512
"""Compressed zstd bytes per step. Four bytes can expand to 128 KiB."""


def decompress(content: bytes, coding: str, limit: int) -> bytes:
    """Return the decompressed content of a body.

    Args:
        content: compressed body.
        coding: content coding, one of `CODINGS`.
        limit: largest decompressed size, bytes. Decompression stops soon after it.

    Raises:
        Problem: 413 if the content is larger or has too many members; 400 if it is not validly
            compressed.
        Cancelled: the deadline has passed, or the client has disconnected.
    """
    try:
        return _gunzip(content, limit) if coding == "gzip" else _unzstd(content, limit)
    except (EOFError, zlib.error, zstandard.ZstdError) as error:
        raise Problem(
            400, f"not-{coding}", f"The body cannot be read as {coding}: {error!s:.100}."
        ) from error


class _Output:
    """Decompressed output so far."""

    def __init__(self, limit: int) -> None:
        self._parts: list[bytes] = []
        self._limit = limit
        self.members = 0
        self._bytes = 0

    def add(self, part: bytes) -> None:
        self._bytes += len(part)
        if self._bytes > self._limit:
            raise Problem(
                413,
                "body-too-large",
                f"The decompressed body is larger than {self._limit} bytes, the limit. Send "
                "smaller bodies; GET /info shows all limits.",
            )
        if part:
            self._parts.append(part)

    def begin_member(self) -> None:
        self.members += 1
        if self.members > MEMBERS:
            raise Problem(
                413,
                "too-many-members",
                f"The compressed body has more than {MEMBERS} members, the limit. Compress the "
                "body as a single member.",
            )

    @property
    def room(self) -> int:
        return self._limit - self._bytes + 1

    def joined(self) -> bytes:
        return b"".join(self._parts)


def _pieces(content: bytes, size: int) -> Iterator[bytes]:
    token = current()
    for at in range(0, len(content), size):
        token.check()
        yield content[at : at + size]


def _gunzip(content: bytes, limit: int) -> bytes:
    output = _Output(limit)
    decoder: Any = None
    for piece in _pieces(content, GZIP_PIECE):
        rest = piece
        while rest:
            if decoder is None:
                if output.members and not (rest := rest.lstrip(b"\0")):
                    break  # zero padding
                output.begin_member()
                decoder = zlib.decompressobj(wbits=zlib.MAX_WBITS | 16)
            output.add(decoder.decompress(rest, output.room))
            rest = decoder.unconsumed_tail
            if decoder.eof:
                rest = decoder.unused_data
                decoder = None
    if decoder is not None:
        raise EOFError("it ends too early")
    return output.joined()


def _unzstd(content: bytes, limit: int) -> bytes:
    output = _Output(limit)
    decompressor = zstandard.ZstdDecompressor(max_window_size=WINDOW_BYTES)
    decoder: Any = None
    for piece in _pieces(content, ZSTD_PIECE):
        rest = piece
        while rest:
            if decoder is None:
                output.begin_member()
                decoder = decompressor.decompressobj()
            output.add(decoder.decompress(rest))
            rest = b""
            if decoder.eof:
                rest = decoder.unused_data
                decoder = None
    if decoder is not None:
        raise EOFError("it ends too early")
    return output.joined()
