"""The paper's experiments (section IV) as one command: train all, compare all, report.

    placecell experiments --train DRIVE@0:299 --train OTHER --test DRIVE@300:500

Every training leaves its run and its model in the output's folders; stopped, the command goes on
where it was.
"""

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.progress import Progress

from segments.extractor import MODEL_FILE, load_extractor
from segments.manifest import FILE as MANIFEST_FILE
from segments.manifest import Manifest
from segments.pairs import load_pair_classifier
from segments.parameters import Parameters
from segments.types import Float64
from training import methods, recognition
from training.evaluation import machine, measure
from training.publishing import (
    Data,
    collect,
    fingerprint,
    publish_eigenvalue,
    publish_network,
    stored_descriptors,
)
from training.run import Run
from training.training_set import Source, TrainingSet


@dataclass(frozen=True, slots=True)
class Plan:
    """What is trained.

    Attributes:
        networks: by name; the first is the one that ablations use.
        seeds: trainings of each method on the first network; the others are trained once.
        dropouts: of the Siamese, to show what regularisation does to its over-fitting.
        epochs: of every training; None: each recipe's own.
        epochs_3d: of the `paper` network, whose epochs cost thirty times as much; None likewise.
    """

    networks: tuple[str, ...] = ("fast", "paper-reduced", "paper")
    seeds: int = 3
    dropouts: tuple[float, ...] = (0.0, 0.2, 0.5)
    epochs: int | None = None
    epochs_3d: int | None = 8

    def trainings(self) -> "Iterator[Training]":
        """All trainings, cheapest first."""
        first = self.networks[0]
        for seed in range(self.seeds):
            for method in methods.METHODS:
                yield Training(method, first, seed, self._changes(first))
        for dropout in self.dropouts:
            changes = self._changes(first) | {"dropout": dropout}
            yield Training("siamese", first, 0, changes, f"dropout-{dropout}")
        random_pairs = self._changes(first) | {"hard": False}
        yield Training("contrastive", first, 0, random_pairs, "random-pairs")
        for network in self.networks[1:]:
            for method in methods.METHODS:
                yield Training(method, network, 0, self._changes(network))

    def _changes(self, network: str) -> dict[str, Any]:
        return {"epochs": self.epochs_3d if network == "paper" else self.epochs}


@dataclass(frozen=True, slots=True)
class Training:
    """One training of the plan.

    Attributes:
        method: by name.
        network: by name.
        seed: of the training; the split into training and validation set is always the same.
        changes: to the method's recipe.
        ablation: what is special about it; empty for those that are compared with the paper.
    """

    method: str
    network: str
    seed: int
    changes: dict[str, Any] = field(default_factory=dict)
    ablation: str = ""

    @property
    def name(self) -> str:
        """Of its run and its model."""
        parts = [self.method, self.network, str(self.seed), self.ablation]
        return "-".join(part for part in parts if part)


def run_experiments(
    training_sources: list[Source],
    test_source: Source,
    plan: Plan,
    output: Path,
    licence: str,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Do what of the plan is not yet done, measure all, and return the report's content."""
    data = collect(training_sources, 0, licence, "placecell experiments")
    training, validation = data.training, data.validation
    test = TrainingSet.of([test_source])
    if not len(test):
        raise ValueError("no segments to test on; are the scans right?")

    check_identity(output, fingerprint(data, plan.epochs, plan.epochs_3d))

    def publish(name: str, seed: int, make: Callable[[Path, Data], Any]) -> None:
        """Train and publish a model unless its folder is there already."""
        folder = output / "models" / name
        if not (folder / MANIFEST_FILE).exists():
            make(folder, replace(data, provenance=data.provenance | {"seed": seed}))

    publish("eigenvalue", 0, publish_eigenvalue)
    trainings = list(plan.trainings())
    task = progress.add_task("trainings", total=len(trainings)) if progress else None
    for one in trainings:
        publish(one.name, one.seed, partial(_train, one, output, progress))
        if progress and task is not None:
            progress.update(task, advance=1)
    report: dict[str, Any] = {
        "test": {
            "drive": test_source.recording.name,
            "scans": [test_source.first, test_source.last],
            "segments": len(test),
            "groups": len(test.group_sizes()),
        },
        "training": {
            "sources": [
                {key: value for key, value in source.describe().items() if key != "scan_hashes"}
                for source in training_sources
            ],
            "segments": len(training),
            "groups": len(training.group_sizes()),
            "validation_segments": len(validation),
        },
        "protocol": test_source.recording.parameters.protocol,
        "machine": machine(),
        "fits_grid": fits_grid(test),
        "models": {},
        "throughput": throughput(output, plan, test.parameters),
    }
    eigenvalue = Training("eigenvalue", "", 0)
    for one in [eigenvalue, *trainings]:
        name = one.name if one.network else "eigenvalue"
        report["models"][name] = asdict(one) | compare(output / "models" / name, test)
        history = output / "runs" / one.name / "history.json"
        if history.exists():
            report["models"][name]["history"] = json.loads(history.read_text())
    return report


def check_identity(output: Path, identity: str) -> None:
    """See that what lies in the output's folder was learned from the same data.

    Raises:
        ValueError: it was not.
    """
    file = output / "identity"
    if file.exists() and file.read_text() != identity:
        raise ValueError(
            f"{output}: holds experiments on other drives or with other epochs; "
            "name another folder with --output, or remove this one"
        )
    output.mkdir(parents=True, exist_ok=True)
    file.write_text(identity)


def _train(
    one: Training, output: Path, progress: Progress | None, folder: Path, data: Data
) -> None:
    identity = fingerprint(data, one.method, one.network, one.changes)
    run = Run(output / "runs" / one.name, one.seed, identity, progress)
    trained = methods.train(
        one.method, data.training, data.validation, run, one.network, **one.changes
    )
    provenance = data.provenance | {"seconds": round(run.seconds, 1)}
    publish_network(folder, trained, replace(data, provenance=provenance))


def compare(folder: Path, test: TrainingSet) -> dict[str, Any]:
    """One model on the test set: its figures, its ROC curve and its distances' distributions."""
    manifest = Manifest.load(folder)
    extractor = load_extractor(folder)
    classifier = load_pair_classifier(folder, manifest)
    figures = measure(extractor, classifier, test.segments, test.groups, seed=0)
    stored = stored_descriptors(extractor, test)
    codes = manifest.quantiser.encode(stored)
    drawn = recognition.draw_pairs(test.groups, recognition.PAIRS, np.random.default_rng(0))
    near, far = (recognition.pair_distances(stored, pairs) for pairs in drawn)
    likely, unlikely = -near, -far
    if classifier is not None:
        likely, unlikely = (
            classifier.probabilities(codes[pairs[:, 0]], codes[pairs[:, 1]]) for pairs in drawn
        )
    edges = np.linspace(0, max(near.max(), far.max()), 61)
    return {
        "figures": figures,
        "pair": manifest.pair,
        "seconds": manifest.training["seconds"],
        "roc": roc_curve(likely, unlikely),
        "distances": {
            "edges": edges.tolist(),
            "positive": np.histogram(near, edges, density=True)[0].tolist(),
            "negative": np.histogram(far, edges, density=True)[0].tolist(),
        },
    }


def roc_curve(positive: Float64, negative: Float64, points: int = 101) -> list[list[float]]:
    """False positive rate and true positive rate at evenly spread false positive rates."""
    rates = np.linspace(0, 1, points)
    thresholds = np.quantile(negative, 1 - rates)
    return [
        [float(rate), float((positive >= threshold).mean())]
        for rate, threshold in zip(rates, thresholds, strict=True)
    ]


def fits_grid(data: TrainingSet) -> float:
    """Share of segments that fit entirely into the voxel grid (the paper's: about 95%)."""
    from segments.alignment import align
    from segments.segments import Segments

    aligned = Segments(align(data.segments), data.segments.ends, data.segments.sensors)
    lowest, highest = aligned.bounds()
    limit = np.array(data.parameters.grid) * data.parameters.grid_voxel
    return float((highest - lowest <= limit).all(axis=1).mean())


def throughput(output: Path, plan: Plan, parameters: Parameters) -> dict[str, float]:
    """Segments a second of each network through ONNX Runtime, batches of 64, all cores."""
    import onnxruntime

    random = np.random.default_rng(0)
    inputs = {
        "occupancy": (random.random((64, *parameters.grid)) < 0.01).astype(np.uint8),
        "extents": random.uniform(0.5, 5, (64, 3)).astype(np.float32),
    }
    rates = {}
    for network in plan.networks:
        file = output / "models" / Training("group", network, 0).name / MODEL_FILE
        session = onnxruntime.InferenceSession(file, providers=["CPUExecutionProvider"])
        session.run(None, inputs)
        seconds = []
        for _ in range(10):
            started = time.perf_counter()
            session.run(None, inputs)
            seconds.append(time.perf_counter() - started)
        rates[network] = 64 / float(np.median(seconds))
    return rates
