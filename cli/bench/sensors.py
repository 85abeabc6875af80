"""`placecell bench sensors`: measures localization across pairs of sensors."""

from pathlib import Path
from typing import Annotated

import typer

from cli.common_options import Every, Model
from cli.outputs import output_file, output_folder
from cli.sources import clear_errors, show


def sensors(
    json_file: Annotated[
        Path | None,
        typer.Option(
            "--json",
            metavar="FILE",
            callback=output_file,
            help="JSON file for the figures. Finished cells are kept in it: the same command "
            "continues a stopped run. (default: sensors.json in the folder of --cache)",
        ),
    ] = None,
    cache: Annotated[
        Path,
        typer.Option(
            callback=output_folder, help="Folder that keeps the prepared drives of each sensor."
        ),
    ] = Path("out/sensors"),
    sensor: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Sensor of 'placecell town --sensor' for maps and queries; repeatable. (default: "
            "all sensors)",
        ),
    ] = None,
    cells: Annotated[
        list[str] | None,
        typer.Option(
            metavar="MAP:QUERY",
            help="Sensor of the map and sensor of the queries, such as vlp-16:os1-64; repeatable. "
            "(default: all pairs of the sensors)",
        ),
    ] = None,
    place: Annotated[
        str, typer.Option(metavar="NAME", help="Place of 'placecell town --place'.")
    ] = "streets",
    seed: Annotated[
        int, typer.Option(help="Random seed of place, route, parked cars and sensor noise.")
    ] = 301,
    scans: Annotated[int, typer.Option(min=1, help="Scans of each drive.")] = 420,
    every: Every = None,
    queries: Annotated[
        int | None,
        typer.Option(
            min=1, help="Queries of each cell, spread evenly. (default: all captures of robot B)"
        ),
    ] = None,
    k: Annotated[int, typer.Option(min=1, help="Number of candidates per segment.")] = 25,
    jobs: Annotated[int, typer.Option(min=1, help="Number of threads.")] = 1,
    model: Model = None,
    only_prepare: Annotated[
        bool,
        typer.Option(
            "--only-prepare", help="Simulate and segment the drives, and measure nothing."
        ),
    ] = False,
) -> None:
    """Measure localization for each sensor of the map and each sensor of the queries.

    Robot A makes the map. Robot B drives the same way in the opposite direction and localizes. The
    command prints the Markdown tables of docs/results/sensors.md, which defines the figures.
    """
    from benchmarks.localization.sensors import SensorMatrix, matrix_tables
    from evaluation.poses.town_drives import TownDrives
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from town import SENSORS

    with clear_errors():
        names = sensor or list(SENSORS)
        pairs = (
            [parse_cell(text) for text in cells]
            if cells
            else [(one, other) for one in names for other in names]
        )
        drives = TownDrives(cache, seed, place, scans, every)
        matrix = SensorMatrix(drives, json_file or cache / "sensors.json", queries, k, jobs)
        if only_prepare:
            matrix.prepare(pairs, show)
            return
        figures = matrix.measure(pairs, model_folder(model or DEFAULT_MODEL), show)
    typer.echo("\n".join(matrix_tables(figures)))


def parse_cell(text: str) -> tuple[str, str]:
    """Parse MAP:QUERY.

    Raises:
        ValueError: the text is not two names.
    """
    one, colon, other = text.partition(":")
    if not (one and colon and other):
        raise ValueError(f"Invalid cell {text!r}: expected MAP:QUERY, such as vlp-16:os1-64.")
    return one, other
