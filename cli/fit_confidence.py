"""`placecell fit-confidence`: what the probability of a pose follows from."""

import json
import tempfile
from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors, show


def fit_confidence(
    town: Annotated[
        list[int] | None,
        typer.Option(help="Seed of a town; repeat for two or more. (default: 31 to 36)"),
    ] = None,
    scans: Annotated[int, typer.Option(min=20, help="Of each robot in each town.")] = 300,
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

    Writes them with how true the probabilities are in towns that each was not fitted on.
    """
    from bench.confidence import fit
    from bench.pose_queries import Pair
    from segments.localisation.confidence import FILE
    from segments.models import DEFAULT_MODEL, model_folder
    from town import two_robots

    seeds = town or list(range(31, 37))
    with clear_errors(), tempfile.TemporaryDirectory(prefix="placecell-towns-") as folder:
        if len(set(seeds)) < 2:
            raise ValueError("two or more towns are needed: each is left out in turn")
        pairs = []
        for each in seeds:
            drives = two_robots(Path(folder) / str(each), seed=each, scans=scans, progress=show)
            pairs.append(Pair.of(*drives, progress=show))
        content = fit(pairs, model_folder(model or DEFAULT_MODEL), seed, progress=show)
        content["fitted_on"]["towns"] = seeds
        file = output or FILE
        file.write_text(json.dumps(content, indent=2) + "\n")
    held_out = content["held_out"]
    for row in held_out["reliability"]:
        typer.echo(f"stated {row['stated']:.3f}: right {row['right']:.3f} of {row['count']:,}")
    typer.echo(f"Brier score {held_out['brier']}; written to {file}")
