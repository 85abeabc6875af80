"""`placecell train`: an extractor from drives, by one of the paper's methods."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.sources import SOURCE_HELP, TOWN_HELP, clear_errors, sources
from cli.tables import progress_console

if TYPE_CHECKING:
    from placecell.descriptors.manifest import Manifest
    from training.export.publishing import Data


class Method(StrEnum):
    """What can be trained."""

    GROUP = "group"
    SIAMESE = "siamese"
    CONTRASTIVE = "contrastive"
    CONTEXT = "context"
    EIGENVALUE = "eigenvalue"


def train(
    method: Annotated[Method, typer.Argument(help="How to learn.")],
    drives: Annotated[
        list[str], typer.Argument(help=SOURCE_HELP + TOWN_HELP, metavar="DRIVE[@FIRST:LAST]...")
    ],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="The model's folder. (default: models/METHOD)"),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of everything random.")] = 0,
    network: Annotated[
        str | None,
        typer.Option(
            help="The extractor's network: fast, wide, paper or paper-reduced. "
            "(default: wide for context, else fast)"
        ),
    ] = None,
    epochs: Annotated[
        int | None,
        typer.Option(min=1, help="Passes over the training set. (default: the method's own)"),
    ] = None,
    runs: Annotated[Path, typer.Option(help="Folder for checkpoints and histories.")] = Path(
        "runs"
    ),
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from this run's last checkpoint.")
    ] = False,
    license_name: Annotated[
        str, typer.Option("--license", help="License of the drives, for the model's card.")
    ] = "not stated",
) -> None:
    """Train an extractor and write it as a model's folder: ONNX, manifest, card.

    group: every group of segments is a class (paper, section III-C). siamese: random pairs, and a
    third network that says whether they match (III-D). contrastive: hard pairs and a margin
    (III-E). context: the group-based network, and what stands around each segment. eigenvalue:
    SegMatch's features, standardised on the drives; the baseline.
    """
    from placecell.core.parameters import NEIGHBORHOOD_V1
    from placecell.descriptors.shipped_models import MODELS_FOLDER

    own = "wide" if method is Method.CONTEXT else "fast"
    options = ["--network", network] if network not in (None, own) else []
    options += ["--epochs", str(epochs)] if epochs else []
    folder = output or MODELS_FOLDER / method
    with clear_errors():
        from training.export.publishing import collect, publish_eigenvalue, retraining

        parts = sources(drives)
        command = retraining(method, parts, license_name, seed, *options)
        around = NEIGHBORHOOD_V1 if method is Method.CONTEXT else None
        data = collect(parts, license_name, around).stating(seed=seed, command=command)
        if method is Method.EIGENVALUE:
            manifest = publish_eigenvalue(folder, data)
        else:
            manifest = learn(method, folder, data, seed, network or own, epochs, runs, resume)
    typer.echo(f"{folder}: {manifest.model_id}")


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
    """Train a network, with a progress bar, and publish what it learned."""
    from rich.progress import Progress

    from training.export.publishing import fingerprint, publish_network
    from training.methods import registry
    from training.methods.run import Run

    checkpoints = registry.run_folder(runs, method, network, seed)
    if not resume:
        (checkpoints / "checkpoint.pt").unlink(missing_ok=True)
    with Progress(console=progress_console()) as progress:
        changes = {"epochs": epochs}
        # As the experiments name their runs: what they trained can be published from here.
        identity = fingerprint(data, method, network, changes)
        run = Run(checkpoints, seed, identity, progress)
        trained = registry.train(method, data.training, data.validation, run, network, **changes)
    return publish_network(folder, trained, data.stating(**run.cost()))
