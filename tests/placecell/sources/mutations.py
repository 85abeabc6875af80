"""Mutated files: seeded damage of all kinds, and the check that a reader survives it.

`PLACECELL_MUTATIONS` is the number of mutations of each format; 200 by default.
"""

import os
import resource
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import numpy as np

from placecell.sources.errors import DriveError

COUNT = int(os.environ.get("PLACECELL_MUTATIONS", "200"))
SECONDS = 20
"""Longest time that a reader may take with one small file."""
MEMORY = 64 << 20
"""Largest memory that a reader may take with one small file, bytes."""
LIES = {
    1: (0, 1, 0x7F, 0x80, 0xFF),
    2: (0, 1, 0x7FFF, 0xFFFF),
    4: (0, 1, 2, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0xFFFFFFF0, 10**9),
    8: (0, 1, 2**31, 2**32, 2**62, 2**63 - 1, 2**63, 2**64 - 1),
}
"""Integers that headers must not be believed, by bytes."""


class Hang(BaseException):
    """Reader that takes too long; no `except Exception` hides it."""


def mutated(content: bytes, seed: int) -> bytes:
    """Return a file with damage: cut, flipped, lied about, moved, repeated or zeroed."""
    random = np.random.default_rng(seed)
    data = bytearray(content)

    def place(room: int = 1) -> int:
        """Choose a place: anywhere, or at the begin or the end, where headers and indexes are."""
        last = max(len(data) - room, 0)
        where = random.integers(4)
        if where == 0:
            return int(min(random.exponential(100), last))
        if where == 1:
            return max(last - int(random.exponential(300)), 0)
        return int(random.integers(last + 1))

    for _ in range(random.integers(1, 4)):
        kind = random.integers(7)
        if not data:
            break
        at = place()
        if kind == 0:
            del data[at:]
        elif kind in (1, 2):
            for _ in range(random.integers(1, 9)):
                data[place()] ^= 1 << int(random.integers(8))
        elif kind in (3, 4):
            size = int(random.choice(list(LIES)))
            value = int(random.choice(len(LIES[size])))
            at = place(size)
            data[at : at + size] = LIES[size][value].to_bytes(size, "little")
        elif kind == 5:
            length = int(random.exponential(40))
            some = bytes(data[place() :][:length])
            data[at : at + (length if random.integers(2) else 0)] = some
        else:
            length = int(random.exponential(60))
            data[at : at + length] = bytes(len(data[at : at + length]))
    return bytes(data)


@contextmanager
def bounded(memory: int = MEMORY) -> Iterator[None]:
    """Check that the block takes neither too long nor too much memory.

    A larger allocation raises a `MemoryError`, even if nobody writes to the memory.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        raise Hang

    before = signal.signal(signal.SIGALRM, stop)
    limits = resource.getrlimit(resource.RLIMIT_AS)
    held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    signal.setitimer(signal.ITIMER_REAL, SECONDS)
    resource.setrlimit(resource.RLIMIT_AS, (held + memory, limits[1]))
    start = time.perf_counter()
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.perf_counter() - start < SECONDS


def check_reader(content: bytes, read: Callable[[bytes], object], name: str) -> int:
    """Read mutations of a file; return how many gave a result, not an error.

    Any exception but a `DriveError` with a message fails the test.
    """
    results = 0
    for seed in range(COUNT):
        damaged = mutated(content, seed)
        try:
            with bounded(MEMORY + 20 * len(damaged)):
                read(damaged)
            results += 1
        except DriveError as error:
            if len(str(error)) < 20:
                raise AssertionError(f"{name}, seed {seed}: {error!r}") from error
        except (Exception, Hang) as error:
            raise AssertionError(f"{name}, seed {seed}: {error!r}") from error
    return results
