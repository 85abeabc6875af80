"""`placecell train`: one subcommand a method."""

import shlex
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.sources import SOURCE_HELP, clear_errors, load, split_source

if TYPE_CHECKING:
    from training.training_set import TrainingSet

VALIDATION_SHARE = 0.1

train = typer.Typer(
    help="Train an extractor on recorded or synthetic drives and write it as a model's folder.",
    no_args_is_help=True,
)

Sources = Annotated[list[str], typer.Argument(help=SOURCE_HELP, metavar="DRIVE[@FIRST:LAST]...")]
Output = Annotated[Path | None, typer.Option("--output", "-o", help="The model's folder.")]
Seed = Annotated[int, typer.Option(help="Of everything random.")]
Licence = Annotated[str, typer.Option(help="Licence of the drives, for the model's card.")]


@train.command()
def group(
    sources: Sources,
    output: Output = None,
    seed: Seed = 0,
    network: Annotated[str, typer.Option(help="The extractor's network.")] = "fast",
    epochs: Annotated[int, typer.Option(min=1, help="Passes over the training set.")] = 60,
    runs: Annotated[Path, typer.Option(help="Folder for checkpoints and histories.")] = Path(
        "runs"
    ),
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from this run's last checkpoint.")
    ] = False,
    licence: Licence = "not stated",
) -> None:
    """Train the paper's group-based extractor: every group is a class (section III-C)."""
    from rich.progress import Progress

    from segments.models import MODELS_FOLDER
    from training.group_based import GroupBasedRecipe
    from training.group_based import train as train_group
    from training.publishing import publish_network
    from training.run import Run

    with clear_errors():
        folder = runs / f"group-{network}-{seed}"
        if (folder / "checkpoint.pt").exists() and not resume:
            (folder / "checkpoint.pt").unlink()
        training, validation, provenance = training_data("group", sources, seed, licence)
        started = time.monotonic()
        with Progress() as progress:
            learned = train_group(
                training,
                validation,
                Run(folder, seed, progress),
                network,
                GroupBasedRecipe(epochs=epochs),
            )
        manifest = publish_network(
            output or MODELS_FOLDER / "group",
            (output or Path("group")).name,
            "group",
            network,
            learned,
            training,
            validation,
            provenance(time.monotonic() - started),
        )
    typer.echo(f"{output or MODELS_FOLDER / 'group'}: {manifest.model_id}")


@train.command()
def eigenvalue(
    sources: Sources, output: Output = None, seed: Seed = 0, licence: Licence = "not stated"
) -> None:
    """Standardise SegMatch's eigenvalue features, the baseline, on the training set."""
    from segments.models import MODELS_FOLDER
    from training.publishing import publish_eigenvalue

    with clear_errors():
        training, validation, provenance = training_data("eigenvalue", sources, seed, licence)
        folder = output or MODELS_FOLDER / "eigenvalue"
        manifest = publish_eigenvalue(folder, training, validation, provenance(0.0))
    typer.echo(f"{folder}: {manifest.model_id}")


def training_data(
    method: str, sources: list[str], seed: int, licence: str
) -> tuple["TrainingSet", "TrainingSet", Callable[[float], dict[str, Any]]]:
    """Training set, validation set, and what the manifest says of them once the time is known."""
    from training.evaluation import machine
    from training.training_set import Source, TrainingSet

    parts = []
    for text in sources:
        path, scans = split_source(text)
        recording = load(path)
        parts.append(Source(recording, *(scans or (0, recording.scans - 1))))
    whole = TrainingSet.of(parts)
    training, validation = whole.split(VALIDATION_SHARE, seed)

    def provenance(seconds: float) -> dict[str, Any]:
        return {
            "sources": [part.describe() for part in parts],
            "segments": len(training),
            "groups": len(training.group_sizes()),
            "validation_share": VALIDATION_SHARE,
            "licence": licence,
            "seed": seed,
            "seconds": round(seconds, 1),
            "machine": machine(),
            "command": shlex.join(
                [
                    *("placecell", "train", method),
                    *(text.rpartition("/")[2].replace(".safetensors", "") for text in sources),
                    *("--seed", str(seed), "--licence", licence),
                ]
            ),
        }

    return training, validation, provenance
