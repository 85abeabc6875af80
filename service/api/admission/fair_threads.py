"""Fair threads: a thread pool that no single client can occupy."""

import asyncio
import time
from collections import OrderedDict, deque
from collections.abc import Callable
from typing import TypeVar

import anyio
import anyio.to_thread

Result = TypeVar("Result")

LONG_SECONDS = 0.25
"""Time after which a running call gives up its place to a waiting call, seconds.

The running call then continues beside the other one.
"""

LENT = 4
"""Largest number of calls at once, as a multiple of the places. One client may have half."""


Kind = tuple[str, bool]
"""Client, and whether its call is heavy."""


class FairThreads:
    """Pool of threads for blocking calls, shared fairly among clients.

    Waiting calls start round robin over the clients. A client without a running call may always
    start one, and a long call gives up its place. So a small call never waits for the end of a
    large one. Heavy calls, which need much memory, have a queue of their own and take no place from
    running calls. A pool belongs to one event loop.
    """

    def __init__(self, places: int) -> None:
        """Create the threads.

        Args:
            places: number of calls that run at once, as long as all calls are short.
        """
        self._places = places
        self._threads = anyio.CapacityLimiter(LENT * places)
        self._started: dict[object, tuple[Kind, float]] = {}
        self._waiting: OrderedDict[Kind, deque[asyncio.Future[object]]] = OrderedDict()
        self._timer: asyncio.TimerHandle | None = None

    async def run(self, client: str, work: Callable[[], Result], heavy: bool = False) -> Result:
        """Run a call; do not start it if it is cancelled before its turn."""
        ticket = await self._turn((client, heavy))
        try:
            return await anyio.to_thread.run_sync(work, limiter=self._threads)
        finally:
            del self._started[ticket]
            self._start_waiting()

    async def _turn(self, kind: Kind) -> object:
        if kind not in self._waiting and self._may_start(kind):
            return self._start(kind)
        turn: asyncio.Future[object] = asyncio.get_running_loop().create_future()
        self._waiting.setdefault(kind, deque()).append(turn)
        self._look_again_later()
        try:
            return await turn
        except asyncio.CancelledError:
            if turn.done() and not turn.cancelled():
                del self._started[turn.result()]
            else:
                self._forget(kind, turn)
            self._start_waiting()
            raise

    def _forget(self, kind: Kind, turn: asyncio.Future[object]) -> None:
        queue = self._waiting.get(kind)
        if queue is not None and turn in queue:
            queue.remove(turn)
            if not queue:
                del self._waiting[kind]

    def _start(self, kind: Kind) -> object:
        ticket = object()
        self._started[ticket] = (kind, time.monotonic())
        return ticket

    def _may_start(self, kind: Kind) -> bool:
        if len(self._started) >= LENT * self._places:
            return False
        client, heavy = kind
        kinds = [each for each, _ in self._started.values()]
        if heavy:
            others = sum(is_heavy for _, is_heavy in kinds)
            return others < (self._places if kind in kinds else 2 * self._places)
        own = sum(each == client for each, _ in kinds)
        if own == 0:
            return True
        recent = time.monotonic() - LONG_SECONDS
        short = sum(began > recent for _, began in self._started.values())
        return short < self._places and own < LENT * self._places // 2

    def _start_waiting(self) -> None:
        """Start waiting calls in free places, round robin over the clients."""
        turned = True
        while turned:
            turned = False
            for kind in list(self._waiting):
                if not self._may_start(kind):
                    continue
                queue = self._waiting.pop(kind)
                turn = queue.popleft()
                if queue:
                    self._waiting[kind] = queue  # behind the others
                if not turn.done():
                    turn.set_result(self._start(kind))
                turned = True
        self._look_again_later()

    def _look_again_later(self) -> None:
        """Schedule the next check for when a running call becomes a long call."""
        if self._timer is not None or not self._waiting:
            return
        recent = time.monotonic() - LONG_SECONDS
        soon = [began - recent for _, began in self._started.values() if began > recent]
        if soon:
            loop = asyncio.get_running_loop()
            self._timer = loop.call_later(min(soon) + 1e-3, self._look_again)

    def _look_again(self) -> None:
        self._timer = None
        self._start_waiting()
