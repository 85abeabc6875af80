"""Searches by several threads give the same results, in the same order, and can be cancelled."""

import threading
import time
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks.storage.search_scale import are_equal, snapshot_of
from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by, current
from placecell.core.types import Int8
from placecell.descriptors.manifest import Manifest
from service.maps.snapshot import MapSnapshot
from service.search import localization, matching, parallel
from service.search.matching import nearest_segments
from service.search.parallel import AHEAD, CORES, in_threads
from tests.service.service_builders import random_codes


def snapshots_of(
    manifest: Manifest, maps: int, segments: int, queries: int
) -> tuple[tuple[MapSnapshot, ...], Int8, Any]:
    """Return maps, the codes of a request, and their model; some maps have the same segments."""
    width = manifest.dimension // manifest.quantizer.per_byte
    searched = tuple(
        snapshot_of(f"map-{each}", random_codes(segments, each % 4, width), manifest)
        for each in range(maps)
    )
    codes = random_codes(queries, 99, width)
    return searched, codes, SimpleNamespace(manifest=manifest, id="m")


def test_results_come_in_the_order_of_the_items() -> None:
    def slow_first(item: int) -> int:
        time.sleep(0.02 if item == 0 else 0.0)
        return 2 * item

    assert [*in_threads(slow_first, range(50))] == [2 * item for item in range(50)]
    assert [*in_threads(slow_first, [])] == []


def test_few_results_are_computed_ahead() -> None:
    begun: list[int] = []
    taken = in_threads(begun.append, range(100))
    next(taken)
    time.sleep(0.05)
    assert len(begun) <= AHEAD + 2
    taken.close()  # type: ignore[attr-defined]
    time.sleep(0.05)
    assert len(begun) <= AHEAD + 2


def test_at_most_one_thread_a_core_computes() -> None:
    at_once, most = 0, 0
    lock = threading.Lock()

    def count(_: int) -> None:
        nonlocal at_once, most
        with lock:
            at_once += 1
            most = max(most, at_once)
        time.sleep(0.002)
        with lock:
            at_once -= 1

    [*in_threads(count, range(40))]
    assert most <= CORES


def test_work_finds_the_token_of_its_request() -> None:
    token = CancelToken()
    with cancelled_by(token):
        assert all(found is token for found in in_threads(lambda _: current(), range(9)))


def test_cancelled_request_ends_the_search() -> None:
    token, done = CancelToken(), list[int]()

    def work(item: int) -> None:
        done.append(item)
        if item == 3:
            token.cancel()

    with cancelled_by(token), pytest.raises(Cancelled):
        [*in_threads(work, range(1_000))]
    assert len(done) < 20


def test_error_of_one_item_is_raised() -> None:
    def work(item: int) -> int:
        return 1 // (item - 2)

    with pytest.raises(ZeroDivisionError):
        [*in_threads(work, range(5))]


def test_threads_make_no_difference_to_candidates(
    manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    searched, codes, model = snapshots_of(manifest, maps=7, segments=400, queries=30)
    monkeypatch.setattr(parallel, "PARALLEL", 1 << 62)
    alone = nearest_segments(codes, model, searched, 10)
    used: list[object] = []

    def noted(work: object, items: object) -> object:
        used.append(items)
        return in_threads(work, items)  # type: ignore[arg-type]

    monkeypatch.setattr(parallel, "PARALLEL", 1)
    monkeypatch.setattr(matching, "in_threads", noted)
    together = nearest_segments(codes, model, searched, 10)
    assert used
    assert are_equal(alone, together)
    # Segments that two maps share are equally near: the first map wins.
    assert len(np.unique(together.places)) > 1


def test_small_search_takes_no_thread(manifest: Manifest, monkeypatch: pytest.MonkeyPatch) -> None:
    searched, codes, model = snapshots_of(manifest, maps=3, segments=50, queries=4)

    def refuse(*_: object) -> object:
        raise AssertionError("a small search must not wait for other threads")

    for module in (matching, localization):
        monkeypatch.setattr(module, "in_threads", refuse)
    found = nearest_segments(codes, model, searched, 5)
    assert found.rows.shape == (4, 5)
    assert parallel.PARALLEL > 4 * 3 * 50
