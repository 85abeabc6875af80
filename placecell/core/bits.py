"""Bit sets: rows of bits in 64-bit words, for compiled loops over many members at once.

Member i is bit i % 64 of word i // 64.
"""

from typing import Any

import numba
import numpy as np

from placecell.core.types import Bool, UInt64

WORD = 64
"""Members of a word."""


def words_of(members: int) -> int:
    """Return the number of words that hold this many members."""
    return -(-members // WORD)


def packed(members: Bool) -> UInt64:
    """Return bits, uint64 (..., words), of booleans (..., members)."""
    count = members.shape[-1]
    padded = np.zeros((*members.shape[:-1], words_of(count) * WORD), dtype=bool)
    padded[..., :count] = members
    return np.packbits(padded, axis=-1, bitorder="little").view(np.uint64)


def unpacked(bits: UInt64, members: int) -> Bool:
    """Return booleans (..., members) of bits, uint64 (..., words)."""
    of_bytes = np.ascontiguousarray(bits).view(np.uint8)
    return np.unpackbits(of_bytes, axis=-1, count=members, bitorder="little").view(bool)


def _trailing_zeros(typing_context: Any, word: Any) -> Any:
    """Count the zeros below the lowest bit; compiled to one instruction."""
    del typing_context, word

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        del context, signature
        return builder.cttz(arguments[0], numba.core.cgutils.false_bit)

    return numba.types.int64(numba.types.uint64), code


trailing_zeros: Any = numba.extending.intrinsic(_trailing_zeros)
"""Compiled function: the index of the lowest bit of a word that is not 0."""
