"""Latency and throughput of the real server over loopback, up to and beyond saturation."""

import asyncio
import re
import tempfile
import urllib.request
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.load.generator import Load, LoadResult, send_from_process
from benchmarks.load.rates import measure_rate, work_of
from benchmarks.load.workload import LoadCase, match_requests, store_map
from benchmarks.scans import draw_scans
from evaluation.figure import figure
from evaluation.machine import machine
from placecell.core.segments import Segments
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from placecell.segmentation.pipeline import Progress, silent
from service.api.body.body import JSON, MSGPACK
from service.child_process import address_of, running_service


@dataclass(frozen=True, slots=True)
class LoadPlan:
    """Extent of the measurement.

    Attributes:
        segments: segments per request.
        small: segments per request of the cases that show the effect of batching.
        k: candidates per segment.
        map_segments: segments of the searched map.
        levels: offered load, as shares of the saturation rate.
        seconds: duration of each level.
        bodies: number of different requests, sent in turn.
    """

    segments: int = 50
    small: int = 5
    k: int = 10
    map_segments: int = 10_000
    levels: tuple[float, ...] = (0.25, 0.5, 0.75, 0.9, 1.1, 1.5, 2.0)
    seconds: float = 10.0
    bodies: int = 20


def measure_load(
    scans: Sequence[Segments], plan: LoadPlan, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Measure the service under load; return the report that `placecell bench serve` writes.

    Raises:
        ValueError: the scans have no segments.
    """
    drawn = Segments.concatenate(draw_scans(scans, plan.segments * plan.bodies, seed))
    cases = [
        LoadCase(MSGPACK, plan.segments, batching=True),
        LoadCase(JSON, plan.segments, batching=True),
        LoadCase(MSGPACK, plan.small, batching=True),
        LoadCase(MSGPACK, plan.small, batching=False),
    ]
    library = measure_library(scans)
    sent = {case.name: match_requests(case, drawn, plan.bodies, plan.k) for case in cases}
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory(prefix="placecell-bench-") as folder:
        for number in progress(range(len(cases)), len(cases), "loading the service"):
            case, data = cases[number], Path(folder) / str(number)
            rows += asyncio.run(_case(case, sent[case.name], drawn, plan, data, seed))
    main = [row for row in rows if row["case"] == cases[0].name]
    half = next(row for row in main if row["level"] == 0.5)
    saturation = main[0]["saturation_segments_per_second"]
    return {
        "rows": rows,
        "saturation_segments_per_second": saturation,
        "match_50_p99_ms_at_half_saturation": half["milliseconds"]["p99"],
        "points_in_descriptors_out_segments_per_second": library,
        "http_over_library": round(saturation / library, 3),
        "default": DEFAULT_MODEL,
        "machine": machine(),
        "seed": seed,
        "sizes": {
            "points_mean": float(drawn.counts.mean()),
            "map_segments": plan.map_segments,
            "body_bytes": {
                name: round(float(np.mean([len(one) for one in bodies])))
                for name, bodies in sent.items()
            },
        },
        "plan": asdict(plan),
    }


def measure_library(scans: Sequence[Segments]) -> float:
    """Measure the default model without the service: segments per second, points to descriptors."""
    extractor = load_extractor(MODELS_FOLDER / DEFAULT_MODEL)
    work = work_of([scan for scan in scans if len(scan)], extractor.describe)
    with ThreadPoolExecutor(1) as pool:
        measure_rate(pool, work, 1, 0.5)
        return round(float(np.median([measure_rate(pool, work, 1, 1.0) for _ in range(5)])), 1)


async def _case(
    case: LoadCase,
    sent: tuple[bytes, ...],
    drawn: Segments,
    plan: LoadPlan,
    data_dir: Path,
    seed: int,
) -> list[dict[str, Any]]:
    environment = {} if case.batching else {"PLACECELL_LIMITS__BATCH": "1"}
    with running_service(data_dir, environment=environment) as address:
        store_map(address, drawn, plan.map_segments, seed)
        host, port = address_of(address)

        async def load(rate: float, seconds: float) -> tuple[LoadResult, float]:
            before = read_batch_counters(address)
            outcome = await send_from_process(Load(host, port, sent, rate, seconds), data_dir)
            after = read_batch_counters(address)
            count = after[1] - before[1]
            return outcome, (after[0] - before[0]) / count if count else 0.0

        await load(0, 1.0)  # a warm-up: first uses compile and allocate
        full, _ = await load(0, plan.seconds)
        most = full.statuses.count(200) / full.elapsed
        rows = []
        for level in plan.levels:
            outcome, batch = await load(level * most, plan.seconds)
            rows.append(
                _row(case, level, level * most, outcome)
                | {
                    "batch_requests": round(batch, 2),
                    "saturation_segments_per_second": round(most * case.segments, 1),
                }
            )
        return rows


def _row(case: LoadCase, level: float, offered: float, outcome: LoadResult) -> dict[str, Any]:
    statuses, times = np.array(outcome.statuses), np.array(outcome.milliseconds)
    good, full = statuses == 200, statuses == 429
    return {
        "case": case.name,
        "media_type": case.media_type,
        "segments": case.segments,
        "batching": case.batching,
        "level": level,
        "offered": round(offered * case.segments, 1),
        "achieved": round(float(good.sum()) / outcome.elapsed * case.segments, 1),
        "requests": len(statuses),
        "milliseconds": percentiles(times[good]),
        "stages": {stage: percentiles(np.array(spent)) for stage, spent in outcome.stages.items()},
        "rejected": int(full.sum()),
        "rejected_milliseconds": percentiles(times[full]),
        "failed": {str(each): int((statuses == each).sum()) for each in set(outcome.statuses)
                   if each not in (200, 429)},
        "generator_cpu_share": round(outcome.cpu / outcome.elapsed, 3),
    }  # fmt: skip


def percentiles(times: np.ndarray[Any, Any]) -> dict[str, float | None]:
    """Return p50, p95, p99 and the maximum; None for each if there are no times."""
    if not len(times):
        return dict.fromkeys(("p50", "p95", "p99", "max"))
    found = np.percentile(times, [50, 95, 99, 100]).round(2).tolist()
    return dict(zip(("p50", "p95", "p99", "max"), found, strict=True))


def read_batch_counters(address: str) -> tuple[float, float]:
    """Return the number of requests that went through the model so far, and of their batches."""
    with urllib.request.urlopen(f"{address}/metrics", timeout=30) as answer:
        text = answer.read().decode()
    found = [
        re.search(rf"^placecell_batch_requests_{what} (\S+)", text, re.MULTILINE)
        for what in ("sum", "count")
    ]
    total, count = (float(match[1]) if match else 0.0 for match in found)
    return total, count


def draw_load(report: dict[str, Any], file: Path) -> None:
    """Plot latency and answered load against offered load, one line per case."""
    with figure(file, 2, size=5) as (left, right):
        for name in dict.fromkeys(row["case"] for row in report["rows"]):
            rows = [row for row in report["rows"] if row["case"] == name]
            offered = [row["offered"] for row in rows]
            worst = [row["milliseconds"]["p99"] for row in rows]
            (line,) = left.plot(offered, worst, "o-", label=name)
            medians = [row["milliseconds"]["p50"] for row in rows]
            left.plot(offered, medians, "--", color=line.get_color())
            right.plot(offered, [row["achieved"] for row in rows], "o-", label=name)
        left.set(
            xlabel="offered load, segments per second",
            ylabel="latency, ms: p99 (p50 dashed)",
            yscale="log",
            title="Latency of /match",
        )
        right.set(
            xlabel="offered load, segments per second",
            ylabel="answered load, segments per second",
            title="Throughput of /match",
        )
        right.legend(fontsize=8)
        for axes in (left, right):
            axes.grid(alpha=0.3)
