"""Paper's experiments (section IV) as one command: trains and compares all models.

    placecell experiments --train DRIVE@0:299 --train OTHER --test DRIVE@300:500

Every training stores its run and its model in the output folder. A stopped command continues when
it is started again.
"""

import json
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from rich.progress import Progress

from evaluation.machine import machine
from placecell.descriptors.extractor import MODEL_FILE
from placecell.descriptors.manifest import FILE as MANIFEST_FILE
from training.data.training_set import Source, TrainingSet, check_apart
from training.experiments.comparison import compare, fits_grid, throughput
from training.experiments.plan import ExperimentPlan, Training
from training.export.publishing import (
    Data,
    collect,
    fingerprint,
    publish_eigenvalue,
    publish_network,
    retraining,
)
from training.methods import registry
from training.methods.run import Run


def run_experiments(
    training_sources: list[Source],
    test_source: Source,
    plan: ExperimentPlan,
    output: Path,
    license_name: str,
    command: str,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Train the models that are not yet in the output folder; measure all models.

    Args:
        training_sources: parts of recordings to train on.
        test_source: part of a recording to test on.
        plan: trainings of the experiments.
        output: output folder.
        license_name: license of the drives.
        command: command that runs these experiments, for the report and the model cards.
        progress: display of the progress; None for no display.

    Returns:
        Content of the report.

    Raises:
        ValueError: the test shares scans with the training, there are too few groups or test
            segments, or the output folder holds other experiments.
    """
    check_apart([*training_sources, test_source])
    data = collect(training_sources, license_name)
    training, validation = data.training, data.validation
    test = TrainingSet.of([test_source])
    if not len(test):
        raise ValueError("No segments lie within the test scans. Choose other scans or a drive.")

    check_identity(output, fingerprint(data, plan.epochs, plan.epochs_3d))

    def publish(one: Training, make: Callable[[Path, Data], Any]) -> None:
        """Train and publish a model unless its folder exists already."""
        folder = output / "models" / one.name
        if not (folder / MANIFEST_FILE).exists():
            again = retraining(
                ["train", one.method], training_sources, license_name, one.seed, *one.options()
            )
            make(folder, data.stating(seed=one.seed, command=command if one.ablation else again))

    eigenvalue = Training("eigenvalue", "", 0)
    publish(eigenvalue, publish_eigenvalue)
    trainings = list(plan.trainings())
    task = progress.add_task("trainings", total=len(trainings)) if progress else None
    for one in trainings:
        publish(one, partial(_train, one, output, progress))
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
        "command": command,
        "protocol": test_source.recording.parameters.protocol,
        "machine": machine(),
        "fits_grid": fits_grid(test),
        "models": {},
        "throughput": throughput(
            {
                network: output / "models" / Training("group", network, 0).name / MODEL_FILE
                for network in plan.networks
            },
            test.parameters,
        ),
    }
    for one in [eigenvalue, *trainings]:
        name, first_of_its_kind = one.name, not one.seed and not one.ablation
        report["models"][name] = asdict(one) | compare(
            output / "models" / name, test, training, paper_forest=first_of_its_kind
        )
        history = output / "runs" / one.name / "history.json"
        if history.exists():
            report["models"][name]["history"] = json.loads(history.read_text())
    return report


def check_identity(output: Path, identity: str) -> None:
    """Check that the output folder belongs to the same experiments.

    Raises:
        ValueError: the folder holds experiments on other drives or with other epochs.
    """
    file = output / "identity"
    if file.exists() and file.read_text() != identity:
        raise ValueError(
            f"{output} holds experiments on other drives or with other epochs. Choose another "
            "folder with --output, or remove this one."
        )
    output.mkdir(parents=True, exist_ok=True)
    file.write_text(identity)


def _train(
    one: Training, output: Path, progress: Progress | None, folder: Path, data: Data
) -> None:
    identity = fingerprint(data, one.method, one.network, one.changes)
    run = Run(output / "runs" / one.name, one.seed, identity, progress)
    trained = registry.train(
        one.method, data.training, data.validation, run, one.network, **one.changes
    )
    publish_network(folder, trained, data.stating(**run.cost()))
