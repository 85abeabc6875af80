"""Robots that write to a map while others ask it: what `bench maps` measures against."""

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
    """What is measured.

    Attributes:
        sizes: segments of the map.
        queries: of a request.
        asked: queries whose answers are checked.
        k: candidates a query.
        rate: requests a second.
        seconds: of each phase.
        upserts: segments a second that are written meanwhile, in tenths of it.
        upload: segments of the map that is uploaded meanwhile, every `upload_seconds`.
        upload_seconds: between uploads.
        starts: of the service, from its cache; the median counts.
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
    """Upsert and upload until the block ends; then the figures are filled in."""
    done, written = threading.Event(), dict[str, Any]()
    random = np.random.default_rng(seed)
    fresh = sampler.sample_map(plan.upload, 1, seed + 1).codes
    others = [
        encode(road_map(np.roll(fresh, shift, 0), sampler.manifest, "bob")) for shift in (0, 1)
    ]
    fewer = plan.upserts // 10

    def upsert(number: int) -> None:
        # Half of them are there already, half are new.
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
            # Late ones are made up for: the rate is that of the plan, or what the service bears.
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
    """Replace so much of the map, again and again, that its index is made anew; when it was."""
    done, rebuilt = threading.Event(), set[int]()
    random = np.random.default_rng(seed)
    many = max(6_000, count // 16)
    fresh = sampler.sample_map(many, 1, seed + 2).codes

    def replace_many() -> None:
        while not done.wait(1.0):
            ids = np.unique(random.integers(count, size=many)).astype(np.uint32)
            drawn = road_map(fresh[: len(ids)], sampler.manifest, "ann")
            client.edit_map(MAP, Delta(replace(drawn, ids=ids), np.zeros(0, np.uint32)))
            # The service keeps each map's base on disk whenever it has made a new one.
            rebuilt.update(file.stat().st_mtime_ns for file in (data / "cache").glob("*.cache"))

    with ThreadPoolExecutor(1) as pool:
        work = pool.submit(replace_many)
        try:
            yield rebuilt
        finally:
            done.set()
        work.result()
