"""Maps and deltas, taken apart and put together; every result is in canonical form."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import canonical, distinct_rows, frame_rows, take
from placecell_client.maps.compact_map import OPTIONAL, CompactMap, MapFileError
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.union import (
    check_same_kind,
    is_same_kind,
    places_of,
    union,
    with_optional,
)

__all__ = [
    "apply",
    "compose",
    "delta_between",
    "difference",
    "empty",
    "is_same_kind",
    "join",
    "take",
    "with_optional",
]


def apply(compact_map: CompactMap, delta: Delta) -> CompactMap:
    """The map after a delta: removed segments are gone, changed ones added or replaced by id.

    Optional columns are those of either. What lacks one gets: 0 for `extents`, `points` and
    `source`, its own id for `views` and `source_ids`, its frame's time for `seen`.

    Args:
        compact_map: a valid map.
        delta: any; one from nothing (`Delta.is_whole`) is the result, whatever the map was.

    Raises:
        MapFileError: the delta is not valid, or of another model, preprocessing or frame.
    """
    delta.check()
    if delta.is_whole:
        return canonical(delta.changed)
    gone = _rows_of(compact_map, np.concatenate([delta.removed, delta.changed.ids]))
    return union([compact_map, delta.changed], gone)


def difference(old: CompactMap, new: CompactMap) -> tuple[CompactMap, NDArray[np.uint32]]:
    """What turns one map into another, where no optional column is lost.

    Segments are compared by value in canonical form, frames, robots and sources too, whatever their
    index.

    Returns:
        The segments of `new` that are new or differ, and the ids that are gone, ascending.

    Raises:
        MapFileError: they are of different models, preprocessing or frames, or `new` lacks an
            optional column of `old`; `delta_between` has an answer for these.
    """
    lost = set(old.optional) - set(new.optional)
    if lost:
        raise MapFileError(f"{min(lost)}: a difference cannot take a column away")
    check_same_kind([old, new])
    before, after = canonical(with_optional(old, new.optional)), canonical(new)
    places = np.searchsorted(before.ids, after.ids)
    is_known = _at(before.ids, places, after.ids)
    rows, places = np.flatnonzero(is_known), places[is_known]
    differs = ~is_known
    differs[rows] = _differs(before, places, after, rows)
    is_gone = np.ones(len(before), dtype=bool)
    is_gone[places] = False
    return canonical(take(after, differs)), before.ids[is_gone]


def delta_between(old: CompactMap, new: CompactMap, since: int, until: int) -> Delta:
    """The delta from one version of a map to another: `apply(old, delta)` is `new`.

    Where a difference cannot say it (another model, an optional column lost), it is from nothing.

    Args:
        old: a valid map.
        new: a valid map.
        since: the sequence of `old`; 0: the delta is from nothing.
        until: the sequence of `new`; 0 with `since` 0: the delta applies to whatever is there.

    Raises:
        MapFileError: a difference cannot say it, and `until` is 0.
    """
    is_told = is_same_kind(old, new) and set(old.optional) <= set(new.optional)
    if until and not (since and is_told):
        return Delta(canonical(new), np.zeros(0, np.uint32), 0, until)
    return Delta(*difference(old, new), since, until)


def compose(first: Delta, second: Delta) -> Delta:
    """One delta that does what two do, one after the other.

    Raises:
        MapFileError: the second does not begin where the first ends, or is of another model.
    """
    first.check()
    second.check()
    if second.is_whole:
        return replace(second, changed=canonical(second.changed))
    if first.until != second.since:
        raise MapFileError(f"a delta since {second.since} does not follow one until {first.until}")
    gone = _rows_of(first.changed, np.concatenate([second.removed, second.changed.ids]))
    changed = union([first.changed, second.changed], gone)
    removed = np.zeros(0, np.uint32)
    if not first.is_whole:
        both = np.union1d(first.removed, second.removed)
        removed = np.setdiff1d(both, changed.ids, assume_unique=True)
    return Delta(changed, removed, first.since, second.until)


def join(parts: Sequence[Delta]) -> Delta:
    """A delta that came in parts.

    Args:
        parts: one or more, in any order, each of other segments.

    Raises:
        MapFileError: they are not parts of one delta.
    """
    for part in parts:
        part.check()
    if len({(part.since, part.until) for part in parts}) != 1:
        raise MapFileError("since, until: not parts of one delta")
    changed = union([part.changed for part in parts])
    removed = np.sort(np.concatenate([part.removed for part in parts]))
    joined = Delta(changed, removed, parts[0].since, parts[0].until)
    joined.check()
    return joined


def empty(
    model_id: str, preprocessing: str, frame: str, code_bytes: int, optional: Iterable[str] = ()
) -> CompactMap:
    """A map without segments, with these optional columns."""
    columns: dict[str, Any] = {
        name: np.zeros((0, *OPTIONAL[name][1]), OPTIONAL[name][0]) for name in optional
    }
    return CompactMap(
        model_id=model_id,
        preprocessing=preprocessing,
        frame=frame,
        codes=np.zeros((0, code_bytes), np.int8),
        centroids=np.zeros((0, 3)),
        ids=np.zeros(0, np.uint32),
        robots=(),
        robot=np.zeros(0, np.uint16),
        frame_index=np.zeros(0, np.uint32),
        frame_times=np.zeros(0),
        frame_positions=np.zeros((0, 3)),
        frame_orientations=np.zeros((0, 4), np.float32),
        **columns,
    )


def _rows_of(compact_map: CompactMap, ids: NDArray[np.uint32]) -> NDArray[np.intp]:
    """The rows of those ids that the map has."""
    order = np.argsort(compact_map.ids, kind="stable")  # as good as free where they are sorted
    places = np.searchsorted(compact_map.ids, ids, sorter=order)
    found = _at(compact_map.ids[order], places, ids)
    return order[places[found]]


def _at(
    ids: NDArray[np.uint32], places: NDArray[np.intp], wanted: NDArray[np.uint32]
) -> NDArray[np.bool_]:
    """Whether the id at each place is the one that is wanted."""
    inside = places < len(ids)
    inside[inside] = ids[places[inside]] == wanted[inside]
    return inside


def _differs(
    before: CompactMap, places: NDArray[np.intp], after: CompactMap, rows: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """For each pair of segments of one id, whether a value differs."""
    differs = np.zeros(len(rows), dtype=bool)
    for name in ("codes", "centroids", *(name for name in after.optional if name != "source")):
        one, other = getattr(before, name)[places], getattr(after, name)[rows]
        unequal = one != other
        differs |= unequal.any(axis=1) if unequal.ndim > 1 else unequal
    robots = places_of(before.robots, after.robots)
    differs |= robots[before.robot[places]] != after.robot[rows]
    if before.source is not None and after.source is not None:
        sources = places_of(("", *before.sources), ("", *after.sources))  # 0: the map itself
        differs |= sources[before.source[places]] != after.source[rows]
    _, ranks = distinct_rows(np.concatenate([frame_rows(before), frame_rows(after)]))
    old_ranks, new_ranks = np.split(ranks, [len(before.frame_times)])
    differs |= old_ranks[before.frame_index[places]] != new_ranks[after.frame_index[rows]]
    return differs
