"""Content of a map file for `placecell export`."""

from pathlib import Path

import numpy as np
from placecell_client.maps.compact_map import MapFileError
from placecell_client.maps.map_file import decode
from scipy.spatial.transform import Rotation

from placecell.export.content import ExportContent, read_recording
from placecell.segmentation.recording import RecordingError


def read_content(file: Path) -> ExportContent:
    """Read a map file or a recording.

    Raises:
        ValueError: the file is neither.
    """
    if not file.is_file():
        raise ValueError(f"{file}: no such file. Give a map file or a recording (.safetensors)")
    try:
        return read_recording(file)
    except RecordingError as error:
        if file.suffix == ".safetensors":
            raise ValueError(f"{error}. Give a map file or a recording") from error
    try:
        return of_map(file)
    except MapFileError as error:
        raise ValueError(
            f"{file}: neither a recording of segments nor a map file ({error}). Write a recording "
            "with 'placecell prepare', or a map file with 'placecell maps pull'"
        ) from error


def of_map(file: Path) -> ExportContent:
    """Return the content of a map file: one point a segment.

    Raises:
        MapFileError: the file is no map file.
    """
    found = decode(file.read_bytes())
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
    )
