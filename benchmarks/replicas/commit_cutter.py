"""Link between replicas and a database server that is cut just after a COMMIT."""

import asyncio
from contextlib import suppress
from threading import Event

from benchmarks.durability.loopback_proxy import LoopbackProxy

CHUNK_BYTES = 1 << 16

COMMIT = b"COMMIT\0"
"""End of a message of PostgreSQL's protocol that commits, in both forms of a query."""


class CommitCutter(LoopbackProxy):
    """Proxy before one server.

    It passes all bytes on. Once armed, it lets the next COMMIT reach the server, waits for the
    server's answer, and then drops the connection: the client never learns that its transaction was
    committed.

    Attributes:
        target: port of the server.
    """

    def __init__(self, target: int) -> None:
        super().__init__()
        self.target = target
        self._armed = Event()

    def arm(self) -> None:
        """Cut the connection of the next commit."""
        self._armed.set()

    def disarm(self) -> bool:
        """Cut nothing; return whether there was still a cut to make."""
        was = self._armed.is_set()
        self._armed.clear()
        return was

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
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
