"""Groups: segments of one surface in successive captures (paper III-A)."""

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64


class Grouper:
    """Assigns segments of successive captures to groups.

    A segment joins the group of the nearest segment of the previous capture, one to one, if their
    centroids are within `d_same`, meters. Otherwise it starts a new group.
    """

    def __init__(self, d_same: float) -> None:
        self.d_same = d_same
        self.count = 0
        self._centroids = np.zeros((0, 3))
        self._groups = np.zeros(0, dtype=np.int64)

    def add_capture(self, centroids: Float64) -> Int64:
        """Return the groups of the next capture's segments, int64 (segments,).

        Args:
            centroids: float64 (segments, 3), meters, world frame.
        """
        groups = np.full(len(centroids), -1, dtype=np.int64)
        now, before = nearest_pairs(centroids, self._centroids, self.d_same)
        groups[now] = self._groups[before]
        new = groups < 0
        groups[new] = self.count + np.arange(new.sum())
        self.count += int(new.sum())
        self._centroids, self._groups = centroids, groups
        return groups


def nearest_pairs(a: Float64, b: Float64, limit: float) -> tuple[Int64, Int64]:
    """Pair points one to one, nearest first.

    Args:
        a: float64 (n, 3), meters.
        b: float64 (m, 3), meters.
        limit: largest distance of a pair, meters.

    Returns:
        Indices into a and into b, int64 (p,) each.
    """
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
