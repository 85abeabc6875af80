"""Soak test: minutes of steady load with faulty clients among the correct ones.

Correct clients offer a fixed share of the saturation rate. Meanwhile some clients disconnect within
a request, some send slowly, and some send garbage. The test watches memory, file descriptors and
all answers.
"""

import asyncio
import random
import tempfile
import urllib.request
from collections import Counter
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.load.generator import Load, LoadResult, send_from_process
from benchmarks.load.serve import LoadPlan, percentiles
from benchmarks.load.workload import LoadCase, match_requests, store_map
from benchmarks.scans import draw_scans
from evaluation.figure import figure
from evaluation.machine import machine
from placecell.core.segments import Segments
from service.api.body.body import MSGPACK
from service.child_process import address_of, running_service

Reader = asyncio.StreamReader
Writer = asyncio.StreamWriter

EXPECTED = {200, 429}
"""Statuses that correct clients may get."""


@dataclass(frozen=True, slots=True)
class SoakPlan:
    """Load and faulty clients of a soak test.

    Attributes:
        seconds: duration of the test.
        share: load of the correct clients, as a share of the saturation rate.
        bad_clients: number of concurrent clients of each faulty kind.
        every: interval between two reads of the process metrics, seconds.
        full: duration of the full load that first measures the saturation rate, seconds.
    """

    seconds: float = 600.0
    share: float = 0.8
    bad_clients: int = 2
    every: float = 5.0
    full: float = 10.0


def run_soak(scans: Sequence[Segments], plan: SoakPlan, seed: int = 0) -> dict[str, Any]:
    """Run the soak test; return the report that `placecell bench soak` writes."""
    shape = LoadPlan()
    drawn = Segments.concatenate(draw_scans(scans, shape.segments * shape.bodies, seed))
    sent = match_requests(
        LoadCase(MSGPACK, shape.segments, batching=True), drawn, shape.bodies, shape.k
    )
    with (
        tempfile.TemporaryDirectory(prefix="placecell-soak-") as folder,
        running_service(Path(folder)) as address,
    ):
        store_map(address, drawn, shape.map_segments, seed)
        outcome, watched, bad = asyncio.run(_run(address, sent, plan, Path(folder), seed))
    statuses = Counter(outcome.statuses)
    memory = [each["resident_mb"] for each in watched]
    half = len(memory) // 2
    return {
        "seconds": plan.seconds,
        "requests": len(outcome.statuses),
        "statuses": {str(status): count for status, count in sorted(statuses.items())},
        "unexpected": sum(count for status, count in statuses.items() if status not in EXPECTED),
        "milliseconds": percentiles(
            np.array(outcome.milliseconds)[np.array(outcome.statuses) == 200]
        ),
        "bad_clients": {kind: dict(told) for kind, told in bad.items()},
        "memory_mb_first_half": round(float(np.median(memory[:half])), 1),
        "memory_mb_second_half": round(float(np.median(memory[half:])), 1),
        "descriptors_most": max(each["descriptors"] for each in watched),
        "descriptors_last": watched[-1]["descriptors"],
        "watched": watched,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


async def _run(
    address: str, sent: tuple[bytes, ...], plan: SoakPlan, folder: Path, seed: int
) -> tuple[LoadResult, list[dict[str, float]], dict[str, Counter[str]]]:
    host, port = address_of(address)
    full = await send_from_process(Load(host, port, sent, 0, plan.full), folder)
    rate = plan.share * full.statuses.count(200) / full.elapsed
    bad: dict[str, Counter[str]] = {kind: Counter() for kind in BAD}
    watched: list[dict[str, float]] = []

    async def watch() -> None:
        passed = 0.0
        while True:
            watched.append(
                {"seconds": passed} | await asyncio.to_thread(read_process_metrics, address)
            )
            await asyncio.sleep(plan.every)
            passed += plan.every

    async def misbehave(kind: str, draw: random.Random) -> None:
        while True:
            try:
                reader, writer = await asyncio.open_connection(host, port)
                try:
                    status = await BAD[kind](reader, writer, draw.choice(sent), draw)
                finally:
                    writer.transport.abort()
            except OSError:
                status = "refused"
            bad[kind][status] += 1
            await asyncio.sleep(draw.uniform(0.05, 0.5))

    others = [asyncio.create_task(watch())]
    for number in range(plan.bad_clients):
        draw = random.Random(seed + number)
        others += [asyncio.create_task(misbehave(kind, draw)) for kind in BAD]
    outcome = await send_from_process(Load(host, port, sent, rate, plan.seconds), folder)
    for other in others:
        other.cancel()
    await asyncio.gather(*others, return_exceptions=True)
    await asyncio.sleep(2 * plan.every)
    last = {"seconds": plan.seconds + 2 * plan.every} | await asyncio.to_thread(
        read_process_metrics, address
    )
    return outcome, [*watched, last], bad


async def abort_request(reader: Reader, writer: Writer, request: bytes, draw: random.Random) -> str:
    """Disconnect within a request or before its answer."""
    del reader
    writer.write(request[: draw.randrange(1, len(request) + 1)])
    await writer.drain()
    await asyncio.sleep(draw.uniform(0, 0.05))
    return "gone"


async def send_slowly(reader: Reader, writer: Writer, request: bytes, draw: random.Random) -> str:
    """Send a request in ten parts with pauses."""
    step = -(-len(request) // 10)
    for start in range(0, len(request), step):
        writer.write(request[start : start + step])
        await writer.drain()
        await asyncio.sleep(draw.uniform(0, 0.2))
    return await _status(reader)


async def send_garbage(reader: Reader, writer: Writer, request: bytes, draw: random.Random) -> str:
    """Send random bytes, or a request with some bytes of its body altered."""
    if draw.random() < 0.5:
        writer.write(draw.randbytes(draw.randrange(1, 5000)) + b"\r\n\r\n")
    else:
        altered = bytearray(request)
        # The first bytes of the body name its fields.
        start = request.index(b"\r\n\r\n") + 4
        altered[start + draw.randrange(20)] = draw.randrange(256)
        for _ in range(20):
            altered[draw.randrange(len(request) // 2, len(request))] = draw.randrange(256)
        writer.write(bytes(altered))
    return await _status(reader)


async def _status(reader: Reader) -> str:
    try:
        line = await asyncio.wait_for(reader.readline(), 30)
    except (OSError, TimeoutError):
        line = b""
    return line.split()[1].decode() if line else "closed"


Bad = Callable[[Reader, Writer, bytes, random.Random], Awaitable[str]]

BAD: dict[str, Bad] = {"dies": abort_request, "dawdles": send_slowly, "babbles": send_garbage}


def read_process_metrics(address: str) -> dict[str, float]:
    """Return the service's resident memory and open file descriptors, from its metrics."""
    with urllib.request.urlopen(f"{address}/metrics", timeout=30) as answer:
        lines = answer.read().decode().splitlines()
    found = dict(line.rsplit(" ", 1) for line in lines if not line.startswith("#"))
    return {
        "resident_mb": round(float(found["process_resident_memory_bytes"]) / 1e6, 1),
        "descriptors": float(found["process_open_fds"]),
    }


def draw_memory(report: dict[str, Any], file: Path) -> None:
    """Plot memory and file descriptors over time."""
    seconds = [each["seconds"] for each in report["watched"]]
    with figure(file, 2) as (left, right):
        left.plot(seconds, [each["resident_mb"] for each in report["watched"]])
        left.set(xlabel="time, seconds", ylabel="resident memory, MB", ylim=(0, None))
        right.plot(seconds, [each["descriptors"] for each in report["watched"]])
        right.set(xlabel="time, seconds", ylabel="open file descriptors", ylim=(0, None))
        for axes in (left, right):
            axes.grid(alpha=0.3)
