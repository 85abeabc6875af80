"""Groups: the same surface seen in successive frames (paper III-A)."""

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64


class Grouper:
    """Numbers the segments of successive frames by group.

    A segment joins the group of the previous frame's segment whose centroid is nearest, one to
    one, if within `d_same`; otherwise it begins a group.
    """

    def __init__(self, d_same: float) -> None:
        self.d_same = d_same
        self.count = 0
        self._centroids = np.zeros((0, 3))
        self._groups = np.zeros(0, dtype=np.int64)

    def add_capture(self, centroids: Float64) -> Int64:
        """Groups of the next frame's segments, int64 (segments,), from their centroids (n, 3)."""
        groups = np.full(len(centroids), -1, dtype=np.int64)
        now, before = nearest_pairs(centroids, self._centroids, self.d_same)
        groups[now] = self._groups[before]
        new = groups < 0
        groups[new] = self.count + np.arange(new.sum())
        self.count += int(new.sum())
        self._centroids, self._groups = centroids, groups
        return groups


def nearest_pairs(a: Float64, b: Float64, limit: float) -> tuple[Int64, Int64]:
    """Pair points one to one, nearest first, within a limit: indices into a and into b."""
    empty = np.zeros(0, dtype=np.int64)
    if not len(a) or not len(b):
        return empty, empty
    close = cKDTree(a).sparse_distance_matrix(cKDTree(b), limit, output_type="ndarray")
    taken_a: dict[int, int] = {}
    taken_b: set[int] = set()
    for i, j, _ in np.sort(close, order=("v", "i", "j")).tolist():
        if i not in taken_a and j not in taken_b:
            taken_a[i] = j
            taken_b.add(j)
    return (
        np.array(list(taken_a.keys()), dtype=np.int64),
        np.array(list(taken_a.values()), dtype=np.int64),
    )
