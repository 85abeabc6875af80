"""`placecell town`: drives through a synthetic town."""

from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors, show


def town(
    output: Annotated[Path, typer.Argument(help="Folder for the drives.")],
    seed: Annotated[
        int, typer.Option(help="Of the town, the route, the parked cars and the noise.")
    ] = 7,
    scans: Annotated[int, typer.Option(min=1, help="Scans a drive.")] = 120,
    spacing: Annotated[float, typer.Option(min=0.05, help="Metres between scans.")] = 1.0,
    columns: Annotated[
        int, typer.Option(min=16, help="Azimuth steps a turn of the sensor.")
    ] = 1000,
    overwrite: Annotated[bool, typer.Option(help="Replace drives that are there.")] = False,
) -> None:
    """Drive two robots through a synthetic town, the same streets in opposite directions.

    Writes OUTPUT/robot_a and OUTPUT/robot_b in the KITTI odometry layout: 64 beams, parked cars
    changed between the drives. The same seed gives the same files.
    """
    from town import two_robots

    with clear_errors():
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
