"""Provenance: finds segments that two maps share, by source map and id in it."""

import numpy as np
from placecell_client import CompactMap

from placecell.core.types import Bool, Float64, Int64, UInt32
from service.maps.writes.deduplication import NONE


def moments_of(content: CompactMap, rows: Int64) -> Float64:
    """Return the times when these segments were seen, seconds, float64 (m,)."""
    return content.frame_times[content.frame_index[rows]]


def keys_in(content: CompactMap, other: CompactMap) -> Bool:
    """Return which segments the other map has too, by source and id there, bool (n,)."""
    found = np.zeros(len(content), dtype=bool)
    (rows, keys), (_, there) = _keys(content, other)
    found[rows] = np.isin(keys, there)
    return found


def shared(one: CompactMap, other: CompactMap) -> tuple[Int64, Int64]:
    """Return the rows of shared segments in both maps, int64 (m,) each."""
    (rows, keys), (places, there) = _keys(one, other)
    _, here, away = np.intersect1d(keys, there, return_indices=True)
    return rows[here], places[away]


def _keys(one: CompactMap, other: CompactMap) -> list[tuple[Int64, Int64]]:
    """Return each map's rows with a source, and a number for their (source, id).

    Equal pairs have equal numbers in both maps. Time is linear in segments and in sources, of which
    a map may name 65,535.
    """
    numbers: dict[str, int] = {}
    found = []
    for content in (one, other):
        if content.source is None:
            found.append((np.zeros(0, np.int64), np.zeros(0, np.int64)))
            continue
        of_names = np.array(
            [numbers.setdefault(name, len(numbers)) for name in content.sources], dtype=np.int64
        )
        rows = np.flatnonzero(content.source)
        ids = _source_ids(content)[rows].astype(np.int64)
        found.append((rows, (of_names[content.source[rows].astype(np.int64) - 1] << 32) + ids))
    return found


def of_source(content: CompactMap, name: str) -> Bool:
    """Return which segments were first written to the map of this name, bool (n,)."""
    if content.source is None or name not in content.sources:
        return np.zeros(len(content), dtype=bool)
    return np.asarray(content.source == content.sources.index(name) + 1)


def _source_ids(content: CompactMap) -> UInt32:
    return NONE if content.source_ids is None else content.source_ids
