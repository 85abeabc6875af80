"""Points that lie near each other."""

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Bool, Float64, Int64


def evenly(rows: Int64, most: int) -> Int64:
    """So many of the rows at most, evenly."""
    if len(rows) <= most:
        return rows
    return rows[np.linspace(0, len(rows) - 1, most).round().astype(np.int64)]


WHOLE = 250.0
"""Metres: a box about places that is no longer is taken whole; a robot sees no farther at once."""

CELL, CELLS = 10.0, 1_000
"""Metres a side of the cells of a longer one, at least; and how many are along it, at most."""


def within(points: Float64, places: Float64, meters: float) -> Int64:
    """Indices of the points about places: of all that are near one of them, and of some around.

    Args:
        points: float64 (n, 3), meters.
        places: float64 (m, 3), meters; m > 0.
        meters: along each axis, up to which a point is near.
    """
    low, high = places.min(axis=0) - meters, places.max(axis=0) + meters
    # One place far from the rest makes it a box of half the map.
    is_wide = (high - low)[:2].max() > WHOLE
    # Axis by axis: nearly all of a large map is gone after the first.
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
    """Which points (n, d) are in a cell that holds a place (m, d), or in one next to it, bool (n,).

    Args:
        points: none farther than so many meters beyond the places, along each axis.
    """
    low, high = places.min(axis=0) - meters, places.max(axis=0) + meters
    # Of twice the meters at least, so that rounding puts nothing that is near two cells away.
    cell = max(CELL, 2 * meters, (high - low).max() / CELLS)
    near = np.zeros((CELLS + 3,) * len(low), dtype=bool)
    of_places, of_points = (((each - low) / cell).astype(np.int64) for each in (places, points))
    for step in np.ndindex((3,) * len(low)):
        near[tuple((of_places + step).T)] = True
    return np.asarray(near[tuple((of_points + 1).T)])


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
