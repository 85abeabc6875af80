"""Pipelined requests: the server's protocol over real sockets."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
import uvicorn
from uvicorn.server import ServerState

from service.server import AHEAD_BYTES, Protocol

REQUEST = b"GET /%d HTTP/1.1\r\nHost: x\r\n\r\n"
PIECE_BYTES = 256 << 10
"""Largest number of bytes that asyncio reads at once."""

SECONDS = 30
"""Time after which a test fails, seconds."""


class App:
    """Application that answers at once, except for one path, where it waits for its release."""

    def __init__(self, held: str) -> None:
        self._held = held
        self.begun = asyncio.Event()
        self.gone = asyncio.Event()
        self.let_go = asyncio.Event()

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        await receive()
        if scope["path"] == self._held:
            self.begun.set()
            listener = asyncio.create_task(self._listen(receive))
            await self.let_go.wait()
            listener.cancel()
        headers = [(b"content-length", b"2")]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": b"ok"})

    async def _listen(self, receive: Any) -> None:
        # Admission control listens in the same way, from before the next request arrives.
        while (await receive())["type"] != "http.disconnect":
            pass
        self.gone.set()
        self.let_go.set()


@asynccontextmanager
async def served(
    app: App,
) -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter, Protocol]]:
    """Serve the application; yield a connection and the server's protocol object."""
    config = uvicorn.Config(app, lifespan="off", log_config=None, access_log=False)
    config.load()
    made: list[Protocol] = []

    def make() -> Protocol:
        made.append(Protocol(config, ServerState(), {}))
        return made[-1]

    server = await asyncio.get_running_loop().create_server(make, "127.0.0.1", 0)
    reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
    try:
        async with asyncio.timeout(SECONDS):
            writer.write(REQUEST % 0)
            if app._held == "/0":
                await app.begun.wait()
            else:
                await answers(reader, 1)
            yield reader, writer, made[0]
    finally:
        app.let_go.set()
        server.close()
        for end in (writer.transport, *(protocol.transport for protocol in made)):
            end.abort()
        await server.wait_closed()


async def answers(reader: asyncio.StreamReader, count: int) -> None:
    for _ in range(count):
        head = await reader.readuntil(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 200")
        assert await reader.readexactly(2) == b"ok"


@pytest.mark.parametrize("reset", [False, True])
def test_disconnect_after_pipelined_requests_is_noticed(reset: bool) -> None:
    async def run() -> None:
        app = App("/0")
        async with served(app) as (_, writer, _):
            writer.write(REQUEST % 1)
            await writer.drain()
            writer.transport.abort() if reset else writer.close()
            await app.gone.wait()

    asyncio.run(run())


def test_disconnect_during_a_pipelined_request_is_noticed() -> None:
    async def run() -> None:
        app = App("/2")
        async with served(app) as (reader, writer, _):
            writer.write(b"".join(REQUEST % n for n in (1, 2, 3, 4)))
            await answers(reader, 1)
            await app.begun.wait()
            writer.write(REQUEST % 5)
            writer.close()
            await app.gone.wait()

    asyncio.run(run())


@pytest.mark.slow
def test_all_pipelined_requests_are_answered() -> None:
    count = 4 * AHEAD_BYTES // len(REQUEST)

    async def run() -> None:
        app = App("/0")
        async with served(app) as (reader, writer, _):
            writer.write(b"".join(REQUEST % n for n in range(1, count)))
            app.let_go.set()
            await answers(reader, count)

    asyncio.run(run())


def test_buffer_of_pipelined_requests_is_bounded() -> None:
    async def run() -> None:
        app = App("/0")
        async with served(app) as (_, writer, protocol):
            writer.write(REQUEST % 1 * 1_000_000)
            while protocol.transport.is_reading():
                await asyncio.sleep(0.01)
            kept, _ = protocol.conn.trailing_data
            assert AHEAD_BYTES <= len(kept) <= AHEAD_BYTES + PIECE_BYTES
            assert not app.gone.is_set()

    asyncio.run(run())
