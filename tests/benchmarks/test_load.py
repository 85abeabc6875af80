"""Load generator, and short runs of the load benchmarks; times are not asserted."""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.load import serve, soak, workload
from benchmarks.load.generator import Load, LoadResult, encode_request, send_load
from benchmarks.load.rates import measure_rate
from placecell.core.segments import Segments

pytestmark = [pytest.mark.integration, pytest.mark.slow]


def scans(count: int) -> list[Segments]:
    """Return scans of ten boxes of points each, around the sensor."""
    random = np.random.default_rng(0)
    made = []
    for _ in range(count):
        clouds = [
            (random.uniform(-1, 1, (300, 3)) * random.uniform(0.3, 2, 3)
             + random.uniform(-15, 15, 3)).astype(np.float32)
            for _ in range(10)
        ]  # fmt: skip
        made.append(Segments.of(clouds, np.zeros((10, 3))))
    return made


async def measured(answer: Callable[[], Awaitable[bytes]], **load: Any) -> LoadResult:
    """Send a load to a server that gives this answer, and return the result."""

    async def serve_one(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with suppress(asyncio.IncompleteReadError):
            while await reader.readuntil(b"end"):
                writer.write(await answer())
        writer.close()

    server = await asyncio.start_server(serve_one, "127.0.0.1", 0)
    host, port = server.sockets[0].getsockname()
    outcome = await send_load(Load(host, port, (encode_request("/x", "a/b", b"end"),), **load))
    server.close()
    await asyncio.sleep(0.05)
    return outcome


def test_requests_are_sent_when_due_although_answers_are_late() -> None:
    arrived: list[float] = []

    async def slow() -> bytes:
        arrived.append(asyncio.get_running_loop().time())
        await asyncio.sleep(0.3)
        head = b"HTTP/1.1 429 Busy\r\nContent-Length: 2\r\nServer-Timing: a;dur=1\r\n\r\n"
        return head + b"no"

    outcome = asyncio.run(measured(slow, rate=50, seconds=0.2))
    assert outcome.statuses == [429] * 10
    # All requests arrived before the first answer was sent.
    assert max(arrived) - min(arrived) < 0.3
    assert min(outcome.milliseconds) >= 300
    assert not outcome.stages  # refusals have no stages


def test_without_a_rate_clients_wait_for_their_answers() -> None:
    inside, most = 0, 0

    async def answer() -> bytes:
        nonlocal inside, most
        inside += 1
        most = max(most, inside)
        await asyncio.sleep(0.02)
        inside -= 1
        return b"HTTP/1.1 200 OK\r\nContent-Length: 2\r\nServer-Timing: a;dur=1.5\r\n\r\nok"

    outcome = asyncio.run(measured(answer, rate=0, seconds=0.2, clients=3))
    assert most == 3
    assert set(outcome.statuses) == {200}
    assert outcome.stages["a"] == [1.5] * len(outcome.statuses)


def test_failed_connection_has_status_0() -> None:
    outcome = asyncio.run(send_load(Load("127.0.0.1", 1, (b"x",), 20, 0.1)))
    assert outcome.statuses == [0, 0]


@pytest.mark.integration
def test_short_load_run_measures_the_real_service(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        serve, "measure_rate", lambda pool, work, threads, _: measure_rate(pool, work, threads, 0.1)
    )
    plan = serve.LoadPlan(
        segments=10, small=2, map_segments=200, levels=(0.5, 3.0), seconds=0.5, bodies=3
    )
    report = serve.measure_load(scans(4), plan)
    assert len(report["rows"]) == 8
    for row in report["rows"]:
        assert not row["failed"]
        assert row["requests"] > 0
        assert {"decode", "queue", "infer", "search", "encode"} <= set(row["stages"])
    assert report["saturation_segments_per_second"] > 0
    assert report["match_50_p99_ms_at_half_saturation"] > 0
    serve.draw_load(report, tmp_path / "serve.png")
    assert (tmp_path / "serve.png").stat().st_size > 1000


@pytest.mark.integration
def test_short_soak_has_no_unexpected_answer(tmp_path: Path) -> None:
    report = soak.run_soak(scans(4), soak.SoakPlan(seconds=3.0, bad_clients=1, every=0.5, full=1.0))
    assert report["unexpected"] == 0
    told = {status for each in report["bad_clients"].values() for status in each}
    assert told <= {"gone", "200", "400", "413", "415", "422", "429"}
    assert report["descriptors_last"] <= report["descriptors_most"]
    soak.draw_memory(report, tmp_path / "soak.png")
    assert (tmp_path / "soak.png").stat().st_size > 1000


def test_perturbed_codes_differ_in_a_tenth_of_their_bytes() -> None:
    codes = np.random.default_rng(0).integers(-128, 128, (20, 32)).astype(np.int8)
    many = workload.perturbed(codes, 100, seed=1)
    changed = (many != codes[np.arange(100) % 20]).mean()
    assert 0.05 < changed < 0.15
    assert (many == workload.perturbed(codes, 100, seed=1)).all()
