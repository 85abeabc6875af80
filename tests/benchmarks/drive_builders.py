"""Drives that leave a small built-up area, for what becomes of frames that show nothing."""

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
"""What stands in the built-up area, of which a robot sees all until it leaves."""

FAR = (70.0, 0.0, 0.0)
"""A return that the preprocessing drops, for a scan must hold a point."""


def trip(folder: Path, scans: int, left: range) -> Drive:
    """A robot that sees the built-up area but for some scans, metre after metre."""
    area = np.concatenate(BOXES)
    seen = [
        np.array([FAR]) if scan in left else area - np.array([scan, 0, 0]) for scan in range(scans)
    ]
    write_odometry(folder, seen, [pose(scan) for scan in range(scans)])
    (folder / "origin.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
    return open_drive(folder)
