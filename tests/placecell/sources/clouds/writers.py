"""Writers of small cloud files, by hand, so that a reader is not tested by its own library."""

import struct
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.sources.clouds.cloud import as_scan, find_cloud_clock
from placecell.sources.clouds.formats import ReadOptions, read_cloud
from placecell.sources.errors import DriveError
from placecell.sources.scan import LidarScan

POINTS: Float64 = np.array([[1.5, -2.25, 0.5], [3.0, 4.0, -1.0], [-7.125, 0.25, 2.0]])
TYPES = {("F", 4): "f", ("F", 8): "d", ("U", 1): "B", ("U", 2): "H", ("U", 4): "I", ("I", 4): "i"}


def read(file: Path, options: ReadOptions | None = None) -> LidarScan:
    """Read a file as a scan whose stamp is unknown."""
    cloud = read_cloud(file, options or ReadOptions())
    clock = find_cloud_clock([(cloud, file, float("nan"))])
    return as_scan(cloud, file, clock=clock)[0]


def pcd_header(
    fields: Sequence[tuple[str, str, int, int]], points: int, data: str, **lines: str
) -> bytes:
    """Return a PCD header; `lines` replace lines, and an empty one leaves a line out."""
    given = {
        "VERSION": "0.7",
        "FIELDS": " ".join(name for name, _, _, _ in fields),
        "SIZE": " ".join(str(size) for _, _, size, _ in fields),
        "TYPE": " ".join(kind for _, kind, _, _ in fields),
        "COUNT": " ".join(str(count) for _, _, _, count in fields),
        "WIDTH": str(points),
        "HEIGHT": "1",
        "VIEWPOINT": "0 0 0 1 0 0 0",
        "POINTS": str(points),
        "DATA": data,
    } | lines
    text = "".join(f"{key} {value}\n" for key, value in given.items() if value)
    return b"# .PCD v0.7 - Point Cloud Data file format\n" + text.encode()


def pcd(
    fields: Sequence[tuple[str, str, int, int]],
    rows: Sequence[Sequence[float]],
    data: str,
    **lines: str,
) -> bytes:
    """Return a PCD file; each row has one value for each value of a point."""
    header = pcd_header(fields, len(rows), data, **lines)
    kinds = [(TYPES[kind, size], count) for _, kind, size, count in fields]
    if data == "ascii":
        return header + "".join(" ".join(f"{v:g}" for v in row) + "\n" for row in rows).encode()
    codes = "".join(f"{count}{kind}" for kind, count in kinds)
    if data == "binary":
        return header + b"".join(struct.pack(f"<{codes}", *row) for row in rows)
    body, column = b"", 0
    for kind, count in kinds:
        for row in rows:
            body += struct.pack(f"<{count}{kind}", *row[column : column + count])
        column += count
    packed = lzf_literal(body)
    return header + struct.pack("<II", len(packed), len(body)) + packed


def check_refused(file: Path, expected: str) -> None:
    """Check that a damaged file is refused with its name and with what is wrong."""
    with pytest.raises(DriveError) as error:
        read(file)
    assert str(error.value).startswith(f"{file}: ")
    assert expected in str(error.value)


def lzf_literal(content: bytes) -> bytes:
    """Return LZF data without any references: runs of at most 32 bytes after their length."""
    runs = [content[start : start + 32] for start in range(0, len(content), 32)]
    return b"".join(bytes([len(run) - 1]) + run for run in runs)


def ply(
    encoding: str,
    properties: Sequence[str],
    rows: Sequence[Sequence[Any]],
    newline: str = "\n",
    before: str = "",
    before_body: bytes = b"",
    after: str = "",
) -> bytes:
    """Return a PLY file; a value that is a list is written as a list of uint8 length."""
    codes = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I"}
    codes |= {"float": "f", "double": "d", "float32": "f", "float64": "d", "uint8": "B"}
    lines = ["ply", f"format {encoding} 1.0", "comment by hand", *before.splitlines()]
    lines += [f"element vertex {len(rows)}", *(f"property {each}" for each in properties)]
    lines += [*after.splitlines(), "end_header"]
    body = before_body
    order = ">" if "big" in encoding else "<"
    for row in rows:
        if encoding == "ascii":
            words = [
                f"{len(v)} {' '.join(map(str, v))}" if isinstance(v, list) else f"{v}" for v in row
            ]
            body += (" ".join(words) + newline).encode()
            continue
        for value, each in zip(row, properties, strict=True):
            if isinstance(value, list):
                kind = codes[each.split()[2]]
                body += struct.pack(f"{order}B{len(value)}{kind}", len(value), *value)
            else:
                body += struct.pack(order + codes[each.split()[0]], value)
    return newline.join(lines).encode() + newline.encode() + body


def las(
    points: Float64,
    compressed: bool = False,
    minor: int = 2,
    point_format: int = 1,
    times: Sequence[float] | None = None,
    scale: float = 0.001,
) -> bytes:
    """Return a LAS or LAZ file that laspy writes."""
    import laspy

    header = laspy.LasHeader(version=f"1.{minor}", point_format=point_format)
    header.scales = np.full(3, scale)
    header.offsets = np.floor(points.min(axis=0)) if len(points) else np.zeros(3)
    cloud = laspy.LasData(header)
    cloud.x, cloud.y, cloud.z = points.T
    if times is not None:
        cloud.gps_time = np.array(times)
    stream = BytesIO()
    cloud.write(stream, do_compress=compressed, laz_backend=laspy.LazBackend.Lazrs)
    return stream.getvalue()
