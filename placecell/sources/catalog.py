"""Catalog of all formats: opens any source of scans."""

from pathlib import Path

from placecell.sources.bags import Mcap, Ros1Bag, Ros2Bag
from placecell.sources.clouds.folder import FolderOfClouds
from placecell.sources.errors import DriveError
from placecell.sources.source import ScanSource

SOURCES: tuple[type[ScanSource], ...] = (Ros1Bag, Ros2Bag, Mcap, FolderOfClouds)
"""Classes in the order in which they are tried: the special before the general."""
UNDERSTOOD = (
    "a ROS 1 bag (.bag), a ROS 2 bag (a folder with metadata.yaml, or .db3), an MCAP file, or PCD, "
    "PLY, LAS, LAZ, NumPy (.npy, .npz), text (.csv, .xyz, .txt, .asc, .pts) and headerless "
    ".bin files, or a folder of them"
)
SHOWN = 8
"""Most names and bytes that an error shows."""


def source_class(path: Path) -> type[ScanSource] | None:
    """Return the class that reads a file or folder; None if none does."""
    return next((each for each in SOURCES if each.recognizes(path)), None)


def is_source(path: Path) -> bool:
    """Return whether a file or folder is a source of scans of a known format."""
    return source_class(path) is not None


def open_source(path: Path) -> ScanSource:
    """Open a file or folder as a source of scans.

    Raises:
        DriveError: missing, of no known format, or damaged.
    """
    if not path.exists():
        raise DriveError(f"{path}: does not exist. Check the path of the drive")
    found = source_class(path)
    if found is None:
        raise DriveError(
            f"{path}: is no source of scans; found {describe(path)}. Expected {UNDERSTOOD}"
        )
    return found(path)  # type: ignore[call-arg]


def describe(path: Path) -> str:
    """Return what a file or folder holds, for a message."""
    if path.is_dir():
        try:
            names = sorted(each.name + "/" * each.is_dir() for each in path.iterdir())
        except OSError as error:
            return f"a folder that cannot be read ({error.strerror})"
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        return f"a folder with {', '.join(names[:SHOWN])}{more}" if names else "an empty folder"
    try:
        with path.open("rb") as stream:
            head = stream.read(SHOWN)
    except OSError as error:
        return f"a file that cannot be read ({error.strerror})"
    return f"a file that begins with {head!r}" if head else "an empty file"
