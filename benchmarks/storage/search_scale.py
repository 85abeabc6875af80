"""Search of large maps: time and memory by number of segments, with one core and with all.

One process holds the maps as a replica does, without HTTP.
"""

import gc
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.machine import machine
from placecell.core.types import Int8
from placecell.descriptors.manifest import Manifest
from placecell.segmentation.pipeline import Progress, silent
from service.core import memory
from service.inference.model_registry import Model
from service.maps import index
from service.maps.index import LayeredIndex
from service.maps.layers import MapLayers
from service.maps.snapshot import MapSnapshot
from service.maps.store import MapHead
from service.search import parallel
from service.search.matching import NearestSegments, nearest_segments

CHUNK = 500_000
"""Number of segments that are sampled at once."""

ALL = 1 << 62
"""Number of compared pairs that no search has."""


@dataclass(frozen=True, slots=True)
class SearchScalePlan:
    """Extent of a measurement.

    Attributes:
        sizes: numbers of segments of all maps together.
        map_segments: numbers of segments of one map; 0: one map holds all.
        queries: numbers of segments of a request.
        k: number of candidates.
        repeats: number of searches of each kind; the median counts.
    """

    sizes: tuple[int, ...] = (100_000, 1_000_000, 10_000_000)
    map_segments: tuple[int, ...] = (0, 100_000)
    queries: tuple[int, ...] = (1, 64)
    k: int = 25
    repeats: int = 5


@dataclass(frozen=True, slots=True)
class SearchTime:
    """Median times of one kind of search.

    Attributes:
        milliseconds: time until the result. On a machine with other work it is longer.
        cpu_milliseconds: processor time of all threads together.
    """

    milliseconds: float
    cpu_milliseconds: float


def measure_search(
    sampler: DescriptorSampler,
    model: Model,
    plan: SearchScalePlan,
    seed: int = 0,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Measure all sizes; return the report that `placecell bench search` writes."""
    rows: list[dict[str, Any]] = []
    cases = [(size, each) for size in plan.sizes for each in plan.map_segments if each < size]
    for number in progress(range(len(cases)), len(cases), "sizes"):
        size, map_segments = cases[number]
        rows.append(_row(sampler, model, plan, size, map_segments or size, seed))
        gc.collect()
    return {
        "rows": rows,
        "code_bytes": model.manifest.dimension // model.manifest.quantizer.per_byte,
        "model_id": model.id,
        "cores": parallel.CORES,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def _row(
    sampler: DescriptorSampler,
    model: Model,
    plan: SearchScalePlan,
    size: int,
    map_segments: int,
    seed: int,
) -> dict[str, Any]:
    random = np.random.default_rng(seed)
    codes = [
        sampled_codes(sampler, min(map_segments, size - start), random)
        for start in range(0, size, map_segments)
    ]
    memory.limit()
    gc.collect()
    memory.release()
    before, begun = resident_bytes(), time.perf_counter()
    searched = tuple(
        snapshot_of(f"map-{number:05}", each, model.manifest) for number, each in enumerate(codes)
    )
    built = time.perf_counter() - begun
    gc.collect()
    memory.release()
    taken = resident_bytes() - before + sum(each.nbytes for each in codes)
    row: dict[str, Any] = {
        "segments": size,
        "maps": len(searched),
        "made_s": round(built, 2),
        "bytes_per_segment": round(taken / size, 1),
    }
    for count in plan.queries:
        asked = sampled_codes(sampler, count, random)
        with on_one_core():
            alone, one = _timed(asked, model, searched, plan)
        together, every = _timed(asked, model, searched, plan)
        row[f"ms_{count}_queries_one_core"] = one.milliseconds
        row[f"ms_{count}_queries"] = every.milliseconds
        row[f"cpu_ms_{count}_queries_one_core"] = one.cpu_milliseconds
        row[f"cpu_ms_{count}_queries"] = every.cpu_milliseconds
        row[f"speedup_{count}_queries"] = round(one.milliseconds / every.milliseconds, 2)
        row[f"equal_{count}_queries"] = are_equal(alone, together)
    return row


def _timed(
    codes: Int8, model: Model, searched: tuple[MapSnapshot, ...], plan: SearchScalePlan
) -> tuple[NearestSegments, SearchTime]:
    """Return the result of a search, and its times."""
    spent, computed = [], []
    found = nearest_segments(codes, model, searched, plan.k)
    for _ in range(plan.repeats):
        begun, before = time.perf_counter(), time.process_time()
        found = nearest_segments(codes, model, searched, plan.k)
        spent.append(time.perf_counter() - begun)
        computed.append(time.process_time() - before)
    return found, SearchTime(_milliseconds(spent), _milliseconds(computed))


def _milliseconds(seconds: Sequence[float]) -> float:
    return round(1e3 * float(np.median(seconds)), 2)


def are_equal(one: NearestSegments, other: NearestSegments) -> bool:
    """Return whether two searches found the same segments at the same distances, bit for bit."""
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in ("places", "rows", "distances")
    )


@contextmanager
def on_one_core() -> Iterator[None]:
    """Search with one thread for a block, as on a machine with one core."""
    kept = index.CORES, parallel.PARALLEL
    index.CORES, parallel.PARALLEL = 1, ALL
    try:
        yield
    finally:
        index.CORES, parallel.PARALLEL = kept


def sampled_codes(sampler: DescriptorSampler, count: int, random: np.random.Generator) -> Int8:
    """Sample the descriptors of `count` segments of different objects, int8 (n, code bytes)."""
    parts = [
        sampler.sample_views(sampler.sample_objects(some, random), np.arange(some), random)
        for some in _shares(count)
    ]
    return np.concatenate(parts)


def _shares(count: int) -> Sequence[int]:
    return [min(CHUNK, count - start) for start in range(0, count, CHUNK)]


def snapshot_of(name: str, codes: Int8, manifest: Manifest) -> MapSnapshot:
    """Return a map with these descriptors and its index, as in a service's memory."""
    layers = MapLayers.of(road_map(codes, manifest, "ann"))
    head = MapHead(
        name=name,
        uid=name,
        sequence=1,
        mark="0" * 64,
        oldest=1,
        next_id=len(codes),
        base_bytes=0,
        log_bytes=0,
        author="bench",
    )
    return MapSnapshot(
        head=head,
        layers=layers,
        base_sequence=1,
        frame_since=1,
        index=LayeredIndex.of(layers, manifest.quantizer),
    )


def resident_bytes() -> int:
    """Return the memory of this process, bytes; 0 where the system does not tell."""
    status = Path("/proc/self/status")
    if not status.exists():
        return 0
    return int(status.read_text().split("VmRSS:")[1].split()[0]) * 1024
