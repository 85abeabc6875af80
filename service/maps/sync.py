"""What changed in a map since a version that a client has, in pages."""

import re
import time
from collections import OrderedDict
from dataclasses import dataclass
from threading import Lock

import numpy as np
from placecell_client import Delta, decode_delta

from placecell.core.types import UInt32
from service.core.problems import Problem
from service.maps.history import history_of, replay
from service.maps.layers import MapLayers
from service.maps.snapshot import MapSnapshot, tag_of
from service.maps.store import IDS, MapHistory, MapStore

PINNED = 8
"""Syncs at work whose version is kept in memory; of others it is made anew for each page."""

PIN_SECONDS = 60.0
"""After its last page that a sync is kept so."""

_SINCE = re.compile(r"(?:([0-9a-f]{16})-)?([0-9]{1,16})")
_CURSOR = re.compile(r"([0-9]{1,16})\.([0-9a-f]{16}-([0-9]{1,16}))\.([0-9]{1,10})")


@dataclass(frozen=True, slots=True)
class SyncPage:
    """A part of what changed.

    Attributes:
        delta: of the segments of this part; `since` and `until` are those of the whole.
        tag: of the version that all parts lead to.
        next: for the part after this one; None: it is the last.
    """

    delta: Delta
    tag: str
    next: str | None


@dataclass(frozen=True, slots=True, eq=False)
class _Sync:
    """From one version to another.

    Attributes:
        since: sequence of the one; 0: from nothing.
        until: sequence of the other.
        tag: of the other.
        layers: the other.
        ids: of all segments that may differ, ascending.
    """

    since: int
    until: int
    tag: str
    layers: MapLayers
    ids: UInt32


class MapSync:
    """Answers the syncs of all maps. For use from many threads."""

    def __init__(self, store: MapStore) -> None:
        self._store = store
        self._guard = Lock()
        self._pinned: OrderedDict[tuple[str, int, str], tuple[_Sync, float]] = OrderedDict()

    def first_page(self, stored: MapSnapshot, since: str, limit: int) -> SyncPage:
        """The first page from a version to the newest.

        Args:
            stored: the map.
            since: the version's sequence or, safer, its tag; 0: from nothing.
            limit: segments in it, at most.

        Raises:
            Problem: 422 if `since` is neither, 410 if the way from there is not known.
        """
        match = _SINCE.fullmatch(since)
        if match is None:
            raise Problem(
                422, "invalid-request", f"since is {since!r:.80}; a sequence or an ETag is due."
            )
        mark, sequence = match[1], int(match[2])
        if mark and since != stored.tag:
            with history_of(self._store, stored) as history:
                _check_known(history, sequence, since)
        return self._page(stored, sequence, stored.tag, stored.head.sequence, 0, limit)

    def next_page(self, stored: MapSnapshot, cursor: str, limit: int) -> SyncPage:
        """A further page; 422 if the cursor is none, 410 if its version is no longer known."""
        match = _CURSOR.fullmatch(cursor)
        if match is None:
            raise Problem(422, "invalid-request", f"cursor: {cursor!r:.80} is none.")
        return self._page(stored, int(match[1]), match[2], int(match[3]), int(match[4]), limit)

    def expire(self) -> None:
        """Let go of versions that nobody has asked for in a while."""
        with self._guard:
            for key, (_, asked) in list(self._pinned.items()):
                if time.monotonic() - asked > PIN_SECONDS:
                    del self._pinned[key]

    def _page(
        self, stored: MapSnapshot, since: int, tag: str, until: int, first: int, limit: int
    ) -> SyncPage:
        sync = self._sync(stored, since, until, tag)
        place = int(np.searchsorted(sync.ids, np.uint32(min(first, IDS - 1))))
        ids = sync.ids[place : place + limit]
        changed = sync.layers.take(ids)
        removed = np.setdiff1d(ids, changed.ids) if since else ids[:0]
        rest = sync.ids[place + limit :]
        following = f"{since}.{tag}.{rest[0]}" if len(rest) else None
        self._pin(stored, sync, wanted=following is not None)
        return SyncPage(Delta(changed, removed, since, until), tag, following)

    def _sync(self, stored: MapSnapshot, since: int, until: int, tag: str) -> _Sync:
        with self._guard:
            pinned = self._pinned.get((stored.head.uid, since, tag))
        if pinned is not None:
            return pinned[0]
        if tag == stored.tag and since in {0, until}:
            ids = stored.layers.ids if since == 0 else stored.layers.ids[:0]
            return _Sync(since, until, tag, stored.layers, ids)
        with history_of(self._store, stored) as history:
            _check_known(history, until, tag)
            layers = stored.layers if tag == stored.tag else replay(history, until)
            ids = _touched(history, since, until) if since else layers.ids
        return _Sync(since, until, tag, layers, ids)

    def _pin(self, stored: MapSnapshot, sync: _Sync, wanted: bool) -> None:
        key = stored.head.uid, sync.since, sync.tag
        with self._guard:
            self._pinned.pop(key, None)
            if wanted:
                self._pinned[key] = sync, time.monotonic()
            while len(self._pinned) > PINNED:
                self._pinned.popitem(last=False)


def _check_known(history: MapHistory, sequence: int, tag: str) -> None:
    try:
        known = tag_of(sequence, history.mark(sequence)) == tag
    except KeyError:
        known = False
    if not known:
        raise _gone(history, tag)


def _touched(history: MapHistory, since: int, until: int) -> UInt32:
    """Ids of the segments that the commits between two versions changed or removed, ascending."""
    touched = [np.zeros(0, np.uint32)]
    if not history.head.oldest <= since <= until:
        raise _gone(history, str(since))
    for _, blob in history.blobs(since, until):
        delta = decode_delta(blob)
        if delta.is_whole:
            raise _gone(history, str(since))
        touched += [delta.changed.ids, delta.removed]
    return np.unique(np.concatenate(touched))


def _gone(history: MapHistory, version: str) -> Problem:
    return Problem(
        410,
        "version-gone",
        f"Map {history.head.name!r:.80} no longer knows, or never knew, how it was at {version}; "
        "get it whole (since=0).",
    )
