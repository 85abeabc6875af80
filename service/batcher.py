"""Micro-batching: what all requests want of a model, computed together.

Nobody waits while the model is idle. While it computes, what arrives gathers, and goes together.
"""

import asyncio
from collections import deque
from dataclasses import dataclass

import anyio.to_thread
import numpy as np

from segments.extractor import Extractor, Inputs
from segments.types import Float32
from service.metrics import Metrics
from service.timing import Timing


@dataclass(frozen=True, slots=True, eq=False)
class Waiting:
    """One request's inputs, and where its descriptors are awaited."""

    inputs: Inputs
    timing: Timing
    answer: asyncio.Future[Float32]

    def __len__(self) -> int:
        return len(next(iter(self.inputs.values())))


class Batcher:
    """Gives a model its work, one batch at a time; the model itself spreads it over the cores.

    Belongs to one event loop.
    """

    def __init__(self, extractor: Extractor, metrics: Metrics, most: int) -> None:
        """Of a model.

        Args:
            most: segments of a batch, unless a single request has more.
        """
        self._extractor = extractor
        self._metrics = metrics
        self._most = most
        self._queue: deque[Waiting] = deque()
        self._at_work: asyncio.Task[None] | None = None

    async def infer(self, inputs: Inputs, timing: Timing) -> Float32:
        """Descriptors of prepared segments, float32 (rows, dimension).

        Cancelled while it waits, it is left out.
        """
        waiting = Waiting(inputs, timing, asyncio.get_running_loop().create_future())
        self._queue.append(waiting)
        self._metrics.queue_segments.inc(len(waiting))
        if self._at_work is None:
            self._at_work = asyncio.create_task(self._work())
        return await waiting.answer

    async def _work(self) -> None:
        try:
            while batch := self._take():
                await self._run(batch)
        finally:
            self._at_work = None

    def _take(self) -> list[Waiting]:
        """The longest waiting, as many as make a batch; those who wait no more are dropped."""
        batch: list[Waiting] = []
        while self._queue:
            if batch and sum(map(len, batch)) + len(self._queue[0]) > self._most:
                break
            waiting = self._queue.popleft()
            self._metrics.queue_segments.dec(len(waiting))
            if not waiting.answer.done():
                batch.append(waiting)
        return batch

    async def _run(self, batch: list[Waiting]) -> None:
        for waiting in batch:
            waiting.timing.lap("queue")
        try:
            found = await anyio.to_thread.run_sync(self._infer, batch)
        except Exception as error:
            if len(batch) == 1:
                _fail(batch[0], error)
                return
            # Whoever's fault it was: the others must not suffer.
            for waiting in batch:
                await self._run([waiting])
            return
        self._metrics.batch_requests.observe(len(batch))
        self._metrics.batch_segments.observe(sum(map(len, batch)))
        for waiting, descriptors in zip(batch, found, strict=True):
            waiting.timing.lap("infer")
            if not waiting.answer.done():
                waiting.answer.set_result(descriptors)

    def _infer(self, batch: list[Waiting]) -> list[Float32]:
        names = batch[0].inputs
        joined = {name: np.concatenate([each.inputs[name] for each in batch]) for name in names}
        ends = np.cumsum([len(each) for each in batch])
        return np.split(self._extractor.infer(joined), ends[:-1])


def _fail(waiting: Waiting, error: Exception) -> None:
    if not waiting.answer.done():
        waiting.answer.set_exception(error)
