"""A link that breaks: it passes bytes between robots and a service, and cuts at random."""

import asyncio
import random
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from threading import Event, Thread
from urllib.parse import urlsplit

PIECE = 1 << 14
"""Bytes that are passed on at once, at most."""


@dataclass(slots=True)
class CuttingProxy:
    """Listens on a port of its own, that stays the same while the service behind it comes and goes.

    Attributes:
        draw: when a connection is cut.
        cut_bytes: that pass through a connection until then, on average; None: it is never cut.
        service: address of the service, such as http://127.0.0.1:8123; None: there is none now.
        cuts: how many connections were cut.
    """

    draw: random.Random
    cut_bytes: float | None
    service: str | None = None
    cuts: int = 0
    _port: int = 0
    _ended: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def address(self) -> str:
        """Where it listens."""
        return f"http://127.0.0.1:{self._port}"

    @contextmanager
    def running(self) -> Iterator[None]:
        """At work until the block ends, in a thread of its own."""
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
        for _ in range(2):  # so that what was aborted is closed
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
            pass  # the service has gone
        finally:
            for each in writers:
                each.transport.abort()


class _Link:
    """A connection that bears so many bytes."""

    def __init__(self, left: float | None) -> None:
        self._left = left
        self.is_cut = False

    async def passes(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Until it is cut, or one end has gone."""
        with suppress(OSError):
            while piece := await reader.read(PIECE):
                if self._left is not None and self._left < len(piece):
                    writer.write(piece[: int(self._left)])
                    self.is_cut = True
                    return
                if self._left is not None:
                    self._left -= len(piece)
                writer.write(piece)
                await writer.drain()
