"""Readers of recorded drives, one file per format."""

from pathlib import Path

from placecell.datasets.drive import Drive
from placecell.datasets.helipr import HeLiPR
from placecell.datasets.kitti_odometry import KittiOdometry
from placecell.datasets.kitti_raw import KittiRaw
from placecell.datasets.mulran import MulRan
from placecell.datasets.source_drive import SourceDrive, open_source_drive
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import (
    NO_ODOMETRY,
    ScanOptions,
    current_scan_options,
    parse_columns,
    use_scan_options,
)

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
    "SourceDrive",
    "open_drive",
    "parse_columns",
    "use_scan_options",
]


def open_drive(path: Path) -> Drive:
    """Open a drive. Its format is detected.

    A folder in a known layout has its own poses. Any other source of scans (bag, MCAP, folder of
    point clouds) gets the poses of the options, its own poses, or those of odometry; so does a
    folder in a known layout if the options state other poses.

    Args:
        path: file or folder of the drive.

    Raises:
        DriveError: The path is missing, has no known format, is broken, or has no poses.
    """
    path = Path(path).absolute()  # so that "." has a name
    if not path.exists():
        raise DriveError(f"{path}: no such file or folder. Check the path of the drive.")
    options = current_scan_options()
    own_poses = options.poses is None and options.odometry in (None, NO_ODOMETRY)
    layouts = "; ".join(f"{reader.name}: {reader.layout}" for reader in FORMATS)
    for reader in FORMATS if path.is_dir() else ():
        if not reader.recognizes(path):
            continue
        if own_poses and reader.has_poses(path):
            return reader(path)
        return open_source_drive(path / reader.scan_folder, path)
    return open_source_drive(path, layouts=layouts)
