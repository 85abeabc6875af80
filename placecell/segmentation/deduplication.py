"""Deduplication within a group, by Hamming distance of the voxel grids (paper III-A)."""

import numpy as np

from placecell.core.types import Bool, Int64, UInt8


def keep_distinct(packed: UInt8, groups: Int64, th_H: int) -> Bool:
    """Return whether each segment is kept, bool (segments,).

    In the given order, a segment is dropped if its grid differs in fewer than `th_H` voxels from a
    kept segment of its group.

    Args:
        packed: uint8 (segments, bytes), occupancy grids as bits (`numpy.packbits`), in time order.
        groups: int64 (segments,), group of each segment.
        th_H: number of differing voxels from which a segment is distinct.
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
