"""The options of `placecell town`."""

from pathlib import Path
from typing import Annotated

import typer

SCANS = 120
"""Of a drive through the small town."""

LARGE = "Large town (with --meters)"

Output = Annotated[Path, typer.Argument(help="Folder for the drives.")]
Seed = Annotated[
    int, typer.Option(min=0, help="Of the town, the route, the parked cars and the noise.")
]
Scans = Annotated[
    int | None,
    typer.Option(
        min=1, help=f"Scans a drive. (default: {SCANS}; in a large town all of the route)"
    ),
]
Spacing = Annotated[float, typer.Option(min=0.05, help="Metres between scans.")]
Columns = Annotated[int, typer.Option(min=16, help="Azimuth steps a turn of the sensor.")]
Overwrite = Annotated[bool, typer.Option(help="Replace drives that are there.")]
Meters = Annotated[
    float | None,
    typer.Option(
        help="Of streets, up to 200,000: a large town; only what is near the sensor is built.",
        rich_help_panel=LARGE,
    ),
]
LookAlikes = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=1.0,
        help="Share of the streets that rows of identical houses line.",
        rich_help_panel=LARGE,
    ),
]
RouteText = Annotated[
    str,
    typer.Option(
        help="all: each street at least once, in as few metres as can be; wander:METRES: at "
        "random; loop:METRES or loop:METRES:LAPS: round, ending with the street it began with; "
        "C,R:C,R: the shortest way between two crossings (column, row; from 0,0 in the "
        "south-west).",
        rich_help_panel=LARGE,
    ),
]
Start = Annotated[
    float,
    typer.Option(
        "--from",
        min=0.0,
        help="Metres of its way after which each drive begins.",
        rich_help_panel=LARGE,
    ),
]
Robots = Annotated[
    int,
    typer.Option(
        min=1,
        max=26,
        help="Drives along the route, every second one the other way; other cars are parked.",
        rich_help_panel=LARGE,
    ),
]
Lane = Annotated[
    float,
    typer.Option(
        min=-3.0,
        max=3.0,
        help="Metres to the right of the middle of the street; negative: against the traffic.",
        rich_help_panel=LARGE,
    ),
]
Oncoming = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=100.0,
        help="Cars that come the other way, a kilometre.",
        rich_help_panel=LARGE,
    ),
]
Rain = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=100.0,
        help="Millimetres an hour: far and dark surfaces are not seen.",
        rich_help_panel=LARGE,
    ),
]
YawDrift = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=90.0,
        help="Of poses_odometry.txt: the heading's standard deviation after one metre, in "
        "degrees; it grows with the root of the metres.",
        rich_help_panel=LARGE,
    ),
]
ScaleDrift = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=0.3,
        help="Of poses_odometry.txt: standard deviation of the share by which all of a drive's "
        "distances are off.",
        rich_help_panel=LARGE,
    ),
]
Pairs = Annotated[
    int,
    typer.Option(
        min=0,
        help="Write OUTPUT/pairs.json: so many pairs of stretches of the first two drives that "
        "overlap by 10% to 100%, and as many that do not overlap.",
        rich_help_panel=LARGE,
    ),
]
PairMeters = Annotated[
    float, typer.Option(min=1.0, help="Of each such stretch.", rich_help_panel=LARGE)
]
Picture = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Draw streets, route and odometry into this PNG.",
        rich_help_panel=LARGE,
    ),
]
JsonFile = Annotated[
    Path | None,
    typer.Option(
        "--json",
        metavar="FILE",
        help="Write what was driven, and how long it took.",
        rich_help_panel=LARGE,
    ),
]
