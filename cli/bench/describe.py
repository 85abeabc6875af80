"""`placecell bench describe`: measures how fast segments become descriptors."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, scans_from, write_json
from cli.outputs import picture_file
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def describe(
    segments: Source = None,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for a plot of accuracy against speed.",
        ),
    ] = None,
    output: Kept = Path("out/bench"),
    repeats: Annotated[
        int, typer.Option(min=1, help="Number of measurements of each figure; the median counts.")
    ] = 5,
    seconds: Annotated[
        float, typer.Option(min=0.0, help="Shortest duration of each measurement, seconds.")
    ] = 0.5,
    seed: Seed = 7,
) -> None:
    """Measure how fast segments become descriptors.

    The command measures each shipped network and the paper's network in the same run: inference
    with batches of 1, 8 and 64 on 1 and 2 threads, orientation and voxelization alone, and all
    steps from points to descriptors with the default model. The paper's network has random weights;
    torch creates it in the first run. Without torch the ratio to the paper is left out.

    On a busy machine trust the ratios, not the rates. Example:

        placecell bench describe --json figures.json --plot speed.png
    """
    from benchmarks.load.describe import DescribePlan, draw_accuracy_speed, measure_inference

    with clear_errors():
        some, name = scans_from(segments, output, seed)
        plan = DescribePlan(repeats=repeats, seconds=seconds)
        report = measure_inference(some, output, plan, seed, progress=show)
        report["source"] = name
        write_json(report, json_file)
        if plot:
            draw_accuracy_speed(report, plot)
    print_report(report)


def print_report(report: dict[str, Any]) -> None:
    """Print the figures."""
    sizes, machine = report["sizes"], report["machine"]
    typer.echo(
        f"{machine['processor']}, {machine['cores']} cores; {sizes['segments']:,} segments of "
        f"{sizes['points_mean']:.0f} points on average, from {report['source']}"
    )
    table = new_table(title="inference, segments/s")
    for name in ("model", "precision", "batch", "threads", "rate", "top1"):
        table.add_column(
            name, justify="left" if name in {"model", "precision"} else "right", overflow="fold"
        )
    for row in report["rows"]:
        table.add_row(
            row["model"],
            row["precision"],
            str(row["batch"]),
            str(row["threads"]),
            f"{row['segments_per_second']:,.0f}",
            "-" if row["top1"] is None else f"{row['top1']:.1%}",
        )
    print_tables(table)
    for threads, rate in report["preprocessing_segments_per_second"].items():
        typer.echo(f"orientation and voxelization, {threads} threads: {rate:,.0f} segments/s")
    for threads, rate in report["surroundings_segments_per_second"].items():
        typer.echo(f"neighborhoods, {threads} threads: {rate:,.0f} segments/s")
    whole = report["points_in_descriptors_out_segments_per_second"]
    typer.echo(f"from points to descriptors: {whole:,.0f} segments/s")
    single = report["single_segment_ms"]
    typer.echo(f"a single segment: {single['p50']:.2f} ms (p50), {single['p99']:.2f} ms (p99)")
    for pair in report["pairs"]:
        typer.echo(
            f"{pair['pairs']:,} match probabilities of {pair['model']} ({pair['kind']}, "
            f"{pair['bytes'] / 1e6:.1f} MB): {pair['p50_ms']:.2f} ms"
        )
    times = report["default_over_paper"]
    if times is None:
        typer.echo("The paper's network was not measured, because torch is not installed.")
    else:
        typer.echo(f"{report['default']} is {times:.1f} times as fast as the paper's network.")
