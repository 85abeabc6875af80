"""`placecell train`: one subcommand a method."""

import shlex
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.sources import SOURCE_HELP, clear_errors, source

if TYPE_CHECKING:
    from training.publishing import Data

VALIDATION_SHARE = 0.1

train = typer.Typer(
    help="Train an extractor on recorded or synthetic drives and write it as a model's folder.",
    no_args_is_help=True,
)

Sources = Annotated[list[str], typer.Argument(help=SOURCE_HELP, metavar="DRIVE[@FIRST:LAST]...")]
Output = Annotated[
    Path | None,
    typer.Option("--output", "-o", help="The model's folder. [default: models/METHOD]"),
]
Seed = Annotated[int, typer.Option(help="Of everything random.")]
Licence = Annotated[str, typer.Option(help="Licence of the drives, for the model's card.")]
Network = Annotated[
    str, typer.Option(help="The extractor's network: fast, paper or paper-reduced.")
]
Epochs = Annotated[
    int | None, typer.Option(min=1, help="Passes over the training set. [default: the recipe's]")
]
Runs = Annotated[Path, typer.Option(help="Folder for checkpoints and histories.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on from this run's last checkpoint.")]


@train.command()
def group(
    sources: Sources,
    output: Output = None,
    seed: Seed = 0,
    network: Network = "fast",
    epochs: Epochs = None,
    runs: Runs = Path("runs"),
    resume: Resume = False,
    licence: Licence = "not stated",
) -> None:
    """Train the paper's group-based extractor: every group is a class (section III-C)."""
    train_method("group", sources, output, seed, network, epochs, runs, resume, licence)


@train.command()
def siamese(
    sources: Sources,
    output: Output = None,
    seed: Seed = 0,
    network: Network = "fast",
    epochs: Epochs = None,
    runs: Runs = Path("runs"),
    resume: Resume = False,
    licence: Licence = "not stated",
) -> None:
    """Train the paper's Siamese network: random pairs, a third network judges (section III-D)."""
    train_method("siamese", sources, output, seed, network, epochs, runs, resume, licence)


@train.command()
def contrastive(
    sources: Sources,
    output: Output = None,
    seed: Seed = 0,
    network: Network = "fast",
    epochs: Epochs = None,
    runs: Runs = Path("runs"),
    resume: Resume = False,
    licence: Licence = "not stated",
) -> None:
    """Train the paper's contrastive extractor on hard pairs (section III-E)."""
    train_method("contrastive", sources, output, seed, network, epochs, runs, resume, licence)


@train.command()
def eigenvalue(
    sources: Sources, output: Output = None, seed: Seed = 0, licence: Licence = "not stated"
) -> None:
    """Standardise SegMatch's eigenvalue features, the baseline, on the training set."""
    from segments.models import MODELS_FOLDER
    from training.publishing import publish_eigenvalue

    with clear_errors():
        folder = output or MODELS_FOLDER / "eigenvalue"
        manifest = publish_eigenvalue(
            folder, training_data("eigenvalue", sources, seed, licence)(0)
        )
    typer.echo(f"{folder}: {manifest.model_id}")


def train_method(
    method: str,
    sources: list[str],
    output: Path | None,
    seed: int,
    network: str,
    epochs: int | None,
    runs: Path,
    resume: bool,
    licence: str,
) -> None:
    """Train by a method and publish what it learned."""
    from rich.progress import Progress

    from segments.models import MODELS_FOLDER
    from training import methods
    from training.publishing import publish_network
    from training.run import Run

    with clear_errors():
        checkpoints = methods.run_folder(runs, method, network, seed)
        if not resume:
            (checkpoints / "checkpoint.pt").unlink(missing_ok=True)
        options = ["--network", network] if network != "fast" else []
        options += ["--epochs", str(epochs)] if epochs else []
        known = training_data(method, sources, seed, licence, options)
        data = known(0)
        with Progress() as progress:
            run = Run(checkpoints, seed, progress)
            trained = methods.train(
                method, data.training, data.validation, run, network, epochs=epochs
            )
        folder = output or MODELS_FOLDER / method
        manifest = publish_network(folder, trained, known(run.seconds))
    typer.echo(f"{folder}: {manifest.model_id}")


def training_data(
    method: str, sources: list[str], seed: int, licence: str, options: list[str] | None = None
) -> Callable[[float], "Data"]:
    """The data of a training, complete once its seconds are known."""
    from training.evaluation import machine
    from training.publishing import Data
    from training.training_set import TrainingSet

    parts = [source(text) for text in sources]
    training, validation = TrainingSet.of(parts).split(VALIDATION_SHARE, seed)
    names = [text.rpartition("/")[2].replace(".safetensors", "") for text in sources]
    command = ["placecell", "train", method, *names, "--seed", str(seed), *(options or [])]

    def known(seconds: float) -> Data:
        provenance = {
            "sources": [part.describe() for part in parts],
            "segments": len(training),
            "groups": len(training.group_sizes()),
            "validation_share": VALIDATION_SHARE,
            "licence": licence,
            "seed": seed,
            "seconds": round(seconds, 1),
            "machine": machine(),
            "command": shlex.join([*command, "--licence", licence]),
        }
        return Data(training, validation, provenance)

    return known
