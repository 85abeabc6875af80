"""`placecell bench`: what is measured for speed."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.sources import clear_errors, load, show

if TYPE_CHECKING:
    from segments.segments import Segments

bench = typer.Typer(help="Measure speed on this machine.", no_args_is_help=True)


Source = Annotated[
    Path | None,
    typer.Option(
        "--segments",
        metavar="PATH",
        help="A drive's folder or a recording of 'placecell prepare' to take segments from. "
        "(default: a short drive through the synthetic town)",
    ),
]
JsonFile = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write the figures here.")
]
Kept = Annotated[
    Path,
    typer.Option(
        "--output", "-o", help="Folder that keeps the town's drive and the paper's network."
    ),
]
Seed = Annotated[int, typer.Option(help="Of the town, and of everything that is drawn.")]


def scans_from(segments: Path | None, output: Path, seed: int) -> "tuple[list[Segments], str]":
    """The segments of each scan, and where they are from."""
    from bench.describe import scans_of, town_scans

    if segments is None:
        return town_scans(output / "town", seed, show), "synthetic town"
    return scans_of(load(segments)), segments.stem


def write_json(report: dict[str, Any], file: Path | None) -> None:
    """Write the figures, if that is wanted."""
    if file:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(report, indent=2) + "\n")


@bench.callback()
def benches() -> None:
    """Measure speed on this machine."""


@bench.command()
def describe(
    segments: Source = None,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw accuracy against speed into this PNG."),
    ] = None,
    output: Kept = Path("out/bench"),
    repeats: Annotated[
        int, typer.Option(min=1, help="Measurements of each figure; the median is given.")
    ] = 5,
    seconds: Annotated[
        float, typer.Option(min=0.0, help="Duration of each measurement, at least.")
    ] = 0.5,
    seed: Seed = 7,
) -> None:
    """Measure how fast segments become descriptors.

    Every shipped network beside the paper's own, in turn in one run, with batches of 1, 8 and 64
    on 1 and 2 threads; alignment and voxelisation alone; and the whole way from points to
    descriptors with the default model. The paper's network gets random weights, for which torch
    is needed the first time; without it the ratio to the paper is left out.

    On a busy machine believe the ratios, not the rates. Example:

        placecell bench describe --json figures.json --plot speed.png
    """
    from bench.describe import Plan, draw
    from bench.describe import bench as run

    with clear_errors():
        some, name = scans_from(segments, output, seed)
        plan = Plan(repeats=repeats, seconds=seconds)
        report = run(some, output, plan, seed, progress=show)
        report["source"] = name
        write_json(report, json_file)
        if plot:
            draw(report, plot)
    print_report(report)


@bench.command()
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
    from bench.serve import Plan, draw
    from bench.serve import bench as run

    with clear_errors():
        some, name = scans_from(segments, output, seed)
        report = run(some, Plan(seconds=seconds), seed, progress=show)
        report["source"] = name
        write_json(report, json_file)
        if plot:
            draw(report, plot)
    print_load(report)


@bench.command()
def soak(
    segments: Source = None,
    minutes: Annotated[float, typer.Option(min=0.05, help="How long.")] = 10.0,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw memory over time into this PNG.")
    ] = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Run the service for minutes at 80% of what it bears, among clients that misbehave.

    Some die in the midst of a request, some send slowly, some send garbage. Ends with status 1 if
    any client that behaved got an answer that is not expected.
    """
    from bench.soak import Soak, draw_memory
    from bench.soak import soak as run

    with clear_errors():
        some, name = scans_from(segments, output, seed)
        report = run(some, Soak(seconds=60 * minutes), seed)
        report["source"] = name
        write_json(report, json_file)
        if plot:
            draw_memory(report, plot)
    typer.echo(
        f"{report['requests']:,} requests: {report['statuses']}, p99 "
        f"{report['milliseconds']['p99']} ms; bad clients: {report['bad_clients']}"
    )
    typer.echo(
        f"memory {report['memory_mb_first_half']:.0f} MB in the first half, "
        f"{report['memory_mb_second_half']:.0f} MB in the second; at most "
        f"{report['descriptors_most']:.0f} file descriptors, {report['descriptors_last']:.0f} after"
    )
    if report["unexpected"]:
        raise typer.Exit(1)


def print_load(report: dict[str, Any]) -> None:
    """The figures on the terminal."""
    from rich.console import Console
    from rich.table import Table

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
    table = Table(*names, title="/match: segments a second, milliseconds")
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
    Console().print(table)
    typer.echo(
        f"saturation: {report['saturation_segments_per_second']:,.0f} segments a second, "
        f"{report['http_over_library']:.0%} of the library alone; /match of 50 at half of it: "
        f"p99 {report['match_50_p99_ms_at_half_saturation']:.1f} ms"
    )


def print_report(report: dict[str, Any]) -> None:
    """The figures on the terminal."""
    from rich.console import Console
    from rich.table import Table

    sizes, machine = report["sizes"], report["machine"]
    typer.echo(
        f"{machine['processor']}, {machine['cores']} cores; {sizes['segments']:,} segments of "
        f"{sizes['points_mean']:.0f} points on average, from {report['source']}"
    )
    table = Table(title="inference, segments a second")
    for name in ("model", "precision", "batch", "threads", "rate", "top1"):
        table.add_column(name, justify="left" if name in {"model", "precision"} else "right")
    for row in report["rows"]:
        table.add_row(
            row["model"],
            row["precision"],
            str(row["batch"]),
            str(row["threads"]),
            f"{row['segments_per_second']:,.0f}",
            "-" if row["top1"] is None else f"{row['top1']:.1%}",
        )
    Console().print(table)
    for threads, rate in report["preprocessing_segments_per_second"].items():
        typer.echo(f"align and voxelise, {threads} threads: {rate:,.0f} segments a second")
    for threads, rate in report["surroundings_segments_per_second"].items():
        typer.echo(f"surroundings, {threads} threads: {rate:,.0f} segments a second")
    whole = report["points_in_descriptors_out_segments_per_second"]
    typer.echo(f"points in, descriptors out: {whole:,.0f} segments a second")
    single = report["single_segment_ms"]
    typer.echo(f"a single segment: {single['p50']:.2f} ms (p50), {single['p99']:.2f} ms (p99)")
    for pair in report["pairs"]:
        typer.echo(
            f"{pair['pairs']:,} probabilities by {pair['model']} ({pair['kind']}, "
            f"{pair['bytes'] / 1e6:.1f} MB): {pair['p50_ms']:.2f} ms"
        )
    times = report["default_over_paper"]
    if times is None:
        typer.echo("the paper's network was not measured: building it needs torch")
    else:
        typer.echo(f"{report['default']}: {times:.1f} times as fast as the paper's network")


@bench.command()
def town(
    metres: Annotated[float, typer.Option(help="Of streets in the town.")] = 5000.0,
    scans: Annotated[int, typer.Option(min=2, help="Scans that are driven and measured.")] = 400,
    spacing: Annotated[float, typer.Option(min=0.05, help="Metres between scans.")] = 1.0,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure what streets cost: simulating scans of a large town, and cutting them into segments.

    Processor time of one thread, and what all of the town's streets come to at that rate.
    """
    from bench.town import bench as run

    with clear_errors():
        report = run(output / "streets", metres, scans, spacing, seed, show)
        write_json(report, json_file)
    typer.echo(json.dumps(report, indent=2))
