"""Labels of points: the semantic class of each return, in the files of SemanticKITTI.

A drive in the KITTI odometry layout may have `labels/NNNNNN.label` beside `velodyne/NNNNNN.bin`:
one little-endian uint32 for each point of the scan, in its order. The lower 16 bits are the class,
the upper 16 bits number the objects. Source: Behley et al. 2019, *SemanticKITTI*.
"""

from pathlib import Path

import numpy as np

from placecell.core.types import UInt8, UInt16
from placecell.datasets.drive import Drive
from placecell.sources.errors import DriveError

FOLDER = "labels"

CODES: dict[str, tuple[int, ...]] = {
    "building": (50,),
    "vegetation": (70,),
    "pole": (80, 71),
    "vehicle": (10, 11, 13, 15, 16, 18, 20, 252, 256, 257, 258, 259),
    "person": (30, 31, 32, 253, 254, 255),
    "fence": (51,),
    "sign": (81,),
    "other": (99, 40, 44, 48, 49, 52, 60, 72),
}
"""Codes of SemanticKITTI for each class; the first one is the code that the town writes.

A trunk (71) counts as a pole, and a rider (31, 32) as a person. Ground (40 to 49, 60, 72) that
remains in a segment is `other`, as are other structures (52). Codes 0 (unlabeled) and 1 (outlier)
have no class.
"""

GROUND = 40
"""Code of a road. The simulated town gives it to all ground."""

NO_CLASS = 255
"""Class index of points and segments without a class."""


def class_of_code() -> UInt8:
    """Return the class index of each code, uint8 (65536,); `NO_CLASS` for codes without a class."""
    table = np.full(1 << 16, NO_CLASS, dtype=np.uint8)
    for index, codes in enumerate(CODES.values()):
        table[list(codes)] = index
    return table


def label_file(drive: Drive, index: int) -> Path:
    """Return the file with the labels of a scan, which may be missing."""
    return drive.folder / FOLDER / f"{drive.scan_files[index].stem}.label"


def has_labels(drive: Drive) -> bool:
    """Return whether a drive has labels beside its scans."""
    return (
        bool(drive.scan_files)
        and drive.scan_files[0].parent == drive.folder / "velodyne"
        and any((drive.folder / FOLDER).glob("*.label"))
    )


def read_codes(drive: Drive, index: int) -> UInt16:
    """Read the code of each point that `Drive.scan` returns, uint16 (n,).

    A scan without a label file has code 0 everywhere.

    Raises:
        DriveError: The file cannot be read, or has another number of labels than the scan.
    """
    points = drive.read_points(index)
    keep = np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)
    file = label_file(drive, index)
    if not file.is_file():
        return np.zeros(int(keep.sum()), np.uint16)
    try:
        codes = np.fromfile(file, dtype="<u4")
    except OSError as error:
        raise DriveError(f"{file}: cannot be read ({error.strerror})") from error
    if len(codes) != len(points) or file.stat().st_size % 4:
        raise DriveError(
            f"{file}: {file.stat().st_size} bytes, expected {4 * len(points)}: 4 bytes for each of "
            f"the {len(points)} points of {drive.scan_path(index)}. Get the labels of this drive"
        )
    return np.asarray(codes[keep] & 0xFFFF, dtype=np.uint16)


def write_codes(folder: Path, name: str, codes: UInt16) -> None:
    """Write the codes of a scan's points, uint16 (n,), as a label file."""
    (folder / FOLDER).mkdir(exist_ok=True)
    (folder / FOLDER / f"{name}.label").write_bytes(codes.astype("<u4").tobytes())
