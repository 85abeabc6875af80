"""Drift of an odometry, estimated without truth: forward against backward."""

from collections.abc import Callable, Sequence

import numpy as np

from placecell.core.types import Float64

WINDOWS = 4
"""Number of parts of a drive that are run backward."""
WINDOW_SCANS = 50
"""Largest number of scans of a part."""
SHORTEST_PATH = 5.0
"""Shortest path of the parts together that tells a drift, meters."""


def windows(scans: int) -> list[range]:
    """Return the parts of a drive that are run backward, evenly spread, without overlap."""
    if scans <= WINDOW_SCANS:
        return [range(scans)]
    count = min(WINDOWS, scans // WINDOW_SCANS)
    starts = np.linspace(0, scans - WINDOW_SCANS, count).astype(int)
    return [range(start, start + WINDOW_SCANS) for start in starts.tolist()]


def estimate_drift(poses: Float64, backward: Callable[[Sequence[int]], Float64]) -> float | None:
    """Return the drift as a percentage of the path; None if the sensor hardly moves.

    Parts of the drive are run again from their end to their start. A perfect odometry finds the
    same way. The drift is the distance between the two ends of a part, summed, over the path.

    Args:
        poses: poses of the forward run, float64 (scans, 4, 4).
        backward: returns the poses of these scans, in their order, by a run of its own.
    """
    apart = driven = 0.0
    for part in windows(len(poses)):
        if len(part) < 2:
            continue
        there = np.linalg.inv(poses[part[0]]) @ poses[part[-1]]
        back = backward(part[::-1])
        again = np.linalg.inv(back[-1]) @ back[0]
        apart += float(np.linalg.norm(again[:3, 3] - there[:3, 3]))
        steps = np.diff(poses[part.start : part.stop, :3, 3], axis=0)
        driven += float(np.linalg.norm(steps, axis=1).sum())
    return 100 * apart / driven if driven >= SHORTEST_PATH else None
