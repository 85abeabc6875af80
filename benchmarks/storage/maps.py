"""Large maps: bytes per segment on disk and in memory, latency, recall and start time.

The real server over loopback serves synthetic maps. The load generator runs in its own process;
this process writes meanwhile.
"""

import asyncio
import tempfile
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import faiss
import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client, Description, encode

from benchmarks.load.generator import Load, encode_request, send_from_process
from benchmarks.load.serve import percentiles
from benchmarks.load.soak import read_process_metrics
from benchmarks.storage.map_writers import MAP, MapsPlan, index_rebuilds, writing_robots
from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler, SampledMap
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.figure import figure
from evaluation.machine import machine
from placecell.core.types import Int64
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.shipped_models import DEFAULT_MODEL
from placecell.segmentation.pipeline import Progress, silent
from service.api.body.body import MSGPACK
from service.child_process import Service, address_of, running_service


def measure_maps(
    sampler: DescriptorSampler, plan: MapsPlan, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Measure maps of each size; return the report that `placecell bench maps` writes."""
    ten_thousand = sampler.sample_map(10_000, 1, seed).codes
    rows = []
    with tempfile.TemporaryDirectory(prefix="placecell-bench-") as folder:
        for number in progress(range(len(plan.sizes)), len(plan.sizes), "maps"):
            content = sampler.sample_map(plan.sizes[number], plan.asked, seed)
            rows.append(_row(sampler, content, plan, Path(folder) / str(number), seed))
    return {
        "rows": rows,
        "file_bytes_per_segment": len(encode(road_map(ten_thousand, sampler.manifest, "ann")))
        / 10_000,
        "model_id": sampler.manifest.model_id,
        "default": DEFAULT_MODEL,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def _row(
    sampler: DescriptorSampler, content: SampledMap, plan: MapsPlan, data: Path, seed: int
) -> dict[str, Any]:
    file = encode(road_map(content.codes, sampler.manifest, "ann", seed=seed))
    row: dict[str, Any] = {"segments": len(content.codes)}
    row["start_empty_s"] = round(_start(data, plan.starts), 3)
    with running_service(data) as address, Client(address, timeout=120) as client:
        empty = read_process_metrics(address)["resident_mb"]
        started = time.perf_counter()
        client.put_map(MAP, file)
        spent = time.perf_counter() - started
        row["upload_segments_per_second"] = round(len(content.codes) / spent)
        row |= _recognized(client, content)
        idle = asyncio.run(_asked(address, content, plan, data))
        row |= {f"idle_match_50_{key}_ms": idle[key] for key in ("p50", "p99")}
        row["memory_mb"] = round(read_process_metrics(address)["resident_mb"] - empty, 1)
        row["process_mb"] = read_process_metrics(address)["resident_mb"]
    row["disk_bytes_per_segment"] = round(_bytes(data) / len(content.codes), 1)
    row["start_cache_s"] = round(_start(data, plan.starts) - row["start_empty_s"], 3)
    for cached in (data / "cache").glob("*"):
        cached.unlink()
    row["start_rebuild_s"] = round(_start(data, 1) - row["start_empty_s"], 3)
    with Service(data) as service:
        address = service.address()
        row |= _written_to(address, sampler, content, plan, data, seed)
        row["memory_mb_after_writes"] = round(
            read_process_metrics(address)["resident_mb"] - empty, 1
        )
        row["peak_mb"] = service.peak_mb()
    return row


def _written_to(
    address: str,
    sampler: DescriptorSampler,
    content: SampledMap,
    plan: MapsPlan,
    data: Path,
    seed: int,
) -> dict[str, Any]:
    """Measure `/match` while robots write, and while the service rebuilds the index."""
    row: dict[str, Any] = {}
    with Client(address, timeout=120) as client:
        with writing_robots(client, sampler, plan, len(content.codes), seed) as written:
            busy = asyncio.run(_asked(address, content, plan, data))
        row |= {f"match_50_{key}_ms": busy[key] for key in ("p50", "p99", "max")}
        row |= written
        with index_rebuilds(client, sampler, data, len(content.codes), seed) as rebuilt:
            busy = asyncio.run(_asked(address, content, plan, data))
        row |= {f"rebuilding_match_50_{key}_ms": busy[key] for key in ("p50", "p99", "max")}
        row["rebuilds"] = len(rebuilt)
    return row


def _recognized(client: Client, content: SampledMap) -> dict[str, float]:
    """Return the shares of queries with a view of their object among the 1 or 25 nearest."""
    model = client.info().model
    exact = _by_comparing_all(content, Quantizer(model["step"], model["per_byte"]))
    found = []
    for start in range(0, len(content.query_codes), 500):
        codes = content.query_codes[start : start + 500]
        nothing = np.zeros((len(codes), 0), np.float32)
        asked = Description(model["model_id"], codes, nothing, np.zeros((len(codes), 3)), {})
        for candidates in client.match(asked, maps=[MAP], k=25).queries:
            assert isinstance(candidates, tuple)
            found.append(content.objects[[candidate.id for candidate in candidates]])
    ours = np.array(found)
    recall, best = _shares(ours, content), _shares(exact, content)
    return {
        "top1": _shares(ours[:, :1], content),
        "recall_at_25": recall,
        "exact_recall_at_25": best,
        "recall_at_25_of_exact": round(recall / best, 4),
    }


def _by_comparing_all(content: SampledMap, quantizer: Quantizer) -> Int64:
    """Return the objects of the 25 nearest segments by exhaustive search, int64 (q, 25)."""
    nearest = faiss.ResultHeap(len(content.query_codes), 25)
    asked = quantizer.levels(content.query_codes).astype(np.float32)
    for start in range(0, len(content.codes), 100_000):
        some = quantizer.levels(content.codes[start : start + 100_000]).astype(np.float32)
        distances, rows = faiss.knn(asked, some, 25)
        nearest.add_result(distances, rows + start)
    nearest.finalize()
    return np.asarray(content.objects[nearest.I])


def _shares(things: Int64, content: SampledMap) -> float:
    return float((things == content.query_objects[:, None]).any(axis=1).mean())


async def _asked(
    address: str, content: SampledMap, plan: MapsPlan, folder: Path
) -> dict[str, float]:
    """Measure `/match` from descriptors at the planned rate, milliseconds."""
    bodies = [
        msgpack.packb(
            {
                "model_id": content.model_id,
                "codes": content.query_codes[start : start + plan.queries].tobytes(),
                "maps": [MAP],
                "k": plan.k,
            }
        )
        for start in range(0, len(content.query_codes) - plan.queries + 1, plan.queries)
    ]
    sent = tuple(encode_request("/match", MSGPACK, body) for body in bodies)
    outcome = await send_from_process(
        Load(*address_of(address), sent, plan.rate, plan.seconds), folder
    )
    good = np.array(outcome.statuses) == 200
    if not good.all():
        raise RuntimeError(f"/match returned statuses {set(outcome.statuses)}; expected 200.")
    return {key: spent or 0.0 for key, spent in percentiles(np.array(outcome.milliseconds)).items()}


def _start(data: Path, times: int) -> float:
    """Return the median time of a start of the service, seconds."""
    spent = []
    for _ in range(times):
        started = time.perf_counter()
        with running_service(data):
            spent.append(time.perf_counter() - started)
    return float(np.median(spent))


def _bytes(folder: Path) -> int:
    """Return the bytes of all files in a folder."""
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def draw_maps(report: dict[str, Any], file: Path) -> None:
    """Plot latency, memory and start time against map size."""
    rows = report["rows"]
    sizes = [row["segments"] for row in rows]
    with figure(file, 3) as (left, middle, right):
        for name, key, style in (
            ("p99 under writes", "match_50_p99_ms", "o-"),
            ("p50 under writes", "match_50_p50_ms", "o--"),
            ("p99 idle", "idle_match_50_p99_ms", "s-"),
            ("p50 idle", "idle_match_50_p50_ms", "s--"),
        ):
            left.plot(sizes, [row[key] for row in rows], style, label=name)
        left.set(title="/match of 50 descriptors", ylabel="latency, ms")
        for name, key in (("process", "process_mb"), ("map and index", "memory_mb")):
            middle.plot(sizes, [row[key] for row in rows], "o-", label=name)
        middle.set(title="Memory", ylabel="MB")
        for name, key in (("from the cache", "start_cache_s"), ("rebuilt", "start_rebuild_s")):
            right.plot(sizes, [row[key] for row in rows], "o-", label=name)
        right.set(title="Start time, minus that of an empty service", ylabel="seconds")
        for axes in (left, middle, right):
            axes.set(xscale="log", xlabel="segments")
            axes.grid(alpha=0.3)
            axes.legend(fontsize=8)
