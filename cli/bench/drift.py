"""`placecell bench drift`: removes the drift of maps of simulated robots."""

from pathlib import Path
from typing import Annotated

import typer

from cli.bench.options import JsonFile, write_json
from cli.drive_options import tell
from cli.outputs import output_folder
from cli.sources import clear_errors
from cli.tables import new_table, print_tables


def drift(
    meters: Annotated[
        list[float] | None,
        typer.Option(
            min=200.0,
            help="Total way of the robots, meters. Repeatable. (default: 2000, 5000, 20000)",
        ),
    ] = None,
    percent: Annotated[
        list[float] | None,
        typer.Option(
            min=0.0, max=10.0, help="Drift of the odometry, percent. Repeatable. (default: 1, 2)"
        ),
    ] = None,
    robots: Annotated[
        list[int] | None,
        typer.Option(
            min=1,
            max=9,
            help="Number of robots; one drives loops, several share streets in both directions. "
            "Repeatable. (default: 1, 3)",
        ),
    ] = None,
    look_alikes: Annotated[
        bool,
        typer.Option(
            "--look-alikes/--no-look-alikes", help="Also measure towns of identical houses."
        ),
    ] = True,
    seed: Annotated[int, typer.Option(help="Seed of towns, routes and noise.")] = 7,
    cache: Annotated[
        Path,
        typer.Option(
            metavar="FOLDER", callback=output_folder, help="Folder where simulated maps are kept."
        ),
    ] = Path("out/drift"),
    every: Annotated[
        float,
        typer.Option(
            min=1.0, help="Way between two captures that are localized in a merged map, meters."
        ),
    ] = 10.0,
    kiss_slam: Annotated[
        Path | None,
        typer.Option(
            metavar="PYTHON",
            help="Python interpreter of the peers' environment (make peers): KISS-SLAM maps the "
            "drives of single robots too. (default: none)",
        ),
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Measure trajectory errors before and after the optimization of a map's pose graph.

    Robots drive through simulated towns with drifting odometry: a scale error that wanders, and a
    heading that walks at random. `seconds` is the time of loop search and optimization, without the
    simulation. The maps of several robots are also merged, with `rigid: false`, and the robots are
    localized in the merged map and in an undrifted one. A simulated map is kept for the next run.
    The command ends with status 1 if a wrong loop is accepted.
    """
    from benchmarks.drift.drift import DriftPlan, run_drift
    from benchmarks.drift.town_maps import DriftCase

    with clear_errors():
        cases = [
            DriftCase(each, count, share, seed)
            for share in ((0.25, 1.0) if look_alikes else (0.25,))
            for each in meters or [2000.0, 5000.0, 20000.0]
            for count in robots or [1, 3]
        ]
        plan = DriftPlan(cases, percent or [1.0, 2.0], cache, every=every, kiss_slam=kiss_slam)
        # A long run that is stopped leaves the rows that it has.
        report = run_drift(plan, tell, keep=lambda so_far: write_json(so_far, json_file))
        write_json(report, json_file)
    table = new_table("case", "meters", "loops", "wrong", "ATE before", "after", "seconds")
    for row in report["rows"]:
        table.add_row(
            row["case"],
            f"{row['meters']:,.0f}",
            f"{row['loops_accepted']} of {row['loops_found']}",
            str(row["loops_wrong"]),
            f"{row['ate_before_m']:.2f} m",
            f"{row['ate_after_m']:.2f} m",
            f"{row['seconds']:.0f}",
        )
    print_tables(table)
    if any(row["loops_wrong"] for row in report["rows"]):
        raise typer.Exit(1)
