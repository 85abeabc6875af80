"""Points that lie near each other."""

import numpy as np
from scipy.spatial import cKDTree

from segments.types import Float64, Int64


def evenly(rows: Int64, most: int) -> Int64:
    """So many of the rows at most, evenly."""
    if len(rows) <= most:
        return rows
    return rows[np.linspace(0, len(rows) - 1, most).round().astype(np.int64)]


def within(points: Float64, places: Float64, metres: float) -> Int64:
    """Indices of the points (n, 3) in a box that holds the places, and so many metres more."""
    low, high = places.min(axis=0) - metres, places.max(axis=0) + metres
    # Axis by axis: nearly all of a large map is gone after the first.
    inside = np.flatnonzero((points[:, 0] >= low[0]) & (points[:, 0] <= high[0]))
    for axis in (1, 2):
        along = points[inside, axis]
        inside = inside[(along >= low[axis]) & (along <= high[axis])]
    return inside


def near_pairs(a: Float64, b: Float64, gate: float, most: int) -> tuple[Int64, Int64]:
    """Points of a (n, 3) and of b (m, 3) that are closer than the gate, indices, int64 (p,) each.

    Where these are too many, of fewer and fewer of the points, evenly: segments may lie so densely
    that each is near all others.
    """
    share = 1.0
    while True:
        of_a = evenly(np.arange(len(a)), int(np.ceil(share * len(a))))
        of_b = evenly(np.arange(len(b)), int(np.ceil(share * len(b))))
        here, there = cKDTree(a[of_a]), cKDTree(b[of_b])
        count = int(there.count_neighbors(here, gate))
        if count <= most:
            break
        share *= 0.9 * np.sqrt(most / count)
    near = there.sparse_distance_matrix(here, gate, output_type="ndarray")
    return of_a[near["j"]], of_b[near["i"]]
