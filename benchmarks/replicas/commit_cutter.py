"""Link between replicas and a database server that is cut just after a COMMIT."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread

CHUNK_BYTES = 1 << 16
STOP_SECONDS = 10.0

COMMIT = b"COMMIT\0"
"""End of a message of PostgreSQL's protocol that commits, in both forms of a query."""


class CommitCutter:
    """Proxy with a fixed port before one server.

    It passes all bytes on. Once armed, it lets the next COMMIT reach the server, waits for the
    server's answer, and then drops the connection: the client never learns that its transaction was
    committed.

    Attributes:
        port: port of the proxy.
        target: port of the server.
        cuts: number of connections that were cut.
    """

    def __init__(self, target: int) -> None:
        self.target = target
        self.port = 0
        self.cuts = 0
        self._armed = Event()
        self._loop = asyncio.new_event_loop()
        self._ended = asyncio.Event()

    def arm(self) -> None:
        """Cut the connection of the next commit."""
        self._armed.set()

    def disarm(self) -> bool:
        """Cut nothing; return whether there was still a cut to make."""
        was = self._armed.is_set()
        self._armed.clear()
        return was

    @contextmanager
    def running(self) -> Iterator[None]:
        """Run the proxy in a thread of its own until the block ends."""
        listening = Event()
        thread = Thread(
            target=self._loop.run_until_complete, args=(self._serve(listening),), daemon=True
        )
        thread.start()
        if not listening.wait(STOP_SECONDS):
            raise RuntimeError("the proxy before the database does not listen")
        try:
            yield
        finally:
            self._loop.call_soon_threadsafe(self._ended.set)
            thread.join(STOP_SECONDS)
            if not self._loop.is_running():
                self._loop.close()

    async def _serve(self, listening: Event) -> None:
        server = await asyncio.start_server(self._connected, "127.0.0.1", 0)
        self.port = server.sockets[0].getsockname()[1]
        listening.set()
        await self._ended.wait()
        server.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)
        for _ in range(2):  # lets aborted connections close
            await asyncio.sleep(0)

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writers = [writer]
        try:
            from_server, to_server = await asyncio.open_connection("127.0.0.1", self.target)
            writers.append(to_server)
            committed = asyncio.Event()
            await asyncio.wait(
                [
                    asyncio.create_task(self._requests(reader, to_server, committed)),
                    asyncio.create_task(self._answers(from_server, writer, committed)),
                ],
                return_when=asyncio.FIRST_COMPLETED,
            )
        except (OSError, asyncio.CancelledError):
            pass  # the server is down, or the proxy ends
        finally:
            for each in writers:
                each.transport.abort()

    async def _requests(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, committed: asyncio.Event
    ) -> None:
        with suppress(OSError):
            while chunk := await reader.read(CHUNK_BYTES):
                if COMMIT in chunk and self.disarm():
                    committed.set()
                writer.write(chunk)
                await writer.drain()

    async def _answers(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, committed: asyncio.Event
    ) -> None:
        with suppress(OSError):
            while chunk := await reader.read(CHUNK_BYTES):
                if committed.is_set():
                    self.cuts += 1
                    return
                writer.write(chunk)
                await writer.drain()
