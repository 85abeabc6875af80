"""Export of stored maps to files of other programs."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from placecell_client import CompactMap
from scipy.spatial.transform import Rotation

from placecell.core.cancellation import current
from placecell.core.geodesy import GeoAnchor
from placecell.export.content import ExportContent
from placecell.export.export import write_content
from placecell.export.targets import ColorBy, Target
from service.core.problems import Problem, invalid_value

MEDIA_TYPES: dict[Target, str] = {
    "ply": "application/octet-stream",
    "las": "application/vnd.las",
    "pcd": "application/octet-stream",
    "mcap": "application/octet-stream",
    "geojson": "application/geo+json",
    "tum": "text/plain",
    "g2o": "text/plain",
}

MOST_SEGMENTS: dict[Target, int] = {
    "ply": 4_000_000,
    "las": 4_000_000,
    "pcd": 4_000_000,
    "mcap": 4_000_000,
    "geojson": 250_000,
    "tum": 4_000_000,
    "g2o": 4_000_000,
}
"""Largest number of segments of a map: GeoJSON takes a kilobyte of memory for each."""

MOST_CAPTURES = 250_000
"""Largest number of captures of a map in the formats of poses and messages."""


def content_of_map(found: CompactMap) -> ExportContent:
    """Return the content of a map for an export: one point a segment."""
    count = len(found)
    poses = np.tile(np.eye(4), (len(found.frame_times), 1, 1))
    if len(poses):
        poses[:, :3, :3] = Rotation.from_quat(found.frame_orientations).as_matrix()
    poses[:, :3, 3] = found.frame_positions
    order = np.argsort(found.frame_times, kind="stable")
    extents = np.zeros((count, 3)) if found.extents is None else found.extents / 10.0
    return ExportContent(
        frame=found.frame,
        points=found.centroids,
        owners=np.arange(count),
        ids=found.ids.astype(np.int64),
        robots=found.robots,
        robot=found.robot.astype(np.int64),
        groups=(found.ids if found.views is None else found.views).astype(np.int64),
        centroids=found.centroids,
        extents=extents,
        poses=poses[order],
        stamps=found.frame_times[order],
        remarks=("a map file has no points of segments: each segment is one point, its centroid",),
        classes=found.classes,
    )


def check_exportable(segments: int, target: Target, anchor: GeoAnchor | None) -> None:
    """Check that a map can be exported, before it is read.

    Raises:
        Problem: 413 if it is too large, 422 if GeoJSON lacks an anchor.
    """
    if segments > MOST_SEGMENTS[target]:
        raise Problem(
            413,
            "too-many-segments",
            f"The map has {segments:,} segments; the limit of {target} is "
            f"{MOST_SEGMENTS[target]:,}. Export it as las or ply.",
        )
    if target == "geojson" and anchor is None:
        raise invalid_value(
            "/query/anchor",
            "GeoJSON needs the place of the map's origin on the Earth. Set the map's anchor with "
            "PUT /maps/MAP/anchor, or give anchor=LAT,LON or anchor=LAT,LON,YAW_DEG.",
        )


def exported(
    load: Callable[[], CompactMap],
    target: Target,
    color: ColorBy,
    anchor: GeoAnchor | None,
    folder: Path,
) -> bytes:
    """Return a map as a file of another program.

    Args:
        load: function that returns the map.
        target: format to write.
        color: number of a segment that decides its color.
        anchor: place of the map; GeoJSON needs it.
        folder: folder in which the file is made, in a private folder of its own.

    Raises:
        Problem: 413 if the map has too many captures, 422 if it lies too far from the anchor.
    """
    loaded = load()
    check_exportable(len(loaded), target, anchor)
    content = content_of_map(loaded)
    current().check()
    if target in {"mcap", "tum", "g2o", "geojson"} and len(content.poses) > MOST_CAPTURES:
        raise Problem(
            413,
            "too-many-segments",
            f"The map has {len(content.poses):,} captures; the limit of {target} is "
            f"{MOST_CAPTURES:,}. Export it as las or ply.",
        )
    with TemporaryDirectory(prefix="export-", dir=folder) as made:
        file = Path(made) / "map"
        try:
            write_content(content, target, file, color, anchor)
        except ValueError as error:
            raise invalid_value("/query/anchor", f"{error}.") from error
        return file.read_bytes()
