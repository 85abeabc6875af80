"""NumPy files: .npy with an array of points, .npz with one or several arrays."""

import struct
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from placecell.sources.clouds.cloud import (
    Cloud,
    check_growth,
    cut_short,
    find_axes,
    printable,
    read_content,
    reason_of,
)
from placecell.sources.clouds.read_limits import TooLargeError, check_bytes
from placecell.sources.errors import DriveError
from placecell.sources.point_times import is_time

NPY = b"\x93NUMPY"
ZIP = b"PK\x03\x04"
ENTRY, MOST_ENTRIES = b"PK\x01\x02", 1_000
"""Mark of an entry in an archive's table, and the largest number of them."""
WIDEST = 64
"""Most columns of an array of points."""
POINT_KEYS = (
    "points", "xyz", "point_cloud", "pointcloud", "pc", "pcd", "cloud", "lidar", "scan", "data",
    "arr_0",
)  # fmt: skip
"""Names of the points' array in .npz files, in the order in which they are tried."""


def is_npy(head: bytes) -> bool:
    """Return whether a file begins as a .npy file does."""
    return head.startswith(NPY)


def is_npz(head: bytes, file: Path) -> bool:
    """Return whether a file is a zip archive named as NumPy names its own."""
    return head.startswith(ZIP) and file.suffix.lower() == ".npz"


def read_npy(file: Path, columns: tuple[str, ...] | None) -> Cloud:
    """Read a .npy file.

    Args:
        columns: names of the columns of a plain array; None: x, y, z and others.

    Raises:
        DriveError: the file is damaged, or its array holds no points.
    """
    return points_of(array_of(read_content(file), file), columns, file)


def read_npz(file: Path, columns: tuple[str, ...] | None) -> Cloud:
    """Read a .npz file: one array of points, or an array for each coordinate.

    Raises:
        DriveError: the file is damaged, or no array holds points.
    """
    content = read_content(file)
    arrays: dict[str, NDArray[Any]] = {}
    refused = ""
    if (count := content.count(ENTRY)) > MOST_ENTRIES:
        raise TooLargeError(
            f"{file}: the archive has {count:,} entries; expected at most {MOST_ENTRIES:,}. Save "
            "the points alone, as an array 'points'"
        )
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            entries = [each for each in archive.infolist() if each.filename.endswith(".npy")]
            claimed = sum(each.file_size for each in entries)
            check_growth(file, len(content), claimed)
            check_bytes(file, claimed)
            for entry in entries:
                try:
                    arrays[entry.filename.removesuffix(".npy")] = array_of(
                        archive.read(entry), file
                    )
                except DriveError as error:  # another array may hold the points
                    refused = str(error)
    except (
        zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError, RuntimeError,
        ValueError, struct.error,
    ) as error:  # fmt: skip
        raise DriveError(
            f"{file}: the archive cannot be read ({reason_of(error)}); the file is damaged. "
            "Write it again"
        ) from error
    if not arrays and refused:
        raise DriveError(refused)
    return chosen(arrays, columns, file)


def chosen(
    arrays: Mapping[str, NDArray[Any]], columns: tuple[str, ...] | None, file: Path
) -> Cloud:
    """Choose the array of points among those of an archive, and the times that belong to it.

    Raises:
        DriveError: no array holds points, or several may.
    """
    flat = {name: each for name, each in arrays.items() if each.ndim == 1 and each.dtype != object}
    if (axes := find_axes(list(flat))) is not None:
        length = len(flat[axes.names[0]])
        values = {name: each for name, each in flat.items() if len(each) == length}
        if all(name in values for name in axes.names):
            return Cloud(values, tuple(values))
    tables = {name: each for name, each in arrays.items() if holds_points(each)}
    named = [key for key in POINT_KEYS if key in {name.lower() for name in tables}]
    names = [name for name in tables if not named or name.lower() == named[0]]
    if len(names) != 1:
        found = ", ".join(f"{name} {each.shape}" for name, each in list(arrays.items())[:10])
        found = printable(found)[:400] or "no arrays"
        raise DriveError(
            f"{file}: {'no array has' if not names else 'several arrays have'} points (n, 3 or "
            f"more); found {found}. Name the array of points 'points'"
        )
    cloud = points_of(tables[names[0]], columns, file)
    length = len(next(iter(cloud.values.values())))
    times = {
        name: each
        for name, each in flat.items()
        if is_time(name) and len(each) == length and name not in cloud.values
    }
    return Cloud({**cloud.values, **times}, (*cloud.fields, *times), cloud.remarks)


def array_of(content: bytes, file: Path) -> NDArray[Any]:
    """Decode an array; objects (pickles) are refused, because they can run code.

    Raises:
        DriveError: damaged, cut short, or with objects.
    """
    stream = BytesIO(content)
    try:
        version = npy.read_magic(stream)
        read_header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read_header(stream)
        if dtype.hasobject:
            raise DriveError(
                f"{file}: holds Python objects, which can run code and are not read. Save a plain "
                "array of numbers: numpy.save(file, array.astype('float32'))"
            )
        room = len(content) - stream.tell()
        claimed = int(np.prod(np.array(shape, object), dtype=object)) if shape else 1
        if claimed * dtype.itemsize > room or min(shape, default=0) < 0:
            raise cut_short(file, "values", room // max(dtype.itemsize, 1), claimed)
        stream.seek(0)
        return np.asarray(np.load(stream, allow_pickle=False))
    except DriveError:
        raise
    except (
        ValueError, EOFError, OSError, TypeError, SyntaxError, KeyError, struct.error,
        OverflowError, MemoryError, RecursionError, UnicodeError, tokenize.TokenError,
    ) as error:  # fmt: skip
        raise DriveError(
            f"{file}: the NumPy array cannot be read ({reason_of(error)}); the file is damaged. "
            "Write it again"
        ) from error


def holds_points(array: NDArray[Any]) -> bool:
    """Return whether an array's shape and type are those of points."""
    if array.dtype.names is not None:
        return True
    return array.dtype.kind in "fiu" and array.ndim >= 2 and 3 <= array.shape[-1] <= WIDEST


def points_of(array: NDArray[Any], columns: tuple[str, ...] | None, file: Path) -> Cloud:
    """Return the points of an array: structured, (n, 3 or more), (3 or 4, n), or a grid of them.

    Raises:
        DriveError: the array has another shape or type.
    """
    if array.dtype.names is not None:
        return structured(array.reshape(-1))
    remarks: tuple[str, ...] = ()
    if array.ndim == 2 and array.shape[1] > WIDEST and 3 <= array.shape[0] <= WIDEST:
        remarks = (f"the array {array.shape} is read column after column",)
        array = array.T
    if not holds_points(array):
        raise DriveError(
            f"{file}: the array is {array.dtype} {array.shape}; expected numbers of shape (n, 3 or "
            "more), a point a row"
        )
    if array.ndim > 2:
        remarks = (f"the grid {array.shape} is read as a list of points",)
    table = array.reshape(-1, array.shape[-1])
    names = columns or ("x", "y", "z", *(f"column_{index}" for index in range(3, table.shape[1])))
    if len(names) != table.shape[1]:
        raise DriveError(
            f"{file}: the array has {table.shape[1]} columns, but --columns names {len(names)}"
        )
    return Cloud({name: table[:, index] for index, name in enumerate(names)}, names, remarks)


def structured(table: NDArray[Any]) -> Cloud:
    """Return the fields of a structured array; a field of three values is x, y and z."""
    values: dict[str, NDArray[Any]] = {}
    for name in table.dtype.names or ():
        column = table[name]
        if column.dtype.kind not in "fiu":
            continue
        if column.ndim == 1:
            values[name] = column
        elif column.ndim == 2 and column.shape[1] >= 3:
            values |= {axis: column[:, index] for index, axis in enumerate("xyz")} | values
    return Cloud(values, tuple(table.dtype.names or ()))
