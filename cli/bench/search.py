"""`placecell bench search`: measures the search of large maps by all cores."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables

if TYPE_CHECKING:
    from rich.table import Table

SIZES = (100_000, 1_000_000, 10_000_000)


def search(
    segments: Source = None,
    size: Annotated[
        list[int] | None,
        typer.Option(
            min=1000,
            help="Segments of all maps together; repeatable. (default: 100,000, 1,000,000 and "
            "10,000,000, which takes 3 GB of memory)",
        ),
    ] = None,
    cold_size: Annotated[
        list[int] | None,
        typer.Option(
            min=1000,
            help="Segments of each of four maps of a service that holds one of them in memory; "
            "repeatable. (default: cold maps are not measured)",
        ),
    ] = None,
    repeats: Annotated[int, typer.Option(min=1, help="Searches of each kind.")] = 5,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure the search in one large map and in many maps, with one core and with all.

    The command measures the time of requests of 1 and 64 segments, and the memory of a segment. It
    ends with status 1 if the results differ. With --cold-size it measures the first request of a
    map that is not in memory, too.
    """
    from benchmarks.storage.cold_maps import ColdMapsPlan, measure_cold_maps
    from benchmarks.storage.search_scale import SearchScalePlan, measure_search
    from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
    from service.core.metrics import Metrics
    from service.core.settings import Settings
    from service.inference.model_registry import Models

    with clear_errors():
        recording = recording_from(segments, output, seed, scans=60)
        sampler = DescriptorSampler.from_recording(
            load_extractor(MODELS_FOLDER / DEFAULT_MODEL), recording, seed
        )
        model = Models(Settings.model_validate({}), Metrics()).default
        plan = SearchScalePlan(sizes=tuple(size or SIZES), repeats=repeats)
        report = measure_search(sampler, model, plan, seed, progress=show)
        report["source"] = recording.name
        if cold_size:
            cold = ColdMapsPlan(sizes=tuple(cold_size))
            report["cold"] = measure_cold_maps(sampler, model.manifest, cold, seed, progress=show)
        write_json(report, json_file)
    rows = report["rows"]
    tables = [_table(rows)]
    if cold_size:
        tables.append(_table(report["cold"]["rows"]))
    print_tables(*tables)
    if not all(value for row in rows for key, value in row.items() if key.startswith("equal")):
        raise typer.Exit(1)


def _table(rows: list[dict[str, Any]]) -> "Table":
    """Return a table with a column for each row of figures."""
    table = new_table("", *(f"{row['segments']:,} in {row['maps']:,} maps" for row in rows))
    for key in rows[0]:
        if key not in {"segments", "maps"}:
            table.add_row(key, *(f"{row[key]:,}" for row in rows))
    return table
