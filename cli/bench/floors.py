"""`placecell bench floors`: measures whether /localize distinguishes similar floors."""

from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.bench.options import JsonFile, Kept, Seed, Source, recording_from, write_json
from cli.common_options import Model
from cli.sources import clear_errors, show
from cli.tables import new_table, print_tables

if TYPE_CHECKING:
    from benchmarks.localization.similar_places import SimilarPlaces

SIMULATED = "Simulated places (with --simulate)"

TRIALS_PER_BUILDING = 125
"""Largest number of trials in one building or town: 500 trials are spread over four."""


def floors(
    segments: Source = None,
    trials: Annotated[
        int, typer.Option(min=1, help="Number of /localize requests, spread over all cases.")
    ] = 500,
    simulate: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help="Simulate drives instead of descriptors. indoor: floors of the same building; "
            "streets: streets of identical houses.",
        ),
    ] = None,
    sensor: Annotated[
        str, typer.Option(metavar="NAME", help="Sensor.", rich_help_panel=SIMULATED)
    ] = "vlp-16",
    scans: Annotated[
        int | None,
        typer.Option(
            min=10,
            help="Scans per drive. (default: 120 on a floor, 400 on streets)",
            rich_help_panel=SIMULATED,
        ),
    ] = None,
    model: Model = None,
    json_file: JsonFile = None,
    output: Kept = Path("out/bench"),
    seed: Seed = 7,
) -> None:
    """Measure how often /localize over maps of similar floors is right, ambiguous or wrong.

    Two floors have the same segments, except for 0 to 60% that are replaced. Each map and each
    robot has its own view: descriptors differ like two views of one real segment, centroids by
    0.3 m along each axis. Cases: eight segments; only segments that all floors have; up to twenty
    floors; five different segments; unequal sizes; deduplicated maps; two models; other buildings.

    With --simulate the floors or streets are simulated with their objects, and two robots drive
    through each in opposite directions. Half of the requests or more are asked without the map of
    the right place; then each pose is wrong.
    """
    from benchmarks.localization.floors import measure_floors
    from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
    from placecell.descriptors.extractor import load_extractor
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER, model_folder

    with clear_errors():
        if simulate is not None:
            from benchmarks.localization.similar_places import measure_similar_places

            report = measure_similar_places(
                groups_of(simulate, output, seed, scans, sensor),
                model_folder(model or DEFAULT_MODEL),
                trials,
                TRIALS_PER_BUILDING,
                seed,
                show,
            ) | {"sensor": sensor}
            write_json(report, json_file)
            print_rows(report)
            return
        if model is not None:
            raise ValueError("--model needs --simulate: the sampled floors use two models.")
        names = (DEFAULT_MODEL, OTHER_MODEL)
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


def groups_of(
    kind: str, output: Path, seed: int, scans: int | None, sensor: str
) -> "Iterator[SimilarPlaces]":
    """Return simulated groups of similar places, one seed after the other.

    Raises:
        ValueError: the kind or the sensor is unknown.
    """
    import town
    from benchmarks.localization.similar_places import DIFFERING, indoor_floors, look_alike_streets

    lidar = town.sensor(sensor)
    folder = output / "similar"
    if kind == "indoor":
        return (
            indoor_floors(
                folder, seed + n, scans or 120, lidar, DIFFERING[n % len(DIFFERING)], show
            )
            for n in count()
        )
    if kind == "streets":
        return (look_alike_streets(folder, seed + n, scans or 400, lidar, show) for n in count())
    raise ValueError(f"Invalid --simulate {kind!r}: expected indoor or streets.")


def print_rows(report: dict[str, Any]) -> None:
    """Print the figures as a table."""
    columns = ("trials", "right", "ambiguous", "wrong", "wrong_but_sure")
    titles = ("trials", "right", "ambiguous", "wrong", "wrong but sure")
    table = new_table("floors", *titles, title="localization on similar floors")
    shares = {f"{name} changed": row for name, row in report["by_share"].items()}
    decided = {}
    if "where_the_difference_decides" in report:
        decided["different segments seen"] = report["where_the_difference_decides"]
    for name, row in {**report["by_case"], **shares, **decided, "all": report}.items():
        table.add_row(name, *(str(row[column]) for column in columns))
    print_tables(table)
