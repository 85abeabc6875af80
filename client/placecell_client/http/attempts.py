"""The attempts of one call: what to send, and whether to send it again. Nothing here sends."""

import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import httpx

from placecell_client.http.deadline import Deadline, Timeouts
from placecell_client.http.errors import ServiceError
from placecell_client.http.requests import Call
from placecell_client.http.response import Answer
from placecell_client.http.retry import RETRIED, Retries, may_be_done
from placecell_client.maps.map_file import MapFileError

T = TypeVar("T")

PART_BYTES = 1 << 16
HOPELESS = (httpx.LocalProtocolError, httpx.UnsupportedProtocol)
"""Transport errors that are the caller's own: a URL without http, say."""
UNREADABLE = (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError)
"""What reading an answer may end in that is none of Placecell's."""


@dataclass(frozen=True, slots=True)
class Policy:
    """How long and how often calls are tried.

    Attributes:
        timeout: seconds, of a whole call.
        retries: when to try again.
        jitter: draws evenly from 0 to 1.
        clock: gives seconds that only grow.
    """

    timeout: float
    retries: Retries
    jitter: Callable[[], float]
    clock: Callable[[], float]

    def __post_init__(self) -> None:
        if not 0 < self.timeout < float("inf"):
            raise ValueError(f"timeout: {self.timeout}, not a number of seconds above 0")

    def lasting(self, timeout: float) -> "Policy":
        """For a call that may take so many seconds, and all of them in one attempt."""
        return replace(self, timeout=timeout, retries=replace(self.retries, longest_attempt=None))


@dataclass(frozen=True, slots=True)
class Attempt:
    """One request, and when its answer must be there."""

    method: str
    path: str
    headers: dict[str, str]
    content: bytes | None
    deadline: Deadline

    @property
    def request(self) -> dict[str, Any]:
        """Arguments of httpx's `stream`, but for the body."""
        return {
            "method": self.method,
            "url": self.path,
            "headers": self.headers,
            "extensions": {"timeout": Timeouts(self.deadline)},
        }

    def parts(self) -> Iterator[bytes] | None:
        """The body in parts, as long as there is time."""
        content = self.content
        if content is None:
            return None
        parts = (content[at : at + PART_BYTES] for at in range(0, len(content), PART_BYTES))
        return self.deadline.guard(parts, httpx.WriteTimeout)


class Attempts(Generic[T]):
    """One call, from its first attempt to its result or its last error."""

    def __init__(self, call: Call[T], policy: Policy) -> None:
        if call.timeout is not None:
            policy = policy.lasting(call.timeout)
        self._call = call
        self._policy = policy
        self._deadline = Deadline(policy.timeout, policy.clock)
        self._request_id = uuid.uuid4().hex
        self._made = 0
        self._may_be_done = False
        self._last: Exception | None = None

    def next(self) -> Attempt:
        """What to send now.

        Raises:
            Exception: the last attempt's, if the wait after it took all the time.
        """
        self._made += 1
        left = self._deadline.remaining()
        if self._last is not None and left <= 0:
            raise self._last
        seconds = min(left, self._policy.retries.longest_attempt or left)
        headers = self._call.headers | {
            "X-Request-Id": self._request_id,
            "Placecell-Timeout": f"{seconds:.3f}",
        }
        if self._call.content is not None:
            headers["Content-Length"] = str(len(self._call.content))
        return Attempt(
            self._call.method,
            self._call.path,
            headers,
            self._call.content,
            Deadline(seconds, self._policy.clock),
        )

    def result(self, answer: Answer) -> T:
        """What the call gives.

        Raises:
            ServiceError: the answer is a refusal, or nothing that can be read.
        """
        # The answer to an earlier DELETE was lost on the way, but not the DELETE.
        gone = answer.status == 404 and self._call.method == "DELETE" and self._may_be_done
        if not answer.ok and not gone:
            raise ServiceError.of(answer)
        try:
            return self._call.read(answer)
        except MapFileError:
            raise
        except UNREADABLE as error:
            missing = isinstance(error, KeyError)
            reason = f"The key {error} is missing" if missing else str(error)
            # Not from the error: it may quote the answer, and that the key.
            raise ServiceError.unreadable(answer, reason) from None

    def wait_after(self, error: httpx.TransportError | ServiceError) -> float | None:
        """Seconds to wait before the next attempt; None if this error is the last."""
        self._last = error
        self._may_be_done |= may_be_done(error)
        if self._may_be_done and not self._call.repeatable:
            return None
        asked = None
        if isinstance(error, ServiceError):
            if error.status not in RETRIED:
                return None
            asked = error.retry_after
        elif isinstance(error, HOPELESS):
            return None
        retries = self._policy.retries
        wait = retries.wait(self._made, self._policy.jitter(), asked)
        if self._made >= retries.attempts or wait >= self._deadline.remaining():
            return None
        return wait
