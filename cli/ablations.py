"""`placecell ablations`: what each part of the context model is worth."""

import json
import shlex
from pathlib import Path
from typing import Annotated

import typer

from cli.experiments import name
from cli.sources import SOURCE_HELP, TOWN_HELP, clear_errors, source, sources
from cli.tables import progress_console


def ablations(
    train: Annotated[
        list[str],
        typer.Option(
            help=SOURCE_HELP + TOWN_HELP + " May be repeated.", metavar="DRIVE[@FIRST:LAST]"
        ),
    ],
    test: Annotated[str, typer.Option(help="What to test on.", metavar="DRIVE[@FIRST:LAST]")],
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for runs, models and the report.")
    ] = Path("out/ablations"),
    epochs: Annotated[int, typer.Option(min=1, help="Of every training.")] = 6,
    seeds: Annotated[int, typer.Option(min=1, help="Of the model itself.")] = 3,
    part: Annotated[
        list[str] | None,
        typer.Option(
            help="Only these: model, surroundings, data, augmentation, network, loss. "
            "May be repeated. (default: all)"
        ),
    ] = None,
) -> None:
    """Train the context model with one thing changed at a time, and compare.

    Losses are compared at the best of the same learning rates, told by the validation groups. Run
    it again to go on where it was stopped.
    """
    from rich.progress import Progress

    command = shlex.join(
        [
            *("placecell", "ablations", *(f"--train={name(text)}" for text in train)),
            *(f"--test={name(test)}", f"--epochs={epochs}", f"--seeds={seeds}"),
            *(f"--part={each}" for each in part or ()),
        ]
    )
    with clear_errors():
        from training.experiments.ablations import run_ablations, variants
        from training.experiments.ablations_report import write_ablations

        everything = list(variants(epochs, seeds))
        parts = dict.fromkeys(variant.part for variant in everything)
        if unknown := set(part or ()) - set(parts):
            raise ValueError(f"no part {unknown.pop()!r}; there are {', '.join(parts)}")
        chosen = [one for one in everything if not part or one.part in {"model", *part}]
        with Progress(console=progress_console()) as progress:
            report = run_ablations(sources(train), source(test), chosen, output, progress)
        file = write_ablations(report | {"command": command}, output)
        (output / "ablations.json").write_text(
            json.dumps(report, indent=1) + "\n", encoding="utf-8"
        )
    typer.echo(f"report: {file}")
