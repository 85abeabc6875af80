"""Proxy on a port of this machine, in a thread of its own."""

import asyncio
from abc import ABC, abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread

STOP_SECONDS = 10.0
"""Longest time until the proxy listens, and until it has ended."""


class LoopbackProxy(ABC):
    """Proxy with a fixed port, which stays the same while the server behind it restarts.

    Attributes:
        port: port of the proxy; 0 before it runs.
        cuts: number of connections that were cut.
    """

    def __init__(self) -> None:
        self.port = 0
        self.cuts = 0
        self._loop = asyncio.new_event_loop()
        self._ended = asyncio.Event()

    @abstractmethod
    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve one connection to its end."""

    @contextmanager
    def running(self) -> Iterator[None]:
        """Run the proxy until the block ends."""
        listening = Event()
        thread = Thread(
            target=self._loop.run_until_complete, args=(self._serve(listening),), daemon=True
        )
        thread.start()
        if not listening.wait(STOP_SECONDS):
            raise RuntimeError("the proxy does not listen")
        try:
            yield
        finally:
            self._loop.call_soon_threadsafe(self._ended.set)
            thread.join(STOP_SECONDS)
            if not self._loop.is_running():
                self._loop.close()

    async def _serve(self, listening: Event) -> None:
        server = await asyncio.start_server(self.connected, "127.0.0.1", 0)
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
