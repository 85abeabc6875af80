"""Text files with a point a line: CSV, XYZ, TXT, ASC and PTS."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from placecell.core.cancellation import checked
from placecell.core.types import Float64
from placecell.sources.clouds.cloud import HEAD, Cloud, find_axes, needed_fields, read_content
from placecell.sources.clouds.read_limits import check_text
from placecell.sources.errors import DriveError

COMMENTS = ("#", "//", "%", "!")
COMMA_NUMBER = re.compile(r"[+-]?\d+(,\d+)?([eE][+-]?\d+)?")
QUATERNION = re.compile(r"(q|quat(ernion)?|ori(entation)?|rot(ation)?)[\w.]*?[_.]?[wxyz]( ?\[\])?")
MISSING = {"", "null", "none", "n/a", "na", "-"}
"""Cells that stand for a missing value."""
FAR = 1e8
"""A first column beyond this is a time, not a coordinate in meters."""
JUDGED = 100
"""Number of rows whose values decide what a table holds."""


@dataclass(frozen=True, slots=True)
class Table:
    """Table of numbers in a text file.

    Attributes:
        names: names of the columns.
        delimiter: what stands between values; None: spaces and tabs.
        decimal_comma: whether numbers have a comma for the decimal point.
        rows: lines with values.
        named: whether the file or the user names the columns.
    """

    names: tuple[str, ...]
    delimiter: str | None
    decimal_comma: bool
    rows: Sequence[str]
    named: bool

    def read(self, columns: Sequence[int], file: Path) -> Float64:
        """Return the values of these columns, float64 (rows, columns); missing ones are NaN.

        Raises:
            DriveError: a value is no number, or a row is too short.
        """
        rows = [row.replace(",", ".") for row in self.rows] if self.decimal_comma else self.rows
        try:
            return np.loadtxt(
                checked(rows), delimiter=self.delimiter, usecols=columns, comments=None,
                quotechar='"', ndmin=2,
            )  # fmt: skip
        except (ValueError, IndexError):
            return with_missing(rows, self.delimiter, columns, file)


def is_text(head: bytes) -> bool:
    """Return whether a file begins with text."""
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        return True
    return bool(head) and not any(byte < 32 and byte not in b"\t\n\r\f\x1a" for byte in head)


def holds_points(head: bytes, file: Path) -> bool:
    """Return whether a text file begins with a table of points."""
    last = max(head.rfind(b"\n"), 0) or len(head)
    try:
        points_of(parse(decode(head[:last]), None, file), file)
    except DriveError:
        return False
    return True


def read_text(file: Path, columns: tuple[str, ...] | None) -> Cloud:
    """Read a table of points.

    Args:
        columns: names of the columns of a file without a header; None: x, y, z and others.

    Raises:
        DriveError: the file has no table of points.
    """
    content = read_content(file)
    if b"\0" in content[:HEAD] and not is_text(content[:HEAD]):
        raise DriveError(
            f"{file}: holds no text, although its name ends with {file.suffix or 'nothing'}; it "
            f"begins with the bytes {content[:8].hex(' ')}. Expected a table with a point a line. "
            "Check that the file is a point cloud, not a picture or an archive"
        )
    check_text(file, content)
    return points_of(parse(decode(content), columns, file), file)


def points_of(table: Table, file: Path) -> Cloud:
    """Return the points of a table.

    Raises:
        DriveError: it holds something else, or a value is no number.
    """
    check_content(table, file)
    _, needed = needed_fields(table.names, file)
    values = table.read([table.names.index(name) for name in needed], file)
    return Cloud({name: values[:, index] for index, name in enumerate(needed)}, table.names)


def decode(content: bytes) -> str:
    """Decode text in UTF-8, UTF-16 with a byte order mark, or else an older encoding."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16", "replace")
    return content.decode("utf-8-sig", "replace")


def parse(text: str, columns: tuple[str, ...] | None, file: Path) -> Table:
    """Find the columns of a table, and the lines with values.

    Raises:
        DriveError: there are none, or a line is too long for a table.
    """
    rows: list[str] = []
    comments: list[str] = []
    for line in checked(text.splitlines()):
        row = line.strip(" \r\n\f\x1a")
        if len(row) > HEAD:
            raise DriveError(
                f"{file}: a line has {len(row):,} characters; expected a table with a point a "
                "line. Convert the file, for example to PLY"
            )
        if row.startswith(COMMENTS):
            if not rows:
                comments.append(row.lstrip("#/%! \t"))
        elif row.strip():
            rows.append(row)
    if len(rows) > 1 and rows[0].strip().isdecimal() and len(rows[1].split()) >= 3:
        rows = rows[1:]  # the number of points, as in PTS files
    header = rows[0] if rows and not all_numbers(rows[0]) else None
    data = rows if header is None else rows[1:]
    if not data:
        raise DriveError(
            f"{file}: holds no rows of numbers; expected a table with a point a line, such as "
            "1.0 2.0 3.0"
        )
    delimiter, decimal_comma = delimiter_of(data)
    width = len(split(data[0], delimiter))
    candidates = [header] if header is not None else comments[::-1]
    for line in candidates:
        names = header_names(line, delimiter, width)
        if names is not None:
            return Table(names, delimiter, decimal_comma, data, True)
    if header is not None:
        raise DriveError(
            f"{file}: its first line {header[:80]!r} is neither numbers nor the names of the "
            f"{width} columns. Give it a header such as x,y,z"
        )
    names = columns or ("x", "y", "z", *(f"column_{index}" for index in range(3, width)))[:width]
    if columns is not None and len(columns) != width:
        raise DriveError(f"{file}: has {width} columns, but --columns names {len(columns)}")
    return Table(names, delimiter, decimal_comma, data, columns is not None)


def all_numbers(row: str) -> bool:
    """Return whether a line holds nothing but numbers, with any delimiters between them."""
    words = [word for word in re.split(r"[\s;,\"]+", row) if word]
    return bool(words) and all(is_number(word) or word.lower() in MISSING for word in words)


def is_number(word: str) -> bool:
    """Return whether a word is a number, NaN and infinity among them."""
    try:
        float(word)
    except ValueError:
        return False
    return True


def delimiter_of(rows: Sequence[str]) -> tuple[str | None, bool]:
    """Return the delimiter, None for spaces and tabs, and whether numbers have a comma."""
    row = rows[0]
    if ";" in row:
        return ";", commas_are_decimal(row.split(";"))
    if "\t" in row and not any(len(cell.split()) > 1 for cell in row.split("\t")):
        return "\t", commas_are_decimal(row.split("\t"))
    if "," not in row:
        return None, False
    words = row.split()
    if len(words) >= 3 and commas_are_decimal(words):
        return None, True
    return ",", False


def commas_are_decimal(words: Sequence[str]) -> bool:
    """Return whether commas stand for decimal points."""
    cells = [word.strip() for word in words if word.strip()]
    return any("," in cell for cell in cells) and all(
        COMMA_NUMBER.fullmatch(cell) or is_number(cell) for cell in cells
    )


def split(row: str, delimiter: str | None) -> list[str]:
    """Split a line into cells; an empty cell behind the last delimiter is none."""
    cells = [cell.strip().strip("\"'").strip() for cell in row.split(delimiter)]
    return cells[:-1] if len(cells) > 1 and not cells[-1] else cells


def header_names(line: str, delimiter: str | None, width: int) -> tuple[str, ...] | None:
    """Return the names of the columns in a header; None if it is none."""
    for each in dict.fromkeys((delimiter, ",", ";", "\t", None)):
        names = split(line, each)
        if len(names) == width and not any(is_number(name) for name in names):
            return tuple(names)
    return None


def with_missing(
    rows: Sequence[str], delimiter: str | None, columns: Sequence[int], file: Path
) -> Float64:
    """Read rows cell by cell, with missing values as NaN.

    Raises:
        DriveError: a value is no number, or a row is too short.
    """
    values = np.full((len(rows), len(columns)), np.nan)
    for index, row in enumerate(checked(rows)):
        cells = row.split(delimiter)
        for position, column in enumerate(columns):
            cell = cells[column].strip().strip('"') if column < len(cells) else None
            if cell is not None and cell.lower() in MISSING:
                continue
            try:
                values[index, position] = float(cell or "no value")
            except ValueError as error:
                shown = row if len(row) <= 80 else f"{row[:80]} ..."
                raise DriveError(
                    f"{file}: row {index + 1} of its points is {shown!r}; expected a number in "
                    f"column {column + 1}. Correct the row, or write the file again"
                ) from error
    return values


def check_content(table: Table, file: Path) -> None:
    """Refuse trajectories and times, which stand beside clouds in many folders.

    Raises:
        DriveError: the table is no cloud.
    """
    width = len(table.names)
    if sum(bool(QUATERNION.fullmatch(name.lower())) for name in table.names) >= 4:
        raise trajectory(file, "its columns are a time, a position and a quaternion")
    if width < 3:
        raise DriveError(
            f"{file}: has {width} column{'s' * (width > 1)}; expected x, y and z at least. Times "
            "belong beside the scans as times.txt"
        )
    if table.named and find_axes(table.names) is not None:
        return
    some = Table(table.names, table.delimiter, table.decimal_comma, table.rows[:JUDGED], True)
    if width == 8:
        values = some.read(range(8), file)
        with np.errstate(all="ignore"):
            unit = np.abs(np.linalg.norm(values[:, 4:], axis=1) - 1) < 1e-2
            # Normals with a small curvature have the length 1 as well, but x does not ascend.
            if np.mean(unit) > 0.9 and (np.diff(values[:, 0]) > 0).all():
                raise trajectory(file, "its columns are a time, a position and a unit quaternion")
    if width in (12, 16):
        matrices = some.read(range(12), file).reshape(-1, 3, 4)[:, :, :3]
        with np.errstate(all="ignore"):
            off = np.abs(matrices @ matrices.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
            if np.mean(off < 1e-2) > 0.9:
                raise trajectory(file, "its rows are 3x4 matrices with a rotation")
    first = some.read([0], file)[:, 0]
    first = first[np.isfinite(first)]
    if not table.named and len(first) and np.median(np.abs(first)) > FAR:
        raise DriveError(
            f"{file}: the first column holds values such as {first[0]:.6g}: a time, not x in "
            "meters. State the columns, for example --columns t,x,y,z"
        )


def trajectory(file: Path, why: str) -> DriveError:
    """Return the error for a trajectory that is given as a cloud."""
    return DriveError(
        f"{file}: is a trajectory, not a point cloud: {why}. Give the folder or file of the scans, "
        "and this file with --poses"
    )
