"""Decompression whose output is bounded, whatever a header states."""

import bz2

from placecell.sources.errors import DriveError

LARGEST = 1 << 30
"""Largest output, bytes: 20 times the largest cloud of today's sensors."""
STEP = 16 << 20
"""Largest part that is decompressed at once, bytes."""
BLOCK = 256 << 10
"""Compressed bytes to read beyond those that are needed, because formats compress in blocks."""
ZSTD_MAGIC = b"\x28\xb5\x2f\xfd"
KINDS = ("", "none", "lz4", "bz2", "zstd")


def decompress(data: bytes, kind: str, size: int, where: str) -> bytes:
    """Decompress a chunk or a message.

    Args:
        data: the compressed bytes.
        kind: `none`, `lz4`, `bz2` or `zstd`.
        size: bytes that the header states, or 0 if it states none.
        where: file and position, for errors.

    Raises:
        DriveError: the data is damaged, has another size than stated, or is too large.
    """
    if kind in ("", "none"):
        return data
    limit = min(size or LARGEST, LARGEST)
    content = begin_of(data, kind, limit + 1, where)
    if len(content) > limit or (size and len(content) != size):
        found = f"more than {limit}" if len(content) > limit else f"{len(content)}"
        raise DriveError(
            f"{where}: the {kind} data gives {found} bytes; expected {size or 'fewer'}, as the "
            "header states. The file is damaged; copy it again"
        )
    return content


def begin_of(data: bytes, kind: str, length: int, where: str) -> bytes:
    """Decompress the first bytes; fewer if the data ends before them.

    Args:
        data: the compressed bytes, or the first of them.
        kind: `none`, `lz4`, `bz2` or `zstd`.
        length: bytes that are needed.
        where: file and position, for errors.

    Raises:
        DriveError: the data is damaged.
    """
    try:
        if kind == "zstd":
            return unzstd(data, length)
        if kind == "lz4":
            import lz4.frame

            # One byte of LZ4 stands for 255 bytes at most.
            most = min(length, 255 * len(data))
            return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data, max_length=most))
        if kind == "bz2":
            return bz2.BZ2Decompressor().decompress(data, max_length=length)
    except (OSError, RuntimeError, ValueError, EOFError) as error:
        raise DriveError(
            f"{where}: the {kind} data is damaged ({error}). Copy the file again, or use the part "
            "of the recording before it"
        ) from error
    return data[:length]


def unzstd(data: bytes, length: int) -> bytes:
    """Decompress the first bytes of zstd data.

    Raises:
        ValueError: the data is damaged.
    """
    import zstandard

    parts, total = [], 0
    try:
        with zstandard.ZstdDecompressor().stream_reader(data, read_across_frames=True) as reader:
            while part := reader.read(min(STEP, length - total)):
                parts.append(part)
                total += len(part)
    except zstandard.ZstdError as error:
        raise ValueError(str(error)) from error
    return parts[0] if len(parts) == 1 else b"".join(parts)
