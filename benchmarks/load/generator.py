"""Open-loop load generator in its own process: `python -m benchmarks.load.generator PLAN`.

Each request is sent at its due time, even if earlier requests are unanswered. Latency counts from
the due time. The generator shares the machine with the service, so it does little work itself: all
bodies are encoded before the start, and HTTP takes a few lines of code.
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
    """Load to send.

    Attributes:
        host, port: address of the service.
        requests: encoded requests, head and body; sent in turn.
        rate: requests per second; 0: each of `clients` clients sends its next request after the
            last answer.
        seconds: duration.
        max_connections: largest number of open connections. A request that waits for a free
            connection counts the wait as latency.
        clients: number of clients if `rate` is 0.
    """

    host: str
    port: int
    requests: tuple[bytes, ...]
    rate: float
    seconds: float
    max_connections: int = 256
    clients: int = 16


@dataclass(slots=True)
class LoadResult:
    """Answers to the requests, in the order of arrival.

    Attributes:
        statuses: HTTP status of each request; 0 if the connection failed.
        milliseconds: time from the due time to the answer, per request.
        stages: milliseconds of each stage in `Server-Timing`, per successful request.
        elapsed: seconds until the last answer.
        cpu: processor time of the generator itself, seconds.
    """

    statuses: list[int] = field(default_factory=list)
    milliseconds: list[float] = field(default_factory=list)
    stages: dict[str, list[float]] = field(default_factory=dict)
    elapsed: float = 0.0
    cpu: float = 0.0


Connection = tuple[asyncio.StreamReader, asyncio.StreamWriter]


async def send_load(load: Load) -> LoadResult:
    """Send the load and collect the answers."""
    outcome, free = LoadResult(), list[Connection]()
    places = asyncio.Semaphore(load.max_connections)
    started, computed = time.perf_counter(), time.process_time()

    async def send_one(number: int, due: float) -> None:
        async with places:
            status, head = await _ask(load, load.requests[number % len(load.requests)], free)
        outcome.statuses.append(status)
        outcome.milliseconds.append(1e3 * (time.perf_counter() - due))
        if status == 200:
            for part in head.get("server-timing", "").split(", "):
                stage, _, spent = part.partition(";dur=")
                outcome.stages.setdefault(stage, []).append(float(spent))

    async def send_repeatedly(first: int) -> None:
        number = first
        while (due := time.perf_counter()) < started + load.seconds:
            await send_one(number, due)
            number += load.clients

    async with asyncio.TaskGroup() as group:
        if not load.rate:
            for first in range(load.clients):
                group.create_task(send_repeatedly(first))
        for number in range(round(load.rate * load.seconds)):
            due = started + number / load.rate
            await asyncio.sleep(due - time.perf_counter())
            group.create_task(send_one(number, due))
    outcome.elapsed = time.perf_counter() - started
    outcome.cpu = time.process_time() - computed
    for _, writer in free:
        writer.close()
    await asyncio.sleep(0)  # lets the connections close before the loop does
    return outcome


async def _ask(load: Load, request: bytes, free: list[Connection]) -> tuple[int, dict[str, str]]:
    """Send a request; return the status and headers of the answer, without its body."""
    # A server closes idle connections. Like other clients, retry on a new connection.
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
    """Return an encoded POST request, head and body."""
    head = (
        f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: {media_type}\r\n"
        f"Accept: {media_type}\r\nContent-Length: {len(body)}\r\n\r\n"
    )
    return head.encode() + body


async def send_from_process(load: Load, folder: Path) -> LoadResult:
    """Send the load from a process of its own, as `send_load` does.

    Args:
        load: load to send.
        folder: folder for the plan file.

    Raises:
        RuntimeError: the process failed.
    """
    file = folder / "load.pickle"
    file.write_bytes(pickle.dumps(load))
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        "benchmarks.load.generator",
        str(file),
        stdout=asyncio.subprocess.PIPE,
    )
    output, _ = await process.communicate()
    if process.returncode:
        raise RuntimeError(f"The load generator failed with exit status {process.returncode}.")
    content: dict[str, Any] = json.loads(output)
    return LoadResult(**content)


if __name__ == "__main__":
    # `send_from_process` wrote this file for this process only.
    plan = pickle.loads(Path(sys.argv[1]).read_bytes())
    json.dump(asdict(asyncio.run(send_load(plan))), sys.stdout)
