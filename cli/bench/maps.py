"""`placecell bench maps`: maps of up to a million segments."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def maps(
    segments: Source = None,
    size: Annotated[
        list[int] | None,
        typer.Option(
            min=1000,
            help="Segments of the map; may be repeated. (default: 10,000, 100,000 and 1,000,000)",
        ),
    ] = None,
    seconds: Annotated[float, typer.Option(min=1.0, help="Of each phase.")] = 60.0,
    json_file: JsonFile = None,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw latency, memory, start.")
    ] = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure large maps: bytes, memory, recall, start, and /match while others write.

    The real server over loopback. Descriptors are those of real segments, each view of a thing
    with the difference that two real segments of one group have.
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
    """The figures on the terminal."""
    rows = report["rows"]
    table = new_table("", *(f"{row['segments']:,} segments" for row in rows))
    for key in rows[0]:
        if key != "segments" and not isinstance(rows[0][key], dict):
            table.add_row(key, *(f"{row[key]:,}" for row in rows))
    print_tables(table)
    typer.echo(f"map file of 10,000: {report['file_bytes_per_segment']:.1f} bytes a segment")
