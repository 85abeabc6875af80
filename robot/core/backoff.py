"""Back-off: how long the agent leaves the service alone after a failed call."""

import random
from collections.abc import Callable


class Backoff:
    """Waits that double with each failure, with jitter, so that robots do not retry together."""

    def __init__(
        self,
        clock: Callable[[], float],
        first: float = 0.5,
        longest: float = 20.0,
        jitter: Callable[[], float] = random.random,
    ) -> None:
        """Create the back-off.

        Args:
            clock: monotonic clock, seconds.
            first: largest wait after the first failure, seconds.
            longest: largest wait without a request of the service, seconds.
            jitter: uniform random number from 0 to 1.
        """
        self._clock = clock
        self._first = first
        self._longest = longest
        self._jitter = jitter
        self._failures = 0
        self._until = 0.0

    @property
    def is_over(self) -> bool:
        """Whether the next call may be made."""
        return self._failures == 0 or self._clock() >= self._until

    @property
    def remaining(self) -> float:
        """Seconds until the next call may be made."""
        return 0.0 if self.is_over else self._until - self._clock()

    def failed(self, retry_after: float | None = None) -> None:
        """Note a failure.

        Args:
            retry_after: seconds that the service asks to wait; None if it does not.
        """
        longest = min(self._longest, self._first * 2.0 ** min(self._failures, 30))
        self._failures += 1
        wait = longest * (0.5 + 0.5 * self._jitter()) + (retry_after or 0.0)
        self._until = self._clock() + wait

    def succeeded(self) -> None:
        """Note a success."""
        self._failures = 0
