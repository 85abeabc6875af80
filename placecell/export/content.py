"""Content of a recording, or of another set of segments, as other programs take it."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from placecell.core.segment_classes import class_indices
from placecell.core.types import Float64, Int64, UInt8
from placecell.segmentation.recording import Recording

GOLDEN = 0.618033988749895
"""Step of the hues of colors: the golden ratio keeps those of neighboring numbers apart."""


CLASS_COLORS = np.array(
    [
        (70, 110, 200),  # building
        (60, 160, 70),  # vegetation
        (150, 95, 50),  # pole
        (225, 60, 55),  # vehicle
        (240, 130, 200),  # person
        (200, 180, 90),  # fence
        (245, 215, 40),  # sign
        (120, 200, 210),  # other
        (140, 140, 140),  # unknown, the last one: index -1
    ],
    np.uint8,
)
"""Colors of the classes, in their order."""


@dataclass(frozen=True, slots=True, eq=False)
class ExportContent:
    """Segments and poses in one coordinate frame.

    Attributes:
        frame: name of the coordinate frame, z up.
        points: float64 (points, 3), meters; a map has one point a segment, its centroid.
        owners: segment of each point, int64 (points,).
        ids: id of each segment, int64 (segments,).
        robots: names of the robots.
        robot: robot of each segment, int64 (segments,).
        groups: object that each segment is a view of, int64 (segments,).
        centroids: centroid of each segment, float64 (segments, 3), meters.
        extents: sides of each segment's box, float64 (segments, 3), meters; 0 if unknown.
        poses: pose of the sensor at each capture, float64 (captures, 4, 4).
        stamps: time of each capture, float64 (captures,), seconds.
        remarks: what the file does not tell, for the user.
        classes: class of each segment, uint8 (segments,); None if it is not known.
    """

    frame: str
    points: Float64
    owners: Int64
    ids: Int64
    robots: tuple[str, ...]
    robot: Int64
    groups: Int64
    centroids: Float64
    extents: Float64
    poses: Float64
    stamps: Float64
    remarks: tuple[str, ...] = ()
    classes: UInt8 | None = None


def read_recording(file: Path) -> ExportContent:
    """Read a recording.

    Raises:
        RecordingError: the file is none.
    """
    return of_recording(Recording.load(file))


def of_recording(recording: Recording) -> ExportContent:
    """Return the content of a recording: all points of all segments."""
    segments = recording.segments
    low, high = segments.bounds()
    captures, first = np.unique(recording.captures, return_index=True)
    poses = np.tile(np.eye(4), (len(captures), 1, 1))
    poses[:, :3, 3] = segments.sensors[first]
    return ExportContent(
        frame=recording.name,
        points=segments.points.astype(np.float64),
        owners=segments.owners,
        ids=np.arange(len(segments)),
        robots=(recording.name,),
        robot=np.zeros(len(segments), np.int64),
        groups=recording.groups,
        centroids=segments.centroids(),
        extents=(high - low).astype(np.float64),
        poses=poses,
        stamps=captures.astype(np.float64),
        remarks=(
            "a recording has sensor positions without orientations or times: orientations are the "
            "identity, and times are the numbers of the scans",
        ),
    )


def class_colors(classes: UInt8) -> UInt8:
    """Return the color of each class, uint8 (n, 3); gray for unknown."""
    return CLASS_COLORS[class_indices(classes)]


def colors(numbers: Int64) -> UInt8:
    """Return a color of each number, uint8 (n, 3): equal numbers have equal colors."""
    hue = (numbers * GOLDEN) % 1.0
    shifted = (hue[:, None] * 6.0 + np.array([5.0, 3.0, 1.0])) % 6.0
    light = 1.0 - 0.75 * np.clip(np.minimum(shifted, 4.0 - shifted), 0.0, 1.0)
    return np.asarray(np.round(255 * light), np.uint8)
