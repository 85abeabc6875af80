"""Connections: slow readers, silent clients, and health checks when all connections are in use."""

import asyncio
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest
import uvicorn
from uvicorn.server import ServerState

from service import server
from service.api.admission.streaming import Answers
from service.server import Protocol

pytestmark = pytest.mark.slow  # by their sum

Served = tuple[str, int]
SECONDS = 60
CLIENTS: list[asyncio.StreamWriter] = []
"""Open connections of a test, which are closed at its end."""


@asynccontextmanager
async def listening(app: Any, **facts: Any) -> AsyncIterator[Served]:
    """Serve an application with the server's protocol and these limits."""
    kind = type("Limited", (Protocol,), facts)
    config = uvicorn.Config(app, lifespan="off", log_config=None, access_log=False)
    config.load()
    shared = ServerState()
    loop = asyncio.get_running_loop()
    made = await loop.create_server(lambda: kind(config, shared, {}), "127.0.0.1", 0)
    try:
        async with asyncio.timeout(SECONDS):
            yield made.sockets[0].getsockname()
    finally:
        made.close()
        for each in list(shared.connections):
            assert isinstance(each, Protocol)
            each.transport.abort()
        for client in CLIENTS:
            client.transport.abort()
        CLIENTS.clear()
        await made.wait_closed()
        await asyncio.sleep(0.01)


async def connected(address: Served, receive_bytes: int | None = None) -> Any:
    """Open a client's connection with a receive buffer of a given size."""
    sock = socket.socket()
    if receive_bytes is not None:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
    sock.setblocking(False)
    await asyncio.get_running_loop().sock_connect(sock, address)
    reader, writer = await asyncio.open_connection(sock=sock, limit=1 << 16)
    CLIENTS.append(writer)
    return reader, writer


def whole(content: bytes) -> Callable[..., Any]:
    """Return an application that sends its answer in one piece."""

    async def app(scope: Any, receive: Any, send: Any) -> None:
        size = str(len(content)).encode()
        headers = [(b"content-length", size)]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        await send({"type": "http.response.body", "body": content})

    return app


GET = b"GET /a HTTP/1.1\r\nHost: x\r\n\r\n"


async def read_slowly(reader: asyncio.StreamReader, size: int, pieces: int) -> bytes:
    """Read a head and a number of bytes, with a pause after each piece."""
    await reader.readuntil(b"\r\n\r\n")
    found = b""
    for _ in range(pieces):
        found += await reader.readexactly(size // pieces)
        await asyncio.sleep(0.02)
    return found + await reader.readexactly(size - len(found))


def test_A3_slow_reader_gets_the_whole_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """The idle time of a connection begins after the last answer is sent."""
    monkeypatch.setattr(server, "HEAD_SECONDS", 0.05)
    content = bytes(range(256)) * (48 << 10)  # 12 MiB: more than the buffers of sockets

    async def main() -> None:
        async with listening(whole(content), stall_seconds=5.0) as address:
            reader, writer = await connected(address, 64 << 10)
            writer.write(GET)
            assert await read_slowly(reader, len(content), 40) == content
            # The client has the whole answer and must send its next request in time.
            assert await reader.read() == b""

    asyncio.run(main())


@pytest.mark.parametrize("close", [b"", b"Connection: close\r\n"])
def test_A3_reader_that_reads_nothing_is_dropped(close: bytes) -> None:
    content = bytes(12 << 20)

    async def main() -> None:
        async with listening(whole(content), stall_seconds=0.4) as address:
            reader, writer = await connected(address, 64 << 10)
            writer.transport.pause_reading()
            writer.write(b"GET /a HTTP/1.1\r\nHost: x\r\n" + close + b"\r\n")
            made = await first_connection()
            await made.lost.wait()
            writer.transport.resume_reading()
            try:
                taken = len(await reader.read())
            except ConnectionResetError:
                taken = 0
            assert taken < len(content)

    seen: list[Any] = []

    async def first_connection() -> Any:
        while not seen:
            await asyncio.sleep(0.01)
        return seen[0]

    made_by = Protocol.connection_made
    lost_by = Protocol.connection_lost

    def made(self: Any, transport: Any) -> None:
        self.lost = asyncio.Event()
        seen.append(self)
        made_by(self, transport)

    def lost(self: Any, error: Any) -> None:
        self.lost.set()
        lost_by(self, error)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Protocol, "connection_made", made)
        patch.setattr(Protocol, "connection_lost", lost)
        asyncio.run(main())


def test_A7_slow_readers_of_one_file_hold_it_once(tmp_path: Any) -> None:
    """40 slow readers of 13.5 MB share one file on disk and need little memory each."""
    import tracemalloc

    content = bytes(13_500_000)
    made: list[int] = []

    def make() -> bytes:
        made.append(1)
        return content

    async def run(work: Callable[[], bytes]) -> bytes:
        await asyncio.sleep(0)
        return work()

    async def main() -> None:
        answers = Answers(tmp_path, 1 << 30, 60.0)
        stuck, go_on = [], asyncio.Event()

        async def app(scope: Any, receive: Any, send: Any) -> None:
            response = await answers.respond_shared("one", make, run, "ann", "a/b")

            async def slow(message: Any) -> None:
                if message.get("body"):
                    stuck.append(len(message["body"]))
                    await go_on.wait()

            async def forever() -> Any:
                await asyncio.sleep(60)

            await response({"type": "http", "state": {}}, forever, slow)

        tracemalloc.start()
        tasks = [asyncio.create_task(app(None, None, None)) for _ in range(40)]
        while len(stuck) < 40:
            await asyncio.sleep(0.01)
        held, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert held < 10_000_000
        assert made == [1]
        assert answers.under_way == len(content)
        for task in tasks[:20]:
            task.cancel()  # half of the readers disconnect
        go_on.set()
        await asyncio.gather(*tasks, return_exceptions=True)
        assert sum(stuck) >= 20 * len(content)
        assert answers.under_way == 0
        assert not answers._shared
        assert not list(tmp_path.iterdir())

    asyncio.run(main())


def test_A7_answers_beyond_the_byte_budget_are_refused(tmp_path: Any) -> None:
    from service.core.problems import Problem

    async def main() -> None:
        answers = Answers(tmp_path, 40 << 20, 60.0)
        big = bytes(15 << 20)
        kept = [await answers.respond(big, "ann", "a/b")]  # in memory
        kept.append(await answers.respond(big, "ann", "a/b"))  # on disk
        with pytest.raises(Problem) as raised:
            await answers.respond(big, "ann", "a/b")
        assert raised.value.status == 429
        assert raised.value.headers is not None
        assert int(raised.value.headers["Retry-After"]) >= 1
        kept.append(await answers.respond(big, "bob", "a/b"))
        assert (await answers.respond(b"small", "ann", "a/b")).body == b"small"
        kept.clear()
        assert answers.under_way == 0
        await answers.respond(big, "ann", "a/b")

    asyncio.run(main())


def test_A7_answer_for_a_full_disk_is_refused(tmp_path: Any, monkeypatch: Any) -> None:
    import errno

    from service.core.problems import Problem

    def full(*_: Any, **__: Any) -> Any:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("tempfile.TemporaryFile", full)

    async def main() -> None:
        answers = Answers(tmp_path, 1 << 30, 60.0)
        with pytest.raises(Problem) as raised:
            await answers.respond(bytes(17 << 20), "ann", "a/b")
        assert raised.value.status == 503
        assert answers.under_way == 0

    asyncio.run(main())


async def answered(address: Served) -> bool:
    reader, writer = await connected(address)
    try:
        writer.write(GET)
        return bool((await reader.readline()).startswith(b"HTTP/1.1 200"))
    except ConnectionResetError:
        return False
    finally:
        writer.close()


@pytest.mark.parametrize("limit", [{"address_most": 3}, {"most": 3}])
def test_A11_longest_idle_connection_makes_room(limit: dict[str, int]) -> None:
    async def main() -> None:
        async with listening(whole(b"ok"), **limit) as address:
            idle = []
            for _ in range(3):
                idle.append(await connected(address))
                await asyncio.sleep(0.01)
            # The first connection is used again, so the second one is idle longest.
            idle[0][1].write(GET)
            assert (await idle[0][0].readline()).startswith(b"HTTP/1.1 200")
            assert await answered(address)
            with pytest.raises((ConnectionResetError, asyncio.IncompleteReadError)):
                await idle[1][0].readexactly(1)
            idle[2][1].write(GET)
            assert (await idle[2][0].readline()).startswith(b"HTTP/1.1 200")
            for _ in range(10):
                assert await answered(address)

    asyncio.run(main())


def test_A11_health_is_answered_while_all_connections_are_at_work() -> None:
    let_go = asyncio.Event()

    async def app(scope: Any, receive: Any, send: Any) -> None:
        if scope["path"] == "/held":
            await let_go.wait()
        await whole(b"ok")(scope, receive, send)

    async def main() -> None:
        async with listening(app, address_most=3) as address:
            held = [await connected(address) for _ in range(3)]
            for _, writer in held:
                writer.write(b"GET /held HTTP/1.1\r\nHost: x\r\n\r\n")
            await asyncio.sleep(0.05)
            for _ in range(40):
                assert await answered(address)
                await asyncio.sleep(0)
            let_go.set()
            for reader, _ in held:
                assert (await reader.readline()).startswith(b"HTTP/1.1 200")

    asyncio.run(main())


def test_A11_body_that_pauses_longest_makes_room() -> None:
    async def app(scope: Any, receive: Any, send: Any) -> None:
        while (await receive()).get("more_body"):
            pass
        await whole(b"ok")(scope, receive, send)

    async def main() -> None:
        async with listening(app, address_most=2) as address:
            trickles = [await connected(address) for _ in range(2)]
            for _, writer in trickles:
                writer.write(b"POST /a HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n1")
                await asyncio.sleep(0.02)
            assert await answered(address)
            with pytest.raises((ConnectionResetError, asyncio.IncompleteReadError)):
                await trickles[0][0].readexactly(1)
            trickles[1][1].write(b"23456789")
            assert (await trickles[1][0].readline()).startswith(b"HTTP/1.1 200")

    asyncio.run(main())


def test_A11_reader_that_does_not_read_makes_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "RESERVE", 0)

    async def app(scope: Any, receive: Any, send: Any) -> None:
        await whole(bytes(12 << 20) if scope["path"] == "/large" else b"ok")(scope, receive, send)

    async def main() -> None:
        async with listening(app, address_most=2, stall_seconds=20.0) as address:
            monkeypatch.setattr(Protocol, "is_stuck", property(lambda self: self._pending() > 0))
            for _ in range(2):
                _, writer = await connected(address, 64 << 10)
                writer.transport.pause_reading()
                writer.write(b"GET /large HTTP/1.1\r\nHost: x\r\n\r\n")
                await asyncio.sleep(0.05)
            for _ in range(3):
                assert await answered(address)

    asyncio.run(main())
