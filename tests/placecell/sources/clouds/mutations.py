"""Damaged copies of files: cut, with flipped bits, and with headers that lie."""

import re
import struct

import numpy as np

LIES = (0, 1, 2, 3, 255, 65_535, 2**31 - 1, 2**31, 2**32 - 1, 10**9, 10**12, 2**63 - 1, 2**64 - 1)
WORDS = (
    b"-1",
    b"nan",
    b"1e308",
    b"-1e308",
    b"",
    b"x",
    b"99999999999999999999999999",
    b"1 1",
    b"0x7",
)
HEAD = 600
"""Bytes in which headers lie."""


def mutate(content: bytes, random: np.random.Generator) -> bytes:
    """Return a copy of a file with one to three kinds of damage."""
    for _ in range(random.integers(1, 4)):
        damage = DAMAGES[random.integers(len(DAMAGES))]
        content = damage(bytearray(content), random)
    return content


def place(content: bytearray, random: np.random.Generator, within: int | None = None) -> int:
    """Return an offset; half of them in the head."""
    end = max(len(content), 1)
    if within is not None or random.random() < 0.5:
        end = min(end, within or HEAD)
    return int(random.integers(end))


def cut(content: bytearray, random: np.random.Generator) -> bytes:
    return bytes(content[: place(content, random)])


def flip(content: bytearray, random: np.random.Generator) -> bytes:
    for _ in range(int(random.integers(1, 9))):
        if content:
            content[place(content, random)] ^= 1 << int(random.integers(8))
    return bytes(content)


def overwrite(content: bytearray, random: np.random.Generator) -> bytes:
    start, size = place(content, random), int(random.integers(1, 65))
    run = (bytes(size), b"\xff" * size, random.bytes(size))[random.integers(3)]
    content[start : start + size] = run
    return bytes(content)


def drop(content: bytearray, random: np.random.Generator) -> bytes:
    start = place(content, random)
    del content[start : start + int(random.integers(1, 65))]
    return bytes(content)


def repeat(content: bytearray, random: np.random.Generator) -> bytes:
    start, size = place(content, random), int(random.integers(1, 257))
    content[start:start] = content[start : start + size]
    return bytes(content)


def append(content: bytearray, random: np.random.Generator) -> bytes:
    return bytes(content) + random.bytes(int(random.integers(1, 100)))


def lie_in_binary(content: bytearray, random: np.random.Generator) -> bytes:
    lie, size = LIES[random.integers(len(LIES))], (1, 2, 4, 8)[random.integers(4)]
    start = place(content, random, HEAD)
    packed = struct.pack("<Q", lie)[:size]
    content[start : start + size] = packed
    return bytes(content)


def lie_in_text(content: bytearray, random: np.random.Generator) -> bytes:
    numbers = list(re.finditer(rb"[-+.\w]+", bytes(content[:HEAD])))
    if not numbers:
        return bytes(content)
    match = numbers[random.integers(len(numbers))]
    lies = [*(str(lie).encode() for lie in LIES), *WORDS]
    content[match.start() : match.end()] = lies[random.integers(len(lies))]
    return bytes(content)


def swap_words(content: bytearray, random: np.random.Generator) -> bytes:
    words = list(re.finditer(rb"\w+", bytes(content[:HEAD])))
    if len(words) < 2:
        return bytes(content)
    first, second = sorted(int(index) for index in random.choice(len(words), 2, replace=False))
    one, other = words[first], words[second]
    content[other.start() : other.end()] = one[0]
    content[one.start() : one.end()] = other[0]
    return bytes(content)


DAMAGES = (
    cut, flip, overwrite, drop, repeat, append, lie_in_binary, lie_in_binary, lie_in_text,
    lie_in_text, swap_words,
)  # fmt: skip
