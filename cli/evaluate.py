"""`placecell evaluate`: measures how well extractors recognize the segments of a drive."""

from typing import Annotated, Any

import typer

from cli.common_options import Drive, Every, Models
from cli.sources import clear_errors, load, parse_scans
from cli.tables import JsonFile, new_table, percent, print_tables, write_json

ROWS = ("top1", "top1_with_mate", "cross_view_top1", "recall_at_25", "pair_auc", "pair_accuracy")


def evaluate(
    drive: Drive,
    scans: Annotated[
        str | None,
        typer.Option(
            metavar="FIRST:LAST",
            help="Evaluate only groups that lie wholly within these scans, both included. "
            "(default: all groups)",
        ),
    ] = None,
    every: Every = None,
    model: Models = None,
    json_file: JsonFile = None,
    seed: Annotated[int, typer.Option(help="Random seed for the drawn pairs.")] = 0,
) -> None:
    """Measure extractors on a drive, with the eigenvalue baseline for comparison.

    docs/results/recognition.md defines the figures.
    """
    from evaluation.recognition.evaluate import evaluate as evaluate_recording
    from evaluation.recognition.evaluate import open_models

    with clear_errors():
        limits = parse_scans(scans) if scans else None
        # Check all arguments first; segmenting the drive takes minutes.
        models = open_models(model or ())
        if json_file:
            json_file.parent.mkdir(parents=True, exist_ok=True)
        report = evaluate_recording(load(drive, every), limits, models, seed)
        write_json(report, json_file)
    print_table(report)


def print_table(report: dict[str, Any]) -> None:
    """Print the figures as a table."""
    first, last = report["scans"]
    typer.echo(
        f"{report['drive']}, scans {first} to {last}, protocol {report['protocol']}: "
        f"{report['segments']:,} segments in {report['groups']:,} groups"
    )
    table = new_table()
    extractors = report["extractors"]
    table.add_column("", overflow="fold")
    for name in extractors:
        table.add_column(name, justify="right", overflow="fold")
    for row in ROWS:
        shown = (figures[row] for figures in extractors.values())
        table.add_row(row, *map(percent, shown))
    if any("alone" in figures for figures in extractors.values()):
        alone = (figures.get("alone", figures)["top1"] for figures in extractors.values())
        table.add_row("top1, segments alone", *map(percent, alone))
    errors = (figures["expected_calibration_error"] for figures in extractors.values())
    shown = ("-" if error is None else f"{error:.3f}" for error in errors)
    table.add_row("expected calibration error", *shown)
    table.add_row("seen in training", *("yes" if f["seen"] else "no" for f in extractors.values()))
    print_tables(table)
