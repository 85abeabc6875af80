"""`placecell maps render`: what a map looks like, from the codes of its segments."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli.common_options import Classes, Ignore
from cli.maps.connection import LOCAL, Url, service
from cli.outputs import output_file
from cli.sources import clear_errors, parse_town, show
from placecell.export.targets import ColorBy

if TYPE_CHECKING:
    from placecell_client import CompactMap

    from placecell.descriptors.manifest import Manifest
    from placecell.export.content import ExportContent

PICTURE_SCANS = 80
"""Scans of the drive of a town's picture."""
PICTURE_MODEL = "context-town"
"""Model of a town's picture: it has classes."""
TARGETS = ("ply", "las", "pcd")


def render(
    source: Annotated[
        str,
        typer.Argument(
            metavar="MAP",
            help="Name of a map of the service, a map file, or town:SEED:SENSOR:PLACE: the map of "
            "a simulated drive is drawn beside its cloud.",
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            callback=output_file,
            help="File to write: a cloud (.ply, .las, .pcd) or a picture (.png).",
        ),
    ],
    model: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Model of the map: name or folder. (default: by the map's id)"
        ),
    ] = None,
    color: Annotated[
        ColorBy | None,
        typer.Option(
            help="Number of a segment that decides its color. (default: class if the map has it, "
            "else id)"
        ),
    ] = None,
    classes: Classes = None,
    ignore: Ignore = None,
    url: Url = LOCAL,
) -> None:
    """Decode the shapes of all segments of a map into a colored cloud or a picture.

    A map holds no points. The decoder of its model makes them from the code of each segment.

        placecell maps render yard -o yard.ply
    """
    with clear_errors():
        from cli.map_content import filtered
        from placecell.core.segment_classes import ClassFilter
        from placecell.export.export import write_content
        from placecell.shapes.decoder import ShapeDecoder
        from service.clouds.map_shapes import rendered_content

        if source.startswith("town:"):
            draw_town(source, output, model)
            return
        suffix = output.suffix.lower().removeprefix(".")
        if suffix not in (*TARGETS, "png"):
            raise ValueError(f"{output}: unknown format. Name a file .ply, .las, .pcd or .png.")
        wanted = ClassFilter.of(classes, ignore or ())
        found = filtered(_content(source, url), wanted, source)
        folder, manifest = _model_of(found, model)
        content = rendered_content(found, ShapeDecoder(folder, manifest), show)
        chosen = color or ("id" if found.classes is None else "class")
        if suffix == "png":
            draw(content, chosen, output)
        else:
            write_content(content, suffix, output, chosen, None)  # type: ignore[arg-type]
    typer.echo(f"{output}: {len(found):,} segments, {len(content.points):,} points")


def draw_town(text: str, file: Path, model: str | None) -> None:
    """Draw the map of a simulated drive beside its cloud.

    Raises:
        ValueError: the file is no PNG file, the place or the sensor is unknown, or the model has no
            classes.
    """
    import tempfile

    from evaluation.poses.map_picture import draw_map
    from evaluation.poses.town_drives import TownDrives
    from placecell.descriptors.shipped_models import model_folder

    if file.suffix.lower() != ".png":
        raise ValueError(f"{file}: the picture of a simulated drive is a PNG file. Name it .png.")
    seed, sensor, place = parse_town(text)
    with tempfile.TemporaryDirectory(prefix="placecell-town-") as folder:
        drives = TownDrives(Path(folder), seed, place or "streets", PICTURE_SCANS)
        robot = drives.robot("robot_a", sensor or "hdl-64e", show)
        found = draw_map(robot, model_folder(model or PICTURE_MODEL), file)
    typer.echo(f"{file}: {len(found):,} segments")


def _content(source: str, url: str) -> "CompactMap":
    from placecell_client.maps.map_file import decode

    if Path(source).is_file():
        return decode(Path(source).read_bytes())
    with service(url) as client:
        return client.get_map(source)


def _model_of(found: "CompactMap", model: str | None) -> "tuple[Path, Manifest]":
    """Return the folder and the manifest of a map's model.

    Raises:
        ValueError: no shipped model made the map, or the named model did not.
    """
    from placecell.descriptors.manifest import Manifest
    from placecell.descriptors.shipped_models import MODELS_FOLDER, model_folder

    folders = [model_folder(model)] if model else sorted(MODELS_FOLDER.iterdir())
    for folder in folders:
        if (folder / "manifest.json").is_file():
            manifest = Manifest.load(folder)
            if manifest.model_id == found.model_id:
                return folder, manifest
    raise ValueError(
        f"The map was made by the model {found.model_id}, which is not there. Name the folder of "
        "that model with --model."
    )


def draw(content: "ExportContent", color: ColorBy, file: Path) -> None:
    """Draw decoded points from above at a slant, nearer ones over farther ones."""
    from evaluation.cloud_picture import draw_cloud
    from evaluation.figure import figure
    from placecell.export.export import shades_of

    with figure(file, size=9) as (axes,):
        draw_cloud(axes, content.points, shades_of(content, color)[content.owners])
        axes.set_title(f"{len(content.ids):,} stored segments")
