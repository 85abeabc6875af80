"""`placecell bench json`: measures the reader of JSON requests."""

from typing import Annotated

import typer

from cli.bench.options import JsonFile, Seed, write_json
from cli.sources import clear_errors


def json_requests(
    json_file: JsonFile = None,
    seconds: Annotated[
        float, typer.Option(min=0.1, help="Duration of each measurement, seconds.")
    ] = 3.0,
    seed: Seed = 7,
) -> None:
    """Measure the throughput of the JSON reader and how long it blocks other threads.

    The same run measures the parser of earlier versions for comparison.
    """
    from benchmarks.load.json_requests import measure_json_requests

    with clear_errors():
        report = measure_json_requests(seconds, seed)
        write_json(report, json_file)
    typer.echo(
        f"The reader takes {report['saturation_ratio']:g} times the requests of "
        f"{report['baseline']}. Its longest pause is {report['longest_pause_ms']:g} ms."
    )
