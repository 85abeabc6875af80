"""Dynamic batching: batches form under load, and a bad request fails alone."""

import asyncio
import threading
from typing import Any

import numpy as np
import pytest
from prometheus_client import CollectorRegistry

from placecell.core.types import Float32
from placecell.descriptors.extractor import Extractor, Inputs
from service.core.metrics import Metrics
from service.core.timing import Timing
from service.inference.batcher import Batcher


class Doubling(Extractor):
    """Extractor that doubles its input; it waits for a signal and records the batches."""

    def __init__(self) -> None:
        self.batches: list[int] = []
        self.entered = threading.Event()
        self.go_on = threading.Event()
        self.go_on.set()

    def prepare(self, *_: Any, **__: Any) -> Inputs:
        raise NotImplementedError

    def infer(self, inputs: Inputs) -> Float32:
        self.entered.set()
        assert self.go_on.wait(60)
        rows = inputs["x"]
        self.batches.append(len(rows))
        if (rows < 0).any():
            raise ValueError("negative")
        return 2 * np.asarray(rows, np.float32)


def rows(first: float, count: int = 1) -> Inputs:
    return {"x": np.full((count, 3), first, np.float32)}


def sample(registry: CollectorRegistry, name: str) -> float:
    value = registry.get_sample_value(name)
    assert value is not None
    return value


async def gather_behind(model: Doubling, batcher: Batcher, *inputs: Inputs) -> list[Any]:
    """Return the results of requests that arrive while the model computes another one."""
    model.go_on.clear()
    model.entered.clear()
    first = asyncio.create_task(batcher.infer(rows(0), Timing()))
    await asyncio.to_thread(model.entered.wait)
    others = [asyncio.create_task(batcher.infer(each, Timing())) for each in inputs]
    await asyncio.sleep(0)
    model.go_on.set()
    await first
    return await asyncio.gather(*others, return_exceptions=True)


def test_requests_during_inference_form_one_batch() -> None:
    model, metrics = Doubling(), Metrics()

    async def run() -> list[Any]:
        batcher = Batcher(model, metrics, most=10)
        return await gather_behind(model, batcher, *[rows(n, n) for n in range(1, 6)])

    found = asyncio.run(run())
    # One alone at once; then 1 + 2 + 3 + 4, for 5 more would be too many; then 5.
    assert model.batches == [1, 10, 5]
    for n, descriptors in enumerate(found, 1):
        assert descriptors.tolist() == [[2.0 * n] * 3] * n
    assert sample(metrics.registry, "placecell_queue_segments") == 0
    assert sample(metrics.registry, "placecell_batch_requests_count") == 3
    assert sample(metrics.registry, "placecell_batch_requests_sum") == 6
    assert sample(metrics.registry, "placecell_batch_segments_sum") == 16


def test_request_larger_than_a_batch_is_computed_in_parts() -> None:
    model = Doubling()
    asked = {"x": np.arange(27, dtype=np.float32).reshape(9, 3)}
    found = asyncio.run(Batcher(model, Metrics(), most=4).infer(asked, Timing()))
    np.testing.assert_array_equal(found, 2 * asked["x"])
    assert model.batches == [4, 4, 1]


def test_A4_small_request_does_not_wait_for_the_end_of_a_large_one() -> None:
    """Row A4, limits on work: a large request takes its turn with those that come later."""
    model, done = Doubling(), []

    async def asked(name: str, batcher: Batcher, count: int) -> None:
        await batcher.infer(rows(1, count), Timing())
        done.append((name, len(model.batches)))

    async def run() -> None:
        batcher = Batcher(model, Metrics(), most=4)
        model.go_on.clear()
        large = asyncio.create_task(asked("large", batcher, 40))
        await asyncio.to_thread(model.entered.wait)
        small = asyncio.create_task(asked("small", batcher, 1))
        await asyncio.sleep(0)
        model.go_on.set()
        await asyncio.gather(large, small)

    asyncio.run(run())
    assert done[0][0] == "small"
    assert done[0][1] <= 3


def test_cancelled_request_stops_between_its_parts() -> None:
    model, metrics = Doubling(), Metrics()

    async def run() -> None:
        batcher = Batcher(model, metrics, most=4)
        model.go_on.clear()
        large = asyncio.create_task(batcher.infer(rows(1, 40), Timing()))
        await asyncio.to_thread(model.entered.wait)
        large.cancel()
        await asyncio.sleep(0)
        model.go_on.set()
        await batcher.infer(rows(2), Timing())

    asyncio.run(run())
    assert model.batches == [4, 1]
    assert sample(metrics.registry, "placecell_queue_segments") == 0


def test_bad_request_in_a_batch_fails_alone() -> None:
    model = Doubling()

    async def run() -> list[Any]:
        batcher = Batcher(model, Metrics(), most=10)
        return await gather_behind(model, batcher, rows(1), rows(-1), rows(3))

    good, bad, other = asyncio.run(run())
    assert good.tolist() == [[2.0] * 3]
    assert isinstance(bad, ValueError)
    assert other.tolist() == [[6.0] * 3]


def test_cancelled_request_is_left_out_of_the_batch() -> None:
    model, metrics = Doubling(), Metrics()

    async def run() -> None:
        batcher = Batcher(model, metrics, most=10)
        model.go_on.clear()
        first = asyncio.create_task(batcher.infer(rows(0), Timing()))
        await asyncio.to_thread(model.entered.wait)
        gone = asyncio.create_task(batcher.infer(rows(7, 5), Timing()))
        await asyncio.sleep(0)
        gone.cancel()
        await asyncio.sleep(0)
        model.go_on.set()
        await first
        with pytest.raises(asyncio.CancelledError):
            await gone
        # The batcher is free again for the next.
        assert (await batcher.infer(rows(2), Timing())).tolist() == [[4.0] * 3]

    asyncio.run(run())
    assert model.batches == [1, 1]
    assert sample(metrics.registry, "placecell_queue_segments") == 0


def test_laps_separate_waiting_from_inference() -> None:
    model, timing = Doubling(), Timing()
    asyncio.run(Batcher(model, Metrics(), most=4).infer(rows(1), timing))
    assert [stage for stage, _ in timing.items()] == ["queue", "infer"]
    assert timing.header().startswith("queue;dur=")
