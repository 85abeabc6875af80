"""`placecell bench floors`: measures whether /localize distinguishes similar floors."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables


def floors(
    segments: Source = None,
    trials: Annotated[
        int, typer.Option(min=1, help="Number of /localize requests, spread over all cases.")
    ] = 500,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure how often /localize over maps of similar floors is right, ambiguous or wrong.

    Two floors have the same segments, except for 0 to 60% that are replaced. Each map and each
    robot has its own view: descriptors differ like two views of one real segment, centroids by
    0.3 m along each axis. Cases: eight segments; only segments that all floors have; up to twenty
    floors; five different segments; unequal sizes; deduplicated maps; two models; other buildings.
    """
    from benchmarks.localization.floors import measure_floors
    from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER

    names = (DEFAULT_MODEL, OTHER_MODEL)
    with clear_errors():
        recording = recording_from(segments, output, seed, scans=60)
        samplers = [
            DescriptorSampler.from_recording(load_extractor(MODELS_FOLDER / each), recording, seed)
            for each in names
        ]
        report = measure_floors(samplers, MODELS_FOLDER, names, trials, seed, progress=show) | {
            "source": recording.name
        }
        write_json(report, json_file)
    print_rows(report)


OTHER_MODEL = "group"
"""Model of the other floors in the case with two models."""


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures as a table."""
    columns = ("trials", "right", "ambiguous", "wrong", "wrong_but_sure")
    titles = ("trials", "right", "ambiguous", "wrong", "wrong but sure")
    table = new_table("floors", *titles, title="localization on similar floors")
    shares = {f"{name} changed": row for name, row in report["by_share"].items()}
    decided = {"different segments seen": report["where_the_difference_decides"]}
    for name, row in {**report["by_case"], **shares, **decided, "all": report}.items():
        table.add_row(name, *(str(row[column]) for column in columns))
    print_tables(table)
