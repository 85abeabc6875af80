"""Spatial helpers: points that are near other points."""

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Bool, Float64, Int64


def evenly(rows: Int64, most: int) -> Int64:
    """Return at most `most` of the rows, evenly spaced."""
    if len(rows) <= most:
        return rows
    return rows[np.linspace(0, len(rows) - 1, most).round().astype(np.int64)]


WHOLE = 250.0
"""Longest box around places that is used whole, meters. One scan of a robot spans less."""

CELL, CELLS = 10.0, 1_000
"""Smallest edge length of the cells of a longer box, meters, and their largest number along it."""


def within(points: Float64, places: Float64, meters: float) -> Int64:
    """Return the indices of all points near a place, int64 (k,). Some farther points are included.

    Args:
        points: float64 (n, 3), meters.
        places: float64 (m, 3), meters; m > 0.
        meters: largest distance along each axis at which a point is near.
    """
    low, high = places.min(axis=0) - meters, places.max(axis=0) + meters
    # One place far from the others makes the box as large as half the map.
    is_wide = (high - low)[:2].max() > WHOLE
    # One axis after the other: the first leaves few points of a large map.
    inside = np.flatnonzero((points[:, 0] >= low[0]) & (points[:, 0] <= high[0]))
    if is_wide:
        inside = inside[_beside(points[inside, :1], places[:, :1], meters)]
    for axis in (1, 2):
        along = points[inside, axis]
        inside = inside[(along >= low[axis]) & (along <= high[axis])]
    if is_wide:
        inside = inside[_beside(points[inside, :2], places[:, :2], meters)]
    return inside


def _beside(points: Float64, places: Float64, meters: float) -> Bool:
    """Return whether each point is in the cell of a place or in an adjacent cell, bool (n,).

    Args:
        points: float64 (n, d), at most `meters` outside the places' bounding box.
        places: float64 (m, d).
        meters: largest distance along each axis at which a point is near.
    """
    low, high = places.min(axis=0) - meters, places.max(axis=0) + meters
    # At least 2 * meters, so that rounding never puts a near point two cells away.
    cell = max(CELL, 2 * meters, (high - low).max() / CELLS)
    near = np.zeros((CELLS + 3,) * len(low), dtype=bool)
    of_places, of_points = (((each - low) / cell).astype(np.int64) for each in (places, points))
    for step in np.ndindex((3,) * len(low)):
        near[tuple((of_places + step).T)] = True
    return np.asarray(near[tuple((of_points + 1).T)])


def near_pairs(a: Float64, b: Float64, gate: float, most: int) -> tuple[Int64, Int64]:
    """Return the pairs of points of a and of b that are closer than the gate.

    If there are more than `most` pairs, evenly spaced points are dropped until they fit: segments
    may be so dense that each is near all others.

    Args:
        a: float64 (n, 3), meters.
        b: float64 (m, 3), meters.
        gate: distance, meters.
        most: largest number of pairs.

    Returns:
        Indices into a and into b, int64 (p,) each.
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
