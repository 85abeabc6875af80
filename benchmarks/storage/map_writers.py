"""Robots that write to a map while `bench maps` measures requests to it."""

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import Client, Delta, encode

from benchmarks.load.serve import percentiles
from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map

MAP = "site"
OTHER = "other"


@dataclass(frozen=True, slots=True)
class MapsPlan:
    """Extent of the measurement.

    Attributes:
        sizes: map sizes, in segments.
        queries: queries per request.
        asked: number of queries whose candidates are compared with the exact ones.
        k: candidates per query.
        rate: requests per second.
        seconds: duration of each phase.
        upserts: segments that a robot replaces or adds per second, in ten edits per second.
        upload: segments of another map that a robot uploads again and again.
        upload_seconds: interval between uploads.
        starts: starts of the service from its cache; the report states their median.
    """

    sizes: tuple[int, ...] = (10_000, 100_000, 1_000_000)
    queries: int = 50
    asked: int = 1_000
    k: int = 10
    rate: float = 10.0
    seconds: float = 60.0
    upserts: int = 1_000
    upload: int = 10_000
    upload_seconds: float = 10.0
    starts: int = 3


@contextmanager
def writing_robots(
    client: Client, sampler: DescriptorSampler, plan: MapsPlan, count: int, seed: int
) -> Iterator[dict[str, Any]]:
    """Edit a map and upload another until the block ends.

    Yields:
        The rates and times of the writes, which are filled in after the block.
    """
    done, written = threading.Event(), dict[str, Any]()
    random = np.random.default_rng(seed)
    fresh = sampler.sample_map(plan.upload, 1, seed + 1).codes
    others = [
        encode(road_map(np.roll(fresh, shift, 0), sampler.manifest, "bob")) for shift in (0, 1)
    ]
    fewer = plan.upserts // 10

    def upsert(number: int) -> None:
        # Half of the ids exist already, half are new.
        ids = np.unique(random.integers(count, size=fewer // 2))
        ids = np.append(ids, count + number * fewer + np.arange(fewer - len(ids)))
        drawn = road_map(fresh[random.integers(len(fresh), size=fewer)], sampler.manifest, "ann")
        changed = replace(drawn, ids=ids.astype(np.uint32))
        client.edit_map(MAP, Delta(changed, np.zeros(0, np.uint32)))

    def upload(number: int) -> None:
        client.put_map(OTHER, others[number % 2], if_match="*" if number else None)

    def regularly(name: str, work: Callable[[int], None], seconds: float) -> None:
        started = time.perf_counter()
        spent: list[float] = []
        while not done.is_set():
            due = time.perf_counter()
            work(len(spent))
            spent.append(1e3 * (time.perf_counter() - due))
            # Late writes follow at once: the rate is the planned one, or the service's limit.
            done.wait(max(0.0, started + len(spent) * seconds - time.perf_counter()))
        written[f"{name}s_a_second"] = round(len(spent) / (time.perf_counter() - started), 3)
        written[f"{name}_ms"] = percentiles(np.array(spent))

    with ThreadPoolExecutor(2) as pool:
        works = [
            pool.submit(regularly, "upsert", upsert, 0.1),
            pool.submit(regularly, "upload", upload, plan.upload_seconds),
        ]
        try:
            yield written
        finally:
            done.set()
        for work in works:
            work.result()
    written["upserted_segments_a_second"] = round(fewer * written["upserts_a_second"])


@contextmanager
def index_rebuilds(
    client: Client, sampler: DescriptorSampler, data: Path, count: int, seed: int
) -> Iterator[set[int]]:
    """Replace large parts of the map until the block ends, so that the service rebuilds its index.

    Yields:
        A set with one modification time of the cache file per rebuild, filled meanwhile.
    """
    done, rebuilt = threading.Event(), set[int]()
    random = np.random.default_rng(seed)
    many = max(6_000, count // 16)
    fresh = sampler.sample_map(many, 1, seed + 2).codes

    def replace_many() -> None:
        while not done.wait(1.0):
            ids = np.unique(random.integers(count, size=many)).astype(np.uint32)
            drawn = road_map(fresh[: len(ids)], sampler.manifest, "ann")
            client.edit_map(MAP, Delta(replace(drawn, ids=ids), np.zeros(0, np.uint32)))
            # The service writes the cache file of a map whenever it has rebuilt the index.
            rebuilt.update(file.stat().st_mtime_ns for file in (data / "cache").glob("*.cache"))

    with ThreadPoolExecutor(1) as pool:
        work = pool.submit(replace_many)
        try:
            yield rebuilt
        finally:
            done.set()
        work.result()
