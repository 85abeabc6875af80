"""`placecell bench town`: measures the simulation and segmentation of town streets."""

import json
from pathlib import Path
from typing import Annotated

import typer

from cli.bench.options import JsonFile, Kept, Seed, write_json
from cli.sources import clear_errors, show


def town(
    meters: Annotated[
        float, typer.Option(help="Total street length of the town, meters.")
    ] = 5000.0,
    scans: Annotated[int, typer.Option(min=2, help="Number of simulated scans.")] = 400,
    spacing: Annotated[float, typer.Option(min=0.05, help="Distance between scans, meters.")] = 1.0,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure how long a large town takes to simulate and to segment.

    The figures are processor times of one thread, and their extrapolation to all streets.
    """
    from benchmarks.town import measure_town

    with clear_errors():
        report = measure_town(output / "streets", meters, scans, spacing, seed, show)
        write_json(report, json_file)
    typer.echo(json.dumps(report, indent=2))
