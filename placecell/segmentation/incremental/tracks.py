"""Tracks: segments over successive captures, with persistent ids and their best views.

Rule of the ids. Each region of a capture is compared with the regions of the capture before, by the
voxels that both hold. Pairs are taken in the order of the shared voxels, most first, then by the
older id. Each region and each id is taken once. So a region that grows keeps its id. When regions
merge, the one with the most voxels in the merged region passes its id on, and the other ids end.
When a region splits, the part with the most of its voxels keeps the id, and the other parts get
new ids. An id that ended never comes back.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Int64

GROWTH = 1.05
"""Number of voxels, relative to the best view, from which a segment has grown."""


@dataclass(slots=True)
class Track:
    """One segment over time.

    Attributes:
        voxels: number of voxels of the best view.
        clear: whether the best view is clear of the local map's border.
        scan: number of the scan at which the best view was captured.
        sensor: float32 (3,), sensor position of the best view.
        points: float32 (n, 3), points of the best view.
        reported: whether the best view was returned by `Tracks.take_complete`.
    """

    voxels: int
    clear: bool
    scan: int
    sensor: Float32
    points: Float32
    reported: bool = False

    def is_improved_by(self, voxels: int, clear: bool) -> bool:
        """Return whether a view is better: clear of the border, then with more voxels."""
        if clear != self.clear:
            return clear
        return voxels >= GROWTH * self.voxels


def persistent_ids(
    shared: Int64, regions: Int64, before: Int64, count: int, next_id: int
) -> tuple[Int64, int]:
    """Return the id of each region, int64 (count,), and the next unused id.

    Args:
        shared: int64 (pairs,), number of voxels that a region shares with one of the capture
            before.
        regions: int64 (pairs,), region of each pair.
        before: int64 (pairs,), id of each pair's region of the capture before.
        count: number of regions.
        next_id: smallest unused id.
    """
    ids = np.full(count, -1, dtype=np.int64)
    taken = set[int]()
    for pair in np.lexsort((regions, before, -shared)).tolist():
        region, identity = int(regions[pair]), int(before[pair])
        if ids[region] < 0 and identity not in taken:
            ids[region] = identity
            taken.add(identity)
    new = np.flatnonzero(ids < 0)
    ids[new] = next_id + np.arange(len(new))
    return ids, next_id + len(new)
