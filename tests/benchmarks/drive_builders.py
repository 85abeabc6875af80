"""Drives that leave a small built-up area, so that some captures have no segments."""

from pathlib import Path

import numpy as np

from placecell.datasets import Drive, open_drive
from tests.placecell.segment_builders import box, pose, write_odometry

BOXES = [
    box((x, y, -1.5), size)
    for x, y, size in [
        *(
            (0.0, 5.0, (2, 1, 3)),
            (7.0, 6.0, (1, 2, 2)),
            (3.0, -5.0, (3, 1, 2)),
            (11, -6, (1, 1, 4)),
        ),
        *(
            (-6.0, 4.0, (2, 2, 2)),
            (15.0, 5.0, (2, 1, 2)),
            (-4.0, -7.0, (1, 3, 3)),
            (18, -4, (2, 2, 3)),
        ),
    ]
]
"""Objects in the built-up area; a robot in the area sees all of them."""

FAR = (70.0, 0.0, 0.0)
"""A point that the preprocessing drops; a scan must hold at least one point."""


def trip(folder: Path, scans: int, left: range, unseen: int = 0) -> Drive:
    """Write a drive of 1 m per scan that sees the built-up area, except in the scans `left`.

    The last `unseen` objects of the area are never seen.
    """
    area = np.concatenate(BOXES[: len(BOXES) - unseen])
    seen = [
        np.array([FAR]) if scan in left else area - np.array([scan, 0, 0]) for scan in range(scans)
    ]
    write_odometry(folder, seen, [pose(scan) for scan in range(scans)])
    (folder / "origin.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
    return open_drive(folder)
