"""`placecell bench town`: what streets cost."""

import json
from pathlib import Path
from typing import Annotated

import typer

from cli.bench.options import JsonFile, Kept, Seed, write_json
from cli.sources import clear_errors, show


def town(
    meters: Annotated[float, typer.Option(help="Of streets in the town.")] = 5000.0,
    scans: Annotated[int, typer.Option(min=2, help="Scans that are driven and measured.")] = 400,
    spacing: Annotated[float, typer.Option(min=0.05, help="Metres between scans.")] = 1.0,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure what streets cost: simulating scans of a large town, and cutting them into segments.

    Processor time of one thread, and what all of the town's streets come to at that rate.
    """
    from benchmarks.town import measure_town

    with clear_errors():
        report = measure_town(output / "streets", meters, scans, spacing, seed, show)
        write_json(report, json_file)
    typer.echo(json.dumps(report, indent=2))
