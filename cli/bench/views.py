"""`placecell bench views`: measures the value of several stored views of one object."""

from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Seed, write_json
from cli.common_options import Drive, Model
from cli.sources import clear_errors, load, parse_scans
from cli.tables import new_table, print_tables


def views(
    drive: Drive,
    scans: Annotated[
        str,
        typer.Option(
            metavar="FIRST:LAST", help="Use the groups that lie wholly within these scans."
        ),
    ],
    model: Model = None,
    json_file: JsonFile = None,
    seed: Seed = 7,
) -> None:
    """Measure map size and recognition if objects are stored once or from several viewpoints."""
    from benchmarks.storage.views import measure_views
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        extractor = load_extractor(model_folder(model or DEFAULT_MODEL))
        report = measure_views(extractor, load(drive), parse_scans(scans), seed)
        write_json(report, json_file)
    print_rows(report)


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures."""
    table = new_table("kept", "views", "segments", "cross view, top1", "cross view, recall at 25")
    for row in report["rows"]:
        shares = (row[key] for key in ("cross_view_top1", "cross_view_recall_at_25"))
        table.add_row(
            row["kept"],
            "-" if row["views"] is None else str(row["views"]),
            f"{row['segments']:,}",
            *(f"{share:.1%}" for share in shares),
        )
    print_tables(table)
