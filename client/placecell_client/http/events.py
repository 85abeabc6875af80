"""Server-sent events: the lines of `GET /events`, and when to reconnect."""

import json
from dataclasses import dataclass
from typing import Any

import httpx

from placecell_client.http.errors import ServiceError
from placecell_client.http.response import HttpResponse
from placecell_client.http.retry import RETRIED, Retries

SILENT_SECONDS = 45.0
"""Seconds without a byte after which a stream counts as broken; the service sends some every 15."""

CONNECT_SECONDS = 10.0


@dataclass(frozen=True, slots=True)
class ServerEvent:
    """Event of the service.

    Attributes:
        kind: Kind of event: `fix`, `no-fix`, `robot`, `upload`, `merge`, `write`, `alarm`; or
            `missed` and `dropped` if events were lost, and `stopping`.
        data: Data of the event; `docs/reference/http-api.md` lists the keys of each kind.
        id: Id of the event, to continue after it.
    """

    kind: str
    data: dict[str, Any]
    id: str


class EventLines:
    """Reader of the lines of a stream; it builds the events and remembers the last id."""

    def __init__(self, last_id: str = "") -> None:
        self.last_id = last_id
        self._kind = "message"
        self._data: list[str] = []

    def read(self, line: str) -> ServerEvent | None:
        """Read a line without its end; return the event that it completes.

        Raises:
            ServiceError: The data of an event is not a JSON object.
        """
        if not line:
            return self._completed()
        name, _, value = line.partition(":")
        value = value.removeprefix(" ")
        if name == "event":
            self._kind = value
        elif name == "data":
            self._data.append(value)
        elif name == "id" and "\0" not in value:
            self.last_id = value
        return None

    def _completed(self) -> ServerEvent | None:
        kind, data = self._kind, self._data
        self._kind, self._data = "message", []
        if not data:
            return None
        try:
            content = json.loads("\n".join(data))
        except ValueError:
            content = None
        if not isinstance(content, dict):
            raise ServiceError(
                200,
                "Unreadable event",
                f"The data of the event {kind!r:.40} is not a JSON object.",
                "urn:placecell:problem:unreadable-answer",
            )
        return ServerEvent(kind, content, self.last_id)


@dataclass(slots=True)
class Reconnection:
    """Decision whether to reconnect to a stream, and when.

    Attributes:
        retries: Waits between attempts.
        failures: Number of failures since the last event.
    """

    retries: Retries
    failures: int = 0

    def headers(self, lines: EventLines) -> dict[str, str]:
        """Return the headers of the next request."""
        headers = {"Accept": "text/event-stream", "Cache-Control": "no-store"}
        return headers | ({"Last-Event-ID": lines.last_id} if lines.last_id else {})

    @property
    def timeout(self) -> httpx.Timeout:
        """Time limits of a stream."""
        return httpx.Timeout(CONNECT_SECONDS, read=SILENT_SECONDS)

    def wait_after(self, error: Exception | None, chance: float) -> float:
        """Return the seconds to wait before the next attempt.

        Args:
            error: Error that ended the stream; None if the service ended it.
            chance: Uniform random number from 0 to 1.

        Raises:
            ServiceError: The service refuses the stream for good.
        """
        if isinstance(error, ServiceError) and error.status not in RETRIED:
            raise error
        self.failures += 1
        asked = error.retry_after if isinstance(error, ServiceError) else None
        return self.retries.wait(self.failures, chance, asked)


def refused(response: httpx.Response, content: bytes) -> ServiceError:
    """Return the error of a response that is no stream of events."""
    answer = HttpResponse.of(response, content)
    if answer.ok:
        return ServiceError.unreadable(answer, "The answer is not a stream of events")
    return ServiceError.of(answer)


def is_stream(response: httpx.Response) -> bool:
    """Return whether a response is a stream of events."""
    kind = str(response.headers.get("Content-Type", "")).partition(";")[0].strip()
    return response.status_code == 200 and kind == "text/event-stream"
