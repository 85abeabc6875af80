"""Speed of inference: all shipped networks and the paper's network, measured in one run.

The networks are measured in turn several times, and the report states the medians. Other load on
the machine then slows all networks alike. Compare rates within a run only.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import onnxruntime

from benchmarks.load.networks import PAPER, networks_of_model, paper_network
from benchmarks.load.rates import Work, measure_rates, work_of
from benchmarks.scans import draw_scans
from evaluation.figure import figure
from evaluation.machine import machine
from placecell.core.parameters import Parameters
from placecell.core.segments import Segments
from placecell.descriptors.extractor import Extractor, load_extractor, one_thread_session
from placecell.descriptors.manifest import PAIR_FILE, Manifest
from placecell.descriptors.neighborhood import describe_neighborhood
from placecell.descriptors.pair_classifier import PairClassifier
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER, shipped_models
from placecell.descriptors.voxels import voxelize
from placecell.segmentation.pipeline import Progress, silent

PAIRS = 1_250
"""Pairs of query and candidate in a usual `/match` request: 50 segments, 25 candidates each."""


@dataclass(frozen=True, slots=True)
class DescribePlan:
    """Extent of the measurement.

    Attributes:
        batches: batch sizes, in segments.
        threads: numbers of threads; each thread computes its own batch, as in the service.
        repeats: measurements per figure; the report states their median.
        seconds: least duration of a measurement.
        segments: number of segments drawn from the drive.
        latencies: number of segments described one by one for the latency percentiles.
    """

    batches: tuple[int, ...] = (1, 8, 64)
    threads: tuple[int, ...] = (1, 2)
    repeats: int = 5
    seconds: float = 0.5
    segments: int = 1024
    latencies: int = 500


def measure_inference(
    scans: Sequence[Segments],
    folder: Path,
    plan: DescribePlan,
    seed: int = 0,
    *,
    models: Path = MODELS_FOLDER,
    default: str = DEFAULT_MODEL,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Measure inference; return the report that `placecell bench describe` writes.

    Args:
        scans: the segments of each scan; scans are drawn until they hold `plan.segments` segments.
        folder: keeps the exported network of the paper for later runs.
        plan: extent of the measurement.
        seed: random seed of the draw and of the paper's weights.
        models: folder of the models.
        default: name of the default model.
        progress: wraps the loops.

    Raises:
        ValueError: the scans have no segments.
    """
    scans = draw_scans(scans, plan.segments, seed)
    drawn = Segments.concatenate(scans)
    extractor = load_extractor(models / default, max(plan.threads))
    parameters = extractor.manifest.parameters
    networks = [
        network for name in shipped_models(models) for network in networks_of_model(models / name)
    ]
    if not any(network.model == PAPER for network in networks):
        networks += paper_network(folder, parameters, extractor.manifest.dimension, seed)

    works: dict[Any, tuple[Work, int]] = {}
    occupancy, extents = voxelize(drawn, parameters)
    around = np.concatenate([describe_neighborhood(scan) for scan in scans])
    inputs: dict[str, np.ndarray[Any, Any]]
    inputs = {"occupancy": occupancy, "extents": extents, "surroundings": around}
    for network in networks:
        # Each thread has its own session, as in the extractor.
        sessions = [one_thread_session(network.file) for _ in range(max(plan.threads))]
        for batch in plan.batches:
            for threads in plan.threads:
                work = inference_work(sessions[:threads], inputs, batch)
                works[network, batch, threads] = (work, threads)
    for threads in plan.threads:
        works["preprocessing", threads] = (preprocessing_work(drawn, parameters), threads)
        works["surroundings", threads] = (work_of(scans, describe_neighborhood), threads)
    works["points in"] = (work_of(scans, extractor.describe), max(plan.threads))
    rates = measure_rates(works, plan.repeats, plan.seconds, progress)

    rows = [
        {
            "model": network.model,
            "precision": network.precision,
            "served": network.served,
            "batch": batch,
            "threads": threads,
            "segments_per_second": rates[network, batch, threads],
            "top1": network.top1,
        }
        for network in networks
        for batch in plan.batches
        for threads in plan.threads
    ]
    return {
        "rows": rows,
        "points_in_descriptors_out_segments_per_second": rates["points in"],
        "default_over_paper": rate_ratio(rows, default, max(plan.batches), max(plan.threads)),
        "preprocessing_segments_per_second": {
            str(threads): rates["preprocessing", threads] for threads in plan.threads
        },
        "surroundings_segments_per_second": {
            str(threads): rates["surroundings", threads] for threads in plan.threads
        },
        "single_segment_ms": measure_latency(extractor, drawn, plan.latencies),
        "pairs": [
            measure_pair_latency(models / name, seed)
            for name in shipped_models(models)
            if (models / name / PAIR_FILE).exists()
        ],
        "default": extractor.manifest.model_id,
        "machine": machine(),
        "seed": seed,
        "sizes": {
            "segments": len(drawn),
            "scans": len(scans),
            "points_mean": float(drawn.counts.mean()),
            "points_median": float(np.median(drawn.counts)),
            "grid": list(parameters.grid),
        },
        "plan": asdict(plan),
    }


def inference_work(
    sessions: Sequence[onnxruntime.InferenceSession],
    inputs: dict[str, np.ndarray[Any, Any]],
    batch: int,
) -> Work:
    """Return the work that runs a network on one batch after the other; sessions take turns."""
    wanted = {given.name for given in sessions[0].get_inputs()}
    inputs = {name: values for name, values in inputs.items() if name in wanted}
    count = len(inputs["occupancy"])
    batch = min(batch, count)
    places = count // batch

    def work(number: int) -> int:
        part = slice(number % places * batch, (number % places + 1) * batch)
        given = {name: values[part] for name, values in inputs.items()}
        # `measure_rate` counts in steps of the number of threads, so each thread keeps its session.
        sessions[number % len(sessions)].run(["descriptor"], given)
        return batch

    return work


def preprocessing_work(segments: Segments, parameters: Parameters, batch: int = 64) -> Work:
    """Return the work that orients and voxelizes one batch after the other."""
    parts = [
        segments.take(np.arange(first, min(first + batch, len(segments))))
        for first in range(0, len(segments), batch)
    ]
    return work_of(parts, lambda part: voxelize(part, parameters))


def measure_latency(extractor: Extractor, segments: Segments, count: int) -> dict[str, float]:
    """Measure p50 and p99 from the points of one segment to its descriptor, milliseconds."""
    times = []
    for number in range(count):
        single = segments.take([number % len(segments)])
        start = perf_counter()
        extractor.describe(single)
        times.append(1e3 * (perf_counter() - start))
    p50, p99 = np.percentile(times, [50, 99])
    return {"p50": round(float(p50), 3), "p99": round(float(p99), 3)}


def measure_pair_latency(folder: Path, seed: int, repeats: int = 50) -> dict[str, Any]:
    """Measure the match probability of `PAIRS` pairs on one thread: p50 of a call."""
    manifest = Manifest.load(folder)
    classifier = PairClassifier(folder, manifest)
    random = np.random.default_rng(seed)
    a, b = random.integers(-127, 128, (2, PAIRS, manifest.code_bytes)).astype(np.int8)
    times = []
    for _ in range(repeats):
        start = perf_counter()
        classifier.probabilities(a, b)
        times.append(1e3 * (perf_counter() - start))
    return {
        "model": manifest.name,
        "kind": manifest.pair["kind"],
        "pairs": PAIRS,
        "p50_ms": round(float(np.median(times)), 3),
        "bytes": (folder / PAIR_FILE).stat().st_size,
    }


def rate_ratio(
    rows: Sequence[dict[str, Any]], default: str, batch: int, threads: int
) -> float | None:
    """Return the default model's rate over the paper's rate; None if a row is missing."""
    found = {
        row["model"]: row["segments_per_second"]
        for row in rows
        if row["served"] and (row["batch"], row["threads"]) == (batch, threads)
    }
    if default not in found or PAPER not in found:
        return None
    return round(float(found[default] / found[PAPER]), 2)


def draw_accuracy_speed(report: dict[str, Any], file: Path) -> None:
    """Plot accuracy against speed of each network, at the largest batch and most threads."""
    most = (max(report["plan"]["batches"]), max(report["plan"]["threads"]))
    with figure(file, size=6) as (axes,):
        for row in report["rows"]:
            if (row["batch"], row["threads"]) != most:
                continue
            speed, name = row["segments_per_second"], f"{row['model']} {row['precision']}"
            if row["top1"] is None:
                axes.axvline(speed, color="grey", linestyle=":")
                axes.annotate(f"{name}: accuracy unknown", (speed, 0.02), rotation=90, ha="right")
            else:
                axes.plot(speed, row["top1"], "o", color="#1b9e77")
                axes.annotate(name, (speed, row["top1"]), (5, 5), textcoords="offset points")
        axes.set(
            xscale="log",
            ylim=(0, 1),
            xlabel=f"inference, segments per second (batch {most[0]}, {most[1]} threads)",
            ylabel="top-1 accuracy on the model's validation groups",
            title=report["machine"]["processor"],
        )
        axes.margins(x=0.3)
        axes.grid(alpha=0.3)
