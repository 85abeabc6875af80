"""Attempts of one call: the next request, and whether to repeat it; no input or output."""

import importlib
import sys
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import httpx

from placecell_client.http.deadline import Deadline, RemainingTime
from placecell_client.http.errors import ServiceError
from placecell_client.http.requests import Call
from placecell_client.http.response import HttpResponse
from placecell_client.http.retry import RETRIED, Retries, may_be_done
from placecell_client.maps.map_file import MapFileError
from placecell_client.seen import SeenVersions

T = TypeVar("T")

PART_BYTES = 1 << 16
"""Size of the parts in which a body is sent, bytes."""
HOPELESS = (httpx.LocalProtocolError, httpx.UnsupportedProtocol)
"""Transport errors that the caller causes, such as a URL without http; never repeated."""
UNREADABLE = (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError)
"""Errors while reading an answer that a Placecell service did not make."""


@dataclass(frozen=True, slots=True)
class Policy:
    """Time limit and repetition of calls.

    Attributes:
        timeout: Time limit of a whole call, seconds.
        retries: Number of attempts and waits between them.
        jitter: Function that returns a uniform random number from 0 to 1.
        clock: Function that returns monotonic seconds.
    """

    timeout: float
    retries: Retries
    jitter: Callable[[], float]
    clock: Callable[[], float]

    def __post_init__(self) -> None:
        if not 0 < self.timeout < float("inf"):
            raise ValueError(
                f"Invalid timeout {self.timeout!r}: expected a positive number of seconds."
            )

    def lasting(self, timeout: float) -> "Policy":
        """Return a policy with another timeout, where one attempt may take all of the time."""
        return replace(self, timeout=timeout, retries=replace(self.retries, longest_attempt=None))


@dataclass(frozen=True, slots=True)
class Attempt:
    """One request and the deadline of its answer."""

    method: str
    path: str
    headers: dict[str, str]
    content: bytes | None
    deadline: Deadline

    @property
    def request(self) -> dict[str, Any]:
        """Arguments of httpx's `stream`, without the body."""
        return {
            "method": self.method,
            "url": self.path,
            "headers": self.headers,
            "extensions": {"timeout": RemainingTime(self.deadline)},
        }

    def parts(self) -> Iterator[bytes] | None:
        """Yield the body in parts until the deadline."""
        content = self.content
        if content is None:
            return None
        parts = (content[at : at + PART_BYTES] for at in range(0, len(content), PART_BYTES))
        return self.deadline.guard(parts, httpx.WriteTimeout)


class Attempts(Generic[T]):
    """One call, from its first attempt to its result or last error.

    Attributes:
        request_id: Id of the call, sent as `X-Request-Id` in every attempt.
    """

    def __init__(self, call: Call[T], policy: Policy, seen: SeenVersions) -> None:
        if call.timeout is not None:
            policy = policy.lasting(call.timeout)
        self._call = call
        self._policy = policy
        self._seen = seen
        self._deadline = Deadline(policy.timeout, policy.clock)
        self.request_id = uuid.uuid4().hex
        self._trace = trace_headers()
        self._made = 0
        self._may_be_done = False
        self._last: Exception | None = None

    def next(self) -> Attempt:
        """Return the next request to send.

        Raises:
            Exception: The error of the last attempt, if the wait used up the time.
        """
        self._made += 1
        left = self._deadline.remaining()
        if self._last is not None and left <= 0:
            raise self._last
        seconds = min(left, self._policy.retries.longest_attempt or left)
        headers = self._call.headers | self._trace | self._seen.headers()
        headers |= {
            "X-Request-Id": self.request_id,
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

    def result(self, answer: HttpResponse) -> T:
        """Return the result of the call.

        Raises:
            ServiceError: The service refused the request, or its answer is unreadable.
        """
        # 404 to a repeated DELETE means that the first one succeeded and its answer was lost.
        gone = answer.status == 404 and self._call.method == "DELETE" and self._may_be_done
        if not answer.ok and not gone:
            raise ServiceError.of(answer)
        self._seen.note(self._call.method, self._call.path, answer.headers)
        try:
            return self._call.read(answer)
        except MapFileError:
            raise
        except UNREADABLE as error:
            missing = isinstance(error, KeyError)
            reason = f"The key {error} is missing" if missing else str(error)
            # Drop the cause: it may quote the answer, which may hold the API key.
            raise ServiceError.unreadable(answer, reason) from None

    def wait_after(self, error: httpx.TransportError | ServiceError) -> float | None:
        """Return the seconds to wait before the next attempt; None to give up with this error."""
        self._last = error
        self._may_be_done |= may_be_done(error)
        if self._may_be_done and not self._call.repeatable:
            return None
        asked = None
        if isinstance(error, ServiceError):
            if self._call.older is not None and refuses_a_field(error):
                self._call = self._call.older()
                return 0.0
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


def trace_headers() -> dict[str, str]:
    """Return `traceparent` of the present span, if the program uses OpenTelemetry."""
    carrier: dict[str, str] = {}
    if "opentelemetry.trace" in sys.modules:
        importlib.import_module("opentelemetry.propagate").inject(carrier)
    return carrier


def refuses_a_field(error: ServiceError) -> bool:
    """Return whether the service does not know a field of the request."""
    return error.status == 422 and "Extra inputs are not permitted" in error.detail
