"""PCD files of the Point Cloud Library."""

import struct
from dataclasses import dataclass
from io import BufferedReader, BytesIO
from pathlib import Path

import numpy as np

from placecell.core.cancellation import checked
from placecell.sources.clouds.cloud import (
    HEAD,
    Cloud,
    cut_short,
    needed_fields,
    printable,
    read_content,
    reason_of,
)
from placecell.sources.clouds.read_limits import check_bytes, check_points, check_text
from placecell.sources.errors import DriveError

LZF_GROWTH = 88
"""Most bytes that one byte of LZF can become: three bytes stand for at most 264."""
ITEM_TYPES = {"F": (4, 8), "I": (1, 2, 4, 8), "U": (1, 2, 4, 8)}
HEADER_LINES = (
    "VERSION", "FIELDS", "COLUMNS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT",
    "POINTS",
)  # fmt: skip
"""Lines that a PCD header has before DATA."""

PADDING = "_"
IDENTITY = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
MOST_FIELDS = 1024
MOST_VALUES = 65_536
"""Most values of a point; `pypcd4` names each of them."""


@dataclass(frozen=True, slots=True)
class PcdHeader:
    """Header of a PCD file.

    Attributes:
        fields: name, type (`F`, `I` or `U`), bytes and count of each field.
        points: number of points that the header states.
        grid: WIDTH times HEIGHT; None if the header lacks one of them.
        viewpoint: position and quaternion (w, x, y, z) of the sensor.
        data: ascii, binary or binary_compressed.
        start: offset of the data in the file.
    """

    fields: tuple[tuple[str, str, int, int], ...]
    points: int
    grid: int | None
    viewpoint: tuple[float, ...]
    data: str
    start: int

    @property
    def point_bytes(self) -> int:
        """Return the bytes of a point."""
        return sum(size * count for _, _, size, count in self.fields)


def is_pcd(head: bytes) -> bool:
    """Return whether a file begins as a PCD file does."""
    lines = [line.strip() for line in head[:4096].splitlines()]
    begun = [line for line in lines if line and not line.startswith(b"#")][:1]
    return head.startswith((b"# .PCD", b"#.PCD")) or (
        bool(begun) and begun[0].split()[0] in (b"VERSION", b"FIELDS", b"COLUMNS")
    )


def read_pcd(file: Path) -> Cloud:
    """Read a PCD file: ascii, binary or binary_compressed, with any fields.

    Raises:
        DriveError: the file is damaged or not understood.
    """
    content = read_content(file)
    header = parse_header(content, file)
    remarks = list[str]()
    body = content[header.start :]
    check_points(file, header.points)
    if header.data == "ascii":
        check_text(file, body)
        rows, body = ascii_rows(body)
        header = agreed_points(header, rows, "rows of points", file, remarks)
        body = b"\n".join(body.splitlines()[: header.points])
    elif header.data == "binary":
        rows = len(body) // header.point_bytes
        header = agreed_points(header, rows, "points", file, remarks)
        body = body[: header.points * header.point_bytes]
    else:
        header = check_compressed(header, body, file, remarks)
    return decode(file, header, body, tuple(remarks))


def parse_header(content: bytes, file: Path) -> PcdHeader:
    """Parse the header, with the defaults of PCL for lines that are missing.

    `pypcd4` refuses versions other than 0.7, comments after the header's eleventh line, and files
    without COUNT, WIDTH or POINTS, and cuts field names at signs such as `/`.

    Raises:
        DriveError: a line is missing or contradicts another.
    """
    entries: dict[str, list[str]] = {}
    start = 0
    while "DATA" not in entries:
        end = content.find(b"\n", start, start + HEAD)
        if end < 0 or end > HEAD:
            # The names come from the file, and a file that is no PCD has any bytes in them.
            found = ", ".join(key for key in entries if key in HEADER_LINES)
            ends = f"its PCD header ends after {found}," if found else "it has a PCD header"
            raise DriveError(
                f"{file}: {ends} without a line DATA; the file is cut short, damaged, or not a PCD "
                "file. Copy or write it again"
            )
        line = printable(content[start:end].decode("utf-8", "replace").strip())
        start = end + 1
        if line and not line.startswith("#"):
            key, *values = line.split()
            entries.setdefault(key.upper(), values)
    names = entries.get("FIELDS") or entries.get("COLUMNS") or []
    if not 1 <= len(names) <= MOST_FIELDS:
        raise DriveError(
            f"{file}: its PCD header names {len(names)} fields in its line FIELDS; expected 1 to "
            f"{MOST_FIELDS:,}. Write the file again"
        )
    fields = list(
        zip(
            names,
            (each.upper() for each in entries.get("TYPE", ["F"] * len(names))),
            whole_numbers(entries.get("SIZE", ["4"] * len(names)), "SIZE", file),
            whole_numbers(entries.get("COUNT", ["1"] * len(names)), "COUNT", file),
            strict=False,
        )
    )
    wrong = [each for each in fields if each[2] not in ITEM_TYPES.get(each[1], ())]
    counts = [each[3] for each in fields]
    if len(fields) != len(names) or wrong or min(counts) < 1 or sum(counts) > MOST_VALUES:
        odd = f"the type {wrong[0][1]} of {wrong[0][2]} bytes" if wrong else "other numbers of them"
        raise DriveError(
            f"{file}: its PCD header has {len(names)} FIELDS, but {odd} in SIZE, TYPE or COUNT. "
            "The file is damaged; write it again"
        )
    sizes = {
        key: whole_numbers(entries[key][:1], key, file)[0]
        for key in ("WIDTH", "HEIGHT", "POINTS")
        if entries.get(key)
    }
    grid = sizes["WIDTH"] * sizes.get("HEIGHT", 1) if "WIDTH" in sizes else None
    points = sizes.get("POINTS", grid)
    if points is None:
        raise DriveError(
            f"{file}: its PCD header states neither POINTS nor WIDTH; add a line POINTS with the "
            "number of points"
        )
    data = (entries["DATA"] or [""])[0].lower()
    data = "binary_compressed" if data == "binaryscompressed" else data  # as old pypcd writes it
    if data not in ("ascii", "binary", "binary_compressed"):
        raise DriveError(
            f"{file}: its PCD header states DATA {data!r}; expected ascii, binary or "
            "binary_compressed"
        )
    try:
        viewpoint = tuple(float(value) for value in entries.get("VIEWPOINT", ()))
    except ValueError:
        viewpoint = ()
    return PcdHeader(
        tuple(fields), points, grid, viewpoint if len(viewpoint) == 7 else IDENTITY, data, start
    )


def whole_numbers(words: list[str], key: str, file: Path) -> list[int]:
    """Parse the numbers of a header line.

    Raises:
        DriveError: one is no whole number from 0 on.
    """
    for word in words:
        if not (word.isascii() and word.isdecimal() and len(word) < 19):
            raise DriveError(
                f"{file}: its PCD header has {key} {word!r}; expected a whole number. The file is "
                "damaged; write it again"
            )
    return [int(word) for word in words]


def agreed_points(
    header: PcdHeader, rows: int, what: str, file: Path, remarks: list[str]
) -> PcdHeader:
    """Return the header with the number of points that the file has.

    Raises:
        DriveError: the file has fewer than the header states.
    """
    points = header.points
    if header.grid is not None and header.grid != points:
        remarks.append(
            f"WIDTH x HEIGHT is {header.grid:,}, but POINTS is {points:,}; the file has {rows:,}"
        )
        if rows < points or rows == header.grid:
            points = header.grid
    if rows < points:
        raise cut_short(file, what, rows, points)
    return with_points(header, points)


def with_points(header: PcdHeader, points: int) -> PcdHeader:
    """Return the header with another number of points."""
    return PcdHeader(
        header.fields, points, header.grid, header.viewpoint, header.data, header.start
    )


def ascii_rows(body: bytes) -> tuple[int, bytes]:
    """Return the rows of an ascii body, with one space between values.

    `pypcd4` refuses tabs, two spaces, spaces at the end, and empty lines.
    """
    rows = [
        b" ".join(words)
        for line in checked(body.splitlines())
        if (words := line.split()) and not words[0].startswith(b"#")
    ]
    return len(rows), b"\n".join(rows)


def check_compressed(header: PcdHeader, body: bytes, file: Path, remarks: list[str]) -> PcdHeader:
    """Check the sizes of a compressed body before it is decompressed.

    PCL leaves padding fields out of compressed data, but `pypcd4` expects them.

    Raises:
        DriveError: the sizes contradict each other or the file.
    """
    if header.points == 0 and header.grid in (0, None):
        return header
    if len(body) < 8:
        raise cut_short(file, "bytes of compressed data", len(body), 8)
    packed, unpacked = struct.unpack("<II", body[:8])
    check_bytes(file, unpacked)
    if packed > len(body) - 8:
        raise cut_short(file, "bytes of compressed data", len(body) - 8, packed)
    if packed < len(body) - 8:
        remarks.append("bytes after the compressed block are ignored, as PCL writes whole pages")
    without = PcdHeader(
        tuple(each for each in header.fields if each[0] != PADDING),
        header.points, header.grid, header.viewpoint, header.data, header.start,
    )  # fmt: skip
    for fields in (header, without):
        for points in (header.points, header.grid):
            if points is not None and points * fields.point_bytes == unpacked:
                if unpacked > LZF_GROWTH * packed + 8:
                    break
                return with_points(fields, points)
    raise DriveError(
        f"{file}: its {packed:,} bytes of compressed data claim to become {unpacked:,} bytes, but "
        f"{header.points:,} points have {header.points * header.point_bytes:,}; the file is "
        "damaged. Write it again"
    )


def decode(file: Path, header: PcdHeader, body: bytes, remarks: tuple[str, ...]) -> Cloud:
    """Decode the body with `pypcd4`.

    Raises:
        DriveError: the data are damaged.
    """
    # Loaded here: it brings pydantic, which a service without drives loads elsewhere.
    from pypcd4.pypcd4 import PointCloud

    names = tuple(name for name, _, _, _ in header.fields)
    keys = {name: f"f{index}" for index, name in reversed(list(enumerate(names)))}
    _, needed = needed_fields(names, file)
    if not header.points:
        empty = np.zeros(0, np.float32)
        return Cloud(dict.fromkeys(needed, empty), names, remarks)
    stream = BytesIO(plain_header(header) + body)
    try:
        table = np.atleast_1d(PointCloud.from_fileobj(BufferedReader(stream)).pc_data)
    except (ValueError, RuntimeError, TypeError, IndexError, OverflowError, struct.error) as error:
        raise DriveError(
            f"{file}: its {header.data} data cannot be decoded ({reason_of(error)}); the file is "
            "damaged. Write it again"
        ) from error
    values = {name: table[keys[name]] for name in needed if keys[name] in (table.dtype.names or ())}
    return Cloud(values, names, remarks)


def plain_header(header: PcdHeader) -> bytes:
    """Return a header that `pypcd4` understands, with fields named f0, f1 and so on.

    Values of ascii files become float64, so that a NaN in a field of integers is no error.
    """
    columns = header.fields
    text = header.data == "ascii"
    lines = (
        "VERSION 0.7",
        f"FIELDS {' '.join(f'f{index}' for index in range(len(columns)))}",
        f"SIZE {' '.join('8' if text else str(size) for _, _, size, _ in columns)}",
        f"TYPE {' '.join('F' if text else kind for _, kind, _, _ in columns)}",
        f"COUNT {' '.join(str(count) for _, _, _, count in columns)}",
        f"WIDTH {header.points}",
        "HEIGHT 1",
        "VIEWPOINT 0 0 0 1 0 0 0",
        f"POINTS {header.points}",
        f"DATA {header.data}",
    )
    return ("\n".join(lines) + "\n").encode()
