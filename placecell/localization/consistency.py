"""Which correspondences can be right together: the graph of consistent distances.

A rigid motion keeps distances. Leordeanu and Hebert 2005, *A spectral technique for correspondence
problems using pairwise constraints*; as hard edges, Enqvist, Josephson and Kahl 2009, *Optimal
correspondences from pairwise constraints*. Where gravity is known, it keeps more: heights, and
distances as seen from above.
"""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.types import Bool, Float64, Int64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters


def consistent(found: Correspondences, parameters: LocalizationParameters) -> Bool:
    """Whether each two correspondences agree, symmetric, bool (m, m).

    None agrees with itself, nor with another of the same query or of the same place.
    """
    graph = np.zeros((len(found), len(found)), dtype=bool)
    _compare(
        *(found.queries, found.places, found.source, found.target, parameters.model == "yaw"),
        *(parameters.distance_tolerance, parameters.height_tolerance),
        *(float(np.tan(np.radians(parameters.tilt))), graph),
    )
    return graph


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
            if not level:
                here += rise**2
                there += other_rise**2
            # |sqrt(here) - sqrt(there)| <= tolerance, without the roots.
            excess = here + there - tolerance**2
            if excess > 0.0 and excess**2 > 4.0 * here * there:
                continue
            if level and abs(rise - other_rise) > height_tolerance + slope * np.sqrt(here):
                continue
            graph[i, j] = True
            graph[j, i] = True
