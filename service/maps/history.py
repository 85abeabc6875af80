"""What a map was: its commits, and each version that is still kept."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from placecell_client import decode, decode_delta, encode

from placecell.core.types import UInt32
from service.core.problems import Problem
from service.maps.layers import Layers, robots_of
from service.maps.replay import version_of
from service.maps.snapshot import StoredMap, tag_of
from service.maps.store import Commit, History, MapStore


@contextmanager
def history_of(store: MapStore, stored: StoredMap) -> Iterator[History]:
    """A map's log; 404 if the map was removed by now."""
    try:
        with store.read(stored.head.uid) as history:
            yield history
    except KeyError as error:
        raise Problem(404, "unknown-map", f"Map {stored.name!r:.80} was removed.") from error


def commits_of(store: MapStore, stored: StoredMap) -> list[Commit]:
    """The commits of a map, oldest first."""
    with history_of(store, stored) as history:
        return history.commits()


def robots_ever(store: MapStore, stored: StoredMap) -> set[str]:
    """Return the robots with segments in any kept version."""
    with history_of(store, stored) as history:
        robots = {*robots_of(decode(history.base()))}
        for _, blob in history.blobs(history.head.oldest, history.head.sequence):
            robots |= {*robots_of(decode_delta(blob).changed)}
        return robots


def ids_ever(store: MapStore, stored: StoredMap) -> UInt32:
    """Return the ids of all segments in any kept version, ascending."""
    with history_of(store, stored) as history:
        ids = [decode(history.base()).ids]
        for _, blob in history.blobs(history.head.oldest, history.head.sequence):
            ids.append(decode_delta(blob).changed.ids)
        return np.unique(np.concatenate(ids))


def version(store: MapStore, stored: StoredMap, sequence: int) -> tuple[Layers, str]:
    """One version of a map, and its tag.

    Raises:
        Problem: 404 if there is none of this sequence, 410 if it is no longer kept.
        StoreError: it is damaged.
    """
    if sequence == stored.head.sequence:
        return stored.layers, stored.tag
    with history_of(store, stored) as history:
        _check_kept(history, sequence)
        return version_of(history, sequence), tag_of(sequence, history.mark(sequence))


def version_file(store: MapStore, stored: StoredMap, sequence: int) -> tuple[bytes, str]:
    """The file of one version, and its tag; errors as of `version`."""
    if sequence == stored.head.sequence != stored.head.oldest:
        return encode(stored.layers.content()), stored.tag
    with history_of(store, stored) as history:
        _check_kept(history, sequence)
        oldest = sequence == history.head.oldest
        file = history.base() if oldest else encode(version_of(history, sequence).content())
        return file, tag_of(sequence, history.mark(sequence))


def version_tag(store: MapStore, stored: StoredMap, sequence: int) -> str:
    """Return the tag of one version; raises as `version` does."""
    if sequence == stored.head.sequence:
        return stored.tag
    with history_of(store, stored) as history:
        _check_kept(history, sequence)
        return tag_of(sequence, history.mark(sequence))


def _check_kept(history: History, sequence: int) -> None:
    head = history.head
    if not 1 <= sequence <= head.sequence:
        raise Problem(
            404,
            "unknown-version",
            f"Map {head.name!r:.80} has versions {head.oldest} to {head.sequence}, not {sequence}.",
        )
    if sequence < head.oldest:
        raise Problem(
            410,
            "version-gone",
            f"Map {head.name!r:.80} kept version {sequence}, but its first is now {head.oldest}.",
        )
