"""The desk where requests for recognition are taken in: not too many, and done in time.

Who comes when it is full is told at once (429). Who waits too long is told so (504), and who has
gone is no longer worked for.
"""

import asyncio
from collections.abc import AsyncIterator, Collection
from contextlib import asynccontextmanager

import anyio
from fastapi import Request
from starlette.requests import ClientDisconnect

from service.bodies import Body, read_body
from service.metrics import Metrics
from service.problems import Problem
from service.settings import Limits
from service.timing import Timing

TIMEOUT = "placecell-timeout"
"""Header: seconds after which the client no longer waits."""

RETRY_SECONDS = 1


class Desk:
    """Admits requests, up to a number at once."""

    def __init__(self, limits: Limits, metrics: Metrics) -> None:
        self._limits = limits
        self._inside = metrics.queue_requests
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
        seconds = self._seconds(request)
        if self._count >= self._limits.requests:
            # Heard out, so that the connection can be used again.
            async for _ in request.stream():
                pass
            raise Problem(
                429,
                "busy",
                f"{self._count} requests are at work or waiting, the limit; try again.",
                headers={"Retry-After": str(RETRY_SECONDS)},
            )
        self._count += 1
        self._inside.set(self._count)
        try:
            with anyio.fail_after(seconds):
                body = await read_body(request, media_types, self._limits)
                timing.lap("receive")
                async with _while_heard(request):
                    yield body
        except TimeoutError as error:
            raise Problem(
                504, "deadline-exceeded", f"Not done within {seconds:g} s; nothing was changed."
            ) from error
        finally:
            self._count -= 1
            self._inside.set(self._count)

    def _seconds(self, request: Request) -> float:
        """How long the request may take."""
        asked = request.headers.get(TIMEOUT)
        if asked is None:
            return self._limits.deadline
        try:
            seconds = float(asked)
        except ValueError:
            seconds = float("nan")
        if not seconds > 0:  # and so not for NaN
            raise Problem(
                400, "invalid-header", f"{TIMEOUT} is {asked!r:.40}: seconds, more than 0, are due."
            )
        return min(seconds, self._limits.deadline)


@asynccontextmanager
async def _while_heard(request: Request) -> AsyncIterator[None]:
    """Cancel the block when the client closes the connection.

    Raises:
        ClientDisconnect: it did.
    """
    worker = asyncio.current_task()
    assert worker is not None
    gone = False

    async def listen() -> None:
        nonlocal gone
        while (await request.receive())["type"] != "http.disconnect":
            pass
        gone = True
        worker.cancel()

    listener = asyncio.create_task(listen())
    try:
        yield
    except asyncio.CancelledError:
        if not gone:
            raise
        worker.uncancel()
        raise ClientDisconnect from None
    finally:
        listener.cancel()
