"""History of a map: its log of commits, and every version that the store still keeps."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import numpy as np
from placecell_client import Delta, decode, decode_delta, encode, encode_delta
from placecell_client.maps.edit import compose

from placecell.core.cancellation import current
from placecell.core.types import UInt32
from service.core.problems import Problem
from service.maps.cache import MapCache
from service.maps.layers import MapLayers, robots_of
from service.maps.snapshot import MapEntry, MapSnapshot, tag_of
from service.maps.store import Commit, MapHead, MapHistory, MapStore

NO_IDS: UInt32 = np.zeros(0, np.uint32)


@contextmanager
def history_of(store: MapStore, snapshot: MapEntry) -> Iterator[MapHistory]:
    """Read a map's log; 404 if the map was removed in the meantime."""
    try:
        with store.read(snapshot.head.uid) as history:
            yield history
    except KeyError as error:
        raise Problem(
            404,
            "unknown-map",
            f"Map {snapshot.name!r:.80} was removed during the request. "
            "GET /maps (placecell maps list) lists the maps.",
        ) from error


def commits_of(store: MapStore, snapshot: MapSnapshot) -> list[Commit]:
    """Return the commits of a map, oldest first."""
    with history_of(store, snapshot) as history:
        return history.commits()


def robots_ever(store: MapStore, snapshot: MapSnapshot) -> set[str]:
    """Return the robots that have segments in any kept version."""
    with history_of(store, snapshot) as history:
        robots = {*robots_of(decode(history.base()))}
        for _, blob in history.blobs(history.head.oldest, history.head.sequence):
            robots |= {*robots_of(decode_delta(blob).changed)}
        return robots


def ids_ever(store: MapStore, snapshot: MapSnapshot) -> UInt32:
    """Return the ids of all segments in any kept version, ascending."""
    with history_of(store, snapshot) as history:
        ids = [decode(history.base()).ids]
        for _, blob in history.blobs(history.head.oldest, history.head.sequence):
            ids.append(decode_delta(blob).changed.ids)
        return np.unique(np.concatenate(ids))


def load_newest(store: MapStore, uid: str, cache: MapCache) -> tuple[MapHead, MapLayers, int]:
    """Load a map's newest version, starting from the cached version if the cache has a valid one.

    Returns:
        The head, the layers, and the sequence of the version that their base is.

    Raises:
        KeyError: there is no such map.
        StoreError: the stored data is damaged.
        MapFileError: the data was written by an incompatible version of Placecell.
    """
    with store.read(uid) as history:
        head, cached = history.head, cache.load(history)
        if cached is None:
            return head, replay(history, head.sequence), head.oldest
        content, sequence = cached
        layers = _advanced(MapLayers.of(content), history, sequence, head.sequence)
        return head, layers, sequence


def load_version(store: MapStore, snapshot: MapSnapshot, sequence: int) -> tuple[MapLayers, str]:
    """Load one version of a map; return its layers and its tag.

    Raises:
        Problem: 404 if the map never had this version, 410 if the version was compacted.
        StoreError: the stored data is damaged.
    """
    if sequence == snapshot.head.sequence:
        return snapshot.layers, snapshot.tag
    with history_of(store, snapshot) as history:
        _check_kept(history, sequence)
        return replay(history, sequence), tag_of(sequence, history.mark(sequence))


def version_file(store: MapStore, snapshot: MapSnapshot, sequence: int) -> tuple[bytes, str]:
    """Return the file of one version and its tag; raises as `load_version` does."""
    if sequence == snapshot.head.sequence != snapshot.head.oldest:
        return encode(snapshot.layers.content()), snapshot.tag
    with history_of(store, snapshot) as history:
        _check_kept(history, sequence)
        oldest = sequence == history.head.oldest
        file = history.base() if oldest else encode(replay(history, sequence).content())
        return file, tag_of(sequence, history.mark(sequence))


def version_changes(store: MapStore, snapshot: MapSnapshot, sequence: int) -> bytes:
    """Return the delta file of one version: its changes against the version before it.

    The first version of a map has all its segments in the delta.

    Raises:
        Problem: 404 if the map never had this version; 410 if the version was compacted, or if it
            is the oldest that is left, so that the version before it is not known.
        StoreError: the stored data is damaged.
    """
    with history_of(store, snapshot) as history:
        _check_kept(history, sequence)
        if sequence > history.head.oldest:
            ((_, blob),) = history.blobs(sequence - 1, sequence)
            return blob
        if sequence > 1:
            raise Problem(
                410,
                "version-gone",
                f"Version {sequence} of map {snapshot.name!r:.80} is the oldest that is left, and "
                "the version before it was compacted. Its changes are not known.",
            )
        return encode_delta(Delta(decode(history.base()), NO_IDS, 0, 1))


def version_tag(store: MapStore, snapshot: MapSnapshot, sequence: int) -> str:
    """Return the tag of one version; raises as `load_version` does."""
    if sequence == snapshot.head.sequence:
        return snapshot.tag
    with history_of(store, snapshot) as history:
        _check_kept(history, sequence)
        return tag_of(sequence, history.mark(sequence))


def replay(history: MapHistory, sequence: int) -> MapLayers:
    """Build one version of a map from its oldest version and the commits after it.

    Raises:
        StoreError: the stored data is damaged.
        MapFileError: the data was written by an incompatible version of Placecell.
    """
    base = MapLayers.of(decode(history.base()))
    return _advanced(base, history, history.head.oldest, sequence)


def compose_all(deltas: Iterable[Delta]) -> Delta | None:
    """Compose consecutive deltas into one; return None if there are none."""
    row = list(deltas)
    # Compose pairs, then pairs of pairs: each segment is handled log n times, not n times.
    while len(row) > 1:
        current().check()
        pairs = [compose(*row[at : at + 2]) for at in range(0, len(row) - 1, 2)]
        row = pairs + row[2 * len(pairs) :]
    return row[0] if row else None


def _advanced(layers: MapLayers, history: MapHistory, since: int, until: int) -> MapLayers:
    """Apply the commits from `since`, exclusive, to `until` to the layers."""
    delta = compose_all(_decoded(blob) for _, blob in history.blobs(since, until))
    return layers if delta is None else layers.after(delta)


def _decoded(blob: bytes) -> Delta:
    current().check()
    return decode_delta(blob)


def _check_kept(history: MapHistory, sequence: int) -> None:
    head = history.head
    if not 1 <= sequence <= head.sequence:
        raise Problem(
            404,
            "unknown-version",
            f"Map {head.name!r:.80} has no version {sequence}. "
            f"Available versions: {head.oldest} to {head.sequence}.",
        )
    if sequence < head.oldest:
        raise Problem(
            410,
            "version-gone",
            f"Version {sequence} of map {head.name!r:.80} was compacted. "
            f"The oldest available version is {head.oldest}.",
        )
