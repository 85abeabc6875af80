"""`placecell export`: writes maps and recordings for other programs."""

from pathlib import Path
from typing import Annotated

import typer

from cli.common_options import Classes, Ignore
from cli.outputs import output_file
from cli.sources import clear_errors
from cli.tables import progress_console
from placecell.export.targets import ColorBy, Target


def export(
    source: Annotated[
        Path,
        typer.Argument(
            help="Map file from 'placecell maps pull', or recording from 'placecell prepare'."
        ),
    ],
    to: Annotated[Target, typer.Option(help="Format to write.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            callback=output_file,
            help="File to write. (default: SOURCE with the new suffix)",
        ),
    ] = None,
    color: Annotated[
        ColorBy, typer.Option(help="Number of a segment that decides its color.")
    ] = "id",
    anchor: Annotated[
        str | None,
        typer.Option(
            metavar="LAT,LON[,YAW_DEG]",
            help="Place of the map's origin in degrees, and the angle from east to the map's x "
            "axis, counter-clockwise; geojson needs it.",
        ),
    ] = None,
    classes: Classes = None,
    ignore: Ignore = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace the file if it exists.")
    ] = False,
) -> None:
    """Write a map or a recording for CloudCompare, QGIS, Foxglove and other programs.

    ply, las, pcd and mcap hold the segments in colors; geojson holds their places; tum and g2o hold
    the sensor's poses. A recording has all points, a map one point a segment.

        placecell export data/city.safetensors --to las
    """
    from functools import partial

    from cli.map_content import read_content
    from placecell.core.segment_classes import ClassFilter
    from placecell.export.export import export as write
    from placecell.export.geo import parse_anchor

    with clear_errors():
        place = None if anchor is None else parse_anchor(anchor)
        read = partial(read_content, wanted=ClassFilter.of(classes, ignore or ()))
        file = output or source.with_suffix(f".{to}")
        with progress_console().status(f"Writing {file}"):
            content = write(source, to, file, color, place, overwrite, read)
        for remark in content.remarks:
            typer.echo(f"placecell: {source}: {remark}", err=True)
    typer.echo(
        f"{file}: {len(content.ids):,} segments, {len(content.points):,} points, "
        f"{len(content.poses):,} poses"
    )
