"""`placecell bench serve`: measures the service under load."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, scans_from, write_json
from cli.outputs import picture_file
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def serve(
    segments: Source = None,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a plot of latency against load.",
        ),
    ] = None,
    output: Kept = Path("out/bench"),
    seconds: Annotated[
        float, typer.Option(min=0.5, help="Duration of each load level, seconds.")
    ] = 10.0,
    seed: Seed = 7,
) -> None:
    """Measure throughput and latency of the service under load.

    A load generator in its own process sends /match requests to a real server over loopback, on
    schedule even if answers are late (open loop). Requests hold 50 segments, in msgpack and in
    JSON, and 5 segments, with and without batching across requests. The load grows from a quarter
    of the saturation rate to twice that rate.
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
    """Print the figures."""
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
    table = new_table(*names, title="/match: load in segments/s, latency in ms")
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
        f"Saturation is at {report['saturation_segments_per_second']:,.0f} segments/s, "
        f"{report['http_over_library']:.0%} of the library alone. At half of it the p99 of /match "
        f"with 50 segments is {report['match_50_p99_ms_at_half_saturation']:.1f} ms."
    )
