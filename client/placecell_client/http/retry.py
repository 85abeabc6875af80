"""Retry policy: when a call is repeated, and the waits between attempts."""

from dataclasses import dataclass

import httpx

from placecell_client.http.errors import ServiceError

TOO_MANY_REQUESTS = 429
RETRIED = frozenset({TOO_MANY_REQUESTS, 502, 503, 504})
"""Temporary statuses: too many requests, a restart, a proxy without a service."""

UNSENT = (httpx.ConnectError, httpx.ConnectTimeout, httpx.PoolTimeout)
"""Transport errors after which the service has received nothing."""


def may_be_done(error: httpx.TransportError | ServiceError) -> bool:
    """Return whether the service may have carried out the failed request.

    After a restart, a deadline or a proxy's error this is unknown. A 503 of a proxy looks like one
    of the service.
    """
    if isinstance(error, ServiceError):
        return error.status != TOO_MANY_REQUESTS
    return not isinstance(error, UNSENT)


@dataclass(frozen=True, slots=True)
class Retries:
    """Retry policy: exponential back-off with full jitter, so that robots do not retry together.

    The wait after attempt i is uniform between 0 and `first_wait * 2 ** (i - 1)`, at most
    `longest_wait`. A `Retry-After` of the service is added, however long it is.

    Attributes:
        attempts: Largest number of attempts, including the first; 1 disables retries.
        first_wait: Upper bound of the first wait, seconds.
        longest_wait: Upper bound of every wait, seconds.
        longest_attempt: Time limit of one attempt, seconds, for links that go silent. None: an
            attempt may take all of the time that is left. `align_maps` and `merge_maps` ignore it,
            because the service computes for minutes.
    """

    attempts: int = 5
    first_wait: float = 0.1
    longest_wait: float = 10.0
    longest_attempt: float | None = None

    def __post_init__(self) -> None:
        if self.attempts < 1:
            raise ValueError(f"Invalid attempts {self.attempts!r}: expected 1 or more.")
        if not all(0 <= wait < float("inf") for wait in (self.first_wait, self.longest_wait)):
            raise ValueError("Invalid first_wait or longest_wait: expected 0 or more seconds.")
        if self.longest_attempt is not None and not self.longest_attempt > 0:
            raise ValueError(
                f"Invalid longest_attempt {self.longest_attempt!r}: expected more than 0 seconds."
            )

    def wait(self, made: int, chance: float, retry_after: float | None = None) -> float:
        """Return the seconds to wait before the next attempt.

        Args:
            made: Number of attempts so far, 1 or more.
            chance: Uniform random number from 0 to 1.
            retry_after: Wait that the service asked for, seconds.
        """
        longest = min(self.longest_wait, self.first_wait * 2.0 ** min(made - 1, 60))
        return chance * longest + (retry_after or 0.0)


USUAL = Retries()
"""Default retry policy."""
