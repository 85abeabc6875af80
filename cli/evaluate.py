"""`placecell evaluate`: measures how well extractors recognize the segments of a drive."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.common_options import Drive, Every, Models
from cli.sources import clear_errors, load, parse_scans, show
from cli.tables import JsonFile, new_table, percent, print_tables, write_json

PLACES = "Place recognition"

ROWS = (
    "top1",
    "top1_with_mate",
    "cross_view_top1",
    "reranked_top1",
    "reranked_top1_with_mate",
    "reranked_cross_view_top1",
    "recall_at_25",
    "pair_auc",
    "pair_accuracy",
)


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
    protocol: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Measure place recognition by the rules of a publication in place of segment "
            "recognition: kitti-loops, mulran or helipr.",
            rich_help_panel=PLACES,
        ),
    ] = None,
    map_drive: Annotated[
        Path | None,
        typer.Option(
            metavar="DRIVE",
            help="Drive for the map. (default: loop closures, in what DRIVE saw before)",
            rich_help_panel=PLACES,
        ),
    ] = None,
    json_file: JsonFile = None,
    seed: Annotated[int, typer.Option(help="Random seed for the drawn pairs.")] = 0,
) -> None:
    """Measure extractors on a drive, with the eigenvalue baseline for comparison.

    docs/results/recognition.md defines the figures.

    With --protocol, each capture is localized, and the nearest map frame counts as retrieved. Run
    it on sequences of KITTI odometry, MulRan or HeLiPR:

        placecell evaluate sequences/00 --protocol kitti-loops

        placecell evaluate Town03/LiDAR/Aeva --map-drive Town01/LiDAR/Ouster --protocol helipr
    """
    if protocol is not None or map_drive is not None:
        evaluate_protocol(drive, map_drive, protocol, scans, every, model or [], json_file, seed)
        return
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


def evaluate_protocol(
    drive: Path,
    map_drive: Path | None,
    name: str | None,
    scans: str | None,
    every: int | None,
    models: list[str],
    json_file: Path | None,
    seed: int,
) -> None:
    """Measure place recognition by a published protocol."""
    from evaluation.poses.place_recognition import PROTOCOLS
    from evaluation.poses.places import evaluate_places, robots_of_places
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from placecell.segmentation.recording import is_recording

    with clear_errors():
        if name not in PROTOCOLS:
            raise ValueError(
                f"Invalid --protocol {name!r}: expected one of {', '.join(PROTOCOLS)}."
                if name
                else "--map-drive needs --protocol."
            )
        if scans is not None:
            raise ValueError("--scans selects groups of segments. Omit it with --protocol.")
        if is_recording(drive):
            raise ValueError(f"{drive}: --protocol needs the drive itself, not a recording.")
        folders = {each: model_folder(each) for each in models or [DEFAULT_MODEL]}
        pair = robots_of_places(drive, map_drive, every, show)
        reports = {
            each: evaluate_places(pair, folder, PROTOCOLS[name], seed, progress=show)
            for each, folder in folders.items()
        }
        write_json({"evaluation": name, "models": reports}, json_file)
    table = new_table("", *reports)
    for row in ("recall_at_1", "f1_max", "f1_max_precision", "f1_max_recall"):
        table.add_row(row, *(percent(figures[row]) for figures in reports.values()))
    for radius in next(iter(reports.values()))["recall_at_1_within_m"]:
        shown = (percent(figures["recall_at_1_within_m"][radius]) for figures in reports.values())
        table.add_row(f"recall_at_1 within {radius} m", *shown)
    first = next(iter(reports.values()))
    typer.echo(
        f"{first['query_drive']} in the map of {first['map_drive']}, {name}: "
        f"{first['queries']:,} queries, {first['revisits']:,} revisits within "
        f"{first['revisit_m']:g} m"
    )
    print_tables(table)


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
