"""`placecell bench localize`: how quick an idle service tells a robot where it is."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.benches.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.sources import clear_errors, show


def localize(
    segments: Source = None,
    size: Annotated[
        list[int] | None,
        typer.Option(min=1000, help="Segments of the map; may be repeated. (default: 10,000)"),
    ] = None,
    seconds: Annotated[float, typer.Option(min=1.0, help="Of each map.")] = 30.0,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure /localize of 50 descriptors, one request at a time, on the real server.

    Descriptors are those of real segments, each view of a thing with the difference that two real
    segments of one group have.
    """
    from bench.localize import Plan
    from bench.localize import bench as run
    from bench.map_content import Views
    from segments.extractor import load_extractor
    from segments.models import DEFAULT_MODEL, MODELS_FOLDER

    with clear_errors():
        recording = recording_from(segments, output, seed, scans=60)
        views = Views.of(load_extractor(MODELS_FOLDER / DEFAULT_MODEL), recording, seed)
        plan = Plan(seconds=seconds) if size is None else Plan(tuple(size), seconds=seconds)
        report = run(views, plan, seed, progress=show) | {"source": recording.name}
        write_json(report, json_file)
    print_rows(report)


def print_rows(report: dict[str, Any]) -> None:
    """The figures on the terminal."""
    from rich.console import Console
    from rich.table import Table

    names = ("p50", "p95", "p99", "max")
    table = Table("segments", "right", *names, "search p50", "verify p50", title="milliseconds")
    for row in report["rows"]:
        steps = (row["stages"][stage]["p50"] for stage in ("search", "verify"))
        spent = (row["milliseconds"][name] for name in names)
        times = (f"{each:.1f}" for each in (*spent, *steps))
        table.add_row(f"{row['segments']:,}", f"{row['localised_right']:.1%}", *times)
    Console().print(table)
