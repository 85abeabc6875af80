"""Decompression whose output is bounded, whatever a header states."""

import bz2

from placecell.sources.errors import DriveError

LARGEST = 1 << 30
"""Largest output, bytes: 20 times the largest cloud of today's sensors."""
STEP = 16 << 20
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
KINDS = ("", "none", "lz4", "bz2", "zstd")


def decompress(data: bytes, kind: str, size: int, where: str) -> bytes:
    """Decompress a chunk or a message.

    Args:
        kind: `none`, `lz4`, `bz2` or `zstd`.
        size: bytes that the header states, or 0 if it states none.
        where: file and position, for errors.

    Raises:
        DriveError: the data is damaged, has another size than stated, or is too large.
    """
    if kind in ("", "none"):
        return data
    limit = min(size or LARGEST, LARGEST)
    try:
        if kind == "zstd":
            content = unzstd(data, limit)
        elif kind == "lz4":
            import lz4.frame

            # One byte of LZ4 stands for 255 bytes at most.
            most = min(limit, 255 * len(data))
            content = lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most)
        else:
            content = bz2.BZ2Decompressor().decompress(data, max_length=limit)
    except (OSError, RuntimeError, ValueError, EOFError, MemoryError) as error:
        raise DriveError(
            f"{where}: the {kind} data is damaged ({error}). Copy the file again, or use the part "
            "of the recording before it"
        ) from error
    if size and len(content) != size:
        raise DriveError(
            f"{where}: the {kind} data gives {len(content)} bytes; the header states {size}. The "
            "file is damaged; copy it again"
        )
    return content


def unzstd(data: bytes, limit: int) -> bytes:
    """Decompress zstd data up to a limit.

    Raises:
        ValueError: the data is damaged or longer.
    """
    import zstandard

    parts, total = [], 0
    try:
        with zstandard.ZstdDecompressor().stream_reader(data, read_across_frames=True) as reader:
            while part := reader.read(min(STEP, limit + 1 - total)):
                parts.append(part)
                total += len(part)
                if total > limit:
                    raise ValueError(f"more than {limit} bytes")
    except zstandard.ZstdError as error:
        raise ValueError(str(error)) from error
    return parts[0] if len(parts) == 1 else b"".join(parts)
