"""Consistency graph: pairs of correspondences that can be right together.

A rigid motion preserves distances. Source: Leordeanu and Hebert 2005, *A spectral technique for
correspondence problems using pairwise constraints*; with hard edges, Enqvist, Josephson and Kahl
2009, *Optimal correspondences from pairwise constraints*. If gravity is known, horizontal distances
and height differences are preserved separately.
"""

import numpy as np

from placecell.core.bits import WORD, trailing_zeros, words_of
from placecell.core.cancellation import is_cancelled
from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Float32, Float64, Int32, Int64, UInt64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters


def consistent(found: Correspondences, parameters: LocalizationParameters) -> UInt64:
    """Return the consistency graph of correspondences, symmetric, as bits (see `core.bits`).

    A correspondence has no edge to itself, to another of the same query, or to another of the same
    place.

    Returns:
        uint64 (m, words), bit j of row i is the edge between i and j.
    """
    graph = np.zeros((len(found), words_of(len(found))), dtype=np.uint64)
    _compare(
        columns=np.stack([*found.source.T, *found.target.T, found.queries, found.places]),
        level=parameters.model == "yaw",
        tolerance=parameters.distance_tolerance,
        height_tolerance=parameters.height_tolerance,
        slope=slope_of(parameters),
        graph=graph,
    )
    return graph


def slope_of(parameters: LocalizationParameters) -> float:
    """Return the height tolerance per meter of horizontal distance that the tilt allows."""
    return float(np.tan(np.radians(parameters.tilt)))


@compiled_part
def keeps_distance(
    here: float, there: float, rise: float, other_rise: float, level: bool, tolerance: float
) -> bool:
    """Return whether two correspondences agree about the distance of their segments.

    It takes no root, so that the compiler makes vector instructions of a loop.

    Args:
        here: squared horizontal distance between the two query segments, square meters.
        there: squared horizontal distance between the two map segments, square meters.
        rise: height difference of the query segments, meters.
        other_rise: height difference of the map segments, meters.
        level: whether gravity is known, so that horizontal distances and heights are kept.
        tolerance: largest difference of the distances, meters.
    """
    squared, other_squared = here, there
    if not level:
        squared += rise**2
        other_squared += other_rise**2
    # |sqrt(squared) - sqrt(other_squared)| <= tolerance
    excess = squared + other_squared - tolerance**2
    return excess <= 0.0 or excess**2 <= 4.0 * squared * other_squared


@compiled_part
def keeps_height(
    here: float,
    rise: float,
    other_rise: float,
    level: bool,
    height_tolerance: float,
    slope: float,
) -> bool:
    """Return whether two correspondences agree about the height difference, if gravity is known.

    Args:
        here: see `keeps_distance`.
        rise: see `keeps_distance`.
        other_rise: see `keeps_distance`.
        level: see `keeps_distance`.
        height_tolerance: largest difference of the height differences, meters.
        slope: increase of the height tolerance per meter of horizontal distance.
    """
    # |rise - other_rise| <= height_tolerance + slope * sqrt(here)
    higher = abs(rise - other_rise) - height_tolerance
    return (not level) or higher <= 0.0 or higher**2 <= slope**2 * here


@compiled
def _compare(
    columns: Float64,
    level: bool,
    tolerance: float,
    height_tolerance: float,
    slope: float,
    graph: UInt64,
) -> None:
    """Fill `graph` with the edges between correspondences.

    Args:
        columns: float64 (8, m): source x, y, z, target x, y, z, query, place. With one array of
            one type, the inner loop compares four correspondences an instruction.
        level: see `keeps_distance`.
        tolerance: see `keeps_distance`.
        height_tolerance: see `keeps_height`.
        slope: see `keeps_height`.
        graph: see `consistent`; all 0.
    """
    edges = np.zeros(WORD * graph.shape[1], dtype=np.uint8)
    for i in range(columns.shape[1]):
        x, y, z = columns[0, i], columns[1, i], columns[2, i]
        u, v, w = columns[3, i], columns[4, i], columns[5, i]
        query, place = columns[6, i], columns[7, i]
        for j in range(i):
            here = (x - columns[0, j]) ** 2 + (y - columns[1, j]) ** 2
            there = (u - columns[3, j]) ** 2 + (v - columns[4, j]) ** 2
            rise, other_rise = z - columns[2, j], w - columns[5, j]
            edges[j] = (
                keeps_distance(here, there, rise, other_rise, level, tolerance)
                & keeps_height(here, rise, other_rise, level, height_tolerance, slope)
                & (query != columns[6, j])
                & (place != columns[7, j])
            )
        eights = edges.view(np.uint64)
        for word in range((i + WORD - 1) // WORD):
            bits = np.uint64(0)
            for part in range(8):
                # Multiplying moves the lowest bits of eight bytes into the highest byte.
                byte = (eights[8 * word + part] * np.uint64(0x0102040810204080)) >> np.uint64(56)
                bits |= byte << np.uint64(8 * part)
            graph[i, word] |= bits
            while bits:
                j = WORD * word + trailing_zeros(bits)
                graph[j, i // WORD] |= np.uint64(1) << np.uint64(i % WORD)
                bits &= bits - np.uint64(1)


@compiled
def count_votes(
    starts: Int64,
    queries: Int64,
    source: Float64,
    target: Float32,
    share: float,
    level: bool,
    tolerance: float,
    height_tolerance: float,
    slope: float,
    flag: Int32,
    votes: Int64,
) -> None:
    """Count for each map the segments that agree about one pose, to rank many maps.

    It is in this file, because compiled functions call only compiled functions of their file.

    Args:
        starts: int64 (maps + 1,), index of each map's first candidate.
        queries: query segment of each candidate, int64 (m,), ascending within a map.
        source: centroids of the query segments, float64 (q, 3), meters.
        target: centroids of the candidates, relative to a point in their map, float32 (m, 3).
        share: share of each map's candidates that is compared.
        level: see `keeps_distance`.
        tolerance: see `keeps_distance`.
        height_tolerance: see `keeps_height`.
        slope: see `keeps_height`.
        flag: flag of a `CancelToken`.
        votes: int64 (maps,), filled with 1 plus the most segments that agree with one candidate.
    """
    for place in range(len(votes)):
        if is_cancelled(flag):
            return
        begin, end = starts[place], starts[place + 1]
        # If there are too many candidates, an even share is compared, ordered by segment.
        step = 1.0 / share
        most = int((end - begin) * share)
        best = 0
        for one in range(most):
            i = begin + int(one * step)
            count = 1
            last = -1
            for another in range(most):
                j = begin + int(another * step)
                if queries[j] == queries[i] or queries[j] == last:
                    continue
                a, b = queries[i], queries[j]
                here = (source[a, 0] - source[b, 0]) ** 2 + (source[a, 1] - source[b, 1]) ** 2
                there = (target[i, 0] - target[j, 0]) ** 2 + (target[i, 1] - target[j, 1]) ** 2
                rise = source[a, 2] - source[b, 2]
                other_rise = float(target[i, 2]) - float(target[j, 2])
                if keeps_distance(here, there, rise, other_rise, level, tolerance) and keeps_height(
                    here, rise, other_rise, level, height_tolerance, slope
                ):
                    count += 1
                    last = queries[j]
            best = max(best, count)
        votes[place] = best
