"""`placecell fit-confidence`: fits the model of a pose's probability."""

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.common_options import Model
from cli.sources import clear_errors, parse_town, show
from cli.tables import JsonFile, new_table, print_tables, write_json

if TYPE_CHECKING:
    from evaluation.poses.cases import FitPair

TOWNS = {51: 0.5, 52: 0.5, 53: 0.5, 54: 0.5, 61: 1.0, 62: 1.0, 63: 1.0}
"""Seed of each default town, and the share of its streets that have identical houses."""


def two_drives(folder: Path, seed: int, scans: int, look_alikes: float) -> tuple[Path, Path]:
    """Simulate two robots that drive the same streets of a large town in opposite directions."""
    from town import City, several_robots

    city = City.build(seed, 1.6 * scans, look_alikes)
    # In a curve the inner lane is shorter than the middle of the street.
    route = city.route(city.planner.every_street()).cut(0.0, max(1.1 * scans, scans + 10.0))
    one, other = several_robots(folder, city, route, 2, scans=scans, oncoming=10.0, progress=show)
    return one, other


def prepared_pairs(folders: list[Path]) -> "list[FitPair]":
    """Read the pairs SEED-SENSOR-PLACE of some folders, in the order of their names.

    Raises:
        ValueError: a folder has no pairs, or a pair's name or recordings do not fit.
    """
    from evaluation.poses.cases import FitPair

    pairs = []
    for folder in folders:
        found = sorted(each for each in folder.glob("*-*") if (each / "robot_b").is_dir())
        if not found:
            raise ValueError(
                f"{folder} has no pairs: expected folders SEED-SENSOR-PLACE, each with the drives "
                "robot_a and robot_b of 'placecell town'."
            )
        pairs += [FitPair.of_folder(each, show) for each in found]
    return pairs


def simulated_pairs(folder: Path, drives: list[str], scans: int) -> "list[FitPair]":
    """Simulate and segment the pairs of town:SEED:SENSOR:PLACE.

    Raises:
        ValueError: a name has another form, or its sensor or place is unknown.
    """
    import town
    from evaluation.poses.cases import FitPair
    from evaluation.poses.queries import Pair

    pairs = []
    for index, name in enumerate(drives):
        seed, sensor, place = parse_town(name)
        one, other = town.two_robots(
            folder / str(index),
            seed=seed,
            scans=scans,
            place=place,
            lidar=town.sensor(sensor),
            progress=show,
        )
        pair = Pair.of(one, other, 2, progress=show)
        pairs.append(FitPair(pair, seed, sensor, place))
    return pairs


def look_alike_pairs(
    folder: Path, seeds: list[int], look_alikes: float | None, scans: int
) -> "list[FitPair]":
    """Simulate and segment the pairs of towns with rows of identical houses."""
    from evaluation.poses.cases import FitPair
    from evaluation.poses.queries import Pair

    pairs = []
    for seed in seeds:
        share = TOWNS.get(seed, 0.5) if look_alikes is None else look_alikes
        drives = two_drives(folder / str(seed), seed, scans, share)
        pair = Pair.of(*drives, progress=show)
        pairs.append(FitPair(pair, seed, look_alikes=share))
    return pairs


def fit_confidence(
    town: Annotated[
        list[int] | None,
        typer.Option(
            help="Random seed of a town; repeatable. (default: 51 to 54, 61 to 63, if neither "
            "--pairs nor --drive is given)"
        ),
    ] = None,
    look_alikes: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=1.0,
            help="Share of streets with identical houses, 0 to 1. "
            "(default: 0.5; 1 for towns 61 to 63)",
        ),
    ] = None,
    pairs: Annotated[
        list[Path] | None,
        typer.Option(
            metavar="FOLDER",
            help="Folder of prepared pairs SEED-SENSOR-PLACE: drives robot_a and robot_b of "
            "'placecell town', with the recordings robot_a.safetensors and robot_b.safetensors of "
            "'placecell prepare --every 2'; repeatable.",
        ),
    ] = None,
    drive: Annotated[
        list[str] | None,
        typer.Option(
            metavar="town:SEED:SENSOR:PLACE",
            help="Pair to simulate, such as town:101:vlp-16:campus; repeatable.",
        ),
    ] = None,
    scans: Annotated[
        int, typer.Option(min=20, help="Scans per robot of --town and --drive.")
    ] = 600,
    queries: Annotated[
        int,
        typer.Option(
            min=2,
            help="Largest number of captures of each robot that are localized, spread evenly. Each "
            "one is localized about ten times.",
        ),
    ] = 40,
    model: Model = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="JSON file for the constants. (default: the file that the service reads)",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Random seed for the drawn segments.")] = 0,
    json_file: JsonFile = None,
) -> None:
    """Fit the probability that a pose is right, on simulated drives of several sensors and places.

    Each model has its own constants. The command writes them into the model's folder. Each sensor
    is left out of the fit once, to calibrate the acceptance of poses and to measure how reliable
    the probabilities are on a new sensor. With one sensor, each town is left out once.
    """
    from evaluation.poses.confidence import fit
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from placecell.localization.confidence import NAME

    folder_of_model = model_folder(model or DEFAULT_MODEL)
    file = output or folder_of_model / NAME
    seeds = town or ([] if pairs or drive else list(TOWNS))
    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-towns-") as temporary:
        folder = Path(temporary)
        found = prepared_pairs(pairs or [])
        found += simulated_pairs(folder / "drives", drive or [], scans) if drive else []
        if len(set(seeds)) + len({each.town for each in found}) < 2:
            raise ValueError("Give two or more towns: each one is left out of the fit once.")
        found += look_alike_pairs(folder, seeds, look_alikes, scans)
        content = fit(found, folder_of_model, queries, seed, progress=show)
        file.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
        write_json(content, json_file)
    print_held_out(content["held_out"])
    typer.echo(f"The constants are in {file}.")


def print_held_out(held_out: dict[str, Any]) -> None:
    """Print the figures of the cases that the fit left out."""
    columns = {
        "told_share_of_right": "right poses returned",
        "told_share_of_right_captures": "of whole captures",
        "false_acceptance": "false poses",
        "wrong_but_sure": "wrong but sure",
        "expected_calibration_error": "calibration error",
        "brier": "Brier score",
    }
    table = new_table("left out", "cases", *columns.values())
    rows = {"all": held_out["all"], **held_out["sensors"], **held_out["places"]}
    for name, row in rows.items():
        values = ("-" if row[key] is None else f"{row[key]:.4f}" for key in columns)
        table.add_row(name, f"{row['cases']:,}", *values)
    print_tables(table)
    typer.echo(f"A pose is returned if its probability exceeds {held_out['threshold']:.3f}.")
