"""A compact map: what a robot keeps of the segments that it has seen."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

COORDINATE_LIMIT = 1e8
"""Metres; no frame on Earth needs more, and a frame's origin may be anywhere."""
TIME_LIMIT = 9e9
"""Seconds, the year 2255; more is a time in another unit."""

CODE_LIMIT = 65_535
"""Bytes of codes that a segment may have."""

SOURCE_LIMIT = 65_535
"""Names of other maps that a `source` tells apart; 0 is the map itself."""

SEGMENT_COLUMNS = ("codes", "centroids", "ids", "robot", "frame_index")
"""Columns of one row a segment that every map has."""
FRAME_COLUMNS = ("frame_times", "frame_positions", "frame_orientations")
"""Columns of the frame table."""
OPTIONAL: dict[str, tuple[type[np.unsignedinteger[Any]], tuple[int, ...]]] = {
    "extents": (np.uint8, (3,)),
    "points": (np.uint16, ()),
    "views": (np.uint32, ()),
    "seen": (np.uint32, ()),
    "source": (np.uint16, ()),
    "source_ids": (np.uint32, ()),
}
"""Columns that a map may have or lack: type, and shape of one segment's value.

`source` and `source_ids`, a segment's provenance, come together.
"""


class MapFileError(ValueError):
    """A map, or a map file, that is not valid; the message says what is wrong."""


@dataclass(frozen=True, slots=True, eq=False)
class CompactMap:
    """Segments of one coordinate frame, in columns: row i of each column is segment i.

    A *frame* in the names `frame_*` is a moment at which a robot took segments: a sensor pose and
    a time. `frame` alone is the coordinate frame's name.

    Attributes:
        model_id: of the model that made the descriptors; those of different ids never compare.
        preprocessing: version of the steps from points to the model's input.
        frame: name of the coordinate frame, z up.
        codes: int8 (n, code bytes), stored descriptors.
        centroids: float64 (n, 3), metres in the coordinate frame; a file keeps whole centimetres,
            at most 327.67 m along each axis from the sensor's position.
        ids: uint32 (n,), each once.
        robots: names of the robots.
        robot: uint16 (n,), indices into `robots`.
        frame_index: uint32 (n,), indices into the three columns of the frame table.
        frame_times: float64 (f,), seconds.
        frame_positions: float64 (f, 3), the sensor's position, metres in the coordinate frame.
        frame_orientations: float32 (f, 4), unit quaternions x, y, z, w from sensor to frame.
        extents: uint8 (n, 3), decimetres of the axis-aligned box, rounded up, at most 255; three
            zeros: unknown.
        points: uint16 (n,), points of the segment, at most 65,535; 0: unknown.
        views: uint32 (n,), the id of the first view of the same thing, which need not be in the map
            any more; its own id where there is but one. Views of one thing share it.
        seen: uint32 (n,), whole seconds of the clock of `frame_times`, when it was last seen.
        source: uint16 (n,), the map that it was merged from, `sources[source - 1]`; 0: written to
            this very map.
        source_ids: uint32 (n,), its id in that map; its own id where `source` is 0.
        sources: names of the maps that segments were merged from, each once.
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

    def __len__(self) -> int:
        return len(self.ids)

    @property
    def code_bytes(self) -> int:
        """Bytes of a segment's codes."""
        return int(self.codes.shape[1])

    @property
    def optional(self) -> tuple[str, ...]:
        """Names of the optional columns that the map has."""
        return tuple(name for name in OPTIONAL if getattr(self, name) is not None)

    @property
    def time_span(self) -> tuple[float, float] | None:
        """Earliest and latest time of the frames, seconds; None without frames."""
        if not len(self.frame_times):
            return None
        return float(self.frame_times.min()), float(self.frame_times.max())

    def check(self) -> None:
        """See that the columns fit each other.

        Raises:
            MapFileError: they do not; the message names the column.
        """
        _check_texts(self)
        _check_columns(self)
        _check_values(self)
        _check_provenance(self)


def is_ascending(ids: NDArray[np.uint32]) -> bool:
    """Whether each is greater than the one before."""
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
            raise MapFileError(f"{name}: must be 1 to 200 printable characters")
    for table, names in tables.items():
        if len(set(names)) != len(names):
            raise MapFileError(f"{table}: a name stands twice")


def _check_columns(compact_map: CompactMap) -> None:
    for name in ("ids", "frame_times"):
        if getattr(compact_map, name).ndim != 1:
            raise MapFileError(f"{name}: shape {getattr(compact_map, name).shape}, not (n,)")
    n, f = len(compact_map.ids), len(compact_map.frame_times)
    codes = compact_map.codes
    if codes.ndim != 2 or not 1 <= codes.shape[1] <= CODE_LIMIT:
        raise MapFileError(f"codes: shape {codes.shape}, not (n, 1 to {CODE_LIMIT})")
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
                f"{name}: {column.dtype} {column.shape}, not {np.dtype(dtype)} {shape}"
            )


def _check_values(compact_map: CompactMap) -> None:
    for name, limit in {
        "frame_positions": COORDINATE_LIMIT,  # before what a file states relative to them
        "centroids": COORDINATE_LIMIT,
        "frame_times": TIME_LIMIT,
        "frame_orientations": 2.0,
    }.items():
        column = getattr(compact_map, name)
        # Written so that NaN fails too.
        if column.size and not (-limit <= column.min() and column.max() <= limit):
            raise MapFileError(f"{name}: a value is not finite or beyond {limit:g}")
    norms = np.linalg.norm(compact_map.frame_orientations.astype(np.float64), axis=1)
    if not (np.abs(norms - 1) <= 1e-3).all():
        raise MapFileError("frame_orientations: not unit quaternions")
    ids = compact_map.ids
    if not is_ascending(ids) and len(np.unique(ids)) != len(ids):
        raise MapFileError("ids: an id stands twice")
    for name, size in {
        "robot": len(compact_map.robots),
        "frame_index": len(compact_map.frame_times),
    }.items():
        column = getattr(compact_map, name)
        if len(column) and int(column.max()) >= size:
            raise MapFileError(f"{name}: index {int(column.max())} in a table of {size}")


def _check_provenance(compact_map: CompactMap) -> None:
    source, ids, names = compact_map.source, compact_map.source_ids, compact_map.sources
    if source is None or ids is None:
        if source is not None or ids is not None:
            raise MapFileError("source, source_ids: one of them without the other")
        if names:
            raise MapFileError("sources: names, but no columns source and source_ids")
        return
    if len(source) and int(source.max()) > len(names):
        raise MapFileError(f"source: {int(source.max())} in a table of {len(names)} names")
    if ((ids != compact_map.ids) & (source == 0)).any():
        raise MapFileError("source_ids: not its own id where the source is 0, the map itself")
