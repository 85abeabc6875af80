"""Duplicates inside a group, by Hamming distance of the voxel grids (paper III-A)."""

import numpy as np

from placecell.core.types import Bool, Int64, UInt8


def keep_distinct(packed: UInt8, groups: Int64, th_H: int) -> Bool:
    """Which segments stay: bool (segments,).

    Greedily in the order given (time), a segment is dropped when its grid differs in fewer than
    `th_H` voxels from one of its group that stays.

    Args:
        packed: uint8 (segments, bytes), occupancy grids as bits (`numpy.packbits`), in time order.
        groups: int64 (segments,).
    """
    kept = np.zeros(len(groups), dtype=bool)
    order = np.argsort(groups, kind="stable")
    for members in np.split(order, np.flatnonzero(np.diff(groups[order])) + 1):
        stay: list[int] = []
        for member in members:
            differing = np.bitwise_count(packed[stay] ^ packed[member]).sum(axis=1)
            if (differing >= th_H).all():
                stay.append(int(member))
        kept[stay] = True
    return kept
