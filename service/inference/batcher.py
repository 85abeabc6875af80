"""Dynamic batching: segments of all requests, computed together.

Requests that arrive during inference are processed as the next batch; an idle model starts at once.
A large request is computed in parts, in turn with others, and stops when it is cancelled.
"""

import asyncio
import contextvars
from collections import deque
from dataclasses import dataclass, field

import anyio.to_thread
import numpy as np

from placecell.core.types import Float32
from placecell.descriptors.extractor import Extractor, Inputs
from service.core.metrics import Metrics
from service.core.timing import Timing

PART = 128
"""Largest number of one request's segments in a batch, so that others wait one batch at most."""


@dataclass(slots=True, eq=False)
class Waiting:
    """Inputs of one request that waits for its descriptors.

    Attributes:
        inputs: of all its segments.
        timing: the request's stopwatch.
        answer: will be the descriptors.
        taken: segments that went into batches so far.
        found: descriptors so far, one array a batch.
    """

    inputs: Inputs
    timing: Timing
    answer: asyncio.Future[Float32]
    taken: int = 0
    found: list[Float32] = field(default_factory=list)

    def __len__(self) -> int:
        return len(next(iter(self.inputs.values())))

    @property
    def left(self) -> int:
        """Return the number of segments that are in no batch yet."""
        return len(self) - self.taken


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Part of a request in one batch: the segments from `start` to `stop`."""

    waiting: Waiting
    start: int
    stop: int

    def __len__(self) -> int:
        return self.stop - self.start


class Batcher:
    """Gives a model its work, one batch at a time; the model itself spreads it over the cores.

    Belongs to one event loop.
    """

    def __init__(self, extractor: Extractor, metrics: Metrics, most: int) -> None:
        """Create the batcher of a model.

        Args:
            extractor: the model.
            metrics: count batches.
            most: segments of a batch.
        """
        self._extractor = extractor
        self._metrics = metrics
        self._most = most
        self._queue: deque[Waiting] = deque()
        self._at_work: asyncio.Task[None] | None = None

    async def infer(self, inputs: Inputs, timing: Timing) -> Float32:
        """Return descriptors of prepared segments, float32 (rows, dimension).

        Cancelled while it waits, it is left out of the batches that follow.
        """
        waiting = Waiting(inputs, timing, asyncio.get_running_loop().create_future())
        self._queue.append(waiting)
        self._metrics.queue_segments.inc(len(waiting))
        if self._at_work is None:
            # In a context of its own: it works for all requests, not for the first alone.
            self._at_work = asyncio.create_task(self._work(), context=contextvars.Context())
        return await waiting.answer

    async def _work(self) -> None:
        try:
            while batch := self._take():
                await self._run(batch)
        finally:
            self._at_work = None

    def _take(self) -> list[Part]:
        """Take a part of the longest waiting requests; unfinished requests go to the end."""
        batch: list[Part] = []
        rest: list[Waiting] = []
        room = self._most
        while self._queue and room > 0:
            waiting = self._queue[0]
            size = min(waiting.left, PART, self._most)
            if waiting.answer.done():
                size = waiting.left  # nobody waits any more: all of it leaves the queue
            elif batch and size > room:
                break
            self._queue.popleft()
            self._metrics.queue_segments.dec(size)
            start, waiting.taken = waiting.taken, waiting.taken + size
            if waiting.answer.done():
                continue
            batch.append(Part(waiting, start, start + size))
            room -= size
            if waiting.left:
                rest.append(waiting)
        self._queue.extend(rest)
        return batch

    async def _run(self, batch: list[Part]) -> None:
        for part in batch:
            part.waiting.timing.lap("queue")
        try:
            found = await anyio.to_thread.run_sync(self._infer, batch)
        except Exception as error:
            if len(batch) == 1:
                _fail(batch[0].waiting, error)
                return
            # Whoever's fault it was: the others must not suffer.
            for part in batch:
                await self._run([part])
            return
        self._metrics.batch_requests.observe(len(batch))
        self._metrics.batch_segments.observe(sum(map(len, batch)))
        for part, descriptors in zip(batch, found, strict=True):
            waiting = part.waiting
            waiting.timing.lap("infer")
            waiting.found.append(descriptors)
            if part.stop == len(waiting) and not waiting.answer.done():
                waiting.answer.set_result(
                    waiting.found[0] if len(waiting.found) == 1 else np.concatenate(waiting.found)
                )

    def _infer(self, batch: list[Part]) -> list[Float32]:
        joined = {
            name: np.concatenate(
                [part.waiting.inputs[name][part.start : part.stop] for part in batch]
            )
            for name in batch[0].waiting.inputs
        }
        ends = np.cumsum([len(part) for part in batch])
        return np.split(self._extractor.infer(joined), ends[:-1])


def _fail(waiting: Waiting, error: Exception) -> None:
    if not waiting.answer.done():
        waiting.answer.set_exception(error)
