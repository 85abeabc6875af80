"""Faulty link: a proxy between robots and a service that cuts connections at random."""

import asyncio
import random
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from threading import Event, Thread
from urllib.parse import urlsplit

CHUNK_BYTES = 1 << 14
"""Largest number of bytes passed on at once."""


@dataclass(slots=True)
class CuttingProxy:
    """Proxy with a fixed port, which stays the same while the service restarts.

    Attributes:
        draw: random generator of the cuts.
        cut_bytes: mean number of bytes until a connection is cut; None: no cuts.
        service: address of the service, such as http://127.0.0.1:8123; None: the service is down.
        cuts: number of connections that were cut.
    """

    draw: random.Random
    cut_bytes: float | None
    service: str | None = None
    cuts: int = 0
    _port: int = 0
    _ended: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def address(self) -> str:
        """Return the address of the proxy."""
        return f"http://127.0.0.1:{self._port}"

    @contextmanager
    def running(self) -> Iterator[None]:
        """Run the proxy in its own thread until the block ends."""
        loop, listening = asyncio.new_event_loop(), Event()
        thread = Thread(target=loop.run_until_complete, args=(self._serve(listening),))
        thread.start()
        listening.wait()
        try:
            yield
        finally:
            loop.call_soon_threadsafe(self._ended.set)
            thread.join()
            loop.close()

    async def _serve(self, listening: Event) -> None:
        server = await asyncio.start_server(self._connected, "127.0.0.1", 0)
        self._port = server.sockets[0].getsockname()[1]
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
            address = urlsplit(self.service or "")
            if address.port is None:
                return
            from_service, to_service = await asyncio.open_connection(address.hostname, address.port)
            writers.append(to_service)
            link = _Link(self.draw.expovariate(1 / self.cut_bytes) if self.cut_bytes else None)
            await asyncio.wait(
                [
                    asyncio.create_task(link.passes(reader, to_service)),
                    asyncio.create_task(link.passes(from_service, writer)),
                ],
                return_when=asyncio.FIRST_COMPLETED,
            )
            self.cuts += link.is_cut
        except OSError:
            pass  # the service is down
        finally:
            for each in writers:
                each.transport.abort()


class _Link:
    """Connection that is cut after a number of bytes."""

    def __init__(self, left: float | None) -> None:
        self._left = left
        self.is_cut = False

    async def passes(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Pass bytes on until the connection is cut or one end closes it."""
        with suppress(OSError):
            while chunk := await reader.read(CHUNK_BYTES):
                if self._left is not None and self._left < len(chunk):
                    writer.write(chunk[: int(self._left)])
                    self.is_cut = True
                    return
                if self._left is not None:
                    self._left -= len(chunk)
                writer.write(chunk)
                await writer.drain()
