"""`placecell bench serve`: the service under load."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, scans_from, write_json
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def serve(
    segments: Source = None,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw latency against load into this PNG.")
    ] = None,
    output: Kept = Path("out/bench"),
    seconds: Annotated[float, typer.Option(min=0.5, help="Duration of each level of load.")] = 10.0,
    seed: Seed = 7,
) -> None:
    """Measure how the service bears load.

    A generator of its own process sends /match requests on schedule, whether or not answers come,
    to the real server over loopback: 50 segments a request in msgpack and in JSON, and 5 with and
    without batching across requests; from a quarter of what the service bears to twice that.
    """
    from benchmarks.load.serve import LoadPlan, draw_load, measure_load

    with clear_errors():
        some, name = scans_from(segments, output, seed)
        report = measure_load(some, LoadPlan(seconds=seconds), seed, progress=show)
        report["source"] = name
        write_json(report, json_file)
        if plot:
            draw_load(report, plot)
    print_load(report)


def print_load(report: dict[str, Any]) -> None:
    """The figures on the terminal."""
    names = (
        "case",
        "offered",
        "achieved",
        "p50",
        "p95",
        "p99",
        "max",
        "429",
        "p99 of 429",
        "batch",
    )
    table = new_table(*names, title="/match: segments a second, milliseconds")
    for row in report["rows"]:
        spent = row["milliseconds"]
        table.add_row(
            row["case"],
            f"{row['offered']:,.0f}",
            f"{row['achieved']:,.0f}",
            *("-" if spent[key] is None else f"{spent[key]:.1f}" for key in spent),
            str(row["rejected"]),
            str(row["rejected_milliseconds"]["p99"] or "-"),
            f"{row['batch_requests']:.1f}",
        )
    print_tables(table)
    typer.echo(
        f"saturation: {report['saturation_segments_per_second']:,.0f} segments a second, "
        f"{report['http_over_library']:.0%} of the library alone; /match of 50 at half of it: "
        f"p99 {report['match_50_p99_ms_at_half_saturation']:.1f} ms"
    )
