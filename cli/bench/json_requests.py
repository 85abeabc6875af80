"""`placecell bench json`: measure the JSON request reader."""

from typing import Annotated

import typer

from cli.bench.options import JsonFile, Seed, write_json
from cli.sources import clear_errors


def json_requests(
    json_file: JsonFile = None,
    seconds: Annotated[
        float, typer.Option(min=0.1, help="Duration of each measurement. (default: 3)")
    ] = 3.0,
    seed: Seed = 7,
) -> None:
    """Measure the throughput of the JSON reader, and how long other threads wait for it.

    The parser of earlier versions is measured in the same run.
    """
    from benchmarks.load.json_requests import measure_json_requests

    with clear_errors():
        report = measure_json_requests(seconds, seed)
        write_json(report, json_file)
    typer.echo(
        f"{report['saturation_ratio']:g} times the requests of {report['baseline']}; "
        f"longest pause {report['longest_pause_ms']:g} ms"
    )
