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
    """Measure /localize with 50 descriptors, one request at a time, on a real server.

    The descriptors come from segmented scans. Two views of one segment differ as two segments of
    one group do.
    """
    from benchmarks.load.localize import LocalizePlan, measure_localize
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
        if maps:
            plan = replace(plan, maps=maps, map_segments=map_size)
        report = measure_localize(views, plan, seed, progress=show) | {"source": recording.name}
        write_json(report, json_file)
    print_rows(report)


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures."""
    names = ("p50", "p95", "p99", "max")
    table = new_table("segments", "right", *names, "search p50", "verify p50", title="latency, ms")
    together = report["together"]
    for row in [*report["rows"], *([together] if together else [])]:
        steps = (row["stages"][stage]["p50"] for stage in ("search", "verify"))
        spent = (row["milliseconds"][name] for name in names)
        times = (f"{each:.1f}" for each in (*spent, *steps))
        table.add_row(_title(row), f"{row['localised_right']:.1%}", *times)
    print_tables(table)


def _title(row: dict[str, Any]) -> str:
    """Return the title of a row: one map of some size, or all of some number of maps."""
    if "maps" in row:
        return f"{row['segments']:,} in {row['maps']:,} maps"
    return f"{row['segments']:,}"
