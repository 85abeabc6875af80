"""Open-loop load generator, a process of its own: `python -m benchmarks.load.generator PLAN`.

Requests leave when they are due, whether or not the answers to earlier ones came; a latency counts
from when the request was due. Bodies were encoded beforehand, and the protocol is spoken in a few
lines, for the generator shares the machine with what it measures.
"""

import asyncio
import json
import pickle
import sys
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any


@dataclass(frozen=True, slots=True)
class Load:
    """What is sent.

    Attributes:
        host, port: of the service.
        requests: whole requests, head and body; sent in turn.
        rate: requests a second; 0: as many as `clients` can send, each after its last answer.
        seconds: for so long.
        clients: that send where there is no rate.
        most: connections at once; who finds none free waits, and that counts.
    """

    host: str
    port: int
    requests: tuple[bytes, ...]
    rate: float
    seconds: float
    most: int = 256
    clients: int = 16


@dataclass(slots=True)
class LoadResult:
    """What became of the requests that were due, in the order of their answers.

    Attributes:
        statuses: of HTTP; 0 where the connection failed.
        milliseconds: from when each was due to its answer.
        stages: of each step that the service tells, milliseconds of every good answer.
        elapsed: seconds until the last answer.
        cpu: seconds of processor time that the generator itself took.
    """

    statuses: list[int] = field(default_factory=list)
    milliseconds: list[float] = field(default_factory=list)
    stages: dict[str, list[float]] = field(default_factory=dict)
    elapsed: float = 0.0
    cpu: float = 0.0


Connection = tuple[asyncio.StreamReader, asyncio.StreamWriter]


async def send_load(load: Load) -> LoadResult:
    """Send all that is due."""
    outcome, free = LoadResult(), list[Connection]()
    places = asyncio.Semaphore(load.most)
    started, computed = time.perf_counter(), time.process_time()

    async def one(number: int, due: float) -> None:
        async with places:
            status, head = await _ask(load, load.requests[number % len(load.requests)], free)
        outcome.statuses.append(status)
        outcome.milliseconds.append(1e3 * (time.perf_counter() - due))
        if status == 200:
            for part in head.get("server-timing", "").split(", "):
                stage, _, spent = part.partition(";dur=")
                outcome.stages.setdefault(stage, []).append(float(spent))

    async def again_and_again(first: int) -> None:
        number = first
        while (due := time.perf_counter()) < started + load.seconds:
            await one(number, due)
            number += load.clients

    async with asyncio.TaskGroup() as group:
        if not load.rate:
            for first in range(load.clients):
                group.create_task(again_and_again(first))
        for number in range(int(load.rate * load.seconds)):
            due = started + number / load.rate
            await asyncio.sleep(due - time.perf_counter())
            group.create_task(one(number, due))
    outcome.elapsed = time.perf_counter() - started
    outcome.cpu = time.process_time() - computed
    for _, writer in free:
        writer.close()
    await asyncio.sleep(0)  # so that they are closed before the loop is
    return outcome


async def _ask(load: Load, request: bytes, free: list[Connection]) -> tuple[int, dict[str, str]]:
    """Status and headers of the answer; the body is read and dropped."""
    # A server closes connections that were idle for long; as clients do, ask again on a new one.
    if free and (answer := await _ask_on(free.pop(), request, free))[0]:
        return answer
    try:
        fresh = await asyncio.open_connection(load.host, load.port, limit=1 << 20)
    except OSError:
        return 0, {}
    return await _ask_on(fresh, request, free)


async def _ask_on(
    connection: Connection, request: bytes, free: list[Connection]
) -> tuple[int, dict[str, str]]:
    reader, writer = connection
    try:
        writer.write(request)
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
        pairs = (line.split(": ", 1) for line in head[1:] if line)
        headers = {name.lower(): value for name, value in pairs}
        await reader.readexactly(int(headers.get("content-length", 0)))
        if headers.get("connection") == "close":
            writer.close()
        else:
            free.append((reader, writer))
        return int(head[0].split()[1]), headers
    except (OSError, asyncio.IncompleteReadError):
        writer.close()
        return 0, {}


def encode_request(path: str, media_type: str, body: bytes) -> bytes:
    """A whole request, head and body."""
    head = (
        f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: {media_type}\r\n"
        f"Accept: {media_type}\r\nContent-Length: {len(body)}\r\n\r\n"
    )
    return head.encode() + body


async def send_from_process(load: Load, folder: Path) -> LoadResult:
    """The same from a process of its own."""
    file = folder / "load.pickle"
    file.write_bytes(pickle.dumps(load))
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "benchmarks.load.generator", str(file)),
        stdout=asyncio.subprocess.PIPE,
    )
    said, _ = await process.communicate()
    if process.returncode:
        raise RuntimeError(f"the load generator ended with status {process.returncode}")
    content: dict[str, Any] = json.loads(said)
    return LoadResult(**content)


if __name__ == "__main__":
    # Written by `sent_by_process` a moment ago, for this process alone.
    plan = pickle.loads(Path(sys.argv[1]).read_bytes())
    json.dump(asdict(asyncio.run(send_load(plan))), sys.stdout)
