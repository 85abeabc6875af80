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

from placecell.core.jit import compiled
from placecell.core.types import Float32, Int32, Int64

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
        moved: whether the segment has moved.
    """

    voxels: int
    clear: bool
    scan: int
    sensor: Float32
    points: Float32
    reported: bool = False
    moved: bool = False

    def is_improved_by(self, voxels: int, clear: bool) -> bool:
        """Return whether a view is better: clear of the border, then with more voxels."""
        if clear != self.clear:
            return clear
        return voxels >= GROWTH * self.voxels


def persistent_ids(
    regions: Int64, before: Int64, shared: Int64, ids_before: Int64, count: int, next_id: int
) -> tuple[Int64, int]:
    """Return the id of each region, int64 (count,), and the next unused id.

    Args:
        regions: int64 (pairs,), region of each pair.
        before: int64 (pairs,), region of the capture before, of each pair.
        shared: int64 (pairs,), number of voxels that both hold.
        ids_before: int64 (regions before,), ids of the regions of the capture before.
        count: number of regions.
        next_id: smallest unused id.
    """
    ids = np.full(count, -1, dtype=np.int64)
    passed_on = ids_before[before]
    taken = set[int]()
    for pair in np.lexsort((regions, passed_on, -shared)).tolist():
        region, identity = int(regions[pair]), int(passed_on[pair])
        if ids[region] < 0 and identity not in taken:
            ids[region] = identity
            taken.add(identity)
    new = np.flatnonzero(ids < 0)
    ids[new] = next_id + np.arange(len(new))
    return ids, next_id + len(new)


@compiled
def shared_voxels(labels: Int32, ends: Int64, before: int) -> tuple[Int64, Int64, Int64]:
    """Count the voxels that each region shares with each region of the capture before.

    Args:
        labels: int32 (voxels,), region of the capture before that held the voxel; -1 if none did.
            The voxels are ordered by region.
        ends: int64 (regions,): region i holds voxels ends[i - 1] to ends[i] - 1.
        before: number of regions of the capture before.

    Returns:
        Region, region of the capture before, and number of voxels of each pair that shares one,
        int64 (pairs,) each.
    """
    tally = np.zeros(before, np.int64)
    met = np.empty(before, np.int64)
    pairs = [np.int64(0) for _ in range(0)]
    start = 0
    for region in range(len(ends)):
        count = 0
        for voxel in range(start, ends[region]):
            label = labels[voxel]
            if label >= 0:
                if tally[label] == 0:
                    met[count] = label
                    count += 1
                tally[label] += 1
        for index in range(count):
            pairs.append(np.int64(region))
            pairs.append(met[index])
            pairs.append(tally[met[index]])
            tally[met[index]] = 0
        start = ends[region]
    columns = np.array(pairs, dtype=np.int64).reshape((-1, 3))
    return columns[:, 0].copy(), columns[:, 1].copy(), columns[:, 2].copy()


@compiled
def label_voxels(labels: Int32, voxels: Int64, ends: Int64) -> None:
    """Set the label of each voxel of the map to its region; -1 if it is in none.

    Args:
        labels: int32 (n,), labels of the map's voxels, which are overwritten.
        voxels: int64 (voxels,), voxels of the regions, ordered by region.
        ends: int64 (regions,): region i holds voxels ends[i - 1] to ends[i] - 1.
    """
    labels[:] = -1
    start = 0
    for region in range(len(ends)):
        for index in range(start, ends[region]):
            labels[voxels[index]] = region
        start = ends[region]
