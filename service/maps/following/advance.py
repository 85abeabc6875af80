"""Newest version of a map from the store, built on the version in memory if that is possible."""

from placecell_client import decode_delta

from placecell.core.cancellation import current
from service.maps.history import compose_all, replay
from service.maps.repository import MapRepository
from service.maps.snapshot import KEEPS_FRAME, MapSnapshot
from service.maps.store import Commit, MapHead, MapHistory, SharedStore


def newest(
    maps: MapRepository, store: SharedStore, head: MapHead, before: MapSnapshot | None
) -> MapSnapshot:
    """Build the newest version of a map.

    Only the commits since the version in memory are read, unless its history has another version
    in its place (a fork), or was compacted beyond it. Then the whole map is read.

    Args:
        maps: maps in memory.
        store: store of the maps.
        head: head of the map in the store; one that was read before the version in memory was
            written is read anew.
        before: version in memory; None if there is none.

    Raises:
        KeyError: the map was deleted.
        StoreError: the stored data is damaged, or the store fails.
        MapFileError: the data was written by an incompatible version of Placecell.
    """
    if before is not None:
        try:
            commits = store.commits_since(before.head, head)
        except KeyError:
            pass  # this service wrote after the look at the head; or a fork, compacted, or damaged
        else:
            return _advanced(maps, before, head, commits)
    with store.read(head.uid) as history:
        head = history.head
        if before is not None and _is_of(history, before):
            commits = list(history.blobs(before.head.sequence, head.sequence))
            return _advanced(maps, before, head, commits)
        layers = replay(history, head.sequence)
    return MapSnapshot(head, layers, head.oldest, head.sequence, maps.indexed(layers, None))


def _is_of(history: MapHistory, before: MapSnapshot) -> bool:
    """Return whether the history has this version, so that later commits lead on from it."""
    head = history.head
    if head.uid != before.head.uid or head.sequence < before.head.sequence:
        return False
    try:
        return history.mark(before.head.sequence) == before.head.mark
    except KeyError:
        return False


def _advanced(
    maps: MapRepository, before: MapSnapshot, head: MapHead, found: list[tuple[Commit, bytes]]
) -> MapSnapshot:
    """Return the version that these commits lead to from one in memory."""
    commits, deltas = [], []
    for commit, blob in found:
        current().check()
        commits.append(commit)
        deltas.append(decode_delta(blob))
    delta = compose_all(deltas)
    layers = before.layers if delta is None else before.layers.after(delta)
    return MapSnapshot(
        head=head,
        layers=layers,
        base_sequence=before.base_sequence if layers.base is before.layers.base else head.sequence,
        frame_since=_frame_since(before, commits),
        index=maps.indexed(layers, before),
    )


def _frame_since(before: MapSnapshot, commits: list[Commit]) -> int:
    """Return the version since which no segment was moved in the map's frame."""
    since, left = before.frame_since, len(before)
    for commit in commits:
        # An empty map takes the frame of what is written next. It is not known how many segments a
        # commit added, so the map counts as empty as soon as it may be.
        if commit.note.operation not in KEEPS_FRAME or left <= 0:
            since, left = commit.sequence, commit.note.changed
        left -= commit.note.removed
    return since
