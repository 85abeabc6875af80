"""`placecell bench soak`: runs the service under load with clients that misbehave."""

from pathlib import Path
from typing import Annotated

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, scans_from, write_json
from cli.outputs import picture_file
from cli.sources import clear_errors


def soak(
    segments: Source = None,
    minutes: Annotated[float, typer.Option(min=0.05, help="Duration, minutes.")] = 10.0,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", callback=picture_file, help="PNG file for a plot of memory over time."
        ),
    ] = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Run the service at 80% of its saturation rate, together with clients that misbehave.

    Some clients die during a request, some send slowly, some send garbage. The command ends with
    status 1 if a correct client gets an unexpected answer.
    """
    from benchmarks.load.soak import SoakPlan, draw_memory, run_soak

    with clear_errors():
        some, name = scans_from(segments, output, seed)
        report = run_soak(some, SoakPlan(seconds=60 * minutes), seed)
        report["source"] = name
        write_json(report, json_file)
        if plot:
            draw_memory(report, plot)
    typer.echo(
        f"{report['requests']:,} requests, statuses {report['statuses']}, p99 "
        f"{report['milliseconds']['p99']} ms; clients that misbehave: {report['bad_clients']}"
    )
    typer.echo(
        f"memory {report['memory_mb_first_half']:.0f} MB in the first half, "
        f"{report['memory_mb_second_half']:.0f} MB in the second; file descriptors at most "
        f"{report['descriptors_most']:.0f}, at the end {report['descriptors_last']:.0f}"
    )
    if report["unexpected"]:
        raise typer.Exit(1)
