"""`placecell bench ladder`: measures recognition against the bytes of a descriptor."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, write_json
from cli.common_options import Drive, Model
from cli.outputs import picture_file
from cli.sources import clear_errors, load, parse_scans
from cli.tables import new_table, print_tables


def ladder(
    drive: Drive,
    scans: Annotated[
        str,
        typer.Option(
            metavar="FIRST:LAST",
            help="Queries are the groups that lie wholly within these scans; quantizers are "
            "fitted on the others.",
        ),
    ],
    model: Model = None,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a plot of recognition against bytes.",
        ),
    ] = None,
) -> None:
    """Measure the bytes and the recognition rate of each way to store descriptors."""
    from benchmarks.storage.ladder import draw_compression, measure_compression
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        extractor = load_extractor(model_folder(model or DEFAULT_MODEL))
        report = measure_compression(extractor, load(drive), parse_scans(scans))
        write_json(report, json_file)
        if plot:
            draw_compression(report, plot)
    print_rows(report)


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures."""
    table = new_table("storage", "bytes", "top1", "cross view", "recall at 25")
    for row in report["rows"]:
        shares = (row[key] for key in ("top1", "cross_view_top1", "recall_at_25"))
        table.add_row(
            row["storage"],
            f"{row['bytes']:.0f}",
            *("-" if share is None else f"{share:.1%}" for share in shares),
        )
    print_tables(table)
