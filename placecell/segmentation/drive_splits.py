"""Drive splits: alternate blocks of one drive's path, as map and as queries."""

import itertools
from collections.abc import Iterable
from statistics import median_low

import numpy as np

from placecell.core.parameters import Parameters
from placecell.datasets import Drive

BLOCK_METERS = 12.0
"""Length of a block, meters, unless half of the path is shorter."""


def alternate_blocks(drive: Drive) -> tuple[list[range], list[range]]:
    """Return the scans of the map's blocks and of the query blocks, in alternation along the path.

    A block is 12 m long, or half of the path if that is shorter. A drive without motion has no
    query block.
    """
    steps = np.linalg.norm(np.diff(drive.poses[:, :3, 3], axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    if along[-1] == 0:
        return [range(len(drive))], []
    length = min(BLOCK_METERS, along[-1] / 2)
    # The last scan is at the end of the last block; it belongs to that block.
    number = np.minimum(along // length, np.ceil(along[-1] / length) - 1)
    starts = [*np.flatnonzero(np.diff(number, prepend=-1)).tolist(), len(drive)]
    blocks = [range(start, end) for start, end in itertools.pairwise(starts)]
    return blocks[::2], blocks[1::2]


def parameters_of(blocks: Iterable[range], parameters: Parameters) -> Parameters:
    """Return the parameters for all blocks, with an accumulation that fits their median length.

    The shortest block does not count: the last block is incomplete and may have a single scan.
    """
    return parameters.for_block(median_low(map(len, blocks)))
