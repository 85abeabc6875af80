"""`placecell bench completion`: benefit of decoded shapes for poses and recognition."""

from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import Drawn, JsonFile, write_json
from cli.common_options import Model
from cli.evaluate_poses import pair_of_town
from cli.sources import clear_errors, show
from cli.tables import new_table, percent, print_tables


def completion(
    drive: Annotated[
        Path,
        typer.Argument(
            help="Drive whose blocks are localized in the map of its other blocks. town:SEED or "
            "town:SEED:SENSOR:PLACE simulates two robots that drive in opposite directions."
        ),
    ],
    queries: Annotated[
        int, typer.Option(min=1, help="Number of queries, spread evenly over the drive.")
    ] = 100,
    scans: Annotated[int, typer.Option(min=30, help="Scans of each simulated drive.")] = 150,
    seed: Drawn = 0,
    model: Model = None,
    json_file: JsonFile = None,
) -> None:
    """Measure whether the shapes that a map decodes make poses or recognition better.

    Each pose is refined by ICP (KISS-ICP's registration) against the decoded shapes and, as the
    upper bound, against the true points of the mapped segments. The candidates of each segment
    are ordered by the overlap of decoded grids. Needs the extra 'odometry'.
    """
    from benchmarks.localization.completion import measure_completion
    from evaluation.poses.queries import Pair
    from placecell.core.parameters import PROTOCOL_V1
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors():
        if str(drive).startswith("town:"):
            made = (str(drive), None, None, None, None, scans, None, None)
            pair = pair_of_town(*made, PROTOCOL_V1)
        else:
            pair = Pair.of(drive, progress=show)
        folder = model_folder(model or DEFAULT_MODEL)
        report = measure_completion(pair, folder, queries, seed, progress=show)
        write_json(report, json_file)
    print_completion(report)


def print_completion(report: dict[str, Any]) -> None:
    """Print the figures as two tables."""
    keys = ("median_m", "p90_m", "median_deg", "p90_deg")
    poses = new_table("refined by", "poses", *(key.replace("_", " ") for key in keys))
    for way, row in report["poses"].items():
        poses.add_row(way, *(str(row[key]) for key in ("poses", *keys)))
    found = {name: report["recognition"][name] for name in ("top1", "cross_view_top1")}
    first = new_table("candidates ordered by", *(name.replace("_", " ") for name in found))
    for way in next(iter(found.values())):
        if way != "queries":
            first.add_row(way, *(percent(row[way]) for row in found.values()))
    print_tables(poses, first)
