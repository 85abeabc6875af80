"""Formats of point cloud files, told by their content."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from placecell.sources.clouds.cloud import HEAD, Cloud
from placecell.sources.clouds.las import is_las, read_las
from placecell.sources.clouds.numpy_files import is_npy, is_npz, read_npy, read_npz
from placecell.sources.clouds.pcd import is_pcd, read_pcd
from placecell.sources.clouds.ply import is_ply, read_ply
from placecell.sources.clouds.raw import read_raw
from placecell.sources.clouds.text import is_text, read_text
from placecell.sources.errors import DriveError
from placecell.sources.point_layout import KITTI, PointLayout


@dataclass(frozen=True, slots=True)
class ReadOptions:
    """Options for files that do not describe themselves.

    Attributes:
        columns: names of the columns of a table without a header; None: x, y, z and others.
        layout: layout of files without a header.
    """

    columns: tuple[str, ...] | None = None
    layout: PointLayout = KITTI


@dataclass(frozen=True, slots=True)
class CloudFormat:
    """A format of point cloud files.

    Attributes:
        name: name of the format in messages and in `placecell inspect`.
        suffixes: endings of file names, in lower case; the first is the usual one.
        matches: returns whether the head of a file has this format.
        read: reads a file.
    """

    name: str
    suffixes: tuple[str, ...]
    matches: Callable[[bytes, Path], bool]
    read: Callable[[Path, ReadOptions], Cloud]


TEXT_SUFFIXES = (".xyz", ".csv", ".txt", ".asc", ".pts", ".xyzi", ".xyzn", ".xyzrgb", ".dat")
RAW = CloudFormat(
    "binary without header",
    (".bin",),
    lambda _, file: file.suffix.lower() == ".bin",
    lambda file, options: read_raw(file, options.layout),
)
TEXT = CloudFormat(
    "text",
    TEXT_SUFFIXES,
    lambda head, file: file.suffix.lower() in TEXT_SUFFIXES and is_text(head),
    lambda file, options: read_text(file, options.columns),
)
FORMATS = (
    CloudFormat("PCD", (".pcd",), lambda head, _: is_pcd(head), lambda file, _: read_pcd(file)),
    CloudFormat("PLY", (".ply",), lambda head, _: is_ply(head), lambda file, _: read_ply(file)),
    CloudFormat(
        "LAS", (".las", ".laz"), lambda head, _: is_las(head), lambda file, _: read_las(file)
    ),
    CloudFormat(
        "NumPy array",
        (".npy",),
        lambda head, _: is_npy(head),
        lambda file, options: read_npy(file, options.columns),
    ),
    CloudFormat(
        "NumPy archive", (".npz",), is_npz, lambda file, options: read_npz(file, options.columns)
    ),
    TEXT,
    RAW,
)
"""Formats in the order in which they are tried: those with a signature first."""
SUFFIXES = {suffix: each for each in FORMATS for suffix in each.suffixes}


def read_head(file: Path) -> bytes:
    """Return the first bytes of a file; none if it cannot be read."""
    try:
        with file.open("rb") as stream:
            return stream.read(HEAD)
    except OSError:
        return b""


def format_of(file: Path) -> CloudFormat | None:
    """Return the format of a file: by its content, else by its name; None if it has none of them.

    A file that is damaged in its first bytes has the format that its name states.
    """
    head = read_head(file)
    for each in FORMATS:
        if head and each.matches(head, file):
            return each
    return SUFFIXES.get(file.suffix.lower())


def read_cloud(file: Path, options: ReadOptions) -> Cloud:
    """Read a point cloud file of any format.

    Raises:
        DriveError: no known format, or the file is damaged.
    """
    found = format_of(file)
    if found is None:
        raise DriveError(
            f"{file}: is no point cloud; expected one of {', '.join(each.name for each in FORMATS)}"
        )
    return found.read(file, options)
