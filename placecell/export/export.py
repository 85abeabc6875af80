"""Export of segments to a file of another program."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from placecell.core.files import written_whole
from placecell.core.geodesy import GeoAnchor
from placecell.core.types import UInt8
from placecell.export.clouds import write_las, write_pcd, write_ply
from placecell.export.content import ExportContent, class_colors, colors, read_recording
from placecell.export.geo import write_geojson
from placecell.export.mcap_file import write_mcap
from placecell.export.poses import write_g2o, write_tum
from placecell.export.targets import ColorBy, Target

CLOUDS = {"ply": write_ply, "las": write_las, "pcd": write_pcd, "mcap": write_mcap}
POSES = {"tum": write_tum, "g2o": write_g2o}


def export(
    source: Path,
    target: Target,
    file: Path,
    color: ColorBy = "id",
    anchor: GeoAnchor | None = None,
    overwrite: bool = False,
    read: Callable[[Path], ExportContent] = read_recording,
) -> ExportContent:
    """Write segments as a file of another program.

    The file appears under its name only when it is complete.

    Args:
        source: file with the segments.
        target: format to write.
        file: file to write.
        color: number of a segment that decides its color.
        anchor: place of the map's origin; GeoJSON needs it.
        overwrite: replace the file if it exists.
        read: function that reads the source.

    Raises:
        ValueError: the source cannot be read, or GeoJSON lacks an anchor.
        FileExistsError: the file exists, and `overwrite` is not set.
    """
    if target == "geojson" and anchor is None:
        raise ValueError(
            "GeoJSON needs the place of the map's origin on the Earth. Give it with --anchor "
            "LAT,LON or --anchor LAT,LON,YAW_DEG, where YAW_DEG is the angle from east to the "
            "map's x axis, counter-clockwise."
        )
    if file.exists() and not overwrite:
        raise FileExistsError(f"{file} exists already. Give another file, or --overwrite")
    if file.exists() and file.samefile(source):
        raise ValueError(f"{file} is the source itself. Give another file with --output.")
    content = read(source)
    with written_whole(file) as unfinished:
        write_content(content, target, unfinished, color, anchor)
    return content


def shades_of(content: ExportContent, color: ColorBy) -> UInt8:
    """Return the color of each segment, uint8 (segments, 3)."""
    if color == "class":
        known = content.classes
        return class_colors(np.zeros(len(content.ids), np.uint8) if known is None else known)
    numbers = {"id": content.ids, "robot": content.robot, "group": content.groups}[color]
    return colors(np.asarray(numbers))


def write_content(
    content: ExportContent, target: Target, file: Path, color: ColorBy, anchor: GeoAnchor | None
) -> None:
    """Write segments to a file of another program.

    Args:
        content: the segments.
        target: format to write.
        file: file to write; an existing one is replaced.
        color: number of a segment that decides its color.
        anchor: place of the map's origin; GeoJSON needs it.

    Raises:
        ValueError: a segment is too far from the anchor.
    """
    shades = shades_of(content, color)
    if target == "geojson":
        assert anchor is not None
        write_geojson(content, shades, file, anchor)
    elif target in POSES:
        POSES[target](content, file)
    else:
        CLOUDS[target](content, shades, file)
