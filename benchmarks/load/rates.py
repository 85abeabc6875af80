"""How many segments a second: works that are measured in turn, again and again."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter
from typing import Any

import numpy as np

from placecell.core.segments import Segments
from placecell.segmentation.pipeline import Progress

Work = Callable[[int], int]
"""Do the piece of work of this number; returns how many segments it had."""


def work_of(parts: Sequence[Segments], do: Callable[[Segments], object]) -> Work:
    """Do this with one part, another each time."""

    def work(number: int) -> int:
        part = parts[number % len(parts)]
        do(part)
        return len(part)

    return work


def measure_rates(
    works: dict[Any, tuple[Work, int]], repeats: int, seconds: float, progress: Progress
) -> dict[Any, float]:
    """Segments a second of each work, by so many threads: the median of the repeats.

    Args:
        works: by any key, each with its threads.
        repeats: of each.
        seconds: of each measurement, at least.
        progress: of the repeats.
    """
    rates: dict[Any, list[float]] = {key: [] for key in works}
    with ThreadPoolExecutor(max(threads for _, threads in works.values())) as pool:
        for work, threads in works.values():
            measure_rate(pool, work, threads, 0)  # the first runs allocate and compile
        for _ in progress(range(repeats), repeats, "measuring"):
            for key, (work, threads) in works.items():
                rates[key].append(measure_rate(pool, work, threads, seconds))
    return {key: round(float(np.median(each)), 1) for key, each in rates.items()}


def measure_rate(pool: ThreadPoolExecutor, work: Work, threads: int, seconds: float) -> float:
    """Segments a second of threads that do the work for so long, and once at least."""

    def one(first: int) -> float:
        start, done, number = perf_counter(), 0, first
        while True:
            done += work(number)
            number += threads
            elapsed = perf_counter() - start
            if elapsed >= seconds:
                # Each by its own clock: none waits for the last batch of another.
                return done / elapsed

    return sum(pool.map(one, range(threads)))
