"""`placecell bench persistent`: compares maps of best views with maps of all captures."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, write_json
from cli.common_options import Model
from cli.sources import clear_errors, parse_scans, show
from cli.tables import new_table, percent, print_tables


def persistent(
    drive: Annotated[
        Path,
        typer.Argument(
            help="Drive: a bag, an MCAP file, a folder of scans, or a folder in a known layout."
        ),
    ],
    scans: Annotated[
        str | None,
        typer.Option(
            metavar="FIRST:LAST",
            help="Measure recognition of groups that lie wholly within these scans, both included. "
            "(default: all groups)",
        ),
    ] = None,
    model: Model = None,
    json_file: JsonFile = None,
) -> None:
    """Compare recognition and poses with one best view of each segment and with all captures.

    Ids persist while a segment is seen (see the incremental segmentation). Recognition is measured
    across views: mates seen from within 10 m of the query are left out. Poses are measured by
    blocks of the drive. The queries are those of protocol v1 in each row.
    """
    from benchmarks.robot.persistent_views import measure_persistent
    from placecell.datasets import open_drive
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        limits = parse_scans(scans) if scans else None
        report = measure_persistent(
            open_drive(drive), limits, model_folder(model or DEFAULT_MODEL), progress=show
        )
        write_json(report, json_file)
    print_comparison(report)


def print_comparison(report: dict[str, Any]) -> None:
    """Print the figures as two tables."""
    recognition, poses = report["recognition"], report["poses_by_blocks"]
    across = new_table(
        "database",
        *("segments", "with a mate", "cross view", "same queries", "complete queries"),
        title=f"{report['drive']}: recognition across views, {recognition['queries']:,} queries, "
        f"{recognition['common_queries']:,} with a mate in each database",
    )
    keys = (
        "cross_view_top1",
        "cross_view_top1_common",
        "cross_view_top1_complete_queries",
    )
    for name, row in recognition["databases"].items():
        counts = (f"{row['segments']:,}", f"{row['queries_with_mate']:,}")
        across.add_row(name, *counts, *(percent(row[key]) for key in keys))
    located = new_table(
        "map",
        *("segments", "bytes", "queries", "best pose right", "right", "wrong but sure"),
        title="poses by blocks",
    )
    for name, row in poses.items():
        located.add_row(
            name,
            *(f"{row[key]:,}" for key in ("map_segments", "map_bytes", "queries")),
            percent(row["best_pose_right"]),
            *(str(row["counts"][key]) for key in ("localised_right", "wrong_but_sure")),
        )
    print_tables(across, located)
