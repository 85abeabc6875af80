"""Scans of segments that benchmarks describe and send."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.datasets import open_drive
from placecell.segmentation.pipeline import Progress, record, silent
from placecell.segmentation.recording import Recording


def draw_scans(scans: Sequence[Segments], segments: int, seed: int) -> list[Segments]:
    """Draw scans at random until they hold `segments` segments; repeat scans if there are too few.

    Args:
        scans: the segments of each scan.
        segments: smallest number of segments to draw.
        seed: random seed of the order.

    Raises:
        ValueError: the scans have no segments.
    """
    filled = [scan for scan in scans if len(scan)]
    if not filled:
        raise ValueError("The scans have no segments to describe. Use a longer drive.")
    random, drawn = np.random.default_rng(seed), list[Segments]()
    while sum(map(len, drawn)) < segments:
        drawn += [filled[index] for index in random.permutation(len(filled))]
    ends = np.cumsum([len(scan) for scan in drawn])
    return drawn[: int(np.searchsorted(ends, segments)) + 1]


def scans_in(recording: Recording) -> list[Segments]:
    """Return the segments of each capture, as a robot sends them."""
    return [
        recording.segments.take(np.flatnonzero(recording.captures == scan))
        for scan in np.unique(recording.captures)
    ]


def town_recording(
    folder: Path, seed: int, progress: Progress = silent, scans: int = 20
) -> Recording:
    """Record a short drive through the synthetic town; keep the drive in the folder."""
    from town import two_robots

    path, _ = two_robots(folder, seed=seed, scans=scans, overwrite=True, progress=progress)
    return record(open_drive(path), PROTOCOL_V1.for_drive(scans), progress=progress)
