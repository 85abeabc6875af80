"""`placecell fit-confidence`: what the probability of a pose follows from."""

import json
import tempfile
from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors, show

LOOK_ALIKES = 0.5
"""Share of the streets that identical houses line: where else is one wrong and sure?"""


def two_drives(folder: Path, seed: int, scans: int) -> tuple[Path, Path]:
    """Two robots' drives through the same streets of a large town, opposite ways."""
    from town import City, several_robots

    city = City.build(seed, 1.6 * scans, LOOK_ALIKES)
    # The inner lane of a turn is shorter than the middle of the street.
    route = city.route(city.planner.every_street()).cut(0.0, max(1.1 * scans, scans + 10.0))
    one, other = several_robots(folder, city, route, 2, scans=scans, oncoming=10.0, progress=show)
    return one, other


def fit_confidence(
    town: Annotated[
        list[int] | None,
        typer.Option(help="Seed of a town; repeat for two or more. (default: 51 to 54)"),
    ] = None,
    scans: Annotated[int, typer.Option(min=20, help="Of each robot in each town.")] = 600,
    model: Annotated[
        str | None,
        typer.Option(help="A model's name or folder. (default: the one that is served)"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="(default: the one that is used)"),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the segments that are drawn.")] = 0,
) -> None:
    """Fit the constants of the probability that a pose is right, on drives through towns.

    Identical houses line half of their streets. Writes the constants with how true the
    probabilities are in towns that each was not fitted on.
    """
    from bench.confidence import fit
    from bench.pose_queries import Pair
    from segments.localisation.confidence import FILE
    from segments.models import DEFAULT_MODEL, model_folder

    seeds = town or list(range(51, 55))
    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-towns-") as folder:
        if len(set(seeds)) < 2:
            raise ValueError("two or more towns are needed: each is left out in turn")
        drives = [two_drives(Path(folder) / str(each), each, scans) for each in seeds]
        pairs = [Pair.of(*both, progress=show) for both in drives]
        content = fit(pairs, model_folder(model or DEFAULT_MODEL), seed, progress=show)
        content["fitted_on"] |= {"towns": seeds, "look_alikes": LOOK_ALIKES}
        file = output or FILE
        file.write_text(json.dumps(content, indent=2) + "\n")
    held_out = content["held_out"]
    for row in held_out["reliability"]:
        typer.echo(f"stated {row['stated']:.3f}: right {row['right']:.3f} of {row['count']:,}")
    typer.echo(f"Brier score {held_out['brier']}; written to {file}")
