"""Options of all commands that read recorded drives: scans, poses, mount of the sensor."""

import functools
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.errors import clear_errors
from cli.tables import show
from placecell.sources.scan_options import (
    DType,
    Order,
    ScanOptions,
    Unit,
    parse_columns,
    use_scan_options,
)
from placecell.trajectories.times import TimeUnit

PANEL = "Recorded drives"

OPTIONS: dict[str, tuple[Any, Any]] = {
    "topic": (
        Annotated[
            str | None,
            typer.Option(
                metavar="NAME",
                help="Topic of a bag with the clouds. (default: the only one, or the one with the "
                "most points)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "poses": (
        Annotated[
            Path | None,
            typer.Option(
                metavar="FILE",
                help="Trajectory: KITTI, TUM, EuRoC, CSV, g2o, or a bag with poses. (default: the "
                "drive's own poses, else odometry)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "pose_offset": (
        Annotated[
            float | None,
            typer.Option(
                metavar="SECONDS",
                help="Seconds to add to the times of --poses. (default: 0)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "odometry": (
        Annotated[
            str | None,
            typer.Option(
                metavar="TOPIC",
                help="Poses by a topic of the bag, by kiss-icp from the scans, or by rko-lio from "
                "scans and IMU; none uses none of them, so that a bag needs --poses. (default: "
                "the bag's own poses, else kiss-icp)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "extrinsic": (
        Annotated[
            str | None,
            typer.Option(
                metavar="MOUNT",
                help="Sensor's pose in the frame of the poses: a file, 'x y z roll pitch yaw' in "
                "meters and radians (append deg for degrees), or identity. (default: the bag's "
                "transforms, else identity)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "deskew": (
        Annotated[
            bool,
            typer.Option(
                "--deskew/--no-deskew",
                help="Remove motion distortion where points have times. Use --no-deskew if the "
                "points are deskewed already.",
                rich_help_panel=PANEL,
            ),
        ],
        True,
    ),
    "columns": (
        Annotated[
            str | None,
            typer.Option(
                metavar="NAMES",
                help="Columns of a .bin scan: their number, or names such as "
                "x,y,z,intensity,ring. (default: inferred from the values; KITTI has 4)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "dtype": (
        Annotated[
            DType | None,
            typer.Option(
                help="Data type of a scan's values. (default: inferred from the values)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "order": (
        Annotated[
            Order,
            typer.Option(
                help="Memory order of a scan: rows (point by point) or columns (all x first).",
                rich_help_panel=PANEL,
            ),
        ],
        "rows",
    ),
    "unit": (
        Annotated[
            Unit,
            typer.Option(
                help="Unit of the scans' coordinates; ft is the international foot, us-ft that of "
                "US surveys.",
                rich_help_panel=PANEL,
            ),
        ],
        "m",
    ),
    "time_unit": (
        Annotated[
            TimeUnit, typer.Option(help="Unit of the times in times.txt.", rich_help_panel=PANEL)
        ],
        "s",
    ),
    "strict": (
        Annotated[
            bool,
            typer.Option(
                "--strict",
                help="Refuse a drive that has unusable scans or NaN points. "
                "(default: skip and count them)",
                rich_help_panel=PANEL,
            ),
        ],
        False,
    ),
}


def tell(message: str) -> None:
    """Print a finding about a drive's files on standard error."""
    typer.echo(f"placecell: {message}", err=True)


def takes_drives(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options of recorded drives to a command; they apply while the command runs."""

    @functools.wraps(command)
    def with_options(**words: Any) -> None:
        given = {name: words.pop(name) for name in OPTIONS}
        with clear_errors():
            names = given.pop("columns")
            options = ScanOptions(
                columns=None if names is None else parse_columns(names),
                tell=tell,
                progress=show,
                **given,
            )
        with use_scan_options(options):
            command(**words)

    signature = inspect.signature(command, eval_str=True)
    extra = [
        inspect.Parameter(
            name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=default, annotation=kind
        )
        for name, (kind, default) in OPTIONS.items()
    ]
    parameters = [*signature.parameters.values(), *extra]
    with_options.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    with_options.__annotations__ = {each.name: each.annotation for each in parameters}
    del with_options.__wrapped__
    return with_options
