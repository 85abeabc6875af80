"""`placecell bench moving`: how many moving segments are marked, and what that gains."""

import tempfile
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.bench.options import JsonFile, Seed, write_json
from cli.common_options import Model
from cli.sources import clear_errors, show
from cli.tables import new_table, percent, print_tables


def moving(
    drive: Annotated[
        Path | None,
        typer.Argument(
            help="Recorded drive: its blocks are localized in the map of its other blocks. "
            "(default: simulated drives)"
        ),
    ] = None,
    sensor: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Simulated sensor, each in a town of its own. Repeatable. "
            "(default: hdl-64e, os1-64, vlp-16)",
        ),
    ] = None,
    scans: Annotated[
        int, typer.Option(min=30, help="Scans of each drive, 1 m and 0.1 s apart.")
    ] = 150,
    oncoming: Annotated[
        float, typer.Option(min=0.0, max=100.0, help="Oncoming cars per kilometer.")
    ] = 30.0,
    seed: Seed = 911,
    model: Model = None,
    json_file: JsonFile = None,
) -> None:
    """Measure how many segments of moving cars are marked, and what leaving them out gains.

    Two robots drive the same streets of a simulated town in opposite directions. The second one is
    localized in the map of the first, with all segments and without those that moved. A segment is
    left out if it is marked while its id persists. Without labels, no segment counts as moving
    or standing.
    """
    from benchmarks.robot.moving_segments import measure_moving, measure_moving_of_drive
    from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder

    with clear_errors(), tempfile.TemporaryDirectory() as folder:
        described_by = model_folder(model or DEFAULT_MODEL)
        if drive is not None:
            report = measure_moving_of_drive(drive, described_by, progress=show)
        else:
            sensors = sensor or ["hdl-64e", "os1-64", "vlp-16"]
            report = measure_moving(
                Path(folder), sensors, seed, scans, oncoming, described_by, progress=show
            )
        write_json(report, json_file)
    print_moving(report)


def print_moving(report: dict[str, Any]) -> None:
    """Print the figures as two tables."""
    marks = new_table(
        "sensor",
        *("views", "marked", "left out"),
        *("moving", "marked", "left out", "standing", "marked", "left out"),
        title="segments that move, by the labels, and segments that are marked",
    )
    poses = new_table(
        *("sensor", "segments"),
        *("map segments", "bytes", "queries", "best pose right", "right", "wrong but sure"),
        title="poses of the second robot in the map of the first",
    )
    keys = (
        *("views", "marked", "left_out", "moving", "moving_marked", "moving_left_out"),
        *("standing", "standing_marked", "standing_left_out"),
    )
    for row in report["rows"]:
        marks.add_row(row["sensor"], *(f"{row[key]:,}" for key in keys))
        for name, found in row["poses"].items():
            poses.add_row(
                row["sensor"],
                name,
                *(f"{found[key]:,}" for key in ("map_segments", "map_bytes", "queries")),
                percent(found["best_pose_right"]),
                *(str(found["counts"][key]) for key in ("localised_right", "wrong_but_sure")),
            )
    print_tables(marks, poses)
