"""Fair threads: no client can occupy all threads or places."""

import asyncio
import threading
from typing import Any

import pytest

from service.api.admission import fair_threads
from service.api.admission.fair_threads import FairThreads


def run(main: Any) -> Any:
    async def bounded() -> Any:
        async with asyncio.timeout(60):
            return await main()

    return asyncio.run(bounded())


def test_A4_one_client_never_holds_all_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """With 2 threads, another client's call runs while one client's calls do not end."""
    monkeypatch.setattr(fair_threads, "LONG_SECONDS", 1e9)
    release = threading.Event()

    async def main() -> None:
        threads = FairThreads(2)
        held = [asyncio.create_task(threads.run("a", lambda: release.wait(60))) for _ in range(20)]
        await asyncio.sleep(0.05)
        assert await threads.run("b", lambda: 7) == 7
        release.set()
        await asyncio.gather(*held)

    run(main)


def test_long_call_gives_up_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small calls of a client do not wait for the end of its large calls."""
    monkeypatch.setattr(fair_threads, "LONG_SECONDS", 0.02)
    release = threading.Event()

    async def main() -> None:
        threads = FairThreads(2)
        held = [asyncio.create_task(threads.run("a", lambda: release.wait(60))) for _ in range(2)]
        await asyncio.sleep(0)
        assert await threads.run("a", lambda: 7) == 7
        release.set()
        await asyncio.gather(*held)

    run(main)


def test_waiting_calls_start_round_robin(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fair_threads, "LONG_SECONDS", 1e9)
    # The order of the starts. The system decides which of two running threads comes first.
    order: list[str] = []
    start = FairThreads._start

    def noted(self: FairThreads, kind: tuple[str, bool]) -> object:
        order.append(kind[0])
        return start(self, kind)

    monkeypatch.setattr(FairThreads, "_start", noted)

    async def main() -> None:
        threads, release = FairThreads(1), threading.Event()
        # Four clients occupy all threads, as many as may run at once.
        held = [asyncio.create_task(threads.run(name, lambda: release.wait(60))) for name in "wxyz"]
        await asyncio.sleep(0.05)
        calls = [asyncio.create_task(threads.run(name, lambda: None)) for name in "aaaaabbc"]
        await asyncio.sleep(0)
        release.set()
        await asyncio.gather(*held, *calls)

    run(main)
    assert order[:4] == list("wxyz")
    assert sorted(order[4:]) == list("aaaaabbc")
    assert set(order[4:7]) == {"a", "b", "c"}


def test_call_cancelled_while_waiting_is_not_started(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fair_threads, "LONG_SECONDS", 1e9)
    started: list[int] = []

    async def main() -> None:
        threads, release = FairThreads(1), threading.Event()
        held = asyncio.create_task(threads.run("a", lambda: release.wait(60)))
        await asyncio.sleep(0.02)
        gone = asyncio.create_task(threads.run("a", lambda: started.append(1)))
        stays = asyncio.create_task(threads.run("a", lambda: started.append(2)))
        await asyncio.sleep(0)
        gone.cancel()
        release.set()
        await asyncio.gather(held, stays)
        with pytest.raises(asyncio.CancelledError):
            await gone
        assert await threads.run("a", lambda: 3) == 3
        assert not threads._started
        assert not threads._waiting

    run(main)
    assert started == [2]


def test_failed_call_frees_its_place() -> None:
    async def main() -> None:
        threads = FairThreads(1)
        for _ in range(9):
            with pytest.raises(ZeroDivisionError):
                await threads.run("a", lambda: 1 // 0)
        assert await threads.run("a", lambda: 3) == 3

    run(main)


def test_heavy_calls_leave_places_for_light_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    """Heavy calls take no place from running calls, so their memory is bounded."""
    monkeypatch.setattr(fair_threads, "LONG_SECONDS", 0.001)
    release, lock = threading.Event(), threading.Lock()
    inside = most = 0

    def heavy() -> None:
        nonlocal inside, most
        with lock:
            inside += 1
            most = max(most, inside)
        release.wait(60)
        with lock:
            inside -= 1

    async def main() -> None:
        threads = FairThreads(2)
        held = [asyncio.create_task(threads.run("a", heavy, heavy=True)) for _ in range(6)]
        await asyncio.sleep(0.05)
        assert await threads.run("a", lambda: 7) == 7
        assert await threads.run("b", lambda: 7) == 7
        assert inside == 2
        assert await threads.run("b", lambda: 8, heavy=True) == 8
        release.set()
        await asyncio.gather(*held)

    run(main)
    assert most <= 4
