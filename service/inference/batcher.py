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
class PendingSegments:
    """Segments of one request that wait for their descriptors.

    Attributes:
        inputs: network inputs of all segments.
        timing: stopwatch of the request.
        answer: future of the descriptors.
        taken: number of segments that went into batches so far.
        found: descriptors so far, one array per batch.
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
        """Return the number of segments that are not in a batch yet."""
        return len(self) - self.taken


@dataclass(frozen=True, slots=True, eq=False)
class BatchSlice:
    """Segments of one request in one batch: those from `start` to `stop`."""

    pending: PendingSegments
    start: int
    stop: int

    def __len__(self) -> int:
        return self.stop - self.start


class Batcher:
    """Runs a model on one batch at a time; the model itself spreads a batch over the cores.

    A batcher belongs to one event loop.
    """

    def __init__(self, extractor: Extractor, metrics: Metrics, most: int) -> None:
        """Create the batcher of a model.

        Args:
            extractor: the model.
            metrics: counters of batches.
            most: largest number of segments in a batch.
        """
        self._extractor = extractor
        self._metrics = metrics
        self._most = most
        self._queue: deque[PendingSegments] = deque()
        self._at_work: asyncio.Task[None] | None = None

    async def infer(self, inputs: Inputs, timing: Timing) -> Float32:
        """Return descriptors of prepared segments, float32 (rows, dimension).

        A call that is cancelled while it waits is left out of the batches that follow.
        """
        pending = PendingSegments(inputs, timing, asyncio.get_running_loop().create_future())
        self._queue.append(pending)
        self._metrics.queue_segments.inc(len(pending))
        if self._at_work is None:
            # The task has its own context, since it works for all requests, not for the first one.
            self._at_work = asyncio.create_task(self._work(), context=contextvars.Context())
        return await pending.answer

    async def _work(self) -> None:
        try:
            while batch := self._take():
                await self._run(batch)
        finally:
            self._at_work = None

    def _take(self) -> list[BatchSlice]:
        """Take a part of the longest waiting requests; unfinished requests go to the end."""
        batch: list[BatchSlice] = []
        rest: list[PendingSegments] = []
        room = self._most
        while self._queue and room > 0:
            pending = self._queue[0]
            size = min(pending.left, PART, self._most)
            if pending.answer.done():
                size = pending.left  # the call was cancelled: all its segments leave the queue
            elif batch and size > room:
                break
            self._queue.popleft()
            self._metrics.queue_segments.dec(size)
            start, pending.taken = pending.taken, pending.taken + size
            if pending.answer.done():
                continue
            batch.append(BatchSlice(pending, start, start + size))
            room -= size
            if pending.left:
                rest.append(pending)
        self._queue.extend(rest)
        return batch

    async def _run(self, batch: list[BatchSlice]) -> None:
        for part in batch:
            part.pending.timing.lap("queue")
        try:
            found = await anyio.to_thread.run_sync(self._infer, batch)
        except Exception as error:
            if len(batch) == 1:
                _fail(batch[0].pending, error)
                return
            # One request must not make the others fail: run each by itself.
            for part in batch:
                await self._run([part])
            return
        self._metrics.batch_requests.observe(len(batch))
        self._metrics.batch_segments.observe(sum(map(len, batch)))
        for part, descriptors in zip(batch, found, strict=True):
            pending = part.pending
            pending.timing.lap("infer")
            pending.found.append(descriptors)
            if part.stop == len(pending) and not pending.answer.done():
                pending.answer.set_result(
                    pending.found[0] if len(pending.found) == 1 else np.concatenate(pending.found)
                )

    def _infer(self, batch: list[BatchSlice]) -> list[Float32]:
        joined = {
            name: np.concatenate(
                [part.pending.inputs[name][part.start : part.stop] for part in batch]
            )
            for name in batch[0].pending.inputs
        }
        ends = np.cumsum([len(part) for part in batch])
        return np.split(self._extractor.infer(joined), ends[:-1])


def _fail(pending: PendingSegments, error: Exception) -> None:
    if not pending.answer.done():
        pending.answer.set_exception(error)
