"""How often, and after which waits, a call is repeated."""

from dataclasses import dataclass

import httpx

from placecell_client.http.errors import ServiceError

TOO_MANY_REQUESTS = 429
RETRIED = frozenset({TOO_MANY_REQUESTS, 502, 503, 504})
"""Statuses that pass by themselves: too many requests, a restart, a proxy that finds nobody."""

UNSENT = (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout)
"""Transport errors after which nothing has come to the service."""


def may_be_done(error: httpx.TransportError | ServiceError) -> bool:
    """Whether what an attempt asked for may have been done, for all that its error says.

    Of what a restart, a deadline or a proxy ends nobody knows; a proxy's 503 is not told from the
    service's.
    """
    if isinstance(error, ServiceError):
        return error.status != TOO_MANY_REQUESTS
    return not isinstance(error, UNSENT)


@dataclass(frozen=True, slots=True)
class Retries:
    """Exponential back-off with full jitter: robots that failed together do not return together.

    The wait after attempt i is drawn evenly from 0 to `first_wait * 2 ** (i - 1)`, at most to
    `longest_wait`. Where the service says `Retry-After`, that comes on top, however long.

    Attributes:
        attempts: at most, the first included; 1 repeats nothing.
        first_wait: seconds.
        longest_wait: seconds.
        longest_attempt: seconds after which an attempt is given up and made again; unless said,
            each has all that is left of the call's timeout. For links that go silent. Not of
            `align_maps` and `merge_maps`, which are silent for minutes.
    """

    attempts: int = 5
    first_wait: float = 0.1
    longest_wait: float = 10.0
    longest_attempt: float | None = None

    def __post_init__(self) -> None:
        if self.attempts < 1:
            raise ValueError(f"attempts: {self.attempts}, not 1 or more")
        if not all(0 <= wait < float("inf") for wait in (self.first_wait, self.longest_wait)):
            raise ValueError("first_wait, longest_wait: not 0 or more seconds")
        if self.longest_attempt is not None and not self.longest_attempt > 0:
            raise ValueError("longest_attempt: not more than 0 seconds")

    def wait(self, made: int, chance: float, retry_after: float | None = None) -> float:
        """Seconds to wait.

        Args:
            made: attempts so far, 1 or more.
            chance: evenly drawn from 0 to 1.
            retry_after: what the service asked for, seconds.
        """
        longest = min(self.longest_wait, self.first_wait * 2.0 ** min(made - 1, 60))
        return chance * longest + (retry_after or 0.0)


USUAL = Retries()
