"""Delta file, version 1: the changes from one version of a map to another.

`docs/reference/delta-file.md` describes the format. Like map files, equal deltas are equal files.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps import container
from placecell_client.maps.canonical import canonical
from placecell_client.maps.columns import REQUIRED, columns_of, header_of, map_of
from placecell_client.maps.compact_map import (
    ODOMETRY_COLUMNS,
    OPTIONAL,
    CompactMap,
    MapFileError,
    is_ascending,
)
from placecell_client.maps.container import Columns, Content, FileFormat
from placecell_client.maps.moved_captures import MovedCaptures

FORMAT = "placecell-delta"
VERSION = 1
MEDIA_TYPE = "application/vnd.placecell.delta"
SEQUENCE_LIMIT = 1 << 53
"""Upper bound of sequence numbers: JSON readers in other languages round larger integers."""

MOVED = {
    "moved_ids": ("ids", np.uint32),
    "moved_positions": ("positions", np.float64),
    "moved_orientations": ("orientations", np.float32),
    "moved_tracks": ("tracks", np.uint32),
    "moved_odometry": ("odometry", np.float64),
}
"""Columns of moved captures: attribute of `MovedCaptures`, and type."""

_DELTA_FILE = FileFormat(
    FORMAT,
    "delta file",
    VERSION,
    REQUIRED | {"removed"},
    frozenset({*OPTIONAL, *ODOMETRY_COLUMNS, *MOVED}),
)


@dataclass(frozen=True, slots=True, eq=False)
class Delta:
    """Changes to a map: added, replaced and removed segments.

    Attributes:
        changed: Added and replaced segments, maybe none. The result has its optional columns, even
            if it has no rows.
        removed: Ids of removed segments, ascending, uint32 (m,); none of them in `changed`. Unknown
            ids are ignored.
        since: Sequence number before the changes. 0 with a positive `until`: `changed` is the whole
            map.
        until: Sequence number after the changes. 0 with `since` 0: the delta applies to any
            version.
        moved: Captures that moved with all segments that are neither changed nor removed; only
            between two versions. None: no capture moved.
    """

    changed: CompactMap
    removed: NDArray[np.uint32]
    since: int = 0
    until: int = 0
    moved: MovedCaptures | None = None

    @property
    def is_whole(self) -> bool:
        """Whether `changed` is the whole map."""
        return self.since == 0 < self.until

    def __len__(self) -> int:
        """Return the number of changed and removed segments, without those of moved captures."""
        return len(self.changed) + len(self.removed)

    def check(self) -> None:
        """Check that all parts are valid and fit together.

        Raises:
            MapFileError: A part is invalid; the message names it.
        """
        self.changed.check()
        removed = self.removed
        if removed.dtype != np.uint32 or removed.ndim != 1:
            raise MapFileError(f"removed: {removed.dtype} {removed.shape}, expected uint32 (m,)")
        if not is_ascending(removed):
            raise MapFileError("removed: the ids are not ascending")
        if len(np.intersect1d(removed, self.changed.ids, assume_unique=True)):
            raise MapFileError("removed: an id is also in changed")
        if type(self.since) is not int or type(self.until) is not int:  # this refuses bool, too
            raise MapFileError("since, until: expected integers")
        if not 0 <= self.since <= self.until < SEQUENCE_LIMIT:
            raise MapFileError("since, until: expected 0 <= since <= until < 2^53")
        if self.is_whole and len(removed):
            raise MapFileError(
                "removed: expected no ids in a delta that holds the whole map (since 0)"
            )
        if self.moved is not None:
            self.moved.check()
            if not self.since:
                raise MapFileError("moved_ids: captures move only between two versions of a map")


def encode_delta(delta: Delta) -> bytes:
    """Encode a delta as a file; rows, tables and centroids are stored as by `encode`.

    Raises:
        MapFileError: The delta is invalid, or a segment is too far from its sensor.
    """
    return container.write(_content(delta))


def decode_delta(data: bytes) -> Delta:
    """Decode a delta file.

    Raises:
        MapFileError: The bytes are not exactly those that `encode_delta` makes of a delta.
    """
    content, checksum = container.read(data, _DELTA_FILE)
    header, columns = content.header, content.columns
    delta = Delta(
        changed=map_of(header, columns),
        removed=columns["removed"].astype(np.uint32, copy=False),
        since=header.get("since", -1),
        until=header.get("until", -1),
        moved=_moved_of(columns),
    )
    if not container.is_file_of(data, _content(delta), checksum):
        raise MapFileError("the file is not in canonical form: encode the delta again")
    return delta


def _content(delta: Delta) -> Content:
    delta.check()
    ordered = canonical(delta.changed)
    header = {
        "format": FORMAT,
        "version": VERSION,
        "since": delta.since,
        "until": delta.until,
        "removed": len(delta.removed),
    }
    columns = columns_of(ordered) | {"removed": delta.removed.astype("<u4", copy=False)}
    if delta.moved is not None:
        header["moved"] = len(delta.moved)
        columns |= _moved_columns(delta.moved.canonical())
    return Content(header | header_of(ordered), columns)


def _moved_of(columns: Columns) -> MovedCaptures | None:
    """Return the moved captures of a file; None if it has none of their columns."""
    found = {
        attribute: columns[name].astype(dtype, copy=False)
        for name, (attribute, dtype) in MOVED.items()
        if name in columns
    }
    if not found:
        return None
    if not {"ids", "positions", "orientations"} <= found.keys():
        raise MapFileError("moved_ids, moved_positions, moved_orientations: expected all or none")
    return MovedCaptures(**found)


def _moved_columns(moved: MovedCaptures) -> Columns:
    columns: Columns = {}
    for name, (attribute, dtype) in MOVED.items():
        column = getattr(moved, attribute)
        if column is not None:
            columns[name] = column.astype(np.dtype(dtype).newbyteorder("<"), copy=False)
    return columns
