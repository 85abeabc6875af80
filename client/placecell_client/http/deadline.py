"""Deadlines of calls."""

from collections.abc import Callable, Iterable, Iterator

import httpx

SHORTEST = 0.001
"""Shortest socket timeout, seconds; a socket treats zero as non-blocking."""


class Deadline:
    """Time at which a call must be finished.

    Args:
        seconds: Time from now, seconds.
        clock: Function that returns monotonic seconds.
    """

    def __init__(self, seconds: float, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._end = clock() + seconds

    def remaining(self) -> float:
        """Return the seconds until the deadline; negative after it."""
        return self._end - self._clock()

    def guard(self, parts: Iterable[bytes], late: type[httpx.TimeoutException]) -> Iterator[bytes]:
        """Yield the parts of a body until the deadline.

        httpx limits the time of each socket operation, not their sum, so a slowly sent body never
        times out by itself.

        Raises:
            httpx.TimeoutException: The deadline has passed; the exception has the type `late`.
        """
        for part in parts:
            if self.remaining() <= 0:
                raise late("The call exceeded its timeout before the body was transferred.")
            yield part


class RemainingTime(dict[str, float]):
    """Timeout extension of httpx that gives each socket operation the time that is left *then*.

    httpx's own timeouts are constant, so connecting, sending and reading could each take the whole
    time of the call. httpcore reads the extension with `get` before each operation; tests hold
    this. If a later release copies the dictionary, each operation gets the time that was left at
    the start of the attempt.
    """

    def __init__(self, deadline: Deadline) -> None:
        left = max(SHORTEST, deadline.remaining())
        super().__init__(dict.fromkeys(("connect", "read", "write", "pool"), left))
        self._deadline = deadline

    def get(self, key: str, default: object = None) -> float:  # noqa: ARG002
        return max(SHORTEST, self._deadline.remaining())
