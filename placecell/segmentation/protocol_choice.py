"""Choice of a drive's protocol: `sparse` if protocol v1 finds few segments in a capture."""

from collections.abc import Iterable

import numpy as np

from placecell.segmentation.recording import Recording

FEWEST = 30
"""Median number of segments in a capture from which protocol v1 is kept.

In simulated towns, a VLP-16 sees 4, 15 and 27 segments in local maps of 1, 2 and 4 scans, and its
best pose is right for 6%, 64% and 80% of the queries; with protocol `sparse`, for all. Sensors that
see 40 segments or more have 99% right best poses with v1 (docs/results/localization.md)."""


def is_sparse(recordings: Iterable[Recording]) -> bool:
    """Return whether the median capture of some recordings has few segments."""
    counts = [
        np.bincount(each.captures, minlength=each.scans)[each.capture_scans] for each in recordings
    ]
    return bool(np.median(np.concatenate(counts)) < FEWEST)
