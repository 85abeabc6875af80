"""Compressed bodies, taken apart within a limit: a small body can hold a large one."""

import gzip
import zlib
from io import BytesIO

import zstandard

from service.problems import Problem

CODINGS = ("gzip", "zstd")

WINDOW_BYTES = 8 << 20
"""Of zstd, at most, as RFC 8878 wants every decoder to support."""


def decompress(content: bytes, coding: str, limit: int) -> bytes:
    """What a body holds.

    Args:
        coding: one of `CODINGS`.
        limit: bytes that it may hold; not much more is ever taken apart.

    Raises:
        Problem: 413 if it holds more, 400 if it is not in its coding.
    """
    try:
        if coding == "gzip":
            with gzip.GzipFile(fileobj=BytesIO(content)) as file:
                inner = file.read(limit + 1)
        else:
            decoder = zstandard.ZstdDecompressor(max_window_size=WINDOW_BYTES)
            with decoder.stream_reader(BytesIO(content), read_across_frames=True) as reader:
                inner = reader.read(limit + 1)
    except (OSError, EOFError, zlib.error, zstandard.ZstdError) as error:
        raise Problem(
            400, f"not-{coding}", f"The body cannot be read as {coding}: {error!s:.100}."
        ) from error
    if len(inner) > limit:
        raise Problem(
            413, "body-too-large", f"The body holds more than {limit} bytes, the limit; see /info."
        )
    return inner
