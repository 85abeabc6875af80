"""Threads of large searches: several maps at once, one thread per core for all requests together.

FAISS and NumPy release Python's lock, so the threads compute at once. Results come in the order of
the items, whatever order they were computed in.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from placecell.core.cancellation import cancelled_by, current
from placecell.core.processors import available_cores

CORES = available_cores()

AHEAD = CORES + 1
"""Number of results that are computed before they are taken; each holds memory."""

PARALLEL = 1 << 22
"""Number of compared pairs of query and segment from which a search takes all cores: some 5 ms."""

_threads = ThreadPoolExecutor(CORES, thread_name_prefix="search")
"""Threads of all large searches; their work must not wait for this pool."""

Item = TypeVar("Item")
Result = TypeVar("Result")


def is_large(pairs: int) -> bool:
    """Return whether a search of so many pairs of query and segment takes all cores.

    A smaller one would wait longer for the threads than it gains.
    """
    return pairs >= PARALLEL


def in_threads(work: Callable[[Item], Result], items: Iterable[Item]) -> Iterator[Result]:
    """Yield the results of some work, in the order of the items, computed by all cores.

    The work finds the cancellation token of the caller. If an item fails, those after it that have
    not begun are left out.

    Args:
        work: the work; it must not call this function.
        items: what it is done with.
    """
    token = current()

    def cancellable(item: Item) -> Result:
        with cancelled_by(token):
            token.check()
            return work(item)

    waiting: deque[Future[Result]] = deque()
    try:
        for item in items:
            waiting.append(_threads.submit(cancellable, item))
            if len(waiting) > AHEAD:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        for each in waiting:
            each.cancel()
