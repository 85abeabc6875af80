"""The HTTP client for asyncio."""

import asyncio
import random
import time
from collections.abc import Awaitable, Callable, Sequence
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


class AsyncClient(Caller):
    """`Client` for asyncio: the same arguments, methods, results and errors.

    An asynchronous context manager, to be shared by the tasks of one event loop. Arrays and maps
    are packed and read on the loop's thread. Who cannot have it held up by a large map runs
    `encode` in another thread and puts the bytes, or gets the file and runs `decode` there.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.AsyncBaseTransport | None = None,
        encoding: Encoding = "msgpack",
        *,
        key: str | None = None,
        retries: Retries = USUAL,
        compress: bool = False,
        jitter: Callable[[], float] = random.random,
        sleep: Callable[[float], Awaitable[None]] = asyncio.sleep,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(base_url, encoding, compress, timeout, retries, jitter, clock)
        self._sleep = sleep
        self._http = httpx.AsyncClient(transport=transport, **http_options(base_url, key))

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def info(self) -> Info:
        """`Client.info`."""
        return await self._send(self._calls.info())

    async def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """`Client.describe`."""
        return await self._send(self._calls.describe(segments, sensors))

    async def match(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 10,
    ) -> Matches:
        """`Client.match`."""
        return await self._send(self._calls.match(description, segments, sensors, maps, k))

    async def maps(self) -> tuple[MapSummary, ...]:
        """`Client.maps`."""
        return await self._send(self._calls.maps())

    async def put_map(self, name: str, compact_map: CompactMap | bytes) -> MapSummary:
        """`Client.put_map`."""
        return await self._send(self._calls.put_map(name, compact_map))

    async def get_map(self, name: str) -> CompactMap:
        """`Client.get_map`."""
        return await self._send(self._calls.get_map(name))

    async def get_map_file(self, name: str) -> bytes:
        """`Client.get_map_file`."""
        return await self._send(self._calls.get_map_file(name))

    async def delete_map(self, name: str) -> None:
        """`Client.delete_map`."""
        await self._send(self._calls.delete_map(name))

    async def _send(self, call: Call[T]) -> T:
        attempts = self._attempts(call)
        while True:
            try:
                return attempts.result(await self._exchange(attempts.next()))
            except (httpx.TransportError, ServiceError) as error:
                wait = attempts.wait_after(error)
                if wait is None:
                    raise
            await self._sleep(wait)

    async def _exchange(self, attempt: Attempt) -> Answer:
        try:
            async with asyncio.timeout(attempt.deadline.remaining()):
                return await self._receive(attempt)
        except TimeoutError as error:
            raise httpx.ReadTimeout("The call's time was over.") from error

    async def _receive(self, attempt: Attempt) -> Answer:
        async with self._http.stream(**attempt.request, content=attempt.content) as response:
            try:
                parts = [part async for part in response.aiter_bytes()]
                return Answer.of(response, b"".join(parts))
            except httpx.DecodingError as error:
                raise ServiceError.unreadable(Answer.of(response, b""), str(error)) from error
