"""Grid cells: find points that may be near each other, at any coordinates."""

import secrets

import numpy as np

from placecell.core.jit import compiled
from placecell.core.types import Float64, Int64, UInt64

SEED: UInt64 = np.array([secrets.randbits(64), secrets.randbits(64) | 1], dtype=np.uint64)
"""Seed of cell numbers, new in each process: nobody can choose points whose numbers collide."""

LAYER_BITS = 20
"""Lowest bits of a cell's number that hold its layer, so that stacked cells are found together."""


def neighboring(points: Float64, radius: float) -> tuple[Int64, Int64]:
    """Assign points to cells such that points within the radius are in neighboring cells.

    The time is that of sorting, for any distribution of points.

    Args:
        points: float64 (n, 3), meters.
        radius: distance, meters.

    Returns:
        The cell of each point, int64 (n,), and for each cell itself and the cells around it,
        int64 (cells, 27), filled up with -1. Hash collisions may add a distant cell, so the caller
        must compare the points.
    """
    # A little larger than the radius, so that rounding never puts a near point two cells away.
    cells = np.nan_to_num(np.floor(points / (radius * (1 + 1e-6))), nan=0.0)
    cells = cells.clip(-(2.0**40), 2.0**40).astype(np.int64)
    keys = np.empty(len(cells), dtype=np.uint64)
    _number(cells, SEED, keys)
    distinct, first, numbers = np.unique(keys, return_index=True, return_inverse=True)
    around = np.full((len(distinct), 27), -1, dtype=np.int64)
    _look_around(cells[first], distinct, SEED, around)
    return numbers.reshape(-1), around


@compiled
def _key(x: int, y: int, z: int, seed: UInt64) -> np.uint64:
    """Return the number of a cell: the finalizer of MurmurHash3 (Appleby), seeded."""
    mixed: np.uint64 = seed[0]
    for coordinate in (x, y):
        mixed = (mixed + np.uint64(coordinate)) * seed[1]
        mixed = (mixed ^ (mixed >> np.uint64(33))) * np.uint64(0xFF51AFD7ED558CCD)
        mixed = (mixed ^ (mixed >> np.uint64(33))) * np.uint64(0xC4CEB9FE1A85EC53)
        mixed ^= mixed >> np.uint64(33)
    layer = np.uint64(z) & np.uint64((1 << LAYER_BITS) - 1)
    return (mixed << np.uint64(LAYER_BITS)) | layer


@compiled
def _number(cells: Int64, seed: UInt64, keys: UInt64) -> None:
    """Fill `keys` with the number of each cell."""
    for row in range(len(cells)):
        keys[row] = _key(cells[row, 0], cells[row, 1], cells[row, 2], seed)


@compiled
def _look_around(cells: Int64, distinct: UInt64, seed: UInt64, around: Int64) -> None:
    """Fill `around` with each cell and its neighbors, the cell itself first."""
    slots = 64
    while slots < 2 * len(distinct):
        slots *= 2
    # Rows of the cells by number: a hash table with linear probing.
    table = np.full(slots, -1, dtype=np.int64)
    for row in range(len(distinct)):
        slot = _slot(distinct[row], slots)
        while table[slot] >= 0:
            slot = (slot + 1) & (slots - 1)
        table[slot] = row
    for row in range(len(cells)):
        around[row, 0] = row
        count = 1
        for column in range(9):
            lowest = _key(
                cells[row, 0] + column // 3 - 1,
                cells[row, 1] + column % 3 - 1,
                cells[row, 2] - 1,
                seed,
            )
            above = lowest & ~np.uint64((1 << LAYER_BITS) - 1)
            for layer in range(3):
                # In a column the numbers are consecutive; the highest layer wraps to the first.
                below = (lowest + np.uint64(layer)) & np.uint64((1 << LAYER_BITS) - 1)
                slot = _slot(above | below, slots)
                while table[slot] >= 0:
                    place = table[slot]
                    if distinct[place] == above | below:
                        if place != row:
                            around[row, count] = place
                            count += 1
                        break
                    slot = (slot + 1) & (slots - 1)


@compiled
def _slot(key: np.uint64, slots: int) -> np.int64:
    """Return the slot of a number in a hash table; `slots` is a power of two."""
    mixed = key ^ (key >> np.uint64(LAYER_BITS))
    mixed *= np.uint64(0x9E3779B97F4A7C15)
    return np.int64((mixed >> np.uint64(20)) & np.uint64(slots - 1))
