"""Radix sort of integer keys: several times faster than a comparison sort."""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.types import Int64

DIGIT_BITS = 11
"""Largest number of bits that one pass sorts by: its counts stay in the processor's first cache."""


def stable_order(keys: Int64) -> Int64:
    """Return the order that sorts keys, int64 (n,); equal keys keep their order.

    Args:
        keys: int64 (n,), none negative.
    """
    if len(keys) < 2:
        return np.zeros(len(keys), dtype=np.int64)
    key_bits = int(keys.max()).bit_length()
    row_bits = (len(keys) - 1).bit_length()
    if key_bits + row_bits > 63:
        return np.argsort(keys, kind="stable")
    order: Int64 = _sorted_rows(keys, key_bits, row_bits)
    return order


@compiled
def _sorted_rows(keys: Int64, key_bits: int, row_bits: int) -> Int64:
    """Return the rows of the keys in sorted order. Key and row are sorted as one number."""
    count = len(keys)
    passes = (key_bits + DIGIT_BITS - 1) // DIGIT_BITS
    numbers, other = np.empty(count, np.int64), np.empty(count, np.int64)
    for row in range(count):
        numbers[row] = (keys[row] << row_bits) | row
    if passes:
        digit = (key_bits + passes - 1) // passes
        mask = (1 << digit) - 1
        ends = np.zeros((passes, 1 << digit), np.int64)
        for row in range(count):
            key = keys[row]
            for number in range(passes):
                ends[number, (key >> (number * digit)) & mask] += 1
        for number in range(passes):
            shift = row_bits + number * digit
            total = 0
            for value in range(1 << digit):
                first = total
                total += ends[number, value]
                ends[number, value] = first
            for row in range(count):
                value = (numbers[row] >> shift) & mask
                other[ends[number, value]] = numbers[row]
                ends[number, value] += 1
            numbers, other = other, numbers
    mask = (1 << row_bits) - 1
    for row in range(count):
        numbers[row] &= mask
    return numbers
