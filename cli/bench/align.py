"""`placecell bench align`: measures how often the alignment of two maps is right."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, write_json
from cli.common_options import Model
from cli.outputs import picture_file
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def align(
    town: Annotated[
        Path, typer.Argument(help="Folder that 'placecell town --meters M --pairs N' wrote.")
    ],
    model: Model = None,
    recording_a: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Recording of the first drive from 'placecell prepare'."),
    ] = None,
    recording_b: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Recording of the second drive."),
    ] = None,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a plot of agreement against overlap.",
        ),
    ] = None,
) -> None:
    """Measure the alignment of map pairs; half of the pairs overlap, the others do not.

    Each map has its own coordinate frame. The command runs the service's code in its own process.
    An alignment is right within 0.5 m and 1 degree in the middle of the overlap.
    """
    from benchmarks.localization.align import draw_alignment, measure_alignment
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        folder = model_folder(model or DEFAULT_MODEL)
        report = measure_alignment(town, folder, (recording_a, recording_b), show)
        write_json(report, json_file)
        if plot:
            draw_alignment(report, plot)
    print_report(report)


def print_report(report: dict[str, Any]) -> None:
    """Print the figures."""
    table = new_table("", "pairs", "right", "wrong", "not aligned")
    for name in ("overlapping", "overlapping_enough", "apart"):
        if name in report:
            row = report[name]
            counts = (row["pairs"], row["right"], row["wrong"], row["pairs"] - row["aligned"])
            table.add_row(name.replace("_", " "), *map(str, counts))
    print_tables(table)
    if report["median_position_error_m"] is not None:
        typer.echo(
            f"Median error {report['median_position_error_m']:.3f} m, "
            f"{report['median_yaw_error_deg']:.3f} deg; "
            f"{report['p50_ms']:.0f} ms (p50), {report['p99_ms']:.0f} ms (p99)"
        )
