"""One drive as map and query: alternate blocks of its path."""

import itertools
from collections.abc import Iterable
from statistics import median_low

import numpy as np

from placecell.core.parameters import Parameters
from placecell.datasets import Drive

BLOCK_METERS = 12.0


def alternate_blocks(drive: Drive) -> tuple[list[range], list[range]]:
    """Scans of the blocks that make the map (the odd ones) and of those that ask (the even ones).

    Blocks are min(12 m, half of the path) long along the path; a drive that stands still has none
    to ask from.
    """
    steps = np.linalg.norm(np.diff(drive.poses[:, :3, 3], axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    if along[-1] == 0:
        return [range(len(drive))], []
    length = min(BLOCK_METERS, along[-1] / 2)
    # The last scan of all lies on the end of the last block, not in one of its own.
    number = np.minimum(along // length, np.ceil(along[-1] / length) - 1)
    starts = [*np.flatnonzero(np.diff(number, prepend=-1)).tolist(), len(drive)]
    blocks = [range(start, end) for start, end in itertools.pairwise(starts)]
    return blocks[::2], blocks[1::2]


def parameters_of(blocks: Iterable[range], parameters: Parameters) -> Parameters:
    """One window of accumulation for all blocks, as their usual length allows.

    Not the shortest: a path ends somewhere within its last block, which may hold a single scan.
    """
    return parameters.for_block(median_low(map(len, blocks)))
