"""Maps that are not in memory: time of their first request, and memory with and without a limit.

A service with HTTP holds several maps of one size, and then one of them at most.
"""

import re
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import httpx
import numpy as np
from placecell_client import Client, Description, encode

from benchmarks.storage.search_scale import sampled_codes
from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.machine import machine
from placecell.descriptors.manifest import Manifest
from placecell.segmentation.pipeline import Progress, silent
from service.child_process import Service

TIMEOUT_SECONDS = 600.0


@dataclass(frozen=True, slots=True)
class ColdMapsPlan:
    """Extent of a measurement.

    Attributes:
        sizes: numbers of segments of each map.
        maps: number of maps.
        rounds: number of times that each map becomes cold and is asked again.
        queries: number of segments of a request.
    """

    sizes: tuple[int, ...] = (10_000, 100_000, 1_000_000)
    maps: int = 4
    rounds: int = 3
    queries: int = 40


def measure_cold_maps(
    sampler: DescriptorSampler,
    manifest: Manifest,
    plan: ColdMapsPlan,
    seed: int = 0,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Measure all sizes; return the report that `placecell bench search` writes."""
    rows = []
    for number in progress(range(len(plan.sizes)), len(plan.sizes), "sizes of cold maps"):
        with tempfile.TemporaryDirectory(prefix="placecell-cold-") as folder:
            rows.append(_row(sampler, manifest, plan, plan.sizes[number], seed, Path(folder)))
    return {"rows": rows, "machine": machine(), "seed": seed, "plan": asdict(plan)}


def _row(
    sampler: DescriptorSampler,
    manifest: Manifest,
    plan: ColdMapsPlan,
    size: int,
    seed: int,
    folder: Path,
) -> dict[str, Any]:
    random = np.random.default_rng(seed)
    names = [f"map-{number}" for number in range(plan.maps)]
    # The service starts without maps: what it takes then is not theirs.
    with _running(folder, {}) as (service, _, client):
        alone = resident_mb(service)
        for name in names:
            content = road_map(sampled_codes(sampler, size, random), manifest, f"robot of {name}")
            client.put_map(name, encode(content))
    asked = _asked(sampler, manifest, plan.queries, random)
    with _running(folder, {}) as (service, address, client):
        for name in names:
            _seconds(client, name, asked)
        everything, held = resident_mb(service), loaded_maps(address)
    first, later = [], []
    with _running(folder, {"PLACECELL_LOADED_SEGMENTS": str(size)}) as (service, address, client):
        for _ in range(plan.rounds):
            for name in names:
                first.append(_seconds(client, name, asked))
                later.append(_seconds(client, name, asked))
        bound, left = resident_mb(service), loaded_maps(address)
    assert (held, left) == (plan.maps, 1), f"{held} and {left} maps are in memory"
    return {
        "segments": size,
        "maps": plan.maps,
        "first_ms": round(1e3 * float(np.median(first)), 1),
        "first_max_ms": round(1e3 * max(first), 1),
        "later_ms": round(1e3 * float(np.median(later)), 1),
        "without_maps_mb": alone,
        "all_loaded_mb": everything,
        "one_loaded_mb": bound,
    }


def _asked(
    sampler: DescriptorSampler, manifest: Manifest, count: int, random: np.random.Generator
) -> Description:
    codes = sampled_codes(sampler, count, random)
    nothing = np.zeros((count, 0), np.float32)
    return Description(manifest.model_id, codes, nothing, np.zeros((count, 3)), {})


def _seconds(client: Client, name: str, asked: Description) -> float:
    """Return the seconds of a search of one map."""
    begun = time.perf_counter()
    client.match(asked, maps=[name], k=25, rerank=False)
    return time.perf_counter() - begun


@contextmanager
def _running(folder: Path, environment: Mapping[str, str]) -> Iterator[tuple[Service, str, Client]]:
    with Service(folder, environment=environment) as service:
        address = service.address()
        with Client(address, TIMEOUT_SECONDS) as client:
            yield service, address, client


def resident_mb(service: Service) -> float:
    """Return the memory of the process now, MB; on Linux only."""
    status = Path(f"/proc/{service.process.pid}/status").read_text()
    return round(int(status.split("VmRSS:")[1].split()[0]) * 1024 / 1e6, 1)


def loaded_maps(address: str) -> int:
    """Return the number of maps in the memory of a service."""
    text = httpx.get(f"{address}/metrics").text
    (line,) = re.findall(r"(?m)^placecell_loaded_maps (.*)$", text)
    return int(float(line))
