"""`placecell bench localize`: how quick an idle service tells a robot where it is."""

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
        typer.Option(min=1000, help="Segments of the map; may be repeated. (default: 10,000)"),
    ] = None,
    maps: Annotated[
        int,
        typer.Option(
            min=0, help="Number of maps searched by requests that name none; 0: not measured."
        ),
    ] = 0,
    map_size: Annotated[int, typer.Option(min=200, help="Segments per map of --maps.")] = 300,
    seconds: Annotated[float, typer.Option(min=1.0, help="Of each map.")] = 30.0,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure /localize of 50 descriptors, one request at a time, on the real server.

    Descriptors are those of real segments, each view of a thing with the difference that two real
    segments of one group have.
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
    """The figures on the terminal."""
    names = ("p50", "p95", "p99", "max")
    table = new_table("segments", "right", *names, "search p50", "verify p50", title="milliseconds")
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
