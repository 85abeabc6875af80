"""`placecell bench localize`: measures the latency of /localize on an idle service."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def localize(
    segments: Source = None,
    size: Annotated[
        list[int] | None,
        typer.Option(min=1000, help="Segments in the map; repeatable. (default: 10,000)"),
    ] = None,
    descriptors: Annotated[
        list[int] | None,
        typer.Option(
            min=4, max=250, help="Descriptors per request; repeatable. (default: 50 and 120)"
        ),
    ] = None,
    steps: Annotated[
        bool,
        typer.Option(
            help="Print also the time of each stage of the service, and the CPU time of each step "
            "from candidates to a pose, for ordinary and for hard queries."
        ),
    ] = False,
    maps: Annotated[
        int,
        typer.Option(min=0, help="Number of maps for requests that search all maps; 0 skips this."),
    ] = 0,
    map_size: Annotated[int, typer.Option(min=200, help="Segments per map of --maps.")] = 300,
    seconds: Annotated[float, typer.Option(min=1.0, help="Duration for each map, seconds.")] = 30.0,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure /localize with 50 and with 120 descriptors, one request at a time, on a real server.

    The descriptors come from segmented scans. Two views of one segment differ as two segments of
    one group do. Ten requests a second are sent, or fewer if the service would be busy for more
    than half of the time.
    """
    from benchmarks.load.localize import LocalizePlan, measure_localize
    from benchmarks.localization.steps import measure_steps
    from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER

    with clear_errors():
        recording = recording_from(segments, output, seed, scans=60)
        views = DescriptorSampler.from_recording(
            load_extractor(MODELS_FOLDER / DEFAULT_MODEL), recording, seed
        )
        sizes: tuple[int, ...] = () if maps else (10_000,)
        if size is not None:
            sizes = tuple(size)
        plan = LocalizePlan(sizes, seconds=seconds)
        if descriptors:
            plan = replace(plan, descriptors=tuple(descriptors))
        if maps:
            plan = replace(plan, maps=maps, map_segments=map_size)
        report = measure_localize(views, plan, seed, progress=show) | {"source": recording.name}
        if steps:
            report["steps"] = measure_steps(plan.descriptors, plan.k, seed=seed)
        write_json(report, json_file)
    print_rows(report)
    if steps:
        print_steps(report)


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures."""
    names = ("p50", "p95", "p99", "max")
    table = new_table(
        "segments",
        "descriptors",
        "right",
        "a second",
        *names,
        "search p50",
        "verify p50",
        title="latency, ms",
    )
    together = report["together"]
    for row in [*report["rows"], *([together] if together else [])]:
        steps = (row["stages"][stage]["p50"] for stage in ("search", "verify"))
        spent = (row["milliseconds"][name] for name in names)
        times = (f"{each:.1f}" for each in (*spent, *steps))
        right = f"{row['localised_right']:.1%}"
        table.add_row(_title(row), str(row["descriptors"]), right, f"{row['rate']:.2g}", *times)
    print_tables(table)


def print_steps(report: dict[str, Any]) -> None:
    """Print the time of each stage of the service, and of each step from candidates to a pose."""
    stages = new_table("segments", "descriptors", "stage", "p50", "p99", title="stages, ms")
    for row in report["rows"]:
        for stage, spent in row["stages"].items():
            times = (f"{spent[name]:.2f}" for name in ("p50", "p99"))
            stages.add_row(_title(row), str(row["descriptors"]), stage, *times)
    names = list(report["steps"][0]["steps"])
    steps = new_table("query", "descriptors", "p50", "p99", *names, title="CPU time, ms; steps p50")
    for row in report["steps"]:
        total = (f"{row['milliseconds'][name]:.1f}" for name in ("p50", "p99"))
        of_steps = (f"{row['steps'][name]['p50']:.1f}" for name in names)
        steps.add_row(row["query"], str(row["descriptors"]), *total, *of_steps)
    print_tables(stages, steps)


def _title(row: dict[str, Any]) -> str:
    """Return the title of a row: one map of some size, or all of some number of maps."""
    if "maps" in row:
        return f"{row['segments']:,} in {row['maps']:,} maps"
    return f"{row['segments']:,}"
