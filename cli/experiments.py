"""`placecell experiments`: runs the paper's experiments and writes a report."""

import shlex
from pathlib import Path
from typing import Annotated

import typer

from cli.outputs import output_folder
from cli.sources import SOURCE_HELP, TOWN_HELP, clear_errors, source, sources, town_recordings
from cli.tables import progress_console


def experiments(
    train: Annotated[
        list[str] | None,
        typer.Option(
            help="Training drive; repeatable. " + SOURCE_HELP + TOWN_HELP,
            metavar="DRIVE[@FIRST:LAST]",
        ),
    ] = None,
    test: Annotated[
        str | None, typer.Option(help="Test drive. " + SOURCE_HELP, metavar="DRIVE[@FIRST:LAST]")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            callback=output_folder,
            help="Folder for the runs, the models and the report. "
            "(default: out/experiments; out/experiments-quick with --quick)",
        ),
    ] = None,
    network: Annotated[
        list[str] | None,
        typer.Option(
            help="Network; repeatable. The first one is trained with all seeds. "
            "(default: fast, paper-reduced, paper)"
        ),
    ] = None,
    seeds: Annotated[int, typer.Option(min=1, help="Number of seeds for the first network.")] = 3,
    epochs: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Number of epochs of each training. "
            "(default: set by the method; fewer for the paper's network)",
        ),
    ] = None,
    quick: Annotated[
        bool,
        typer.Option("--quick", help="Smoke test: few epochs, one seed, only the fast network."),
    ] = False,
    license_name: Annotated[
        str, typer.Option("--license", help="License of the drives, written into the model cards.")
    ] = "not stated",
) -> None:
    """Train the paper's three methods, compare them with the baseline, and write a report.

    Without --train and --test the command simulates two drives through the synthetic town: robot
    A's drive is for training, robot B's for testing. Run the same command again to continue a
    stopped run.
    """
    from rich.progress import Progress

    with clear_errors():
        from training.data.training_set import Source
        from training.experiments.experiments import run_experiments
        from training.experiments.plan import ExperimentPlan
        from training.experiments.report import write_report

    plan = ExperimentPlan(
        networks=tuple(network or ExperimentPlan().networks), seeds=seeds, epochs=epochs
    )
    if quick:
        plan = ExperimentPlan(networks=("fast",), seeds=1, dropouts=(0.0, 0.5), epochs=epochs or 2)
    folder = output or Path("out/experiments-quick" if quick else "out/experiments")
    words = ["placecell", "experiments", *(f"--train={name(text)}" for text in train or ())]
    words += [f"--test={name(test)}"] if test else []
    words += [f"--network={each}" for each in network or ()]
    words += [f"--seeds={seeds}"] if seeds != ExperimentPlan().seeds else []
    words += [f"--epochs={epochs}"] if epochs else []
    words += ["--quick"] if quick else []
    command = shlex.join(words)
    with clear_errors():
        if bool(train) != bool(test):
            raise ValueError("Give both --train and --test, or neither for the synthetic town.")
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
    typer.echo(f"The report is in {file}.")


def name(source: str) -> str:
    """Return the name of a source without its folders."""
    return source.rpartition("/")[2]
