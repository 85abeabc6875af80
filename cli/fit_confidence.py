"""`placecell fit-confidence`: fits the model of a pose's probability."""

import json
import tempfile
from pathlib import Path
from typing import Annotated

import typer

from cli.common_options import Model
from cli.sources import clear_errors, show
from cli.tables import JsonFile, write_json

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


def fit_confidence(
    town: Annotated[
        list[int] | None,
        typer.Option(
            help="Random seed of a town; repeatable, at least two. (default: 51 to 54, 61 to 63)"
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
    scans: Annotated[int, typer.Option(min=20, help="Scans per robot and town.")] = 600,
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
    """Fit the probability that a pose is right, on simulated drives through towns.

    Each model has its own constants. The command writes them into the model's folder. Each town is
    left out of the fit once, to measure how reliable the probabilities are.
    """
    from evaluation.poses.confidence import fit
    from evaluation.poses.queries import Pair
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
    from placecell.localization.confidence import NAME

    folder_of_model = model_folder(model or DEFAULT_MODEL)
    file = output or folder_of_model / NAME
    seeds = town or list(TOWNS)
    shares = [TOWNS.get(each, 0.5) if look_alikes is None else look_alikes for each in seeds]
    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-towns-") as folder:
        if len(set(seeds)) < 2:
            raise ValueError("Give two or more towns: each one is left out of the fit once.")
        drives = [
            two_drives(Path(folder) / str(each), each, scans, share)
            for each, share in zip(seeds, shares, strict=True)
        ]
        pairs = [Pair.of(*both, progress=show) for both in drives]
        content = fit(pairs, folder_of_model, seed, progress=show)
        content["fitted_on"] |= {"towns": seeds, "look_alikes": shares}
        file.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
        write_json(content, json_file)
    held_out = content["held_out"]
    for row in held_out["reliability"]:
        typer.echo(
            f"Stated probability {row['stated']:.3f}: "
            f"{row['right']:.3f} of {row['count']:,} poses are right."
        )
    typer.echo(f"The Brier score is {held_out['brier']}. The constants are in {file}.")
