"""LAS files of the ASPRS, and LAZ, their compressed form."""

import logging
import struct
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell.sources.clouds.cloud import Cloud, check_growth, cut_short, read_content, reason_of
from placecell.sources.clouds.read_limits import check_bytes, check_points
from placecell.sources.errors import DriveError

SMALLEST_HEADER = 227
RECORD_HEADER = 54
"""Bytes of the header of a variable length record."""
POINTS_AT_ONCE = 1_000_000
COMPRESSED = 0x80
"""Bit of the point format that marks a LAZ file."""
SHORTEST_POINT = 20
LASZIP, LASZIP_RECORD = b"laszip encoded", 22204
"""User and number of the record on the compression."""
ITEMS = 32
"""Offset in that record of the number of the parts of a point, before the parts."""
ITEM_BYTES = {6: 20, 7: 8, 8: 6, 9: 29, 10: 30, 11: 6, 12: 8, 13: 29}
"""Bytes of each type of a part; extra bytes (0, 14) may have any number."""
LAYERS, EXTRA_14 = {10: 9, 11: 1, 12: 2, 13: 1}, 14
"""Layers of each type of a part of the point formats from 6 on; extra bytes have one a byte."""


@dataclass(frozen=True, slots=True)
class LasHeader:
    """Part of a LAS header that decides how much memory a file takes."""

    points: int
    start: int
    point_bytes: int
    compressed: bool
    header_bytes: int
    records: int


def is_las(head: bytes) -> bool:
    """Return whether a file begins as a LAS or LAZ file does."""
    return head.startswith(b"LASF")


def read_las(file: Path) -> Cloud:
    """Read a LAS or LAZ file; coordinates are float64, as the file scales them.

    Raises:
        DriveError: the file is damaged.
    """
    content = read_content(file)
    header = parse_header(content, file)
    check_points(file, header.points)
    check_bytes(file, header.points * header.point_bytes)
    if header.compressed:
        check_growth(file, len(content), header.points * header.point_bytes)
    content = plain_text(content, header, file)
    if header.compressed:
        check_chunk_table(content, header, file)
    elif header.start + header.points * header.point_bytes > len(content):
        room = max(len(content) - header.start, 0) // header.point_bytes
        raise cut_short(file, "points", room, header.points)
    import laspy
    from lazrs import LazrsError

    logging.getLogger("laspy").setLevel(logging.CRITICAL)  # what it logs is raised as well
    columns: dict[str, list[NDArray[Any]]] = {"x": [], "y": [], "z": []}
    try:
        with (
            np.errstate(all="ignore"),
            laspy.open(
                BytesIO(content), read_evlrs=False, laz_backend=laspy.LazBackend.Lazrs
            ) as reader,
        ):
            fields = tuple(reader.header.point_format.dimension_names)
            if "gps_time" in fields:
                columns["gps_time"] = []
            for chunk in reader.chunk_iterator(POINTS_AT_ONCE):
                for name, parts in columns.items():
                    parts.append(np.asarray(getattr(chunk, name), np.float64))
    except (
        laspy.LaspyException, LazrsError, struct.error, ValueError, KeyError, IndexError,
        OverflowError, EOFError, AssertionError, TypeError, MemoryError,
    ) as error:  # fmt: skip
        raise damaged(file, error) from error
    except BaseException as error:
        # lazrs is written in Rust; its panics are no Exception.
        if type(error).__name__ != "PanicException":
            raise
        raise damaged(file, error) from error
    values = {
        name: np.concatenate(parts) if parts else np.zeros(0) for name, parts in columns.items()
    }
    if len(values["x"]) < header.points:
        raise cut_short(file, "points", len(values["x"]), header.points)
    return Cloud(values, ("x", "y", "z", *(each for each in fields if each not in "XYZ")))


def damaged(file: Path, error: BaseException) -> DriveError:
    """Return the error for a file that laspy or lazrs refuses."""
    return DriveError(
        f"{file}: its LAS content cannot be decoded ({reason_of(error)}); the file is damaged. "
        "Write it again"
    )


def parse_header(content: bytes, file: Path) -> LasHeader:
    """Parse the counts and sizes of the header; laspy believes them, whatever the file's size.

    Raises:
        DriveError: they contradict the file.
    """
    if len(content) < SMALLEST_HEADER:
        raise cut_short(file, "bytes of header", len(content), SMALLEST_HEADER)
    minor = content[25]
    header_bytes, start, records = struct.unpack_from("<HII", content, 94)
    kind, point_bytes, points = struct.unpack_from("<BHI", content, 104)
    if content[24] != 1 or minor > 5:
        raise DriveError(
            f"{file}: is LAS version {content[24]}.{minor}; expected 1.0 to 1.5. Convert it, for "
            "example with 'pdal translate'"
        )
    if minor >= 4:
        if len(content) < 375:
            raise cut_short(file, "bytes of header", len(content), 375)
        points = struct.unpack_from("<Q", content, 247)[0]
    within = header_bytes + records * RECORD_HEADER <= start <= len(content)
    if not within or header_bytes < SMALLEST_HEADER or point_bytes < SHORTEST_POINT:
        raise DriveError(
            f"{file}: its LAS header states {records:,} records after {header_bytes} bytes, points "
            f"of {point_bytes} bytes, and points from byte {start:,} on, but the file has "
            f"{len(content):,} bytes; it is cut short or damaged. Copy or write it again"
        )
    return LasHeader(points, start, point_bytes, bool(kind & COMPRESSED), header_bytes, records)


def plain_text(content: bytes, header: LasHeader, file: Path) -> bytes:
    """Replace characters beyond ASCII in the names of the records' users.

    laspy refuses files with such a name that is not UTF-8.

    Raises:
        DriveError: a record is damaged.
    """
    names = []
    position = header.header_bytes
    for _ in range(header.records):
        user, kind, length = struct.unpack_from("<16sHH", content, position + 2)
        names.append(slice(position + 2, position + 18))
        if user.startswith(LASZIP) and kind == LASZIP_RECORD:
            kinds = check_items(content[position + RECORD_HEADER :][:length], header, file)
            check_layers(content, header, kinds, file)
        position += RECORD_HEADER + length
        if position > header.start:
            raise DriveError(
                f"{file}: its {header.records:,} LAS records reach beyond its first point; the "
                "file is damaged. Write it again"
            )
    if all(content[name].isascii() for name in names):
        return content
    plain = bytearray(content)
    for name in names:
        plain[name] = bytes(byte if byte < 128 else ord("?") for byte in plain[name])
    return bytes(plain)


def check_items(record: bytes, header: LasHeader, file: Path) -> list[tuple[int, int]]:
    """Check the parts of a point in the record on the compression; lazrs panics if one is wrong.

    Returns:
        The type and the bytes of each part.

    Raises:
        DriveError: a part has another size than its type, or they are not as long as a point.
    """
    count = int.from_bytes(record[ITEMS : ITEMS + 2], "little")
    parts = record[ITEMS + 2 :][: 6 * count]
    items = list(struct.iter_unpack("<HHH", parts[: len(parts) // 6 * 6]))
    wrong = [kind for kind, size, _ in items if ITEM_BYTES.get(kind, size) != size]
    total = sum(size for _, size, _ in items)
    if wrong or len(items) != count or total != header.point_bytes:
        raise DriveError(
            f"{file}: its record on the compression names parts of {total} bytes, but a point has "
            f"{header.point_bytes}; the file is damaged. Write it again"
        )
    return [(kind, size) for kind, size, _ in items]


def check_layers(
    content: bytes, header: LasHeader, parts: list[tuple[int, int]], file: Path
) -> None:
    """Check the sizes of the layers of each chunk; lazrs allocates what they claim, or aborts.

    A chunk of the point formats from 6 on has its first point as it is, its number of points, the
    sizes of its layers, and the layers.

    Raises:
        DriveError: a layer reaches beyond the file.
    """
    layers = sum(size if kind == EXTRA_14 else LAYERS.get(kind, 0) for kind, size in parts)
    position, left = header.start + 8, header.points
    while layers and left > 0:
        end = position + header.point_bytes + 4 + 4 * layers
        count, sizes = 0, [0]
        if end <= len(content):
            count, *sizes = struct.unpack_from(
                f"<{1 + layers}I", content, position + header.point_bytes
            )
        position, left = end + sum(sizes), left - count
        if position > len(content) or not count:
            raise DriveError(
                f"{file}: a compressed chunk reaches beyond the file's {len(content):,} bytes; the "
                "file is cut short or damaged. Copy or write it again"
            )


def check_chunk_table(content: bytes, header: LasHeader, file: Path) -> None:
    """Refuse a chunk table with more chunks than bytes; lazrs allocates what the table claims.

    Raises:
        DriveError: the table lies outside the file, or claims too many chunks.
    """
    if not header.points:
        return
    position = -1
    if header.start + 8 <= len(content):
        position = struct.unpack_from("<q", content, header.start)[0]
    if position == -1:
        position = struct.unpack_from("<q", content, len(content) - 8)[0]
    chunks = -1
    if header.start < position <= len(content) - 8:
        chunks = struct.unpack_from("<I", content, position + 4)[0]
    if not 0 <= chunks <= min(header.points, len(content)):
        raise DriveError(
            f"{file}: its table of compressed chunks lies at byte {position:,} of {len(content):,} "
            "or claims more chunks than points; the file is cut short or damaged. Copy or write "
            "it again"
        )
