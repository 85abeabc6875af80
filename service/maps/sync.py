"""Sync: the changes of a map since a version that a client has, in pages."""

import re
import time
from collections import OrderedDict
from dataclasses import dataclass, replace
from threading import Lock

import numpy as np
from placecell_client import Delta, decode_delta
from placecell_client.maps.edit import moving_difference
from placecell_client.maps.moved_captures import MovedCaptures

from placecell.core.types import UInt32
from service.core.problems import Problem
from service.maps.history import history_of, replay
from service.maps.layers import MapLayers
from service.maps.snapshot import MOVES_CAPTURES, MapSnapshot, tag_of
from service.maps.store import IDS, MapHistory, MapStore

PINNED = 8
"""Number of running syncs whose version stays in memory; others rebuild it for each page."""

PIN_SECONDS = 60.0
"""Seconds after its last page for which a sync stays in memory."""

_SINCE = re.compile(r"(?:([0-9a-f]{16})-)?([0-9]{1,16})")
_CURSOR = re.compile(r"([0-9]{1,16})\.([0-9a-f]{16}-([0-9]{1,16}))\.([0-9]{1,10})(\.m)?")


@dataclass(frozen=True, slots=True)
class SyncPage:
    """One part of the changes.

    Attributes:
        delta: changes of the segments of this part; `since` and `until` are those of all parts.
        tag: tag of the version that all parts lead to.
        next: cursor of the part after this one; None: this is the last part.
    """

    delta: Delta
    tag: str
    next: str | None


@dataclass(frozen=True, slots=True, eq=False)
class _Sync:
    """The way from one version to another.

    Attributes:
        since: sequence of the earlier version; 0: a full sync.
        until: sequence of the later version.
        tag: tag of the later version.
        layers: segments of the later version.
        ids: ids of all segments that may differ, ascending; a moved capture is one of them.
        moved: captures that moved with their segments; None: there are none, or the client does not
            know them.
    """

    since: int
    until: int
    tag: str
    layers: MapLayers
    ids: UInt32
    moved: MovedCaptures | None = None


class MapSync:
    """Answers the syncs of all maps. Safe to use from many threads."""

    def __init__(self, store: MapStore) -> None:
        self._store = store
        self._guard = Lock()
        self._pinned: OrderedDict[tuple[str, int, str, bool], tuple[_Sync, float]] = OrderedDict()

    def first_page(
        self, snapshot: MapSnapshot, since: str, limit: int, moved: bool = False
    ) -> SyncPage:
        """Return the first page from a version to the newest one.

        Args:
            snapshot: the map.
            since: the version's tag or, less safe, its sequence; 0: a full sync.
            limit: largest number of segments in the page.
            moved: tell captures that moved instead of all their segments.

        Raises:
            Problem: 422 if `since` is invalid, 410 if the changes since then are not known.
        """
        match = _SINCE.fullmatch(since)
        if match is None:
            raise Problem(
                422,
                "invalid-request",
                f"Invalid since {since!r:.80}: expected an ETag without quotes, a sequence, or 0 "
                "for a full sync.",
            )
        mark, sequence = match[1], int(match[2])
        if mark and since != snapshot.tag:
            with history_of(self._store, snapshot) as history:
                _check_known(history, sequence, since)
        until = snapshot.head.sequence
        return self._page(snapshot, sequence, snapshot.tag, until, 0, limit, moved)

    def next_page(self, snapshot: MapSnapshot, cursor: str, limit: int) -> SyncPage:
        """Return the page of a cursor; 422 if it is invalid, 410 if its version is not known."""
        match = _CURSOR.fullmatch(cursor)
        if match is None:
            raise Problem(
                422,
                "invalid-request",
                f"Invalid cursor {cursor!r:.80}. Use the value of Placecell-Next, or request a "
                "full sync with since=0.",
            )
        since, tag, until, first, moved = match.groups()
        return self._page(
            snapshot, int(since), tag, int(until), int(first), limit, moved is not None
        )

    def expire(self) -> None:
        """Drop versions from memory whose sync has not asked for a page in a while."""
        with self._guard:
            for key, (_, asked) in list(self._pinned.items()):
                if time.monotonic() - asked > PIN_SECONDS:
                    del self._pinned[key]

    def _page(
        self,
        snapshot: MapSnapshot,
        since: int,
        tag: str,
        until: int,
        first: int,
        limit: int,
        moved: bool,
    ) -> SyncPage:
        sync = self._sync(snapshot, since, until, tag, moved)
        place = int(np.searchsorted(sync.ids, np.uint32(min(first, IDS - 1))))
        ids = sync.ids[place : place + limit]
        captures = None
        if sync.moved is not None:
            here = np.isin(sync.moved.ids, ids)
            captures = sync.moved.take(here) if here.any() else None
            ids = np.setdiff1d(ids, sync.moved.ids)
        changed = sync.layers.take(ids)
        removed = np.setdiff1d(ids, changed.ids) if since else ids[:0]
        rest = sync.ids[place + limit :]
        following = f"{since}.{tag}.{rest[0]}{'.m' if moved else ''}" if len(rest) else None
        self._pin(snapshot, sync, moved, wanted=following is not None)
        return SyncPage(Delta(changed, removed, since, until, captures), tag, following)

    def _sync(self, snapshot: MapSnapshot, since: int, until: int, tag: str, moved: bool) -> _Sync:
        with self._guard:
            pinned = self._pinned.get((snapshot.head.uid, since, tag, moved))
        if pinned is not None:
            return pinned[0]
        if tag == snapshot.tag and since in {0, until}:
            ids = snapshot.layers.ids if since == 0 else snapshot.layers.ids[:0]
            return _Sync(since, until, tag, snapshot.layers, ids)
        with history_of(self._store, snapshot) as history:
            _check_known(history, until, tag)
            layers = snapshot.layers if tag == snapshot.tag else replay(history, until)
            ids = _touched(history, since, until) if since else layers.ids
            if moved and since and _moves(history, since, until):
                return _with_moves(history, _Sync(since, until, tag, layers, ids))
        return _Sync(since, until, tag, layers, ids)

    def _pin(self, snapshot: MapSnapshot, sync: _Sync, moved: bool, wanted: bool) -> None:
        key = snapshot.head.uid, sync.since, sync.tag, moved
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
    """Return the ids of the segments that commits between two versions changed, ascending."""
    touched = [np.zeros(0, np.uint32)]
    if not history.head.oldest <= since <= until:
        raise _gone(history, str(since))
    for _, blob in history.blobs(since, until):
        delta = decode_delta(blob)
        if delta.is_whole:
            raise _gone(history, str(since))
        touched += [delta.changed.ids, delta.removed]
    return np.unique(np.concatenate(touched))


def _moves(history: MapHistory, since: int, until: int) -> bool:
    """Return whether a commit between two versions may have moved captures."""
    return any(
        since < commit.sequence <= until and commit.note.operation in MOVES_CAPTURES
        for commit in history.commits()
    )


def _with_moves(history: MapHistory, sync: _Sync) -> _Sync:
    """Return a sync that tells moved captures instead of their segments."""
    before, after = replay(history, sync.since).content(), sync.layers.content()
    changed, removed, moved = moving_difference(before, after)
    if moved is None:
        return sync
    ids = np.unique(np.concatenate([changed.ids, removed, moved.ids]))
    return replace(sync, ids=ids, moved=moved)


def _gone(history: MapHistory, version: str) -> Problem:
    return Problem(
        410,
        "version-gone",
        f"Map {history.head.name!r:.80} has no version {version}, or dropped it. "
        "Request a full sync with since=0.",
    )
