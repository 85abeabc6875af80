"""Uploaded point cloud file: read from memory, so that no name or path in it is ever followed."""

import re
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import cast

from placecell.core.types import Float64
from placecell.sources.clouds.cloud import as_scan, printable
from placecell.sources.clouds.formats import (
    FORMATS,
    RAW,
    SUFFIXES,
    TEXT,
    CloudFormat,
    ReadOptions,
)
from placecell.sources.clouds.numpy_files import ZIP
from placecell.sources.clouds.read_limits import ReadLimits, TooLargeError, reading_within
from placecell.sources.clouds.text import is_text
from placecell.sources.errors import DriveError
from placecell.sources.point_layout import find_layout
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import ScanOptions
from service.core.problems import Problem

NAMELESS = "scan"
"""Name of a file whose client gives no usable one."""

POINT_BYTES = 256
"""Largest plausible size of a decompressed point, bytes."""

HEAD_BYTES = 65_536
"""Size of the part of a file that tells its format, bytes."""


@dataclass(frozen=True, slots=True, eq=False)
class UploadedCloud:
    """Point cloud of an uploaded file.

    Attributes:
        format: name of the file's format.
        scan: points in the file's frame, less `shift`.
        shift: what was subtracted from the file's coordinates, float64 (3,), meters.
        remarks: what is odd about the file, and how it was read.
    """

    format: str
    scan: LidarScan
    shift: Float64
    remarks: tuple[str, ...]


class _Content(PurePosixPath):
    """Content of a file with the part of `Path` that the readers use; on no disk."""

    content: bytes = b""

    def read_bytes(self) -> bytes:
        return self.content

    def is_file(self) -> bool:
        return bool(self.content)


def read_uploaded_cloud(content: bytes, name: str, most_points: int) -> UploadedCloud:
    """Read an uploaded point cloud file of any format that Placecell reads.

    Args:
        content: the file.
        name: name of the file; its ending tells a format without a signature, and problems show
            it.
        most_points: largest number of points.

    Raises:
        Problem: 413 if the file is too large, 415 if it is no point cloud, 422 if it is damaged.
        Cancelled: the request is late, or its client disconnected.
    """
    file = _Content(_safe(name))
    file.content = content
    found = _format_of(content, file)
    path = cast(Path, file)
    options = ReadOptions()
    try:
        with reading_within(ReadLimits(most_points, POINT_BYTES * most_points)):
            if found is RAW:
                options = ReadOptions(layout=find_layout([path], [len(content)], ScanOptions()))
            cloud = found.read(path, options)
            scan, shift = as_scan(cloud, path, scale=options.layout.scale)
    except TooLargeError as error:
        raise Problem(413, "too-many-points", _told(error)) from error
    except DriveError as error:
        raise Problem(422, "invalid-cloud-file", _told(error)) from error
    if scan.read > most_points:
        raise Problem(
            413,
            "too-many-points",
            f"{file}: has {scan.read:,} points; the limit is {most_points:,}. Thin it out, for "
            "example to one point for each voxel of 0.1 m.",
        )
    return UploadedCloud(found.name, scan, shift, cloud.remarks)


def _safe(name: str) -> str:
    """Return the last part of a name, without signs that cannot be shown."""
    last = PurePosixPath(printable(name).replace("\\", "/")).name
    return NAMELESS if last in {"", ".", ".."} else last


def _format_of(content: bytes, file: PurePosixPath) -> CloudFormat:
    """Return the format of a file: by its content, else by its name.

    Raises:
        Problem: 422 if the file is empty, 415 if it has no known format.
    """
    if not content:
        raise Problem(
            422,
            "invalid-cloud-file",
            f"{file}: is empty. Send a point cloud file as the body of the request.",
        )
    head = content[:HEAD_BYTES]
    named = SUFFIXES.get(file.suffix.lower())
    for each in FORMATS:
        if each.matches(head, cast(Path, file)):
            return each
    if named is not None:
        return named  # its first bytes are damaged; the reader says how
    if head.startswith(ZIP):
        return SUFFIXES[".npz"]
    if is_text(head):
        return TEXT
    expected = ", ".join(each.name for each in FORMATS)
    raise Problem(
        415,
        "unsupported-cloud-file",
        f"{file}: is no point cloud that Placecell reads; expected one of {expected}. Convert the "
        "file to PCD or PLY, or end its name with .bin if it has no header.",
    )


def _told(error: DriveError) -> str:
    """Return a reader's message for a client, who has no command line options."""
    sentences = re.split(r"(?<=[.;]) ", str(error))
    kept = [each for each in sentences if " --" not in each]
    if len(kept) < len(sentences):
        kept.append("Convert the file to PCD or PLY.")
    text = " ".join(kept)
    return text if text.endswith(".") else f"{text}."
