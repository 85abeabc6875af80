"""Voting: select correspondences that share yaw and translation with others.

It is a generalized Hough transform (Ballard 1981, *Generalizing the Hough transform to detect
arbitrary shapes*). Its time is linear in the number of correspondences; that of comparing pairs is
quadratic.
"""

import numpy as np

from placecell.core.cancellation import current, is_cancelled
from placecell.core.grid_cells import SEED
from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Float64, Int32, Int64, UInt64
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters


def most_voted(found: Correspondences, parameters: LocalizationParameters) -> Correspondences:
    """Return at most `parameters.most` correspondences, those in the fullest cells, in their order.

    For each yaw, a correspondence votes for the translation that moves its query to its place. Its
    value is the weight of its best cell, in which each query counts once, by its heaviest vote.

    Args:
        found: correspondences; those of a query stand together, the heaviest first.
        parameters: limit and cell sizes.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    if len(found) <= parameters.most:
        return found
    worth = np.zeros(len(found))
    token = current()
    _vote(
        queries=found.queries,
        # About the middle of the scan, so that a small yaw error moves the points little.
        source=found.source - np.median(found.source, axis=0),
        target=found.target - np.median(found.target, axis=0),
        weights=found.weights,
        yaws=2 * np.pi * np.arange(0, 360, parameters.vote_yaw) / 360,
        edge=parameters.vote_cell,
        seed=SEED,
        flag=token.flag,
        worth=worth,
    )
    token.check()
    best = np.argsort(-worth, kind="stable")[: parameters.most]
    return found.take(np.sort(best))


@compiled
def _vote(
    queries: Int64,
    source: Float64,
    target: Float64,
    weights: Float64,
    yaws: Float64,
    edge: float,
    seed: UInt64,
    flag: Int32,
    worth: Float64,
) -> None:
    """Raise `worth` to the weight of all queries that vote for each correspondence's best cell.

    The cells of one yaw are in a hash table with linear probing. A table entry is of the present
    round if its stamp is.
    """
    slots = 64
    while slots < 2 * len(queries):
        slots *= 2
    stamps = np.zeros(slots, dtype=np.int64)
    cells = np.empty((slots, 3), dtype=np.int64)
    last = np.empty(slots, dtype=np.int64)
    sums = np.empty(slots)
    slot_of = np.empty(len(queries), dtype=np.int64)
    stamp = 0
    for yaw in yaws:
        cos, sin = np.cos(yaw), np.sin(yaw)
        # Two grids, half a cell apart: a border of one is in the interior of the other.
        for offset in (0.0, 0.5):
            if is_cancelled(flag):
                return
            stamp += 1
            for one in range(len(queries)):
                x = target[one, 0] - cos * source[one, 0] + sin * source[one, 1]
                y = target[one, 1] - sin * source[one, 0] - cos * source[one, 1]
                i = np.int64(np.floor(x / edge + offset))
                j = np.int64(np.floor(y / edge + offset))
                k = np.int64(np.floor((target[one, 2] - source[one, 2]) / edge + offset))
                slot = _slot(i, j, k, seed, slots)
                while stamps[slot] == stamp and not (
                    cells[slot, 0] == i and cells[slot, 1] == j and cells[slot, 2] == k
                ):
                    slot = (slot + 1) & (slots - 1)
                if stamps[slot] != stamp:
                    stamps[slot] = stamp
                    cells[slot, 0], cells[slot, 1], cells[slot, 2] = i, j, k
                    last[slot] = -1
                    sums[slot] = 0.0
                if last[slot] != queries[one]:
                    last[slot] = queries[one]
                    sums[slot] += weights[one]
                slot_of[one] = slot
            for one in range(len(queries)):
                worth[one] = max(worth[one], sums[slot_of[one]])


@compiled_part
def _slot(i: np.int64, j: np.int64, k: np.int64, seed: UInt64, slots: int) -> np.int64:
    """Return the slot of a cell; with the seed, nobody can choose cells that share a slot."""
    mixed = seed[0]
    for number in (i, j, k):
        mixed = (mixed ^ np.uint64(number)) * seed[1]
        mixed ^= mixed >> np.uint64(29)
    return np.int64((mixed >> np.uint64(7)) & np.uint64(slots - 1))
