"""Operations on maps and deltas: apply, compare, compose, join; results are canonical."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import canonical, distinct_rows, frame_rows, take
from placecell_client.maps.compact_map import OPTIONAL, CompactMap, MapFileError
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.moved_captures import MovedCaptures, moved_centroids
from placecell_client.maps.union import (
    check_same_kind,
    is_same_kind,
    places_of,
    union,
    with_odometry,
    with_optional,
)

__all__ = [
    "apply",
    "canonical_difference",
    "compose",
    "delta_between",
    "difference",
    "empty",
    "expanded",
    "is_same_kind",
    "join",
    "moving_difference",
    "take",
    "with_optional",
]


def apply(compact_map: CompactMap, delta: Delta) -> CompactMap:
    """Apply a delta to a map: remove segments, and add or replace segments by id.

    The result has the optional columns of both. Missing values become 0 for `extents`, `points`,
    `classes` and `source`, the segment's own id for `views` and `source_ids`, and the capture time
    for `seen`.

    Args:
        compact_map: A valid map.
        delta: The changes. If it holds the whole map (`Delta.is_whole`), it replaces the map.

    Raises:
        MapFileError: The delta is invalid, has another model, preprocessing or frame, or moves a
            capture that the map does not have.
    """
    delta.check()
    if delta.is_whole:
        return canonical(delta.changed)
    delta = expanded(compact_map, delta)
    gone = _rows_of(compact_map, np.concatenate([delta.removed, delta.changed.ids]))
    return union([compact_map, delta.changed], gone)


def difference(old: CompactMap, new: CompactMap) -> tuple[CompactMap, NDArray[np.uint32]]:
    """Compare two maps.

    Segments are compared by value in canonical form, with their captures, robots and sources.
    Indices into tables do not matter.

    Returns:
        The added and changed segments of `new`, and the ids of removed segments, ascending.

    Raises:
        MapFileError: The maps differ in model, preprocessing or frame, or `new` lacks an optional
            column of `old`. `delta_between` handles these cases.
    """
    lost = set(old.optional) - set(new.optional)
    if old.has_odometry and not new.has_odometry:
        lost.add("frame_odometry")
    if lost:
        raise MapFileError(f"{min(lost)}: a difference cannot remove a column")
    return canonical_difference(canonical(with_optional(old, new.optional)), canonical(new))


def canonical_difference(
    before: CompactMap, after: CompactMap
) -> tuple[CompactMap, NDArray[np.uint32]]:
    """Return `difference` of two maps in canonical form, with the same optional columns."""
    check_same_kind([before, after])
    places = np.searchsorted(before.ids, after.ids)
    is_known = _at(before.ids, places, after.ids)
    rows, places = np.flatnonzero(is_known), places[is_known]
    differs = ~is_known
    differs[rows] = _differs(before, places, after, rows)
    is_gone = np.ones(len(before), dtype=bool)
    is_gone[places] = False
    return canonical(take(after, differs)), before.ids[is_gone]


def moving_difference(
    before: CompactMap, after: CompactMap
) -> tuple[CompactMap, NDArray[np.uint32], MovedCaptures | None]:
    """Compare two maps as `canonical_difference` does, and tell apart captures that moved.

    A capture moved if most of its segments have another capture of the same time. Segments that
    follow it exactly (`moved_centroids`) are not among the changed ones.

    Args:
        before: A map in canonical form.
        after: A map in canonical form, with the optional columns of `before` or more.

    Returns:
        Changed segments, ids of removed segments, and moved captures; None if there are none.
    """
    before = with_optional(before, after.optional)
    if before.has_odometry or after.has_odometry:
        before, after = with_odometry(before), with_odometry(after)
    changed, removed = canonical_difference(before, after)
    places = np.searchsorted(before.ids, after.ids)
    rows = np.flatnonzero(_at(before.ids, places, after.ids))
    places = places[rows]
    target = _target_of(before, before.frame_index[places], after, after.frame_index[rows])
    there = target[before.frame_index[places]]
    moves = there >= 0
    rows, places, there = rows[moves], places[moves], there[moves]
    here = before.frame_index[places]
    follows = (after.frame_index[rows] == there) & ~_values_differ(before, places, after, rows)
    places_after = moved_centroids(
        before.centroids[places],
        before.frame_positions[here],
        before.frame_orientations[here],
        after.frame_positions[there],
        after.frame_orientations[there],
    )
    follows &= (places_after == after.centroids[rows]).all(axis=1)
    frames, first = np.unique(here[follows], return_index=True)
    if not len(frames):
        return changed, removed, None
    # All other segments of a moved capture are sent, also those that stay where they are.
    stays = ~follows & np.isin(here, frames)
    sent = np.isin(after.ids, changed.ids)
    sent[rows[stays]] = True
    sent[rows[follows]] = False
    ids, to = after.ids[rows[follows]][first], there[follows][first]
    order = np.argsort(ids)
    frames, to = frames[order], to[order]
    moved = MovedCaptures(ids[order], after.frame_positions[to], after.frame_orientations[to])
    if after.frame_tracks is not None and after.frame_odometry is not None:
        assert before.frame_tracks is not None
        assert before.frame_odometry is not None
        same = (before.frame_tracks[frames] == after.frame_tracks[to]).all()
        if not same or (before.frame_odometry[frames] != after.frame_odometry[to]).any():
            moved = replace(moved, tracks=after.frame_tracks[to], odometry=after.frame_odometry[to])
    return canonical(take(after, sent)), removed, moved


def expanded(compact_map: CompactMap, delta: Delta) -> Delta:
    """Return a delta whose moved captures are replaced by their segments, as changed segments.

    Args:
        compact_map: The map that the delta starts from.
        delta: A valid delta.

    Raises:
        MapFileError: The map does not have a moved capture, so the delta starts from another one.
    """
    moved = delta.moved
    if moved is None:
        return delta
    before = canonical(compact_map)
    places = np.searchsorted(before.ids, moved.ids)
    found = _at(before.ids, places, moved.ids)
    if not found.all():
        raise MapFileError(
            f"moved_ids: the map has no segment {int(moved.ids[~found][0])}; apply the delta to "
            f"version {delta.since}"
        )
    frames = before.frame_index[places]
    number = np.full(len(before.frame_times), -1)
    number[frames] = np.arange(len(frames))
    if len(np.unique(frames)) != len(frames):
        raise MapFileError("moved_ids: two segments have the same capture")
    which = number[before.frame_index]
    listed = np.concatenate([delta.removed, delta.changed.ids])
    rows = np.flatnonzero((which >= 0) & ~np.isin(before.ids, listed))
    which, here = which[rows], before.frame_index[rows]
    part = replace(
        take(before, rows),
        centroids=moved_centroids(
            before.centroids[rows],
            before.frame_positions[here],
            before.frame_orientations[here],
            moved.positions[which],
            moved.orientations[which],
        ),
        frame_index=which.astype(np.uint32),
        frame_times=before.frame_times[frames],
        frame_positions=moved.positions,
        frame_orientations=moved.orientations,
        frame_tracks=before.frame_tracks,
        frame_odometry=before.frame_odometry,
    )
    if moved.tracks is not None:
        part = replace(part, frame_tracks=moved.tracks, frame_odometry=moved.odometry)
    elif before.frame_tracks is not None and before.frame_odometry is not None:
        part = replace(
            part,
            frame_tracks=before.frame_tracks[frames],
            frame_odometry=before.frame_odometry[frames],
        )
    return replace(delta, changed=union([delta.changed, part]), moved=None)


def delta_between(old: CompactMap, new: CompactMap, since: int, until: int) -> Delta:
    """Return the delta from one version of a map to another: `apply(old, delta)` equals `new`.

    If a difference is impossible (another model, a removed column), the delta holds the whole map.

    Args:
        old: A valid map.
        new: A valid map.
        since: Sequence number of `old`; 0: the delta holds the whole map.
        until: Sequence number of `new`; 0 with `since` 0: the delta applies to any version.

    Raises:
        MapFileError: A difference is impossible, and `until` is 0.
    """
    is_told = is_same_kind(old, new) and set(old.optional) <= set(new.optional)
    is_told = is_told and not (old.has_odometry and not new.has_odometry)
    if until and not (since and is_told):
        return Delta(canonical(new), np.zeros(0, np.uint32), 0, until)
    return Delta(*difference(old, new), since, until)


def compose(first: Delta, second: Delta) -> Delta:
    """Combine two consecutive deltas into one.

    Raises:
        MapFileError: The second delta does not follow the first, has another model, or moves
            captures, which only the map itself has.
    """
    first.check()
    second.check()
    if second.moved is not None and not second.is_whole:
        raise MapFileError("moved_ids: apply a delta that moves captures to the map itself")
    if second.is_whole:
        return replace(second, changed=canonical(second.changed))
    if first.until != second.since:
        raise MapFileError(
            f"a delta since version {second.since} does not follow one until version {first.until}"
        )
    gone = _rows_of(first.changed, np.concatenate([second.removed, second.changed.ids]))
    changed = union([first.changed, second.changed], gone)
    removed = np.zeros(0, np.uint32)
    if not first.is_whole:
        both = np.union1d(first.removed, second.removed)
        removed = np.setdiff1d(both, changed.ids, assume_unique=True)
    return Delta(changed, removed, first.since, second.until, first.moved)


def join(parts: Sequence[Delta]) -> Delta:
    """Join the parts of a delta.

    Args:
        parts: One or more parts in any order, without common segments.

    Raises:
        MapFileError: The parts do not belong to one delta.
    """
    for part in parts:
        part.check()
    if len({(part.since, part.until) for part in parts}) != 1:
        raise MapFileError("since, until: the parts belong to different deltas")
    changed = union([part.changed for part in parts])
    removed = np.sort(np.concatenate([part.removed for part in parts]))
    moved = _joined_moves([part.moved for part in parts if part.moved is not None])
    joined = Delta(changed, removed, parts[0].since, parts[0].until, moved)
    joined.check()
    return joined


def empty(
    model_id: str, preprocessing: str, frame: str, code_bytes: int, optional: Iterable[str] = ()
) -> CompactMap:
    """Return a map without segments, with the given optional columns."""
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
    """Return the rows of the ids that the map has."""
    order = np.argsort(compact_map.ids, kind="stable")  # almost free if the ids are sorted
    places = np.searchsorted(compact_map.ids, ids, sorter=order)
    found = _at(compact_map.ids[order], places, ids)
    return order[places[found]]


def _at(
    ids: NDArray[np.uint32], places: NDArray[np.intp], wanted: NDArray[np.uint32]
) -> NDArray[np.bool_]:
    """Return whether the id at each place is the wanted one."""
    inside = places < len(ids)
    inside[inside] = ids[places[inside]] == wanted[inside]
    return inside


def _differs(
    before: CompactMap, places: NDArray[np.intp], after: CompactMap, rows: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """Return for each pair of segments with the same id whether a value differs."""
    differs = _values_differ(before, places, after, rows)
    differs |= (before.centroids[places] != after.centroids[rows]).any(axis=1)
    if before.has_odometry or after.has_odometry:
        before, after = with_odometry(before), with_odometry(after)
    _, ranks = distinct_rows(np.concatenate([frame_rows(before), frame_rows(after)]))
    old_ranks, new_ranks = np.split(ranks, [len(before.frame_times)])
    differs |= old_ranks[before.frame_index[places]] != new_ranks[after.frame_index[rows]]
    return differs


def _values_differ(
    before: CompactMap, places: NDArray[np.intp], after: CompactMap, rows: NDArray[np.intp]
) -> NDArray[np.bool_]:
    """Return for each pair of segments whether a value apart from place and capture differs."""
    differs = np.zeros(len(rows), dtype=bool)
    for name in ("codes", *(name for name in after.optional if name != "source")):
        one, other = getattr(before, name)[places], getattr(after, name)[rows]
        unequal = one != other
        differs |= unequal.any(axis=1) if unequal.ndim > 1 else unequal
    robots = places_of(before.robots, after.robots)
    differs |= robots[before.robot[places]] != after.robot[rows]
    if before.source is not None and after.source is not None:
        sources = places_of(("", *before.sources), ("", *after.sources))  # 0: the map itself
        differs |= sources[before.source[places]] != after.source[rows]
    return differs


def _target_of(
    before: CompactMap,
    here: NDArray[np.uint32],
    after: CompactMap,
    there: NDArray[np.uint32],
) -> NDArray[np.intp]:
    """Return the capture that each capture of a map became; -1 if it did not move.

    Args:
        before: The earlier map.
        here: Captures of the common segments in it.
        after: The later map.
        there: Captures of the same segments in it.
    """
    target = np.full(len(before.frame_times), -1)
    if not len(here):
        return target
    both = np.column_stack([here, there]).astype(np.int64)
    pairs, counts = np.unique(both, axis=0, return_counts=True)
    order = np.lexsort((counts, pairs[:, 0]))
    last = np.flatnonzero(np.diff(pairs[order, 0], append=-1))
    one, other = pairs[order[last]].T
    _, ranks = distinct_rows(np.concatenate([frame_rows(before), frame_rows(after)]))
    old_ranks, new_ranks = np.split(ranks, [len(before.frame_times)])
    moves = old_ranks[one] != new_ranks[other]
    moves &= before.frame_times[one] == after.frame_times[other]
    target[one[moves]] = other[moves]
    return target


def _joined_moves(parts: Sequence[MovedCaptures]) -> MovedCaptures | None:
    """Join the moved captures of several parts of a delta."""
    if not parts:
        return None
    told = [part for part in parts if part.tracks is not None]
    if told and len(told) < len(parts):
        raise MapFileError("moved_odometry: expected in all parts or in none")
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("ids", "positions", "orientations", *(["tracks", "odometry"] if told else []))
    }
    joined = MovedCaptures(**columns)
    return joined.take(np.argsort(joined.ids, kind="stable"))
