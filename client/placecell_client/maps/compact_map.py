"""Compact map: the segments of a map in columns, with checks."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

COORDINATE_LIMIT = 1e8
"""Largest coordinate, meters; a frame may have its origin anywhere on Earth."""
TIME_LIMIT = 9e9
"""Largest time, seconds (year 2255); larger values have another unit."""

CODE_LIMIT = 65_535
"""Largest number of code bytes per segment."""

SOURCE_LIMIT = 65_535
"""Largest number of source maps; source 0 is the map itself."""

CLASS_LIMIT = 248
"""Largest byte of `classes`: the last class with the probability 1."""

SEGMENT_COLUMNS = ("codes", "centroids", "ids", "robot", "frame_index")
"""Columns of every map with one row per segment."""
FRAME_COLUMNS = ("frame_times", "frame_positions", "frame_orientations")
"""Columns of the frame table."""
ODOMETRY_COLUMNS = ("frame_tracks", "frame_odometry")
"""Optional columns of the frame table; they come together."""
ODOMETRY_WIDTH = 7
"""Numbers of a capture in `frame_odometry`: x, y, z, yaw, and three variances."""
OPTIONAL: dict[str, tuple[type[np.unsignedinteger[Any]], tuple[int, ...]]] = {
    "extents": (np.uint8, (3,)),
    "points": (np.uint16, ()),
    "views": (np.uint32, ()),
    "seen": (np.uint32, ()),
    "missed": (np.uint32, ()),
    "source": (np.uint16, ()),
    "source_ids": (np.uint32, ()),
    "classes": (np.uint8, ()),
    "confirmed": (np.uint8, ()),
    "absent": (np.uint8, ()),
}
"""Optional columns: type, and shape of one segment's value.

`source` and `source_ids`, the provenance of a segment, come together, and so do `missed`,
`confirmed` and `absent`.
"""


class MapFileError(ValueError):
    """Error: a map, map file or delta file is invalid; the message names the fault."""


@dataclass(frozen=True, slots=True, eq=False)
class CompactMap:
    """Segments of a map in one coordinate frame, in columns: row i of each column is segment i.

    The columns `frame_*` are the capture table: each row is a moment at which a robot saw segments,
    with time and sensor pose. `frame` alone is the name of the coordinate frame.

    Attributes:
        model_id: Id of the model that computed the descriptors; descriptors of different models are
            not comparable.
        preprocessing: Version of the steps from points to the model's input.
        frame: Name of the coordinate frame, z up.
        codes: Stored descriptors, int8 (n, code bytes).
        centroids: Centroids in the coordinate frame, meters, float64 (n, 3). A file stores whole
            centimeters, at most 327.67 m along each axis from the sensor position.
        ids: Unique segment ids, uint32 (n,).
        robots: Names of the robots.
        robot: Robot of each segment as an index into `robots`, uint16 (n,).
        frame_index: Capture of each segment as an index into the capture table, uint32 (n,).
        frame_times: Times of the captures, seconds, float64 (f,).
        frame_positions: Sensor positions in the coordinate frame, meters, float64 (f, 3).
        frame_orientations: Unit quaternions x, y, z, w from the sensor frame to the coordinate
            frame, float32 (f, 4).
        extents: Size of the axis-aligned bounding box, decimeters, rounded up, at most 255; uint8
            (n, 3). Three zeros: unknown.
        points: Number of points of the segment, at most 65,535; 0: unknown. uint16 (n,).
        views: Id of the first view of the same object, uint32 (n,). All views of one object share
            it; a single view has its own id. The first view may have been removed.
        seen: Time when the segment was last seen, whole seconds on the clock of `frame_times`,
            uint32 (n,).
        missed: Time of the last pass that should have seen the segment and did not, whole seconds
            as in `seen`; 0: there was none. uint32 (n,).
        source: Map that the segment was merged from, `sources[source - 1]`; 0: written to this map.
            uint16 (n,).
        source_ids: Id of the segment in its source map, uint32 (n,); its own id if `source` is 0.
        sources: Names of the maps that segments were merged from, without duplicates.
        frame_tracks: Odometry track of each capture, uint32 (f,). Captures of one track are
            connected by odometry; 0: no odometry. The number is unique among all robots.
        frame_odometry: Pose of the sensor by the odometry of its track, and the variances since
            the track began, float64 (f, 7): x, y, z, meters; yaw of the sensor's x axis, radians;
            variance of the horizontal position along each axis, m^2, of the height, m^2, and of
            the yaw, rad^2. Three zeros: unknown variances. The pose stays as the odometry gave it
            when the captures are moved.
        classes: Class of the segment and its probability, as `placecell_client.classes` reads them,
            uint8 (n,); 0: unknown.
        confirmed: Number of later passes that saw the object again, at most 255, uint8 (n,).
        absent: Number of passes since then that should have seen it and did not, at most 255,
            uint8 (n,).
    """

    model_id: str
    preprocessing: str
    frame: str
    codes: NDArray[np.int8]
    centroids: NDArray[np.float64]
    ids: NDArray[np.uint32]
    robots: tuple[str, ...]
    robot: NDArray[np.uint16]
    frame_index: NDArray[np.uint32]
    frame_times: NDArray[np.float64]
    frame_positions: NDArray[np.float64]
    frame_orientations: NDArray[np.float32]
    extents: NDArray[np.uint8] | None = None
    points: NDArray[np.uint16] | None = None
    views: NDArray[np.uint32] | None = None
    seen: NDArray[np.uint32] | None = None
    source: NDArray[np.uint16] | None = None
    source_ids: NDArray[np.uint32] | None = None
    sources: tuple[str, ...] = ()
    frame_tracks: NDArray[np.uint32] | None = None
    frame_odometry: NDArray[np.float64] | None = None
    classes: NDArray[np.uint8] | None = None
    missed: NDArray[np.uint32] | None = None
    confirmed: NDArray[np.uint8] | None = None
    absent: NDArray[np.uint8] | None = None

    def __len__(self) -> int:
        return len(self.ids)

    def __repr__(self) -> str:
        return (
            f"CompactMap({len(self):,} segments, frame={self.frame!r}, "
            f"model_id={self.model_id!r}, robots={self.robots!r})"
        )

    @property
    def code_bytes(self) -> int:
        """Number of code bytes per segment."""
        return int(self.codes.shape[1])

    @property
    def optional(self) -> tuple[str, ...]:
        """Names of the map's optional columns."""
        return tuple(name for name in OPTIONAL if getattr(self, name) is not None)

    @property
    def has_odometry(self) -> bool:
        """Whether the map has the columns of the odometry."""
        return self.frame_tracks is not None

    @property
    def time_span(self) -> tuple[float, float] | None:
        """Earliest and latest capture time, seconds; None without captures."""
        if not len(self.frame_times):
            return None
        return float(self.frame_times.min()), float(self.frame_times.max())

    def check(self) -> None:
        """Check types, shapes and values of all columns.

        Raises:
            MapFileError: A column is invalid; the message names it.
        """
        _check_texts(self)
        _check_columns(self)
        _check_values(self)
        _check_classes(self)
        _check_long_life(self)
        _check_provenance(self)
        _check_odometry(self)


def is_ascending(ids: NDArray[np.uint32]) -> bool:
    """Return whether each id is greater than the one before."""
    return bool((ids[1:] > ids[:-1]).all())


def _check_texts(compact_map: CompactMap) -> None:
    texts = {
        "model_id": compact_map.model_id,
        "preprocessing": compact_map.preprocessing,
        "frame": compact_map.frame,
    }
    tables = {"robots": compact_map.robots, "sources": compact_map.sources}
    for table, names in tables.items():
        texts |= {f"{table}[{index}]": name for index, name in enumerate(names)}
    for name, text in texts.items():
        if not 1 <= len(text) <= 200 or not text.isprintable():
            raise MapFileError(f"{name}: expected 1 to 200 printable characters")
    for table, names in tables.items():
        if len(set(names)) != len(names):
            raise MapFileError(f"{table}: a name occurs twice")


def _check_columns(compact_map: CompactMap) -> None:
    for name in ("ids", "frame_times"):
        if getattr(compact_map, name).ndim != 1:
            raise MapFileError(f"{name}: shape {getattr(compact_map, name).shape}, expected (n,)")
    n, f = len(compact_map.ids), len(compact_map.frame_times)
    codes = compact_map.codes
    if codes.ndim != 2 or not 1 <= codes.shape[1] <= CODE_LIMIT:
        raise MapFileError(f"codes: shape {codes.shape}, expected (n, 1 to {CODE_LIMIT})")
    expected = {
        "codes": (np.int8, (n, codes.shape[1])),
        "centroids": (np.float64, (n, 3)),
        "ids": (np.uint32, (n,)),
        "robot": (np.uint16, (n,)),
        "frame_index": (np.uint32, (n,)),
        "frame_times": (np.float64, (f,)),
        "frame_positions": (np.float64, (f, 3)),
        "frame_orientations": (np.float32, (f, 4)),
    } | {name: (OPTIONAL[name][0], (n, *OPTIONAL[name][1])) for name in compact_map.optional}
    for name, (dtype, shape) in expected.items():
        column: NDArray[np.generic] = getattr(compact_map, name)
        if column.dtype != dtype or column.shape != shape:
            raise MapFileError(
                f"{name}: {column.dtype} {column.shape}, expected {np.dtype(dtype)} {shape}"
            )


def _check_values(compact_map: CompactMap) -> None:
    for name, limit in {
        "frame_positions": COORDINATE_LIMIT,  # first: files store centroids relative to them
        "centroids": COORDINATE_LIMIT,
        "frame_times": TIME_LIMIT,
        "frame_orientations": 2.0,
    }.items():
        column = getattr(compact_map, name)
        # The comparison is written so that NaN fails too.
        if column.size and not (-limit <= column.min() and column.max() <= limit):
            raise MapFileError(f"{name}: a value is not finite or beyond {limit:g}")
    norms = np.linalg.norm(compact_map.frame_orientations.astype(np.float64), axis=1)
    if not (np.abs(norms - 1) <= 1e-3).all():
        raise MapFileError("frame_orientations: not unit quaternions")
    ids = compact_map.ids
    if not is_ascending(ids) and len(np.unique(ids)) != len(ids):
        raise MapFileError("ids: an id occurs twice")
    for name, size in {
        "robot": len(compact_map.robots),
        "frame_index": len(compact_map.frame_times),
    }.items():
        column = getattr(compact_map, name)
        if len(column) and int(column.max()) >= size:
            raise MapFileError(
                f"{name}: index {int(column.max())}, but the table has {size} entries"
            )


def _check_long_life(compact_map: CompactMap) -> None:
    names = ("missed", "confirmed", "absent")
    present = [name for name in names if getattr(compact_map, name) is not None]
    if present and len(present) < len(names):
        raise MapFileError(f"{', '.join(names)}: expected all columns or none, found {present}")


def _check_classes(compact_map: CompactMap) -> None:
    classes = compact_map.classes
    if classes is not None and len(classes) and int(classes.max()) > CLASS_LIMIT:
        raise MapFileError(f"classes: {int(classes.max())}, expected 0 to {CLASS_LIMIT}")


def _check_provenance(compact_map: CompactMap) -> None:
    source, ids, names = compact_map.source, compact_map.source_ids, compact_map.sources
    if source is None or ids is None:
        if source is not None or ids is not None:
            raise MapFileError("source, source_ids: expected both columns or neither")
        if names:
            raise MapFileError("sources: has names, but source and source_ids are missing")
        return
    if len(source) and int(source.max()) > len(names):
        raise MapFileError(f"source: {int(source.max())}, but there are {len(names)} names")
    if ((ids != compact_map.ids) & (source == 0)).any():
        raise MapFileError("source_ids: expected the segment's own id where the source is 0")


def _check_odometry(compact_map: CompactMap) -> None:
    tracks, odometry = compact_map.frame_tracks, compact_map.frame_odometry
    if tracks is None or odometry is None:
        if tracks is not None or odometry is not None:
            raise MapFileError("frame_tracks, frame_odometry: expected both columns or neither")
        return
    f = len(compact_map.frame_times)
    for name, column, dtype, shape in (
        ("frame_tracks", tracks, np.uint32, (f,)),
        ("frame_odometry", odometry, np.float64, (f, ODOMETRY_WIDTH)),
    ):
        if column.dtype != dtype or column.shape != shape:
            raise MapFileError(
                f"{name}: {column.dtype} {column.shape}, expected {np.dtype(dtype)} {shape}"
            )
    if odometry.size and not (np.abs(odometry) <= COORDINATE_LIMIT).all():
        raise MapFileError(f"frame_odometry: a value is not finite or beyond {COORDINATE_LIMIT:g}")
    if odometry.size and odometry[:, 4:].min() < 0:
        raise MapFileError("frame_odometry: a variance is negative")
