"""Voting: which correspondences share a turn and a shift with others (generalized Hough transform).

Ballard 1981, *Generalizing the Hough transform to detect arbitrary shapes*. Linear in the number of
correspondences, where comparing them in pairs is not.
"""

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters


def most_voted(found: Correspondences, parameters: LocalizationParameters) -> Correspondences:
    """The correspondences in the fullest cells, `parameters.most` at most, in their old order.

    For each turn, a correspondence votes for the one shift that takes its query to its place. It is
    worth what its best cell is worth, in which each query counts once.
    """
    if len(found) <= parameters.most:
        return found
    worth = np.zeros(len(found))
    # About the middle of the scan, so that a turn a little off shifts nothing by much.
    source = found.source - np.median(found.source, axis=0)
    steps = int(np.ceil(360 / parameters.vote_yaw))
    token = current()
    for yaw in 2 * np.pi * np.arange(steps) / steps:
        token.check()
        shift = found.target - _turned(source, yaw)
        # Two grids, half a cell apart: what lies at a border of one is inside of the other.
        for offset in (0.0, 0.5):
            cells = np.floor(shift / parameters.vote_cell + offset).astype(np.int64)
            worth = np.maximum(worth, _filled(found, cells))
    best = np.argsort(-worth, kind="stable")[: parameters.most]
    return found.take(np.sort(best))


def _turned(points: Float64, yaw: float) -> Float64:
    """Points (n, 3) turned about z."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    x, y, z = points.T
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=1)


def _filled(found: Correspondences, cells: "np.ndarray") -> Float64:
    """Of each correspondence the weight of all queries that vote for its cell."""
    cells = cells - cells.min(axis=0)
    size = cells.max(axis=0) + 1
    keys = (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]
    # A query that votes for a cell more than once counts by its heaviest vote.
    order = np.lexsort((-found.weights, found.queries, keys))
    same = (np.diff(keys[order], prepend=-1) == 0) & (
        np.diff(found.queries[order], prepend=-1) == 0
    )
    weights = np.where(same, 0.0, found.weights[order])
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    sums = np.add.reduceat(weights, starts)
    filled = np.empty(len(keys))
    filled[order] = np.repeat(sums, np.diff(starts, append=len(keys)))
    return filled
