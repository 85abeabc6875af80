"""The delta file, version 1: what turns one version of a map into another.

`docs/reference/delta-file.md` describes it. It is as strict as the map file: equal deltas are equal
files.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps import container
from placecell_client.maps.canonical import canonical
from placecell_client.maps.columns import REQUIRED, columns_of, header_of, map_of
from placecell_client.maps.compact_map import OPTIONAL, CompactMap, MapFileError, is_ascending
from placecell_client.maps.container import Content, FileFormat

FORMAT = "placecell-delta"
VERSION = 1
MEDIA_TYPE = "application/vnd.placecell.delta"
SEQUENCE_LIMIT = 1 << 53
"""Beyond which JSON readers in other languages round."""

_DELTA_FILE = FileFormat(FORMAT, "delta file", VERSION, REQUIRED | {"removed"}, frozenset(OPTIONAL))


@dataclass(frozen=True, slots=True, eq=False)
class Delta:
    """Segments that a version of a map has gained, and those that it has lost.

    Attributes:
        changed: segments that are new or have other values; may have no rows. Its optional columns
            are columns of the result, even then.
        removed: uint32 (m,), ids ascending; none of `changed`. Those of no segment do no harm.
        since: the map's sequence before; 0 with an `until` above it: from nothing, `changed` is the
            whole map.
        until: the map's sequence after; 0 with `since` 0: applies to whatever is there.
    """

    changed: CompactMap
    removed: NDArray[np.uint32]
    since: int = 0
    until: int = 0

    @property
    def is_whole(self) -> bool:
        """Whether it is from nothing: `changed` is the map."""
        return self.since == 0 < self.until

    def __len__(self) -> int:
        """Segments that it changes or removes."""
        return len(self.changed) + len(self.removed)

    def check(self) -> None:
        """See that the parts are valid and fit each other.

        Raises:
            MapFileError: they are not, or do not; the message says which.
        """
        self.changed.check()
        removed = self.removed
        if removed.dtype != np.uint32 or removed.ndim != 1:
            raise MapFileError(f"removed: {removed.dtype} {removed.shape}, not uint32 (m,)")
        if not is_ascending(removed):
            raise MapFileError("removed: ids do not ascend")
        if len(np.intersect1d(removed, self.changed.ids, assume_unique=True)):
            raise MapFileError("removed: an id is changed as well")
        if type(self.since) is not int or type(self.until) is not int:  # a bool is none either
            raise MapFileError("since, until: not integers")
        if not 0 <= self.since <= self.until < SEQUENCE_LIMIT:
            raise MapFileError("since, until: not 0 <= since <= until < 2^53")
        if self.is_whole and len(removed):
            raise MapFileError("removed: nothing can be removed from nothing (since 0)")


def encode_delta(delta: Delta) -> bytes:
    """The delta as a file; rows, tables and centroids as `map_file.encode`.

    Raises:
        MapFileError: the delta is not valid, or a segment too far from its sensor.
    """
    return container.write(_content(delta))


def decode_delta(data: bytes) -> Delta:
    """The delta of a file.

    Raises:
        MapFileError: the bytes are not exactly what `encode_delta` makes of a delta.
    """
    content, checksum = container.read(data, _DELTA_FILE)
    header, columns = content.header, content.columns
    delta = Delta(
        changed=map_of(header, columns),
        removed=columns["removed"].astype(np.uint32, copy=False),
        since=header.get("since", -1),
        until=header.get("until", -1),
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
    return Content(header | header_of(ordered), columns)
