"""Throughput of replicas behind the balancer, and the time until all of them know a write."""

import asyncio
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client, CompactMap, Delta, encode

from benchmarks.load.generator import Load, encode_request, send_from_process
from benchmarks.load.serve import percentiles
from benchmarks.replicas.balancer import running_balancer
from benchmarks.replicas.fleet_crash import running_fleet, scratch_folder
from benchmarks.replicas.replica_group import Replica, ReplicaGroup
from benchmarks.synthetic_maps.random_maps import MapTemplate
from placecell.core.types import Float64
from service.child_process import address_of

MSGPACK = "application/msgpack"

SITE = "site"
SEEN_SECONDS = 10.0
"""Longest wait until a replica knows a write, seconds."""

POLL_SECONDS = 0.001


@dataclass(frozen=True, slots=True)
class ReplicasPlan:
    """Extent of a measurement.

    Attributes:
        seconds: duration of each load.
        segments: segments of the map.
        around: segments of a request.
        requests: number of different requests.
        clients: number of clients that each send their next request after the last answer.
        writers: number of robots that write at once.
        writes: number of writes whose way to another replica is measured.
        replicas: largest number of replicas.
    """

    seconds: float = 15.0
    segments: int = 20_000
    around: int = 40
    requests: int = 32
    clients: int = 8
    writers: int = 4
    writes: int = 200
    replicas: int = 3


def measure_replicas(
    plan: ReplicasPlan, seed: int = 0, tell: Callable[[str], None] = lambda _: None
) -> dict[str, Any]:
    """Measure 1, 2 and more replicas; return the report that `placecell bench replicas` writes.

    Args:
        plan: extent of the measurement.
        seed: random seed of the map and of the requests.
        tell: takes a line about the progress.

    Raises:
        MissingToolError: PostgreSQL or haproxy is not installed.
    """
    random = np.random.default_rng(seed)
    rows = []
    with scratch_folder() as folder, running_fleet(folder, plan.replicas, tell) as fleet:
        with Client(fleet.address, timeout=60.0) as client:
            template = MapTemplate.from_info(client.info())
            ids = np.arange(plan.segments, dtype=np.uint32)
            content = template.random_map("ann", ids, random)
            client.put_map(SITE, encode(content))
        matches = [match_body(content, plan, random) for _ in range(plan.requests)]
        poses = [localize_body(content, plan, random) for _ in range(plan.requests)]
        wait_until_known(fleet.group, matches[0])
        ports = [each.port for each in fleet.group.replicas]
        for count in range(1, plan.replicas + 1):
            with running_balancer(folder, ports[:count]) as address:
                row: dict[str, Any] = {"replicas": count}
                for path, bodies in (("/match", matches), ("/localize", poses)):
                    row[path.removeprefix("/")] = _load(address, path, bodies, plan, folder)
                row["writes_a_second"] = round(_writes(address, template, plan, seed), 1)
                rows.append(row)
                tell(f"{count} replicas: {row}")
        seen = times_until_seen(fleet.group.replicas, template, plan.writes, random)
    return {
        "rows": rows,
        "write_to_match_ms": percentiles(1e3 * np.array(seen)),
        "machine": machine_of(),
        "seed": seed,
        "plan": asdict(plan),
    }


def machine_of() -> dict[str, Any]:
    """Return the machine, which database, balancer, replicas and clients share."""
    from evaluation.machine import machine

    return machine() | {"shared_by": "database, standby, balancer, replicas and clients"}


def around_a_place(
    content: CompactMap, count: int, random: np.random.Generator
) -> tuple[list[int], Float64]:
    """Return rows of a map that stand together, and their centroids as a robot sees them."""
    first = int(random.integers(len(content) - count))
    rows = np.arange(first, first + count)
    seen = content.centroids[rows] - content.centroids[rows].mean(axis=0)
    return rows.tolist(), seen


def match_body(content: CompactMap, plan: ReplicasPlan, random: np.random.Generator) -> bytes:
    """Return the msgpack body of a `/match` of segments of a map."""
    rows, centroids = around_a_place(content, plan.around, random)
    body = {
        "model_id": content.model_id,
        "codes": content.codes[rows].tobytes(),
        "centroids": centroids.astype("<f8").tobytes(),
        "maps": [SITE],
        "k": 10,
    }
    return bytes(msgpack.packb(body))


def localize_body(content: CompactMap, plan: ReplicasPlan, random: np.random.Generator) -> bytes:
    """Return the msgpack body of a `/localize` of segments of a map."""
    body = msgpack.unpackb(match_body(content, plan, random))
    return bytes(msgpack.packb(body | {"k": 25}))


def wait_until_known(group: ReplicaGroup, body: bytes) -> None:
    """Wait until every replica answers a search in the map.

    Raises:
        RuntimeError: one does not.
    """
    for replica in group.replicas:
        until = time.monotonic() + SEEN_SECONDS
        while True:
            answer = httpx.post(
                f"{replica.address}/match",
                content=body,
                headers={"Content-Type": MSGPACK},
                timeout=60.0,
            )
            if answer.status_code == 200:
                break
            if time.monotonic() > until:
                raise RuntimeError(f"a replica does not know the map: {answer.text[:300]}")
            time.sleep(0.1)


def _load(
    address: str, path: str, bodies: Sequence[bytes], plan: ReplicasPlan, folder: Path
) -> dict[str, Any]:
    host, port = address_of(address)
    requests = tuple(encode_request(path, MSGPACK, body) for body in bodies)
    load = Load(host, port, requests, rate=0, seconds=plan.seconds, clients=plan.clients)
    result = asyncio.run(asyncio.wait_for(send_from_process(load, folder), 10 * plan.seconds + 60))
    good = sum(status == 200 for status in result.statuses)
    return {
        "a_second": round(good / result.elapsed, 1),
        "milliseconds": percentiles(np.array(result.milliseconds)),
        "failed": len(result.statuses) - good,
    }


def _writes(address: str, template: MapTemplate, plan: ReplicasPlan, seed: int) -> float:
    """Return the number of edits a second of several robots, each in a map of its own."""
    ended = time.monotonic() + plan.seconds

    def write(number: int) -> int:
        random, done = np.random.default_rng([seed, number]), 0
        with Client(address, timeout=60.0) as client:
            while time.monotonic() < ended:
                ids = np.arange(10, dtype=np.uint32) + 10 * (done % 100)
                changed = template.random_map(f"robot-{number}", ids, random)
                client.edit_map(f"yard-{number}", Delta(changed, ids[:0]), create=True)
                done += 1
        return done

    with ThreadPoolExecutor(plan.writers) as threads:
        return sum(threads.map(write, range(plan.writers))) / plan.seconds


def times_until_seen(
    replicas: Sequence[Replica], template: MapTemplate, writes: int, random: np.random.Generator
) -> list[float]:
    """Return the times from the answer to a write at one replica until another one matches it."""
    one, other = replicas[0], replicas[-1]
    times = []
    with (
        Client(one.address, timeout=60.0) as writer,
        httpx.Client(base_url=other.address, timeout=60.0) as reader,
    ):
        for number in range(writes):
            ids = np.array([number], np.uint32)
            changed = template.random_map("bob", ids, random)
            writer.edit_map("seen", Delta(changed, ids[:0]), create=True)
            begun = time.monotonic()
            body = {
                "model_id": template.model_id,
                "codes": changed.codes.tolist(),
                "maps": ["seen"],
                "k": 1,
            }
            while not _has(reader, body, number):
                if time.monotonic() > begun + SEEN_SECONDS:
                    raise RuntimeError(f"a write is not known after {SEEN_SECONDS:.0f} s")
                time.sleep(POLL_SECONDS)
            times.append(time.monotonic() - begun)
    return times


def _has(reader: httpx.Client, body: dict[str, Any], id_: int) -> bool:
    answer = reader.post("/match", json=body)
    if answer.status_code != 200:
        return False
    candidates = answer.json()["queries"][0].get("candidates", [])
    return any(each["id"] == id_ and each["distance"] == 0 for each in candidates)
