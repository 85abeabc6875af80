"""Rates in segments per second, measured in turn so that a busy machine slows all alike."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter
from typing import Any

import numpy as np

from placecell.core.segments import Segments
from placecell.segmentation.pipeline import Progress

Work = Callable[[int], int]
"""Do the numbered piece of work and return its number of segments."""


def work_of(parts: Sequence[Segments], do: Callable[[Segments], object]) -> Work:
    """Return the work that calls `do` with the parts in turn."""

    def work(number: int) -> int:
        part = parts[number % len(parts)]
        do(part)
        return len(part)

    return work


def measure_rates(
    works: dict[Any, tuple[Work, int]], repeats: int, seconds: float, progress: Progress
) -> dict[Any, float]:
    """Return the rate of each work in segments per second: the median of the repeats.

    Args:
        works: each work and its number of threads, by a key.
        repeats: measurements per work.
        seconds: least duration of a measurement.
        progress: wraps the loop of the repeats.
    """
    rates: dict[Any, list[float]] = {key: [] for key in works}
    with ThreadPoolExecutor(max(threads for _, threads in works.values())) as pool:
        for work, threads in works.values():
            measure_rate(pool, work, threads, 0)  # the first run allocates and compiles
        for _ in progress(range(repeats), repeats, "measuring"):
            for key, (work, threads) in works.items():
                rates[key].append(measure_rate(pool, work, threads, seconds))
    return {key: round(float(np.median(each)), 1) for key, each in rates.items()}


def measure_rate(pool: ThreadPoolExecutor, work: Work, threads: int, seconds: float) -> float:
    """Return the segments per second of `threads` threads that work for `seconds`.

    Each thread works at least once.
    """

    def one(first: int) -> float:
        start, done, number = perf_counter(), 0, first
        while True:
            done += work(number)
            number += threads
            elapsed = perf_counter() - start
            if elapsed >= seconds:
                # Each thread uses its own clock, so no thread waits for another's last batch.
                return done / elapsed

    return sum(pool.map(one, range(threads)))
