"""Which segments of two maps are the same, told by where they come from."""

import numpy as np
from placecell_client import CompactMap

from segments.types import Bool, Float64, Int64, UInt32
from service.living import NONE


def moments_of(content: CompactMap, rows: Int64) -> Float64:
    """When these segments were seen, seconds, float64 (m,)."""
    return content.frame_times[content.frame_index[rows]]


def keys_in(content: CompactMap, other: CompactMap) -> Bool:
    """Which segments of one map the other has too, by source and id there, bool (n,)."""
    found = np.zeros(len(content), dtype=bool)
    for name in content.sources:
        here, there = of_source(content, name), of_source(other, name)
        found[here] = np.isin(_source_ids(content)[here], _source_ids(other)[there])
    return found


def shared(one: CompactMap, other: CompactMap) -> tuple[Int64, Int64]:
    """Rows of what both have, by source and id there, int64 (m,) each."""
    pairs = [(np.zeros(0, np.int64), np.zeros(0, np.int64))]
    for name in set(one.sources) & set(other.sources):
        here, there = (np.flatnonzero(of_source(each, name)) for each in (one, other))
        _, rows, places = np.intersect1d(
            _source_ids(one)[here], _source_ids(other)[there], return_indices=True
        )
        pairs.append((here[rows], there[places]))
    rows, places = (np.concatenate(each) for each in zip(*pairs, strict=True))
    return rows, places


def of_source(content: CompactMap, name: str) -> Bool:
    """Which segments were written to the map of this name first, bool (n,)."""
    if content.source is None or name not in content.sources:
        return np.zeros(len(content), dtype=bool)
    return np.asarray(content.source == content.sources.index(name) + 1)


def _source_ids(content: CompactMap) -> UInt32:
    return NONE if content.source_ids is None else content.source_ids
