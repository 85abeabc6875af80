"""`placecell experiments`: the paper's experiments, from trainings to the report."""

import shlex
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.sources import SOURCE_HELP, clear_errors, load, show, source

if TYPE_CHECKING:
    from training.training_set import Source


def experiments(
    train: Annotated[
        list[str] | None,
        typer.Option(help=SOURCE_HELP + " May be repeated.", metavar="DRIVE[@FIRST:LAST]"),
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
    licence: Annotated[
        str, typer.Option(help="Licence of the drives, for the models' cards.")
    ] = "not stated",
) -> None:
    """Train the paper's three methods, compare them with the baseline, and write the report.

    Without drives it drives the synthetic town: trained on robot A's drive, tested on robot B's.
    Run it again to go on where it was stopped.
    """
    from rich.progress import Progress

    with clear_errors():
        from training.experiments import run_experiments
        from training.plan import Plan
        from training.report import write_report

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
            training_sources, test_source = [source(text) for text in train], source(test)
        else:
            training_sources, test_source = town_sources(scans=60 if quick else 400)
        with Progress() as progress:
            report = run_experiments(
                training_sources, test_source, plan, folder, licence, command, progress
            )
        file = write_report(report, folder)
    typer.echo(f"report: {file}")


def name(source: str) -> str:
    """A source as it is told to others: without the folders it lies in."""
    return source.rpartition("/")[2]


def town_sources(scans: int) -> tuple[list["Source"], "Source"]:
    """Robot A's drive through the town to train on, robot B's to test on."""
    from town import two_robots
    from training.training_set import Source

    with tempfile.TemporaryDirectory(prefix="placecell-town-") as folder:
        drives = two_robots(Path(folder), seed=1, scans=scans, progress=show)
        a, b = (load(drive) for drive in drives)
    return [Source(a, 0, a.scans - 1)], Source(b, 0, b.scans - 1)
