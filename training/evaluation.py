"""`placecell evaluate`: every extractor on a drive, under a named protocol (paper IV-B)."""

import os
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from segments.extractor import Extractor, load_extractor
from segments.models import BASELINE, DEFAULT_MODEL, MODELS_FOLDER, model_folder, shipped_models
from segments.recording import Recording
from segments.types import Float32, Int64
from training import recognition


def measure(
    extractor: Extractor, descriptors: Float32, groups: Int64, sensors: Float32, seed: int
) -> dict[str, Any]:
    """All figures of one extractor; None where nothing is there to be measured."""
    found = recognition.retrieve(descriptors, groups)
    crossed = recognition.retrieve(descriptors, groups, sensors, recognition.CROSS_VIEW_METRES)
    positive, negative = recognition.draw_pairs(
        groups, recognition.PAIRS, np.random.default_rng(seed)
    )
    near = recognition.pair_distances(descriptors, positive)
    far = recognition.pair_distances(descriptors, negative)
    paired = bool(len(near) and len(far))
    return {
        "model_id": extractor.manifest.model_id,
        "top1": mean(found.right),
        "top1_with_mate": mean(found.right[found.has_mate]),
        "cross_view_top1": mean(crossed.right[crossed.has_mate]),
        "cross_view_queries": int(crossed.has_mate.sum()),
        "recall_at_25": mean(found.recalled[found.has_mate]),
        "pair_auc": recognition.area_under_roc(-near, -far) if paired else None,
        "pair_accuracy": recognition.accuracy_at(extractor.manifest.pair_threshold, near, far)
        if paired
        else None,
        "pair_by": "distance",
    }


def mean(values: np.ndarray[Any, Any]) -> float | None:
    """Share of true values; None of none."""
    return float(values.mean()) if len(values) else None


def evaluate(
    recording: Recording,
    scans: tuple[int, int] | None = None,
    models: Sequence[str] = (),
    seed: int = 0,
    models_folder: Path = MODELS_FOLDER,
) -> dict[str, Any]:
    """Measure extractors on a recording.

    Args:
        scans: first and last; only groups wholly within are taken in.
        models: names in `models/` or paths; all shipped ones unless given. The eigenvalue
            baseline is always measured.

    Returns:
        What `placecell evaluate --json` writes.

    Raises:
        ModelError: a model cannot be loaded.
        ValueError: no segments lie within the scans.
    """
    first, last = scans or (0, recording.scans - 1)
    inside = recording.within(first, last)
    chosen = np.flatnonzero(inside & recording.distinct)
    if not len(chosen):
        raise ValueError(f"{recording.name}: no group lies wholly within scans {first} to {last}")
    segments, groups = recording.segments.take(chosen), recording.groups[chosen]
    names = list(models) or shipped_models(models_folder)
    extractors = {}
    for name in dict.fromkeys([*names, BASELINE]):
        extractor = load_extractor(model_folder(name, models_folder))
        quantiser = extractor.manifest.quantiser
        stored = quantiser.decode(quantiser.encode(extractor.describe(segments)))
        figures = measure(extractor, stored, groups, segments.sensors, seed)
        figures["seen"] = has_seen(extractor, recording, first, last)
        extractors[extractor.manifest.name] = figures
    return {
        "drive": recording.name,
        "scans": [first, last],
        "segments_raw": int(inside.sum()),
        "segments": len(chosen),
        "groups": len(np.unique(groups)),
        "default": DEFAULT_MODEL,
        "extractors": extractors,
        "protocol": recording.parameters.protocol,
        "every": recording.parameters.frame_step,
        "machine": machine(),
        "seed": seed,
    }


def has_seen(extractor: Extractor, recording: Recording, first: int, last: int) -> bool:
    """Whether the model was trained on any of these scans, wherever they lay."""
    trained: set[str] = set()
    for source in extractor.manifest.training.get("sources", []):
        trained.update(source["scan_hashes"])
    return not trained.isdisjoint(recording.scan_hashes[first : last + 1])


def machine() -> dict[str, Any]:
    """What a figure was measured on."""
    return {
        "processor": processor_name(),
        "cores": len(os.sched_getaffinity(0)),
        "system": platform.platform(terse=True),
        "python": platform.python_version(),
    }


def processor_name() -> str:
    """The processor's name where the system tells it."""
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
