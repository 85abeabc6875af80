"""`placecell bench maps`: measures maps of up to a million segments."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.outputs import picture_file
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def maps(
    segments: Source = None,
    size: Annotated[
        list[int] | None,
        typer.Option(
            min=1000,
            help="Segments in the map; repeatable. (default: 10,000, 100,000 and 1,000,000)",
        ),
    ] = None,
    seconds: Annotated[
        float, typer.Option(min=1.0, help="Duration of each phase, seconds.")
    ] = 60.0,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            callback=picture_file,
            help="PNG file for plots of latency, memory and start time.",
        ),
    ] = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure large maps: bytes, memory, recall, start time, and /match during writes.

    The command uses a real server over loopback. The descriptors come from segmented scans. Two
    views of one segment differ as two segments of one group do.
    """
    from benchmarks.storage.map_writers import MapsPlan
    from benchmarks.storage.maps import draw_maps, measure_maps
    from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER

    with clear_errors():
        recording = recording_from(segments, output, seed, scans=60)
        views = DescriptorSampler.from_recording(
            load_extractor(MODELS_FOLDER / DEFAULT_MODEL), recording, seed
        )
        plan = MapsPlan(seconds=seconds) if size is None else MapsPlan(tuple(size), seconds=seconds)
        report = measure_maps(views, plan, seed, progress=show) | {"source": recording.name}
        write_json(report, json_file)
        if plot:
            draw_maps(report, plot)
    print_rows(report)


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures."""
    rows = report["rows"]
    table = new_table("", *(f"{row['segments']:,} segments" for row in rows))
    for key in rows[0]:
        if key != "segments" and not isinstance(rows[0][key], dict):
            table.add_row(key, *(f"{row[key]:,}" for row in rows))
    print_tables(table)
    typer.echo(
        f"The map file of 10,000 segments has {report['file_bytes_per_segment']:.1f} bytes each."
    )
