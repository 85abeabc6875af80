"""`placecell town`: drives through a synthetic town."""

import json
import re
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from cli.sources import clear_errors, show

if TYPE_CHECKING:
    from town import City, Route
    from town.planner import Way

SCANS = 120
"""Of a drive through the small town."""

LARGE = "Large town (with --metres)"


def town(
    context: typer.Context,
    output: Annotated[Path, typer.Argument(help="Folder for the drives.")],
    seed: Annotated[
        int, typer.Option(min=0, help="Of the town, the route, the parked cars and the noise.")
    ] = 7,
    scans: Annotated[
        int | None,
        typer.Option(
            min=1, help=f"Scans a drive. (default: {SCANS}; in a large town all of the route)"
        ),
    ] = None,
    spacing: Annotated[float, typer.Option(min=0.05, help="Metres between scans.")] = 1.0,
    columns: Annotated[
        int, typer.Option(min=16, help="Azimuth steps a turn of the sensor.")
    ] = 1000,
    overwrite: Annotated[bool, typer.Option(help="Replace drives that are there.")] = False,
    metres: Annotated[
        float | None,
        typer.Option(
            help="Of streets, up to 200,000: a large town; only what is near the sensor is built.",
            rich_help_panel=LARGE,
        ),
    ] = None,
    look_alikes: Annotated[
        float,
        typer.Option(
            min=0.0, max=1.0, help="Share of the streets that rows of identical houses line.",
            rich_help_panel=LARGE,
        ),
    ] = 0.25,
    route: Annotated[
        str,
        typer.Option(
            help="all: each street at least once, in as few metres as can be; wander:METRES: at "
            "random; loop:METRES or loop:METRES:LAPS: round, ending with the street it began with; "
            "C,R:C,R: the shortest way between two crossings (column, row; from 0,0 in the "
            "south-west).",
            rich_help_panel=LARGE,
        ),
    ] = "all",
    robots: Annotated[
        int,
        typer.Option(
            min=1, max=26,
            help="Drives along the route, every second one the other way; other cars are parked.",
            rich_help_panel=LARGE,
        ),
    ] = 2,
    lane: Annotated[
        float,
        typer.Option(
            min=-3.0, max=3.0,
            help="Metres to the right of the middle of the street; negative: against the traffic.",
            rich_help_panel=LARGE,
        ),
    ] = 1.6,
    oncoming: Annotated[
        float,
        typer.Option(
            min=0.0, max=100.0, help="Cars that come the other way, a kilometre.",
            rich_help_panel=LARGE,
        ),
    ] = 10.0,
    rain: Annotated[
        float,
        typer.Option(
            min=0.0, max=100.0, help="Millimetres an hour: far and dark surfaces are not seen.",
            rich_help_panel=LARGE,
        ),
    ] = 0.0,
    yaw_drift: Annotated[
        float,
        typer.Option(
            min=0.0, max=90.0,
            help="Of poses_odometry.txt: the heading's standard deviation after one metre, in "
            "degrees; it grows with the root of the metres.",
            rich_help_panel=LARGE,
        ),
    ] = 0.05,
    scale_drift: Annotated[
        float,
        typer.Option(
            min=0.0, max=0.3,
            help="Of poses_odometry.txt: standard deviation of the share by which all of a drive's "
            "distances are off.",
            rich_help_panel=LARGE,
        ),
    ] = 0.01,
    pairs: Annotated[
        int,
        typer.Option(
            min=0,
            help="Write OUTPUT/pairs.json: so many pairs of stretches of the first two drives that "
            "overlap by 10% to 100%, and as many that do not overlap.",
            rich_help_panel=LARGE,
        ),
    ] = 0,
    pair_metres: Annotated[
        float, typer.Option(min=1.0, help="Of each such stretch.", rich_help_panel=LARGE)
    ] = 300.0,
    picture: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Draw streets, route and odometry into this PNG.",
            rich_help_panel=LARGE,
        ),
    ] = None,
    json_file: Annotated[
        Path | None,
        typer.Option(
            "--json", metavar="FILE", help="Write what was driven, and how long it took.",
            rich_help_panel=LARGE,
        ),
    ] = None,
) -> None:  # fmt: skip
    """Drive robots through a synthetic town, the same streets in opposite directions.

    Writes OUTPUT/robot_a and OUTPUT/robot_b in the KITTI odometry layout: 64 beams, parked cars
    changed between the drives. The same seed gives the same files.

    With --metres the town is large, and the drives have a second file of poses, poses_odometry.txt,
    in which the robots' odometry drifts. Five kilometres of streets, all of them driven both ways:

        placecell town out/town5 --metres 5000 --picture out/town5.png

    A scan takes about a megabyte and a fortieth of a second: see docs/town.md.
    """
    with clear_errors():
        if metres is None:
            refuse_options_of_large_towns(context)
            small_town(output, seed, scans or SCANS, spacing, columns, overwrite)
            return
        if pairs and robots < 2:
            raise ValueError("--pairs needs two robots or more")
        from town import HDL_64E, City, Odometry, several_robots

        city = City.build(seed, metres, look_alikes)
        way = city.route(planned(city, route), lane)
        # Before anything is driven, for there may be none.
        drawn = pairs_of(city, way, scans, spacing, pairs, pair_metres) if pairs else None
        started = time.perf_counter()
        drives = several_robots(
            output,
            city,
            way,
            robots,
            scans=scans,
            spacing=spacing,
            lidar=replace(HDL_64E, columns=columns, rain=rain),
            odometry=Odometry(yaw_drift, scale_drift),
            oncoming=oncoming,
            overwrite=overwrite,
            progress=show,
        )
        figures = {
            "seed": seed,
            "street_metres": round(city.network.metres(), 1),
            "streets": len(city.network.streets),
            "route_metres": round(way.length(), 1),
            "scans": {drive.name: len(list((drive / "velodyne").iterdir())) for drive in drives},
            "seconds": round(time.perf_counter() - started, 1),
        }
        if drawn:
            write_json(drawn, output / "pairs.json")
        if picture:
            from town.picture import draw_plan

            draw_plan(picture, city, way, drives)
        if json_file:
            write_json(figures, json_file)
    typer.echo(json.dumps(figures))


def refuse_options_of_large_towns(context: typer.Context) -> None:
    """Say that an option would have no effect.

    Raises:
        ValueError: one of the large town's was given.
    """
    for parameter in context.command.params:
        source = context.get_parameter_source(str(parameter.name))
        given = source is not None and source.name == "COMMANDLINE"
        if given and getattr(parameter, "rich_help_panel", None) == LARGE:
            raise ValueError(f"{parameter.opts[0]} needs a large town: give --metres too")


def small_town(
    output: Path, seed: int, scans: int, spacing: float, columns: int, overwrite: bool
) -> None:
    """Two robots in the town that is built whole."""
    from town import two_robots

    drives = two_robots(
        output,
        seed=seed,
        scans=scans,
        spacing=spacing,
        columns=columns,
        overwrite=overwrite,
        progress=show,
    )
    for drive in drives:
        typer.echo(f"{drive}: {scans} scans")


def planned(city: "City", text: str) -> "Way":
    """The way that `--route` asks for.

    Raises:
        ValueError: no such way.
    """
    rng = np.random.default_rng([city.seed, 11])
    number = r"(\d+(?:\.\d*)?)"
    if text == "all":
        return city.planner.every_street()
    if match := re.fullmatch(f"wander:{number}", text):
        return city.planner.wander(float(match[1]), rng)
    if match := re.fullmatch(rf"loop:{number}(?::(\d+))?", text):
        return city.planner.loop(float(match[1]), rng, int(match[2] or 1))
    if match := re.fullmatch(r"(\d+),(\d+):(\d+),(\d+)", text):
        a, b, c, d = (int(part) for part in match.groups())
        return city.planner.between((a, b), (c, d))
    raise ValueError(
        f"--route is all, wander:METRES, loop:METRES, loop:METRES:LAPS or C,R:C,R, not {text!r}"
    )


def pairs_of(
    city: "City", route: "Route", scans: int | None, spacing: float, count: int, metres: float
) -> dict[str, Any]:
    """Pairs of stretches of the first two robots' drives along a route."""
    from town import Traversal, draw_pairs, way_of

    a, b = (Traversal.of(*way_of(number, route, scans, spacing), spacing) for number in (0, 1))
    overlapping, apart = draw_pairs(city, a, b, count, metres, city.seed)
    return {
        "seed": city.seed,
        "street_metres": round(city.network.metres(), 1),
        "metres": metres,
        "drives": ["robot_a", "robot_b"],
        "overlapping": [pair.as_dict() for pair in overlapping],
        "apart": [pair.as_dict() for pair in apart],
    }


def write_json(content: dict[str, Any], file: Path) -> None:
    """Write a file for programs."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(content, indent=2) + "\n")
