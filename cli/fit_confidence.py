"""`placecell fit-confidence`: fits the model of a pose's probability."""

import json
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.common_options import Model
from cli.outputs import output_file
from cli.sources import DEFAULT_SENSOR, clear_errors, parse_town, show
from cli.tables import JsonFile, new_table, print_tables, write_json

if TYPE_CHECKING:
    from evaluation.poses.cases import FitPair

DRIVES = (
    "town:101:os1-64",
    "town:102:vlp-16",
    "town:103:hdl-32e",
    "town:104:os0-128",
    "town:105:solid-state",
    "town:106:os1-32",
    "town:107:os0-32",
    "town:108:os1-128",
    "town:109:os0-64",
    "town:110:hdl-64e",
    "town:111:vlp-16:campus",
    "town:112:os0-64:garden",
    "town:113:os1-64:campus",
    "town:114:vlp-16:car-park",
    "town:115:os0-128:indoor",
    "town:116:vlp-16:garden",
    "town:501:vlp-16:look-alikes",
    "town:502:os1-32:look-alikes",
    "town:503:hdl-32e:look-alikes",
    "town:504:os1-64:look-alikes",
    "town:601:hdl-64e+os0-32",
    "town:602:hdl-32e+os0-64",
    "town:603:vlp-16+os0-128",
    "town:604:os0-32+os1-32",
    "town:605:os0-64+os1-64",
    "town:606:os0-128+os1-128",
    "town:607:os1-32+solid-state",
    "town:608:os1-64+hdl-64e",
    "town:609:os1-128+hdl-32e",
    "town:610:solid-state+vlp-16",
    "town:611:hdl-64e+os0-128:look-alikes",
    "town:613:vlp-16+os1-64:campus",
    "town:614:os0-32+os1-128:garden",
    "town:615:os0-64+solid-state:car-park",
)
"""Default pairs: all sensors, all places, and towns of identical houses with seeds that nothing
else uses. The pairs of two sensors follow a rule: in the order of `town.SENSORS`, each sensor meets
the third one after it in streets, and some meet the fifth one after them in other places."""

SCANS, LOOK_ALIKE_SCANS, CITY_SCANS = 150, 400, 600
"""Default numbers of scans of each robot: in a place, in a town of identical houses, and of --town.
In a large town, a robot finds similar streets when the map lacks its own."""

TOWNS = {61: 1.0, 62: 1.0, 63: 1.0}
"""Share of the streets with identical houses in a town of --town; 0.5 in others."""


def two_drives(
    folder: Path,
    seed: int,
    scans: int,
    look_alikes: float,
    sensors: tuple[str, str] = (DEFAULT_SENSOR, DEFAULT_SENSOR),
) -> tuple[Path, Path]:
    """Simulate two robots that drive the same streets of a large town in opposite directions."""
    import town
    from town.drives.robots import fitted

    city = town.City.build(seed, 1.6 * scans, look_alikes)
    route = fitted(city.route(city.planner.every_street()), scans)
    lidar, other_lidar = map(town.sensor, sensors)
    one, other = town.several_robots(
        folder, city, route, 2, scans=scans, lidar=lidar, other_lidar=other_lidar, progress=show
    )
    return one, other


def prepared_pairs(folders: list[Path]) -> "list[FitPair]":
    """Read the pairs of some folders (`FitPair.of_folder`), in the order of their names.

    Raises:
        ValueError: a folder has no pairs, or a pair's name or recordings do not fit.
    """
    from evaluation.poses.cases import FitPair

    pairs = []
    for folder in folders:
        found = sorted(each for each in folder.glob("*-*") if (each / "robot_b").is_dir())
        if not found:
            raise ValueError(
                f"{folder} has no pairs: expected folders SEED-SENSOR-PLACE or "
                "SEED-SENSOR+OTHER-PLACE, each with the drives robot_a and robot_b of 'placecell "
                "town'."
            )
        pairs += [FitPair.of_folder(each, show) for each in found]
    return pairs


def simulated_pairs(folder: Path, drives: Sequence[str], scans: int | None) -> "list[FitPair]":
    """Simulate and segment the pairs of town:SEED:SENSOR:PLACE or town:SEED:SENSOR+OTHER:PLACE.

    Raises:
        ValueError: a name has another form, or its sensor or place is unknown.
    """
    return [_simulated(folder / str(index), name, scans) for index, name in enumerate(drives)]


def _simulated(folder: Path, name: str, scans: int | None) -> "FitPair":
    import town
    from evaluation.poses.cases import LOOK_ALIKES, FitPair
    from evaluation.poses.queries import Pair

    alike = name.endswith(f":{LOOK_ALIKES}")
    seed, sensors, place = parse_pair(name.removesuffix(f":{LOOK_ALIKES}"))
    sensor, other = sensors
    if alike:
        drives = two_drives(folder, seed, scans or LOOK_ALIKE_SCANS, 1.0, sensors)
        return FitPair(Pair.of(*drives, 2, progress=show), seed, sensor, LOOK_ALIKES, 1.0, other)
    drives = town.two_robots(
        folder,
        seed=seed,
        scans=scans or SCANS,
        place=place,
        lidar=town.sensor(sensor),
        other_lidar=town.sensor(other),
        progress=show,
    )
    return FitPair(Pair.of(*drives, 2, progress=show), seed, sensor, place, other_sensor=other)


def parse_pair(text: str) -> tuple[int, tuple[str, str], str]:
    """Parse town:SEED:SENSOR:PLACE or town:SEED:SENSOR+OTHER:PLACE; the place may be omitted.

    Returns:
        The seed, the names of both robots' sensors, and the name of the place.

    Raises:
        ValueError: the text has another form, or a sensor or the place is unknown.
    """
    first, plus, rest = text.partition("+")
    if not plus:
        seed, sensor, place = parse_town(text)
        return seed, (sensor, sensor), place
    other, colon, place = rest.partition(":")
    seed, sensor, place = parse_town(f"{first}{colon}{place}")
    _, other, _ = parse_town(f"town:{seed}:{other}")
    return seed, (sensor, other), place


def look_alike_pairs(
    folder: Path, seeds: list[int], look_alikes: float | None, scans: int | None
) -> "list[FitPair]":
    """Simulate and segment the pairs of towns with rows of identical houses."""
    from evaluation.poses.cases import FitPair
    from evaluation.poses.queries import Pair

    pairs = []
    for seed in seeds:
        share = TOWNS.get(seed, 0.5) if look_alikes is None else look_alikes
        drives = two_drives(folder / str(seed), seed, scans or CITY_SCANS, share)
        pair = Pair.of(*drives, progress=show)
        pairs.append(FitPair(pair, seed, look_alikes=share))
    return pairs


def fit_confidence(
    town: Annotated[
        list[int] | None,
        typer.Option(help="Random seed of a large town, seen by an HDL-64E; repeatable."),
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
            help="Folder of prepared pairs SEED-SENSOR-PLACE or SEED-SENSOR+OTHER-PLACE: drives "
            "robot_a and robot_b of 'placecell town', with the recordings robot_a.safetensors and "
            "robot_b.safetensors of 'placecell prepare --every 2'; repeatable.",
        ),
    ] = None,
    drive: Annotated[
        list[str] | None,
        typer.Option(
            metavar="town:SEED:SENSOR[+OTHER]:PLACE",
            help="Pair to simulate, such as town:101:vlp-16:campus, or town:601:vlp-16+os1-64 "
            "with two sensors; repeatable. The place look-alikes is a town of identical houses. "
            "(default: 34 pairs of all sensors and places, if neither --pairs nor --town is given)",
        ),
    ] = None,
    scans: Annotated[
        int | None,
        typer.Option(
            min=20,
            help="Scans per robot of --town and --drive. (default: 600 with --town; 150 with "
            "--drive, and 400 in a town of identical houses)",
        ),
    ] = None,
    queries: Annotated[
        int,
        typer.Option(
            min=2,
            help="Largest number of captures of each robot that are localized, spread evenly. Each "
            "one is localized about ten times.",
        ),
    ] = 16,
    model: Model = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            callback=output_file,
            help="JSON file for the constants. (default: the file that the service reads)",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(help="Random seed for the drawn segments.")] = 0,
    json_file: JsonFile = None,
) -> None:
    """Fit the probability that a pose is right, on simulated drives of several sensors and places.

    Each model has its own constants. The command writes them into the model's folder. Each sensor
    is left out of the fit once, and the two sensors of a pair together, to calibrate the acceptance
    of poses and to measure how reliable the probabilities are on a new sensor. With one sensor,
    each town is left out once.
    """
    from evaluation.poses.confidence import fit
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from placecell.localization.confidence import NAME

    folder_of_model = model_folder(model or DEFAULT_MODEL)
    file = output or folder_of_model / NAME
    seeds = town or []
    names = drive or ([] if pairs or seeds else list(DRIVES))
    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-towns-") as temporary:
        folder = Path(temporary)
        found = prepared_pairs(pairs or [])
        found += simulated_pairs(folder / "drives", names, scans)
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
    rows = {
        "all": held_out["all"],
        "same sensor": held_out["same_sensor"],
        "cross sensor": held_out["cross_sensor"],
        **held_out["sensors"],
        **held_out["places"],
    }
    for name, row in rows.items():
        values = ("-" if row[key] is None else f"{row[key]:.4f}" for key in columns)
        table.add_row(name, f"{row['cases']:,}", *values)
    print_tables(table)
    typer.echo(f"A pose is returned if its probability exceeds {held_out['threshold']:.3f}.")
