"""The HTTP client."""

import random
import time
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self, TypeVar

import httpx
from numpy.typing import ArrayLike

from placecell_client.answer import Answer
from placecell_client.attempts import Attempt
from placecell_client.caller import Caller, http_options
from placecell_client.calls import Call
from placecell_client.errors import ServiceError
from placecell_client.map_file import CompactMap
from placecell_client.results import Description, Info, MapSummary, Matches
from placecell_client.retries import USUAL, Retries
from placecell_client.wire import Encoding

T = TypeVar("T")


class Client(Caller):
    """Talks to one Placecell service; a context manager, to be shared by threads.

    Each method raises `ServiceError` when the service refuses or cannot be understood, and
    `httpx.TransportError` when it cannot be reached or does not answer in time. Before that, what
    may pass by itself is tried again; every call is safe to repeat.

    Args:
        base_url: such as `http://127.0.0.1:8000`.
        timeout: seconds for a whole call, all attempts and the waits between them.
        transport: instead of the network, for tests.
        encoding: of points and descriptors on the wire; `json` is larger and slower, and readable.
        key: that the service asks for, sent as `Authorization: Bearer`.
        retries: how often, and after which waits.
        compress: send maps as gzip.
        jitter: draws evenly from 0 to 1, for the waits.
        sleep: waits these seconds.
        clock: gives seconds that only grow.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
        encoding: Encoding = "msgpack",
        *,
        key: str | None = None,
        retries: Retries = USUAL,
        compress: bool = False,
        jitter: Callable[[], float] = random.random,
        sleep: Callable[[float], None] = time.sleep,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(base_url, encoding, compress, timeout, retries, jitter, clock)
        self._sleep = sleep
        self._http = httpx.Client(transport=transport, **http_options(base_url, key))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def info(self) -> Info:
        """What the service is, and how much it takes at once."""
        return self._send(self._calls.info())

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """Descriptors of the segments of one scan.

        Args:
            segments: points of each, (points, 3), metres, all in one z-up frame.
            sensors: where the sensor was at capture, (segments, 3) or (3,) for all, same frame.

        Raises:
            ValueError: the arrays do not fit each other or hold a value that is not finite.
        """
        return self._send(self._calls.describe(segments, sensors))

    def match(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 10,
    ) -> Matches:
        """The k nearest segments of the maps to each query.

        Args:
            description: the queries, as `describe` gave them, or
            segments: the queries' points, with
            sensors: as for `describe`.
            maps: names; all maps of the service's model unless said.
            k: candidates a query, at most.

        Raises:
            ValueError: neither or both kinds of query, or arrays that do not fit.
        """
        return self._send(self._calls.match(description, segments, sensors, maps, k))

    def maps(self) -> tuple[MapSummary, ...]:
        """The stored maps, by name."""
        return self._send(self._calls.maps())

    def put_map(self, name: str, compact_map: CompactMap | bytes) -> MapSummary:
        """Store a map, in place of one of that name; returns when it is safely on disk.

        Raises:
            MapFileError: the map is not valid.
        """
        return self._send(self._calls.put_map(name, compact_map))

    def get_map(self, name: str) -> CompactMap:
        """A stored map.

        Raises:
            MapFileError: the map is of another version than this client reads.
        """
        return self._send(self._calls.get_map(name))

    def get_map_file(self, name: str) -> bytes:
        """A stored map's file, byte by byte as it was put."""
        return self._send(self._calls.get_map_file(name))

    def delete_map(self, name: str) -> None:
        """Remove a map."""
        self._send(self._calls.delete_map(name))

    def _send(self, call: Call[T]) -> T:
        attempts = self._attempts(call)
        while True:
            try:
                return attempts.result(self._exchange(attempts.next()))
            except (httpx.TransportError, ServiceError) as error:
                wait = attempts.wait_after(error)
                if wait is None:
                    raise
            self._sleep(wait)

    def _exchange(self, attempt: Attempt) -> Answer:
        with self._http.stream(**attempt.request, content=attempt.parts()) as response:
            try:
                parts = attempt.deadline.guard(response.iter_bytes(), httpx.ReadTimeout)
                return Answer.of(response, b"".join(parts))
            except httpx.DecodingError as error:
                raise ServiceError.unreadable(Answer.of(response, b""), str(error)) from error
