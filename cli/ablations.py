"""`placecell ablations`: measures what each part of the context model contributes."""

import json
import shlex
from pathlib import Path
from typing import Annotated

import typer

from cli.experiments import name
from cli.outputs import output_folder
from cli.sources import SOURCE_HELP, TOWN_HELP, clear_errors, source, sources
from cli.tables import progress_console


def ablations(
    train: Annotated[
        list[str],
        typer.Option(
            help="Training drive; repeatable. " + SOURCE_HELP + TOWN_HELP,
            metavar="DRIVE[@FIRST:LAST]",
        ),
    ],
    test: Annotated[
        str, typer.Option(help="Test drive. " + SOURCE_HELP, metavar="DRIVE[@FIRST:LAST]")
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            callback=output_folder,
            help="Folder for the runs, the models and the report.",
        ),
    ] = Path("out/ablations"),
    epochs: Annotated[int, typer.Option(min=1, help="Number of epochs of each training.")] = 6,
    seeds: Annotated[int, typer.Option(min=1, help="Number of seeds for the unchanged model.")] = 3,
    part: Annotated[
        list[str] | None,
        typer.Option(
            help="Part to vary: model, surroundings, data, augmentation, network or loss; "
            "repeatable. (default: all)"
        ),
    ] = None,
) -> None:
    """Train variants of the context model that differ in one part, and compare them.

    Each loss is trained with the same set of learning rates; the validation groups select the best
    one. Run the same command again to continue a stopped run.
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
            raise ValueError(f"unknown part {unknown.pop()!r}; expected one of {', '.join(parts)}")
        chosen = [one for one in everything if not part or one.part in {"model", *part}]
        with Progress(console=progress_console()) as progress:
            report = run_ablations(sources(train), source(test), chosen, output, progress)
        file = write_ablations(report | {"command": command}, output)
        (output / "ablations.json").write_text(
            json.dumps(report, indent=1) + "\n", encoding="utf-8"
        )
    typer.echo(f"The report is in {file}.")
