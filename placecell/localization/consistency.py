"""Consistency graph: pairs of correspondences that can be right together.

A rigid motion preserves distances. Source: Leordeanu and Hebert 2005, *A spectral technique for
correspondence problems using pairwise constraints*; with hard edges, Enqvist, Josephson and Kahl
2009, *Optimal correspondences from pairwise constraints*. If gravity is known, horizontal distances
and height differences are preserved separately.
"""

import numpy as np

from placecell.core.cancellation import is_cancelled
from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Bool, Float32, Float64, Int32, Int64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters


def consistent(found: Correspondences, parameters: LocalizationParameters) -> Bool:
    """Return the consistency graph of correspondences, symmetric, bool (m, m).

    A correspondence has no edge to itself, to another of the same query, or to another of the same
    place.
    """
    graph = np.zeros((len(found), len(found)), dtype=bool)
    _compare(
        queries=found.queries,
        places=found.places,
        source=found.source,
        target=found.target,
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
def agree(
    here: float,
    there: float,
    rise: float,
    other_rise: float,
    level: bool,
    tolerance: float,
    height_tolerance: float,
    slope: float,
) -> bool:
    """Return whether two correspondences are consistent.

    Args:
        here: squared horizontal distance between the two query segments, square meters.
        there: squared horizontal distance between the two map segments, square meters.
        rise: height difference of the query segments, meters.
        other_rise: height difference of the map segments, meters.
        level: whether gravity is known, so that heights are kept.
        tolerance: largest difference of the distances, meters.
        height_tolerance: largest difference of the height differences, meters.
        slope: increase of the height tolerance per meter of distance.
    """
    squared, other_squared = here, there
    if not level:
        squared += rise**2
        other_squared += other_rise**2
    # |sqrt(squared) - sqrt(other_squared)| <= tolerance, without the roots.
    excess = squared + other_squared - tolerance**2
    if excess > 0.0 and excess**2 > 4.0 * squared * other_squared:
        return False
    return not (level and abs(rise - other_rise) > height_tolerance + slope * np.sqrt(squared))


@compiled
def _compare(
    queries: Int64,
    places: Int64,
    source: Float64,
    target: Float64,
    level: bool,
    tolerance: float,
    height_tolerance: float,
    slope: float,
    graph: Bool,
) -> None:
    for i in range(len(queries)):
        for j in range(i):
            if queries[i] == queries[j] or places[i] == places[j]:
                continue
            here = (source[i, 0] - source[j, 0]) ** 2 + (source[i, 1] - source[j, 1]) ** 2
            there = (target[i, 0] - target[j, 0]) ** 2 + (target[i, 1] - target[j, 1]) ** 2
            rise = source[i, 2] - source[j, 2]
            other_rise = target[i, 2] - target[j, 2]
            if agree(here, there, rise, other_rise, level, tolerance, height_tolerance, slope):
                graph[i, j] = True
                graph[j, i] = True


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
        level: see `agree`.
        tolerance: see `agree`.
        height_tolerance: see `agree`.
        slope: see `agree`.
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
                if agree(here, there, rise, other_rise, level, tolerance, height_tolerance, slope):
                    count += 1
                    last = queries[j]
            best = max(best, count)
        votes[place] = best
