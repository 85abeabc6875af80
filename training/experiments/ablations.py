"""Ablations of the context model: trainings that differ in one setting each.

All variants but those of the loss use the group-based loss.

placecell ablations --train DRIVE@0:299 --train town:11 --test DRIVE@300:500
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.progress import Progress

from evaluation.recognition.evaluate import measure
from placecell.core.parameters import NEIGHBORHOOD_V1
from placecell.descriptors.extractor import MODEL_FILE, load_extractor
from placecell.descriptors.manifest import FULL_FILE
from training.data.augmentation import Augmentation
from training.data.training_set import Source, TrainingSet, check_apart
from training.experiments.comparison import throughput
from training.export.publishing import (
    Data,
    collect,
    export_network,
    fingerprint,
    stored_axes,
    whole,
)
from training.methods import metric
from training.methods.context import ContextRecipe, learn_neighborhood
from training.methods.fit import Sgd
from training.methods.group_based import GroupBasedRecipe
from training.methods.metric import MetricRecipe
from training.methods.registry import Trained, train_segment
from training.methods.run import Run

RATES = (0.05, 0.2)
"""Learning rates of each loss; the best one on the validation groups counts."""

NETWORKS = ("fast", "paper-reduced")
"""Networks that are compared with the network of the model."""


@dataclass(frozen=True, slots=True)
class Variant:
    """Variant: one training and its changed setting.

    Attributes:
        part: part of the model that differs; the variants of one part are compared.
        name: name of the choice.
        segment: recipe for the descriptor of the segment itself.
        neighborhood: recipe for the projection of the neighborhood.
        towns: True if the training includes synthetic towns.
    """

    part: str
    name: str
    segment: GroupBasedRecipe | MetricRecipe
    neighborhood: ContextRecipe = field(default_factory=ContextRecipe)
    network: str = "wide"
    towns: bool = True
    seed: int = 0

    def training_name(self) -> str:
        """Return the name of the network's run; variants of the neighborhood share it."""
        part = "model" if self.part == "surroundings" else self.part
        name = "seed-0" if self.part == "surroundings" else self.name
        return f"{part}-{name}"


def variants(epochs: int, seeds: int) -> Iterator[Variant]:
    """Yield all variants; the model itself, with several seeds, comes first."""
    base = GroupBasedRecipe(epochs=epochs)
    for seed in range(seeds):
        yield Variant("model", f"seed-{seed}", base, seed=seed)
    own = ContextRecipe()
    changed = {f"dimension-{size}": replace(own, dimension=size) for size in (32, 64, 128)}
    changed |= {f"weight-{weight}": replace(own, weight=weight) for weight in (0.8, 1.6)}
    changed |= {f"shrinkage-{share}": replace(own, shrinkage=share) for share in (0.02, 0.5)}
    for name, neighborhood in changed.items():
        yield Variant("surroundings", name, base, neighborhood)
    yield Variant("data", "without-towns", base, towns=False)
    changes = {
        "none": Augmentation(0.0, 0.0, 0.0, 0.0),
        "no-turns": Augmentation(yaw=0.0),
        "turns-60": Augmentation(yaw=np.radians(60.0)),
        "no-cuts": Augmentation(cut_share=0.0),
        "no-missing-points": Augmentation(drop_most=0.0),
    }
    for name, augmentation in changes.items():
        yield Variant("augmentation", name, replace(base, augmentation=augmentation))
    for network in NETWORKS:
        yield Variant("network", network, base, network=network)
    for rate in RATES:
        sgd = Sgd(learning_rate=rate)
        yield Variant("loss", f"cross-entropy-{rate}", replace(base, sgd=sgd))
        for loss in metric.LOSSES:
            yield Variant("loss", f"{loss}-{rate}", MetricRecipe(loss, epochs, sgd))


def run_ablations(
    training_sources: Sequence[Source],
    test_source: Source,
    chosen: Sequence[Variant],
    output: Path,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Train and measure every variant that is not yet in the output folder.

    Args:
        training_sources: parts of recordings to train on.
        test_source: part of a recording to test on.
        chosen: variants to train.
        output: output folder.
        progress: display of the progress; None for no display.

    Returns:
        `rows`: part, name, network, validation and test figures of each variant, in order.
        `throughput`: segments per second of each network's ONNX file, float32 and 8-bit.

    Raises:
        ValueError: the test shares scans with the training, or there are too few groups.
    """
    check_apart([*training_sources, test_source])
    everything = collect(training_sources, "not stated", NEIGHBORHOOD_V1)
    recorded = [source for source in training_sources if not source.synthetic] or training_sources
    real = collect(recorded, "not stated", NEIGHBORHOOD_V1)
    test = TrainingSet.of([test_source], NEIGHBORHOOD_V1)
    task = progress.add_task("variants", total=len(chosen)) if progress else None
    rows = []
    for variant in chosen:
        data = everything if variant.towns else real
        file = output / "rows" / f"{variant.part}-{variant.name}.json"
        if not file.exists():
            row = _measured(variant, data, test, output, progress)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(json.dumps(row, indent=1) + "\n")
        rows.append(json.loads(file.read_text()))
        if progress and task is not None:
            progress.update(task, advance=1)
    files = {
        f"{network} {precision}": output / "models" / f"{part}-{name}" / file_name
        for part, name, network in [("model", "seed-0", "wide")]
        + [("network", network, network) for network in NETWORKS]
        for precision, file_name in [("fp32", FULL_FILE), ("int8", MODEL_FILE)]
    }
    found = {name: file for name, file in files.items() if file.exists()}
    return {"rows": rows, "throughput": throughput(found, test.parameters)}


def _measured(
    variant: Variant, data: Data, test: TrainingSet, output: Path, progress: Progress | None
) -> dict[str, Any]:
    name = variant.training_name()
    identity = fingerprint(data, name, variant.network, variant.segment)
    run = Run(output / "runs" / name, variant.seed, identity, progress)
    network = train_segment(data.training, data.validation, run, variant.network, variant.segment)
    projection = learn_neighborhood(data.training, variant.neighborhood)
    trained = Trained("context", variant.network, network, projection=projection)
    with whole(output / "models" / f"{variant.part}-{variant.name}") as folder:
        export_network(folder, trained, data, stored_axes(trained, data)).save(folder)
        figures = measure(
            load_extractor(folder), None, test.segments, test.groups, 0, test.neighborhood
        )
    return {
        "part": variant.part,
        "name": variant.name,
        "network": variant.network,
        "seed": variant.seed,
        "validation_top1": run.history[-1]["validation_top1"],
        "seconds": run.cost()["seconds"],
        "top1_alone": figures["alone"]["top1"],
    } | {
        key: figures[key]
        for key in ("top1", "recall_at_25", "cross_view_top1", "pair_auc_by_distance")
    }
