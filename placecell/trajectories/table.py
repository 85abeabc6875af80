"""Table of numbers in a text file: any separator, with or without a header line."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from placecell.core.errors import DriveError
from placecell.core.text_files import read_lines
from placecell.core.types import Float64, Int64

COMMENTS = ("#", "%", "//")
LONGEST_SHOWN = 60
"""Largest number of characters of a file that a message quotes."""


@dataclass(frozen=True, slots=True)
class TextTable:
    """Cells of a text file.

    Attributes:
        file: the file.
        rows: cells of each line that is neither empty nor a comment.
        lines: number of each of these lines in the file, from 1.
        names: column names of the header line; empty if there is none.
        separator: character between cells; "" for white space.
    """

    file: Path
    rows: Sequence[Sequence[str]]
    lines: Sequence[int]
    names: tuple[str, ...]
    separator: str

    @property
    def width(self) -> int:
        """Number of cells of the first row."""
        return len(self.rows[0])

    @property
    def line_numbers(self) -> Int64:
        """Line of each row, int64 (rows,)."""
        return np.array(self.lines, dtype=np.int64)

    def numbers(self, columns: Sequence[int]) -> Float64:
        """Return columns as numbers, float64 (rows, columns).

        Raises:
            DriveError: a row has no such cell, or a cell is no finite number.
        """
        table = np.empty((len(self.rows), len(columns)))
        for number, (row, line) in enumerate(zip(self.rows, self.lines, strict=True)):
            for place, column in enumerate(columns):
                if column >= len(row):
                    raise DriveError(
                        f"{self.file}, line {line}: {len(row)} values, expected "
                        f"{len(self.names) or self.width} as in the lines before. The file may be "
                        "cut short; remove the line"
                    )
                table[number, place] = self.number(row[column], line)
        bad = ~np.isfinite(table).all(axis=1)
        if bad.any():
            raise DriveError(
                f"{self.file}, line {self.lines[int(bad.argmax())]}: a value is not finite (NaN or "
                f"infinity), in {int(bad.sum())} of {len(table)} lines. Remove these lines"
            )
        return table

    def number(self, cell: str, line: int) -> float:
        """Parse a cell.

        Raises:
            DriveError: the cell is no number.
        """
        try:
            if "_" in cell:  # Python reads 1_000 as a number; no other program writes it.
                raise ValueError(cell)
            return float(cell.replace(",", ".") if self.separator == ";" else cell)
        except ValueError as error:
            raise DriveError(
                f"{self.file}, line {line}: found {cell[:LONGEST_SHOWN]!r}, expected a number"
            ) from error


def is_number(cell: str) -> bool:
    """Return whether a cell is a number; a comma may be its decimal point."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True


def read_text_table(file: Path, what: str) -> TextTable:
    """Read the cells of a text file.

    Args:
        file: the file.
        what: the expected content, for messages.

    Raises:
        DriveError: unreadable, binary, or without lines.
    """
    lines = read_lines(file, what)
    if any("\0" in line for line in lines[:100]):
        raise DriveError(f"{file}: is a binary file; it must hold {what}")
    comment, rows, numbers = "", list[str](), list[int]()
    for number, line in enumerate(lines, start=1):
        text = line.strip()
        if text.startswith(COMMENTS):
            comment = comment if rows else text
        elif text:
            rows.append(text)
            numbers.append(number)
    if not rows:
        raise DriveError(f"{file}: holds no lines with values; it must hold {what}")
    sample = rows[min(1, len(rows) - 1)]
    separator = next((each for each in (";", ",", "\t") if each in sample), "")
    names: tuple[str, ...] = ()
    cells = [split(row, separator) for row in rows]
    if not any(is_number(cell) for cell in cells[0]):
        names = tuple(header_names(rows[0], separator))
        cells, numbers = cells[1:], numbers[1:]
        if not cells:
            raise DriveError(f"{file}: holds a header line and no values")
    elif comment:
        named = header_names(comment.lstrip("#%/ "), separator)
        if len(named) == len(cells[0]) and not any(is_number(name) for name in named):
            names = tuple(named)
    return TextTable(file, cells, numbers, names, separator)


def split(line: str, separator: str) -> list[str]:
    """Split a line into cells, without the spaces around them."""
    if not separator:
        return line.split()
    if '"' in line:
        cells = next(csv.reader([line], delimiter=separator), [])
    else:
        cells = line.split(separator)
    cells = [cell.strip() for cell in cells]
    return cells[:-1] if len(cells) > 1 and not cells[-1] else cells


def header_names(line: str, separator: str) -> list[str]:
    """Split a header line; a unit in brackets belongs to the name before it."""
    names = list[str]()
    for cell in split(line, separator):
        if not separator and names and re.match(r"[\[(]", cell):
            names[-1] += cell
        else:
            names.append(cell)
    return names
