"""`placecell train`: trains an extractor on drives with one of the paper's methods."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.common_options import License, Resume, Runs, TrainingDrives
from cli.outputs import output_folder
from cli.sources import clear_errors, sources
from cli.tables import progress_console

if TYPE_CHECKING:
    from placecell.descriptors.manifest import Manifest
    from training.export.publishing import Data


class Method(StrEnum):
    """Training methods."""

    GROUP = "group"
    SIAMESE = "siamese"
    CONTRASTIVE = "contrastive"
    CONTEXT = "context"
    EIGENVALUE = "eigenvalue"


def train(
    method: Annotated[Method, typer.Argument(help="Training method.")],
    drives: TrainingDrives,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            callback=output_folder,
            help="Folder for the model. (default: models/METHOD)",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Random seed of the training.")] = 0,
    network: Annotated[
        str | None,
        typer.Option(
            help="Network of the extractor: fast, wide, paper or paper-reduced. "
            "(default: wide for context, otherwise fast)"
        ),
    ] = None,
    epochs: Annotated[
        int | None,
        typer.Option(
            min=1, help="Number of passes over the training set. (default: set by the method)"
        ),
    ] = None,
    keep_network: Annotated[
        str | None,
        typer.Option(
            metavar="MODEL",
            help="Model of the method context whose network is kept: name or folder. Only the "
            "neighborhood's part, the quantizer and the pair classifier are fitted. (default: "
            "train a network)",
        ),
    ] = None,
    runs: Runs = Path("runs"),
    resume: Resume = False,
    license_name: License = "not stated",
) -> None:
    """Train an extractor and write a model folder: ONNX file, manifest, model card.

    group: each group of segments is a class (paper, section III-C). siamese: random pairs, and a
    third network that predicts whether they match (III-D). contrastive: hard pairs and a margin
    (III-E). context: the group-based network plus the neighborhood of each segment. eigenvalue:
    the baseline, SegMatch's features standardized on the drives.
    """
    from placecell.core.parameters import NEIGHBORHOOD_V1
    from placecell.descriptors.shipped_models import MODELS_FOLDER, model_folder

    own = "wide" if method is Method.CONTEXT else "fast"
    options = ["--network", network] if network not in (None, own) else []
    options += ["--epochs", str(epochs)] if epochs else []
    options += ["--keep-network", Path(keep_network).name] if keep_network else []
    folder = output or MODELS_FOLDER / method
    with clear_errors():
        from training.export.publishing import collect, publish_eigenvalue, retraining
        from training.export.refitting import publish_refit

        if keep_network and method is not Method.CONTEXT:
            raise ValueError(f"--keep-network needs the method context, not {method}.")
        parts = sources(drives)
        command = retraining(["train", method], parts, license_name, seed, *options)
        around = NEIGHBORHOOD_V1 if method is Method.CONTEXT else None
        data = collect(parts, license_name, around).stating(seed=seed, command=command)
        if method is Method.EIGENVALUE:
            manifest = publish_eigenvalue(folder, data)
        elif keep_network:
            manifest = publish_refit(folder, model_folder(keep_network), data)
        else:
            manifest = learn(method, folder, data, seed, network or own, epochs, runs, resume)
    typer.echo(f"Model {manifest.model_id} is in {folder}.")


def learn(
    method: str,
    folder: Path,
    data: "Data",
    seed: int,
    network: str,
    epochs: int | None,
    runs: Path,
    resume: bool,
) -> "Manifest":
    """Train a network with a progress bar and write its model folder."""
    from rich.progress import Progress

    from training.export.publishing import fingerprint, publish_network
    from training.methods import registry
    from training.methods.run import Run

    checkpoints = registry.run_folder(runs, method, network, seed)
    if not resume:
        (checkpoints / "checkpoint.pt").unlink(missing_ok=True)
    with Progress(console=progress_console()) as progress:
        changes = {"epochs": epochs}
        # Runs have the same names as in the experiments, so their networks can be published here.
        identity = fingerprint(data, method, network, changes)
        run = Run(checkpoints, seed, identity, progress)
        trained = registry.train(method, data.training, data.validation, run, network, **changes)
    return publish_network(folder, trained, data.stating(**run.cost()))
