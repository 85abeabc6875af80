"""A moment by which something must be done."""

from collections.abc import Callable, Iterable, Iterator

import httpx

SHORTEST = 0.001
"""Seconds; a socket takes zero for `do not wait at all`."""


class Deadline:
    """A moment of a clock.

    Args:
        seconds: from now.
        clock: gives seconds that only grow.
    """

    def __init__(self, seconds: float, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._end = clock() + seconds

    def remaining(self) -> float:
        """Seconds until then; negative after it."""
        return self._end - self._clock()

    def guard(self, parts: Iterable[bytes], late: type[httpx.TimeoutException]) -> Iterator[bytes]:
        """The parts of a body, as long as there is time.

        httpx bounds each step of a socket, not their sum: a body that trickles never times out.

        Raises:
            httpx.TimeoutException: the deadline has passed; of the type `late`.
        """
        for part in parts:
            if self.remaining() <= 0:
                raise late("The call's time was over before its body had passed.")
            yield part


class Timeouts(dict[str, float]):
    """httpx's `timeout` extension, which leaves to each step the seconds that are left *then*.

    A plain one would let connecting, sending and reading take the whole time each. Should httpx
    ever copy it, it becomes the plain one.
    """

    def __init__(self, deadline: Deadline) -> None:
        left = max(SHORTEST, deadline.remaining())
        super().__init__(dict.fromkeys(("connect", "read", "write", "pool"), left))
        self._deadline = deadline

    def get(self, key: str, default: object = None) -> float:  # noqa: ARG002
        return max(SHORTEST, self._deadline.remaining())
