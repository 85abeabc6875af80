"""Readers of recorded drives, one file per format."""

from pathlib import Path

from placecell.datasets.drive import Drive
from placecell.datasets.helipr import HeLiPR
from placecell.datasets.kitti_odometry import KittiOdometry
from placecell.datasets.kitti_raw import KittiRaw
from placecell.datasets.mulran import MulRan
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import ScanOptions, parse_columns, use_scan_options

FORMATS = (KittiOdometry, KittiRaw, MulRan, HeLiPR)

__all__ = [
    "FORMATS",
    "Drive",
    "DriveError",
    "HeLiPR",
    "KittiOdometry",
    "KittiRaw",
    "MulRan",
    "ScanOptions",
    "open_drive",
    "parse_columns",
    "use_scan_options",
]


def open_drive(folder: Path) -> Drive:
    """Open a drive. Its layout is detected.

    Args:
        folder: folder of the drive.

    Raises:
        DriveError: The folder is missing, has no known layout, or is broken.
    """
    folder = Path(folder).absolute()  # so that "." has a name
    if not folder.is_dir():
        raise DriveError(f"{folder}: no such folder. Check the path of the drive.")
    for reader in FORMATS:
        if reader.recognizes(folder):
            return reader(folder)
    layouts = "; ".join(f"{reader.name}: {reader.layout}" for reader in FORMATS)
    raise DriveError(
        f"{folder}: not a drive in a known layout ({layouts}). Check the path, or "
        "convert the drive (docs/tutorials/your-own-logs.md)."
    )
