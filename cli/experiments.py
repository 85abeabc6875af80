"""`placecell experiments`: the paper's experiments, from trainings to the report."""

import shlex
from pathlib import Path
from typing import Annotated

import typer

from cli.sources import SOURCE_HELP, TOWN_HELP, clear_errors, source, sources, town_recordings
from cli.tables import progress_console


def experiments(
    train: Annotated[
        list[str] | None,
        typer.Option(
            help=SOURCE_HELP + TOWN_HELP + " May be repeated.", metavar="DRIVE[@FIRST:LAST]"
        ),
    ] = None,
    test: Annotated[
        str | None, typer.Option(help="What to test on.", metavar="DRIVE[@FIRST:LAST]")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Folder for runs, models and the report. "
            "(default: out/experiments, with --quick out/experiments-quick)",
        ),
    ] = None,
    network: Annotated[
        list[str] | None,
        typer.Option(
            help="Networks; the first gets all seeds. (default: fast, paper-reduced, paper)"
        ),
    ] = None,
    seeds: Annotated[int, typer.Option(min=1, help="Trainings on the first network.")] = 3,
    epochs: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Of every training. (default: each method's own, fewer on the paper network)",
        ),
    ] = None,
    quick: Annotated[
        bool,
        typer.Option("--quick", help="A smoke run: few epochs, one seed, the fast network alone."),
    ] = False,
    license_name: Annotated[
        str, typer.Option("--license", help="License of the drives, for the models' cards.")
    ] = "not stated",
) -> None:
    """Train the paper's three methods, compare them with the baseline, and write the report.

    Without drives it drives the synthetic town: trained on robot A's drive, tested on robot B's.
    Run it again to go on where it was stopped.
    """
    from rich.progress import Progress

    with clear_errors():
        from training.data.training_set import Source
        from training.experiments.experiments import run_experiments
        from training.experiments.plan import Plan
        from training.experiments.report import write_report

    plan = Plan(networks=tuple(network or Plan().networks), seeds=seeds, epochs=epochs)
    if quick:
        plan = Plan(networks=("fast",), seeds=1, dropouts=(0.0, 0.5), epochs=epochs or 2)
    folder = output or Path("out/experiments-quick" if quick else "out/experiments")
    words = ["placecell", "experiments", *(f"--train={name(text)}" for text in train or ())]
    words += [f"--test={name(test)}"] if test else []
    words += [f"--network={each}" for each in network or ()]
    words += [f"--seeds={seeds}"] if seeds != Plan().seeds else []
    words += [f"--epochs={epochs}"] if epochs else []
    words += ["--quick"] if quick else []
    command = shlex.join(words)
    with clear_errors():
        if bool(train) != bool(test):
            raise ValueError("give both --train and --test, or neither for the synthetic town")
        if train and test:
            training_sources, test_source = sources(train), source(test)
        else:
            a, b = (
                Source(recording, 0, recording.scans - 1)
                for recording in town_recordings(seed=1, scans=60 if quick else 400)
            )
            training_sources, test_source = [a], b
        with Progress(console=progress_console()) as progress:
            report = run_experiments(
                training_sources, test_source, plan, folder, license_name, command, progress
            )
        file = write_report(report, folder)
    typer.echo(f"report: {file}")


def name(source: str) -> str:
    """A source as it is told to others: without the folders it lies in."""
    return source.rpartition("/")[2]
