"""Voting: select correspondences that share yaw and translation with others.

It is a generalized Hough transform (Ballard 1981, *Generalizing the Hough transform to detect
arbitrary shapes*). Its time is linear in the number of correspondences; that of comparing pairs is
quadratic.
"""

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters


def most_voted(found: Correspondences, parameters: LocalizationParameters) -> Correspondences:
    """Return at most `parameters.most` correspondences, those in the fullest cells, in their order.

    For each yaw, a correspondence votes for the translation that moves its query to its place. Its
    value is the weight of its best cell, in which each query counts once.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    if len(found) <= parameters.most:
        return found
    worth = np.zeros(len(found))
    # About the middle of the scan, so that a small yaw error moves the points little.
    source = found.source - np.median(found.source, axis=0)
    steps = int(np.ceil(360 / parameters.vote_yaw))
    token = current()
    for yaw in 2 * np.pi * np.arange(steps) / steps:
        token.check()
        shift = found.target - _turned(source, yaw)
        # Two grids, half a cell apart: a border of one is in the interior of the other.
        for offset in (0.0, 0.5):
            cells = np.floor(shift / parameters.vote_cell + offset).astype(np.int64)
            worth = np.maximum(worth, _filled(found, cells))
    best = np.argsort(-worth, kind="stable")[: parameters.most]
    return found.take(np.sort(best))


def _turned(points: Float64, yaw: float) -> Float64:
    """Return points (n, 3) rotated about z by yaw, radians."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    x, y, z = points.T
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=1)


def _filled(found: Correspondences, cells: "np.ndarray") -> Float64:
    """Return the weight of all queries that vote for each correspondence's cell, float64 (m,)."""
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
