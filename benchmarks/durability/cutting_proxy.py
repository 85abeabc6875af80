"""Faulty link: a proxy between robots and a service that cuts connections at random."""

import asyncio
import random
from contextlib import suppress
from urllib.parse import urlsplit

from benchmarks.durability.loopback_proxy import LoopbackProxy

CHUNK_BYTES = 1 << 14
"""Largest number of bytes passed on at once."""


class CuttingProxy(LoopbackProxy):
    """Proxy that cuts each connection after a random number of bytes.

    Attributes:
        draw: random generator of the cuts.
        cut_bytes: mean number of bytes until a connection is cut; None: no cuts.
        service: address of the service, such as http://127.0.0.1:8123; None: the service is down.
    """

    def __init__(
        self, draw: random.Random, cut_bytes: float | None, service: str | None = None
    ) -> None:
        super().__init__()
        self.draw = draw
        self.cut_bytes = cut_bytes
        self.service = service

    @property
    def address(self) -> str:
        """Return the address of the proxy."""
        return f"http://127.0.0.1:{self.port}"

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
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
