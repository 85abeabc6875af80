"""Re-ranking: order the candidates of each segment by the neighbors that support them.

Descriptors of segments that look alike are equally near. The segments around them tell them apart:
around the right candidate, the neighbors of the query find candidates at the same offsets. A
neighbor supports a candidate if one of its own nearest candidates lies in the same map, at the same
horizontal distance and height difference, turned by the yaw between the two frames. That yaw is
unknown, so the support of a candidate is the largest number of neighbors that agree about one yaw.
Nothing else of the frames matters, only that both are level.

The idea is the geometric verification of SegMatch (Dubé et al. 2017, *SegMatch: Segment Based Place
Recognition in 3D Point Clouds*), here as a soft score of each candidate. It needs no training and
no pose. `placecell.localization` compares all pairs of candidates, for a pose.

Tolerances and weight were chosen on six drives of the synthetic town that no model was trained on
(`docs/results/recognition.md`).
"""

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.cancellation import current, is_cancelled
from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Float64, Int32, Int64, UInt8

CANDIDATES = 25
"""Number of nearest candidates of a segment among which the best one is sought."""

NEAREST, FARTHEST = 1.0, 40.0
"""Horizontal distance of a neighbor from its segment, meters. A nearer one may be another part of
the same object."""

NEIGHBORS = 32
"""Largest number of neighbors of a segment, the nearest ones."""

DEPTH = 10
"""Largest number of a neighbor's candidates that may support another one, the nearest ones."""

DISTANCE_TOLERANCE, HEIGHT_TOLERANCE = 0.7, 0.7
"""Largest difference of the horizontal distances and of the height differences, meters."""

TURNS = 64
"""Number of sectors of the circle in which neighbors agree about the yaw."""

WEIGHT = 1.0
"""Weight of log(1 + support) against a distance in units of the nearest candidate's distance."""


def supports(
    centroids: Float64, places: Float64, maps: Int64, captures: Int64 | None = None
) -> Int64:
    """Return the support of each candidate, int64 (q, k): the number of agreeing neighbors.

    A candidate is compared with at most 10 candidates of at most 32 neighbors. So the work is at
    most 320 comparisons times q times k, for any input.

    Args:
        centroids: centroids of the query segments, float64 (q, 3), meters, in one level frame.
        places: centroids of their candidates, nearest first, float64 (q, k, 3), meters, in the
            level frame of their map.
        maps: number of each candidate's map, int64 (q, k); -1 where there is no candidate.
        captures: number of the capture of each query, int64 (q,): only segments of one capture are
            neighbors. None: all queries are of one capture.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    counts = np.zeros(maps.shape, dtype=np.int64)
    token = current()
    count_supports(
        np.ascontiguousarray(centroids, dtype=np.float64),
        np.ascontiguousarray(places, dtype=np.float64),
        np.ascontiguousarray(maps, dtype=np.int64),
        neighbors_of(centroids, captures),
        token.flag,
        counts,
    )
    token.check()
    return counts


def neighbors_of(centroids: Float64, captures: Int64 | None = None) -> Int64:
    """Return the neighbors of each segment, nearest first, int64 (q, 32); -1 where there is none.

    A segment with a coordinate that is not finite has no neighbors and is none.

    Args:
        centroids: see `supports`.
        captures: see `supports`.
    """
    neighbors = np.full((len(centroids), NEIGHBORS), -1, dtype=np.int64)
    usable = np.flatnonzero(np.isfinite(centroids).all(axis=1))
    if len(usable) < 2:
        return neighbors
    points = centroids[usable, :2]
    if captures is not None:
        # A third axis keeps the captures apart, so that one tree serves all.
        _, numbers = np.unique(captures[usable], return_inverse=True)
        points = np.column_stack([points, 2 * FARTHEST * numbers.reshape(-1)])
    # The nearest one is the segment itself.
    nearest = min(NEIGHBORS + 1, len(usable))
    distances, found = cKDTree(points).query(points, nearest, distance_upper_bound=FARTHEST)
    is_neighbor = (distances >= NEAREST) & np.isfinite(distances)
    found = np.append(usable, -1)[np.where(is_neighbor, found, -1)]
    first = np.argsort(~is_neighbor, axis=1, kind="stable")[:, :NEIGHBORS]
    neighbors[usable, : first.shape[1]] = np.take_along_axis(found, first, axis=1)
    return neighbors


@compiled
def count_supports(
    centroids: Float64, places: Float64, maps: Int64, neighbors: Int64, flag: Int32, counts: Int64
) -> int:
    """Fill `counts` with the support of each candidate; return the number of comparisons.

    Args:
        centroids: see `supports`.
        places: see `supports`.
        maps: see `supports`.
        neighbors: see `neighbors_of`.
        flag: flag of a `CancelToken`.
        counts: int64 (q, k), all 0.
    """
    most = NEIGHBORS * DEPTH
    # The candidates of all neighbors of a query, one after the other.
    owners, others = np.empty(most, np.int64), np.empty(most, np.int64)
    x, y, z = np.empty(most), np.empty(most), np.empty(most)
    least, farthest = np.empty(most), np.empty(most)
    fits = np.empty(most, np.uint8)
    agreeing, turns = np.zeros(TURNS, np.int64), np.zeros(TURNS, np.uint8)
    comparisons = 0
    for query in range(len(maps)):
        if is_cancelled(flag):
            return comparisons
        size = 0
        for neighbor in neighbors[query]:
            if neighbor < 0:
                break
            east = centroids[neighbor, 0] - centroids[query, 0]
            north = centroids[neighbor, 1] - centroids[query, 1]
            rise = centroids[neighbor, 2] - centroids[query, 2]
            distance = np.sqrt(east * east + north * north)
            for other in range(min(maps.shape[1], DEPTH)):
                owners[size], others[size] = neighbor, maps[neighbor, other]
                x[size] = places[neighbor, other, 0]
                y[size] = places[neighbor, other, 1]
                z[size] = places[neighbor, other, 2] - rise
                least[size] = (distance - DISTANCE_TOLERANCE) ** 2
                farthest[size] = (distance + DISTANCE_TOLERANCE) ** 2
                size += 1
        for column in range(maps.shape[1]):
            place = maps[query, column]
            if place < 0:
                continue
            here_x, here_y = places[query, column, 0], places[query, column, 1]
            here_z = places[query, column, 2]
            # This loop is free of branches, so that the compiler makes vector instructions of it.
            for i in range(size):
                squared = (x[i] - here_x) ** 2 + (y[i] - here_y) ** 2
                fits[i] = (
                    (least[i] <= squared)
                    & (squared <= farthest[i])
                    & (abs(z[i] - here_z) <= HEIGHT_TOLERANCE)
                    & (others[i] == place)
                )
            comparisons += size
            counts[query, column] = _agreement(
                owners[:size], fits[:size], x, y, here_x, here_y, centroids, query, turns, agreeing
            )
    return comparisons


@compiled_part
def _agreement(
    owners: Int64,
    fits: UInt8,
    x: Float64,
    y: Float64,
    here_x: float,
    here_y: float,
    centroids: Float64,
    query: int,
    turns: UInt8,
    agreeing: Int64,
) -> int:
    """Return the largest number of neighbors that agree about one yaw.

    Args:
        owners: neighbor of each of the neighbors' candidates, int64 (n,), those of one together.
        fits: whether distance, height and map of each fit, uint8 (n,).
        x: x of each, float64 (n or more,), meters.
        y: y of each, float64 (n or more,), meters.
        here_x: x of the supported candidate, meters.
        here_y: y of the supported candidate, meters.
        centroids: see `supports`.
        query: index of the query.
        turns: room for the sectors of one neighbor, uint8 (64,).
        agreeing: room for the neighbors of each sector, int64 (64,).
    """
    agreeing[:] = 0
    zero, owner = np.nan, -1
    for i in range(len(owners)):
        if not fits[i]:
            continue
        if owners[i] != owner:
            owner = owners[i]
            turns[:] = 0
        east = centroids[owner, 0] - centroids[query, 0]
        north = centroids[owner, 1] - centroids[query, 1]
        u, v = x[i] - here_x, y[i] - here_y
        turn = np.arctan2(east * v - north * u, east * u + north * v)
        if np.isnan(zero):
            # Sectors begin at the first turn, so that no yaw is preferred.
            zero = turn
        # A position that is off by the tolerance turns the offset by this angle.
        off = DISTANCE_TOLERANCE / np.sqrt(east * east + north * north)
        first = np.floor((turn - zero - off) * (TURNS / (2 * np.pi)))
        last = np.floor((turn - zero + off) * (TURNS / (2 * np.pi)))
        for sector in range(int(first), int(last) + 1):
            # A neighbor counts once in a sector, however many of its candidates fit.
            if turns[sector % TURNS] == 0:
                turns[sector % TURNS] = 1
                agreeing[sector % TURNS] += 1
    return int(agreeing.max())


def rerank(distances: Float64, counts: Int64) -> Int64:
    """Return the order of each query's candidates, best first, int64 (q, k).

    The score of a candidate is log(1 + support) minus its distance in units of the nearest
    candidate's distance. So the unit of the descriptors does not matter, and without any support
    the order stays. Ties keep their order.

    Args:
        distances: descriptor distances of the candidates, ascending, float64 (q, k); infinite
            where there is no candidate.
        counts: support of each candidate, int64 (q, k).
    """
    return np.argsort(-scores_of(distances, counts), axis=1, kind="stable")


def scores_of(distances: Float64, counts: Int64) -> Float64:
    """Return the score of each candidate, float64 (q, k); see `rerank`."""
    nearest = distances[:, :1].astype(np.float64)
    # An equal descriptor, at distance 0, comes before all that differ.
    units = np.where(np.isfinite(nearest), np.maximum(nearest, np.finfo(np.float32).tiny), 1.0)
    return np.asarray(WEIGHT * np.log1p(counts) - distances / units)
