"""Options of `placecell town`."""

from pathlib import Path
from typing import Annotated

import typer

from cli.outputs import output_file, picture_file

SCANS = 120
"""Default number of scans of a drive through the small town."""

SENSOR = "Sensor"

INDOOR = "Indoor floor (with --place indoor)"

LARGE = "Large town (with --meters)"

Output = Annotated[Path, typer.Argument(help="Folder for the drives.")]
Seed = Annotated[
    int, typer.Option(min=0, help="Random seed of town, route, parked cars and sensor noise.")
]
Place = Annotated[
    str,
    typer.Option(
        metavar="NAME", help="Place: streets, campus, garden, indoor, car-park or suburb."
    ),
]
Floor = Annotated[
    int,
    typer.Option(
        min=0,
        help="Floor of an indoor place. All floors of a seed have the same walls and the same "
        "route.",
        rich_help_panel=INDOOR,
    ),
]
Differing = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=1.0,
        help="Share of the furniture that differs between floor 0 and another floor, 0 to 1. "
        "What people move always differs.",
        rich_help_panel=INDOOR,
    ),
]
Scans = Annotated[
    int | None,
    typer.Option(
        min=1, help=f"Scans per drive. (default: {SCANS}; in a large town the whole route)"
    ),
]
Spacing = Annotated[
    float | None,
    typer.Option(
        min=0.05,
        help="Distance between scans, meters. (default: 1.0 on streets; each other place has its "
        "own, see docs/explanation/town.md)",
    ),
]
Sensor = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="Sensor: hdl-64e, hdl-32e, vlp-16, os0-32, os0-64, os0-128, os1-32, os1-64, os1-128 "
        "or solid-state. docs/explanation/sensors.md describes them.",
        rich_help_panel=SENSOR,
    ),
]
Mount = Annotated[
    float | None,
    typer.Option(
        help="Height of the sensor above the ground, meters, 0.3 to 3. (default: that of the "
        "sensor's usual carrier, 1.73 for hdl-64e; at most that of the place's usual robot)",
        rich_help_panel=SENSOR,
    ),
]
Columns = Annotated[
    int | None,
    typer.Option(
        min=16,
        help="Azimuth steps per revolution, or shots of each laser of solid-state; fewer thin the "
        "scans. (default: the sensor's own: 1000 for hdl-64e)",
        rich_help_panel=SENSOR,
    ),
]
Rain = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=100.0,
        help="Rain, millimeters per hour; it hides far and dark surfaces.",
        rich_help_panel=SENSOR,
    ),
]
Dropout = Annotated[
    float | None,
    typer.Option(
        min=0.0,
        max=0.99,
        help="Share of the returns that are lost at random. (default: the sensor's own: 0.02 for "
        "hdl-64e)",
        rich_help_panel=SENSOR,
    ),
]
Speed = Annotated[
    float | None,
    typer.Option(
        help="Speed of the robots, m/s. A sweep takes 0.1 s. (default: 10 times --spacing, so "
        "each sweep begins where the last one ended)",
        rich_help_panel=SENSOR,
    ),
]
Distortion = Annotated[
    bool,
    typer.Option(
        "--distortion",
        help="Write raw sweeps, distorted by the robot's motion, with a fifth column: the time of "
        "each point in seconds from the time of its scan. (default: deskewed scans)",
        rich_help_panel=SENSOR,
    ),
]
Labels = Annotated[
    bool,
    typer.Option(
        "--labels",
        help="Also write the class of each point, in labels/NNNNNN.label, as SemanticKITTI does. "
        "(default: no labels)",
    ),
]
Overwrite = Annotated[bool, typer.Option(help="Replace existing drives.")]
Meters = Annotated[
    float | None,
    typer.Option(
        help="Total street length in meters (at most 200,000); enables the large, tiled town.",
        rich_help_panel=LARGE,
    ),
]
LookAlikes = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=1.0,
        help="Share of streets with rows of identical houses, 0 to 1.",
        rich_help_panel=LARGE,
    ),
]
RouteText = Annotated[
    str,
    typer.Option(
        help="Route. all: the shortest route with every street; wander:METERS: a random route; "
        "loop:METERS or loop:METERS:LAPS: a closed loop that ends on its first street; C,R:C,R: "
        "the shortest route between two crossings (column, row; 0,0 is in the south-west).",
        rich_help_panel=LARGE,
    ),
]
Start = Annotated[
    float,
    typer.Option(
        "--from",
        min=0.0,
        help="Distance from the start of the route at which each drive begins, meters.",
        rich_help_panel=LARGE,
    ),
]
Robots = Annotated[
    int,
    typer.Option(
        min=1,
        max=26,
        help="Number of drives along the route; every second one is in the opposite direction. "
        "Each drive has its own parked cars.",
        rich_help_panel=LARGE,
    ),
]
Lane = Annotated[
    float,
    typer.Option(
        min=-3.0,
        max=3.0,
        help="Distance to the right of the street's middle, meters; negative: on the left.",
        rich_help_panel=LARGE,
    ),
]
Oncoming = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=100.0,
        help="Oncoming cars per kilometer.",
        rich_help_panel=LARGE,
    ),
]
YawDrift = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=90.0,
        help="Heading drift in poses_odometry.txt: standard deviation after one meter, degrees; "
        "it grows with the square root of the distance.",
        rich_help_panel=LARGE,
    ),
]
ScaleDrift = Annotated[
    float,
    typer.Option(
        min=0.0,
        max=0.3,
        help="Scale error in poses_odometry.txt: standard deviation of a drive's relative error "
        "of all distances.",
        rich_help_panel=LARGE,
    ),
]
Pairs = Annotated[
    int,
    typer.Option(
        min=0,
        help="Number of pairs of stretches of the first two drives that overlap by 10% to 100%, "
        "and of pairs that do not overlap; written to OUTPUT/pairs.json. 0: none.",
        rich_help_panel=LARGE,
    ),
]
PairMeters = Annotated[
    float,
    typer.Option(min=1.0, help="Length of each stretch of --pairs, meters.", rich_help_panel=LARGE),
]
Picture = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        callback=picture_file,
        help="PNG file for a drawing of streets, route and odometry.",
        rich_help_panel=LARGE,
    ),
]
JsonFile = Annotated[
    Path | None,
    typer.Option(
        "--json",
        metavar="FILE",
        callback=output_file,
        help="JSON file for the lengths, the scans and the duration.",
        rich_help_panel=LARGE,
    ),
]
