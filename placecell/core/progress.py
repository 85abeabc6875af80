"""Progress of loops, shown by the caller."""

from collections.abc import Callable, Iterable

Progress = Callable[[Iterable[int], int, str], Iterable[int]]
"""Function that shows the progress of a loop: (items, number of items, title) -> the items."""


def silent(items: Iterable[int], total: int, what: str) -> Iterable[int]:  # noqa: ARG001
    """Return the items and show no progress."""
    return items
