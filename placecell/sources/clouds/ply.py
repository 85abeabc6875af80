"""PLY files: ascii and binary of either byte order.

The reader is our own: `plyfile`, the usual library, is under the GPL.
"""

import re
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
from placecell.sources.clouds.read_limits import check_points, check_text
from placecell.sources.errors import DriveError

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "long": "i8", "int64": "i8", "ulong": "u8", "uint64": "u8",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": "="}
MOST_PROPERTIES = 1024


@dataclass(frozen=True, slots=True)
class Property:
    """Property of an element: its NumPy type, and for a list the type of its length."""

    name: str
    type: str
    length_type: str | None = None


@dataclass(frozen=True, slots=True)
class Element:
    """Element of a PLY file, such as `vertex`."""

    name: str
    count: int
    properties: tuple[Property, ...] = ()

    @property
    def has_lists(self) -> bool:
        """Return whether the rows differ in length."""
        return any(each.length_type for each in self.properties)

    def dtype(self, order: str) -> np.dtype[Any]:
        """Return the type of a row; a list counts with its length only."""
        return np.dtype(
            [
                (f"f{index}", order + (each.length_type or each.type))
                for index, each in enumerate(self.properties)
            ]
        )


def is_ply(head: bytes) -> bool:
    """Return whether a file begins as a PLY file does."""
    return re.match(rb"ply[ \t]*[\r\n]", head) is not None


def read_ply(file: Path) -> Cloud:
    """Read the points of a PLY file; faces and other elements are skipped.

    Raises:
        DriveError: the file is damaged or has no points.
    """
    content = read_content(file)
    encoding, elements, start = parse_header(content, file)
    index = next(
        (index for index, each in enumerate(elements) if each.name.lower() in ("vertex", "point")),
        None,
    )
    if index is None:
        found = ", ".join(each.name for each in elements) or "none"
        raise DriveError(
            f"{file}: has no element 'vertex'; its elements are: {printable(found)[:400]}"
        )
    vertex = elements[index]
    check_points(file, vertex.count)
    names = tuple(each.name for each in vertex.properties)
    _, needed = needed_fields(names, file)
    lists = {each.name for each in vertex.properties if each.length_type} & set(needed)
    if lists:
        raise DriveError(
            f"{file}: the property {min(lists)!r} of its points is a list; expected one value a "
            "point. Write the file again"
        )
    wanted = {name: names.index(name) for name in needed}
    if encoding == "ascii":
        check_text(file, content[start:])
        values = ascii_values(content[start:], elements[:index], vertex, wanted, file)
    else:
        order = ORDERS[encoding]
        for element in elements[:index]:
            start = end_of(content, start, element, order, file)
        values = binary_values(content, start, vertex, wanted, order, file)
    others = [each.name for each in elements if each is not vertex and each.count]
    remarks = (f"elements other than points are ignored: {', '.join(others)}",) if others else ()
    return Cloud(values, names, remarks)


def parse_header(content: bytes, file: Path) -> tuple[str, list[Element], int]:
    """Parse the header: encoding, elements, and the offset of the data.

    Raises:
        DriveError: a line is missing or not understood.
    """
    match = re.match(rb"ply[ \t]*(\r\n|\n|\r)", content)
    newline = match[1] if match else b"\n"
    position = match.end() if match else 0
    encoding = ""
    elements: list[Element] = []
    while True:
        end = content.find(newline, position, HEAD)
        if end < 0:
            raise DriveError(
                f"{file}: its PLY header has no line end_header; the file is cut short or damaged. "
                "Copy or write it again"
            )
        line = content[position:end].decode("utf-8", "replace").strip()
        position = end + len(newline)
        words = line.split()
        if words[:1] == ["end_header"]:
            break
        try:
            if words[:1] == ["format"]:
                encoding = words[1]
            elif words[:1] == ["element"]:
                elements.append(Element(words[1], count_of(words[2])))
            elif words[:1] == ["property"]:
                elements[-1] = with_property(elements[-1], words[1:])
        except (IndexError, KeyError, ValueError) as error:
            raise DriveError(
                f"{file}: its PLY header has a line {line[:80]!r} that is not understood; the file "
                "is damaged. Write it again"
            ) from error
    if encoding not in ORDERS:
        raise DriveError(
            f"{file}: its PLY header states the format {encoding!r}; expected one of "
            f"{', '.join(ORDERS)}"
        )
    return encoding, elements, position


def count_of(word: str) -> int:
    """Parse the number of rows of an element."""
    count = int(word)
    if not 0 <= count < 2**62:
        raise ValueError(word)
    return count


def with_property(element: Element, words: list[str]) -> Element:
    """Return the element with the property of a header line added."""
    if words[0] == "list":
        added = Property(words[3], TYPES[words[2].lower()], TYPES[words[1].lower()])
        if "f" in TYPES[words[1].lower()]:
            raise ValueError(words[1])
    else:
        added = Property(words[1], TYPES[words[0].lower()])
    if len(element.properties) >= MOST_PROPERTIES:
        raise ValueError("too many properties")
    return Element(element.name, element.count, (*element.properties, added))


def binary_values(
    content: bytes, start: int, vertex: Element, wanted: dict[str, int], order: str, file: Path
) -> dict[str, NDArray[Any]]:
    """Return the wanted properties of the points of a binary file.

    Raises:
        DriveError: the file is cut short.
    """
    dtype = vertex.dtype(order)
    room = (len(content) - start) // dtype.itemsize
    if room < vertex.count:
        raise cut_short(file, "points", room, vertex.count)
    if not vertex.has_lists:
        table = np.frombuffer(content, dtype, vertex.count, start)
        return {name: table[f"f{index}"] for name, index in wanted.items()}
    types = {name: order + vertex.properties[index].type for name, index in wanted.items()}
    found = {name: np.zeros(vertex.count, types[name][1:]) for name in wanted}
    readers = {name: struct.Struct(order + np.dtype(types[name]).char) for name in wanted}
    at = {index: name for name, index in wanted.items()}
    for row in checked(range(vertex.count)):
        for index, each in enumerate(vertex.properties):
            if index in at:
                name = at[index]
                if start + readers[name].size > len(content):
                    raise cut_short(file, "points", row, vertex.count)
                found[name][row] = readers[name].unpack_from(content, start)[0]
            start = end_of_property(content, start, each, order, file)
    return found


def end_of(content: bytes, start: int, element: Element, order: str, file: Path) -> int:
    """Return the offset after an element that stands before the points.

    Raises:
        DriveError: the file is cut short.
    """
    if not element.properties:
        return start
    least = element.dtype(order).itemsize
    if (len(content) - start) // least < element.count:
        raise cut_short(file, f"rows of {element.name}", (len(content) - start) // least,
                        element.count)  # fmt: skip
    if not element.has_lists:
        return start + least * element.count
    for _ in checked(range(element.count)):
        for each in element.properties:
            start = end_of_property(content, start, each, order, file)
    return start


def end_of_property(content: bytes, start: int, each: Property, order: str, file: Path) -> int:
    """Return the offset after a property of one row.

    Raises:
        DriveError: the file is cut short.
    """
    if each.length_type is None:
        return start + int(each.type[1:])
    size = int(each.length_type[1:])
    signed = each.length_type[0] == "i"
    length = int.from_bytes(
        content[start : start + size], "little" if order == "<" else "big", signed=signed
    )
    end = start + size + length * int(each.type[1:])
    if length < 0 or start + size > len(content) or end > len(content):
        raise DriveError(
            f"{file}: a list {each.name!r} of {length:,} values reaches beyond the file's end; the "
            "file is cut short or damaged. Copy or write it again"
        )
    return end


def ascii_values(
    body: bytes, before: list[Element], vertex: Element, wanted: dict[str, int], file: Path
) -> dict[str, NDArray[Any]]:
    """Return the wanted properties of the points of an ascii file, float64.

    Raises:
        DriveError: the file is cut short, or a value is no number.
    """
    lines = [line for line in body.splitlines() if line.strip()]
    skipped = sum(each.count for each in before if each.properties)
    rows = lines[skipped : skipped + vertex.count]
    if len(rows) < vertex.count:
        raise cut_short(file, "points", len(rows), vertex.count)
    if not rows:
        return {name: np.zeros(0) for name in wanted}
    first_list = next(
        (index for index, each in enumerate(vertex.properties) if each.length_type), None
    )
    try:
        if first_list is None or first_list > max(wanted.values()):
            table = np.loadtxt(
                (line.decode("ascii", "replace") for line in checked(rows)),
                usecols=tuple(wanted.values()), comments=None, ndmin=2,
            )  # fmt: skip
            return {name: table[:, column] for column, name in enumerate(wanted)}
        found = {name: np.zeros(len(rows)) for name in wanted}
        for row, line in enumerate(checked(rows)):
            words = line.split()
            position = 0
            for index, each in enumerate(vertex.properties):
                for name, column in wanted.items():
                    if column == index:
                        found[name][row] = float(words[position])
                position += 1 if each.length_type is None else 1 + int(words[position])
                if position < 0:
                    raise ValueError(f"a list {each.name!r} of negative length")
        return found
    except (ValueError, IndexError, OverflowError) as error:
        raise DriveError(
            f"{file}: a row of its ascii points cannot be read ({reason_of(error)}); the file is "
            "damaged. Write it again"
        ) from error
