"""The desk where requests are taken in: not too many, and done in time.

Who comes when it is full is told at once (429). Who waits too long is told so (504), and who has
gone is no longer worked for.
"""

import asyncio
from collections.abc import AsyncIterator, Collection
from contextlib import asynccontextmanager

import anyio
import anyio.lowlevel
from fastapi import Request
from prometheus_client import Gauge
from starlette.requests import ClientDisconnect

from service.bodies import Body, read_body
from service.limits import discard
from service.problems import Problem
from service.timing import Timing

TIMEOUT = "placecell-timeout"
"""Header: seconds after which the client no longer waits."""

RETRY_SECONDS = 1


class Desk:
    """Admits requests, up to a number at once."""

    def __init__(
        self,
        most: int,
        seconds: float,
        body_seconds: float,
        body_bytes: int,
        inside: Gauge | None = None,
    ) -> None:
        """A desk.

        Args:
            most: requests at once.
            seconds: that one may take.
            body_seconds: of these, until its body has come.
            body_bytes: that a compressed body may hold.
            inside: is told how many there are.
        """
        self._most = most
        self._seconds = seconds
        self._body_seconds = body_seconds
        self._body_bytes = body_bytes
        self._inside = inside
        self._count = 0

    @asynccontextmanager
    async def admit(
        self, request: Request, media_types: Collection[str], timing: Timing
    ) -> AsyncIterator[Body]:
        """The body of a request; what is done with it ends in time, or when the client goes.

        Raises:
            Problem: 429 if too many are inside, 504 if the deadline passes, and what `read_body`
                finds wrong.
        """
        seconds = self._until(request)
        if self._count >= self._most:
            raise await self._full(request)
        self._change(1)
        try:
            with anyio.move_on_after(seconds) as time:
                body = await read_body(request, media_types, self._body_seconds, self._body_bytes)
                timing.lap("receive")
                async with _while_heard(request):
                    yield body
                # What a thread did was not interrupted; late is late all the same.
                await anyio.lowlevel.checkpoint_if_cancelled()
        finally:
            self._change(-1)
        if time.cancelled_caught:
            raise Problem(504, "deadline-exceeded", f"Not done within {seconds:g} s.")

    def _change(self, by: int) -> None:
        self._count += by
        if self._inside is not None:
            self._inside.set(self._count)

    async def _full(self, request: Request) -> Problem:
        headers = {"Retry-After": str(RETRY_SECONDS)}
        # A body that was heard out leaves the connection fit for the next request; a client that
        # waits for a 100 must not be made to send it.
        if "expect" in request.headers or not await discard(request.receive):
            headers["Connection"] = "close"
        return Problem(
            429,
            "busy",
            f"{self._count} requests are at work or waiting, the limit; try again.",
            headers=headers,
        )

    def _until(self, request: Request) -> float:
        """How long the request may take."""
        asked = request.headers.get(TIMEOUT)
        if asked is None:
            return self._seconds
        try:
            seconds = float(asked)
        except ValueError:
            seconds = float("nan")
        if not seconds > 0:  # and so not for NaN
            raise Problem(
                400, "invalid-header", f"{TIMEOUT} is {asked!r:.40}: seconds, more than 0, are due."
            )
        return min(seconds, self._seconds)


@asynccontextmanager
async def _while_heard(request: Request) -> AsyncIterator[None]:
    """Cancel the block when the client closes the connection.

    Raises:
        ClientDisconnect: it did.
    """
    with anyio.CancelScope() as scope:

        async def listen() -> None:
            while (await request.receive())["type"] != "http.disconnect":
                pass
            scope.cancel()

        listener = asyncio.create_task(listen())
        try:
            yield
        finally:
            listener.cancel()
    if scope.cancelled_caught:
        raise ClientDisconnect
