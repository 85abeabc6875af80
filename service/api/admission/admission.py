"""Admission control: limits concurrent requests (429), enforces deadlines (504), cancels work.

Work is cancelled at its deadline or when its client disconnects. Requests take one of several
lanes: recognition, reads of stored maps, edits, uploads, alignments. Each lane has its own places
and threads, which clients share fairly. A client is an API key, or an address if the service has no
keys.
"""

import asyncio
import time
from collections import Counter
from collections.abc import AsyncIterator, Callable, Collection
from contextlib import asynccontextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TypeVar

import anyio
import anyio.lowlevel
from fastapi import Request
from prometheus_client import Gauge
from starlette.requests import ClientDisconnect

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from service.api.admission.addresses import client_network
from service.api.admission.fair_threads import FairThreads
from service.api.admission.receiving import BodyRules, Receiver, busy, check_types
from service.api.body.body import Body
from service.api.body.compression import decompress
from service.api.middleware.body_limit import discard
from service.core.problems import Problem
from service.core.timing import Timing

Result = TypeVar("Result")

TIMEOUT = "placecell-timeout"
"""Header with the seconds after which the client stops waiting."""

HEAVY_BYTES = 1 << 20
"""Bytes from which a body counts as heavy; a compressed one counts as heavy at any size."""

SHARING_SECONDS = 5.0
"""Time after its last request during which a client keeps its share of a lane, seconds."""


class Lane:
    """Lane: the requests of one kind, with their own limits and threads."""

    def __init__(
        self,
        most: int,
        threads: int,
        seconds: float,
        body: BodyRules,
        body_bytes: int,
        receiver: Receiver,
        gauge: Gauge | None = None,
    ) -> None:
        """Create a lane.

        Args:
            most: largest number of requests that run or wait.
            threads: number of requests that run at once.
            seconds: longest time of a request after its body has arrived, seconds.
            body: time limits of a body.
            body_bytes: largest size of a decompressed body, bytes.
            receiver: receiver of the bodies.
            gauge: metric of the number of requests in the lane.
        """
        self.threads = FairThreads(threads)
        self._most = most
        self._seconds = seconds
        self._body = body
        self._body_bytes = body_bytes
        self._receiver = receiver
        self._gauge = gauge
        self._inside: Counter[str] = Counter()
        self._asked: dict[str, float] = {}

    @asynccontextmanager
    async def admit(
        self,
        request: Request,
        media_types: Collection[str],
        timing: Timing,
        body_bytes: int | None = None,
    ) -> AsyncIterator[Body]:
        """Receive a request's body; cancel the block at the deadline or on disconnect.

        Args:
            request: the HTTP request.
            media_types: media types that the body may have.
            timing: stopwatch of the request.
            body_bytes: largest size of the decompressed body, bytes; None: that of the lane.

        Raises:
            Problem: 429 if the lane is full; 504 if the deadline passes; 408, 413 or 415 if the
                body is late, too large or of the wrong type.
        """
        client = client_of(request)
        asked = _timeout_of(request)
        media_type, coding = check_types(request, media_types)
        began = time.monotonic()
        await self._check_early(client, request)
        rules = self._body
        if asked is not None:
            rules = BodyRules(min(rules.seconds, asked), rules.stall_seconds)
        with self._receiver.holding(client) as held:
            try:
                content = await self._receiver.receive(request, client, rules, held)
            except Problem as problem:
                if problem.status == 408 and asked is not None and asked <= rules.seconds:
                    raise _late(asked) from problem
                raise
            timing.lap("receive")
            spent = time.monotonic() - began
            limit = self._limit(asked, spent)
            is_heavy = len(content) > HEAVY_BYTES or coding != "identity"
            async with self._inside_until(
                request, client, limit, limit + spent, is_heavy
            ) as admitted:
                if coding != "identity":
                    packed, most = content, body_bytes or self._body_bytes
                    content = await admitted.run(lambda: decompress(packed, coding, most))
                    held.add(len(content))
                yield Body(media_type, content)

    @asynccontextmanager
    async def enter(self, request: Request) -> AsyncIterator[None]:
        """Admit a request without a body; raise as `admit` does."""
        client = client_of(request)
        asked = _timeout_of(request)
        limit = self._limit(asked, 0.0)
        async with self._inside_until(request, client, limit, limit):
            yield

    def _limit(self, asked: float | None, spent: float) -> float:
        """Return the seconds that are left for the work.

        If the body and the work share one time limit, the body's time is subtracted.
        """
        together = self._body.seconds <= self._seconds
        left = self._seconds - (spent if together else 0.0)
        return max(left if asked is None else min(left, asked - spent), 0.0)

    @asynccontextmanager
    async def _inside_until(
        self,
        request: Request,
        client: str,
        seconds: float,
        told: float,
        is_heavy: bool = False,
    ) -> AsyncIterator["Admitted"]:
        """Take a place in the lane for a block."""
        self._check(client)
        self._change(client, 1)
        token = CancelToken(time.monotonic() + seconds)
        admitted = Admitted(self, client, token, is_heavy)
        timer = asyncio.get_running_loop().call_later(seconds, token.cancel)
        before = _admitted.set(admitted)
        stopped = False
        try:
            with anyio.move_on_after(seconds) as scope, cancelled_by(token):
                async with _while_connected(request, token):
                    try:
                        yield admitted
                    except Cancelled:
                        stopped = True
                        # If the client has disconnected, that error comes first.
                        await anyio.lowlevel.checkpoint()
                # The thread was not interrupted, but the deadline has passed.
                await anyio.lowlevel.checkpoint_if_cancelled()
        finally:
            _admitted.reset(before)
            timer.cancel()
            token.cancel()
            self._change(client, -1)
        if scope.cancelled_caught or stopped:
            raise _late(told)

    def _change(self, client: str, by: int) -> None:
        self._inside[client] += by
        if not self._inside[client]:
            del self._inside[client]
        if self._gauge is not None:
            self._gauge.set(self._inside.total())

    def _check(self, client: str) -> None:
        """Check that a client may have one more request in the lane.

        Active clients share the places equally, and each client always has one place.

        Raises:
            Problem: 429 if the client's share or the lane is full.
        """
        now = time.monotonic()
        self._asked[client] = now
        for each, last in list(self._asked.items()):
            if now - last > SHARING_SECONDS and each not in self._inside:
                del self._asked[each]
        own, total = self._inside[client], self._inside.total()
        share = max(self._most // len(self._asked), 1)
        if own >= share or (own and total >= self._most) or total >= 2 * self._most:
            raise busy(
                f"This client has {own} requests running or waiting, all clients have {total}; "
                f"the limits are {share} and {self._most}."
            )

    async def _check_early(self, client: str, request: Request) -> None:
        """Refuse a request before its body arrives if the lane is full already."""
        try:
            self._check(client)
        except Problem as problem:
            # If the whole body was received, the connection can carry the next request. A client
            # that waits for `100 Continue` must not be made to send its body.
            if "expect" in request.headers or not await discard(request.receive):
                problem.headers = {**(problem.headers or {}), "Connection": "close"}
            raise


@dataclass(frozen=True, slots=True)
class Admitted:
    """Admitted request: holds a place in a lane."""

    lane: Lane
    client: str
    token: CancelToken
    is_heavy: bool = False

    async def run(self, work: Callable[[], Result]) -> Result:
        """Run blocking work in one of the lane's threads, when it is the client's turn."""
        self.token.check()
        return await self.lane.threads.run(self.client, work, self.is_heavy)


_admitted: ContextVar[Admitted | None] = ContextVar("placecell_admitted", default=None)


def admitted() -> Admitted | None:
    """Return the current request if it has a place in a lane; None otherwise."""
    return _admitted.get()


def client_of(request: Request) -> str:
    """Return the client of a request, for fair shares: its API key or its address."""
    state = request.app.state.placecell
    if state.keys:
        return f"key {request.scope['state'].get('key', '')}"
    return f"address {client_network(request.client.host) if request.client else ''}"


def _timeout_of(request: Request) -> float | None:
    """Return the seconds that the client waits; None if the request has no such header."""
    asked = request.headers.get(TIMEOUT)
    if asked is None:
        return None
    try:
        seconds = float(asked)
    except ValueError:
        seconds = float("nan")
    if not seconds > 0:  # excludes NaN
        raise Problem(
            400,
            "invalid-header",
            f"Invalid Placecell-Timeout {asked!r:.40}: expected a positive number of seconds.",
        )
    return seconds


def _late(seconds: float) -> Problem:
    return Problem(504, "deadline-exceeded", f"Not finished within {seconds:.3g} s.")


@asynccontextmanager
async def _while_connected(request: Request, token: CancelToken) -> AsyncIterator[None]:
    """Cancel the block and its token when the client closes the connection.

    Raises:
        ClientDisconnect: the client closed the connection.
    """
    with anyio.CancelScope() as scope:

        async def listen() -> None:
            while (await request.receive())["type"] != "http.disconnect":
                pass
            token.cancel()
            scope.cancel()

        listener = asyncio.create_task(listen())
        try:
            yield
        finally:
            listener.cancel()
    if scope.cancelled_caught:
        raise ClientDisconnect
