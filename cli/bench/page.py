"""`placecell bench page`: measures the operator's page in a real browser."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Seed, write_json
from cli.outputs import output_folder
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def page(
    json_file: JsonFile = None,
    segments: Annotated[
        int, typer.Option(min=1000, max=1_400_000, help="Segments of the map.")
    ] = 1_000_000,
    seconds: Annotated[
        float, typer.Option(min=1.0, help="Duration of the turn of the view, seconds.")
    ] = 10.0,
    pictures: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            callback=output_folder,
            help="Folder for pictures of each view, of 1280 and of 390 pixels' width, with two "
            "robots of a town. With it, nothing is measured.",
        ),
    ] = None,
    seed: Seed = 7,
) -> None:
    """Measure the operator's page: size, first picture, pictures a second, memory of the tab.

    The command stores a large map in a service and opens the page in Chromium, which draws
    without a GPU. It needs Chromium and: pip install 'placecell[page]'.
    """
    with clear_errors():
        if pictures is not None:
            from benchmarks.page.pictures import take_pictures

            files = take_pictures(pictures, seed, show)
            typer.echo(f"{len(files)} pictures are in {pictures}.")
            return
        from benchmarks.page.measure import measure_page

        report = measure_page(segments, seconds, seed)
        write_json(report, json_file)
    print_page(report)


def print_page(report: dict[str, Any]) -> None:
    """Print the figures."""
    table = new_table("figure", "value", title=f"Page with {report['segments']:,} segments")
    table.add_row("all files, gzipped", f"{report['gzip_bytes'] / 1000:.0f} kB")
    table.add_row("first picture", f"{report['first_picture_1m_s']:.2f} s")
    table.add_row(
        "pictures a second while turning",
        f"{report['frames_per_second_1m']:.0f}, of {report['drawn_while_turning']:,} segments",
    )
    table.add_row("memory of the tab", f"{report['tab_mb']:.0f} MB")
    table.add_row("requests to other hosts", ", ".join(report["other_hosts"]) or "none")
    print_tables(table)
