"""Map repository: the stored maps in memory, searchable if their model is loaded.

If a limit is set, the maps that were used least recently are cold: only their summary is in memory,
and a request for one loads it.
"""

import logging
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fnmatch import fnmatchcase
from itertools import count
from threading import Lock
from typing import Protocol, TypeVar
from weakref import WeakValueDictionary

import numpy as np
from placecell_client import CompactMap, Delta, MapFileError, encode_delta

from placecell.core.cancellation import holding
from placecell.core.types import UInt32
from service.core.problems import Problem
from service.inference.model_registry import Models
from service.maps.cache import MapCache
from service.maps.history import ids_ever, load_newest
from service.maps.index import LayeredIndex, MapIndex
from service.maps.layers import MapLayers
from service.maps.quotas import NoRoomError, Quotas, Usage
from service.maps.shared_index import SharedIndexes
from service.maps.snapshot import KEEPS_FRAME, MOVES_CAPTURES, ColdMap, MapEntry, MapSnapshot
from service.maps.store import Annotation, Ids, MapHead, MapStore, Note, StoreError

logger = logging.getLogger("placecell")

Entry = TypeVar("Entry", bound=MapEntry)

KNOWN_VERSIONS = 64
"""Number of last versions of each map that `has_had` knows."""


class FollowingAnchors(Protocol):
    """Anchors that follow the captures around them."""

    def moved(self, snapshot: MapSnapshot, layers: MapLayers) -> Sequence[Annotation]:
        """Return the annotations of a map that follow the captures into its next version."""

    def adopt(self, snapshot: MapSnapshot, rows: Sequence[Annotation]) -> None:
        """Use annotations of a map that were written with its next version."""


class OutdatedError(Problem):
    """Another service wrote to the map, so this write does not follow its newest version."""

    def __init__(self, name: str) -> None:
        super().__init__(
            409,
            "map-changed",
            f"Another service wrote to map {name!r:.80} meanwhile; nothing was changed. Try again.",
        )


class MapRepository:
    """All maps in memory, by name. Safe to use from many threads.

    A reader takes a `MapSnapshot`, which never changes, and waits for no writer. A writer holds
    `writing(name)` from reading the snapshot until `commit` returns.

    Attributes:
        store: the store on disk.
        shared: indexes that several small maps share.
        copied_segments: number of segments that writes have copied.
        most_segments: largest number of segments in memory; 0: no limit.
        on_delete: is called with the uid of each map that was deleted.
        catch_up: loads what other services wrote to the map of a name before a monotonic time.
        anchors: anchors of the maps, which follow captures that are moved.
    """

    def __init__(
        self,
        store: MapStore,
        models: Models,
        quotas: Quotas,
        cache: MapCache,
        clock: Callable[[], float] = time.time,
        patterns: Sequence[str] = (),
        most_segments: int = 0,
    ) -> None:
        """Load the stored maps. A damaged map is logged and not served.

        Args:
            store: the store.
            models: loaded models.
            quotas: quotas of the maps.
            cache: files of versions, for a fast start.
            clock: returns Unix seconds.
            patterns: patterns of the names of the maps to load; none: all maps.
            most_segments: number of segments in memory beyond which the maps that were used least
                recently are dropped, until a request needs them; 0: no limit.
        """
        self.store = store
        self.patterns = patterns
        self.most_segments = most_segments
        self.catch_up: Callable[[str, float], None] = lambda *_: None
        self.shared = SharedIndexes()
        self.copied_segments = 0
        self.on_delete: Callable[[str], None] = lambda _: None
        self.anchors: FollowingAnchors | None = None
        self._models = models
        self._quotas = quotas
        self._cache = cache
        self._clock = clock
        self._guard = Lock()
        self._locks: WeakValueDictionary[str, Lock] = WeakValueDictionary()
        self._committing = Lock()
        self._damaged: dict[str, MapHead] = {}
        self._by_name: dict[str, MapSnapshot] = {}
        self._cold: dict[str, ColdMap] = {}
        self._loads: WeakValueDictionary[str, Lock] = WeakValueDictionary()
        self._uses = count()
        self._used: dict[str, int] = {}
        self._usage = Usage()
        self._refused: set[str] = set()
        self._had: dict[str, deque[str]] = {}
        loaded: dict[str, MapSnapshot] = {}
        segments = 0
        for head in store.heads():
            if not self.serves(head.name):
                continue
            try:
                newest, layers, base = load_newest(store, head.uid, cache)
            except KeyError:
                continue  # another service deleted it
            except (StoreError, MapFileError) as error:
                logger.error("map %r is damaged and not served: %s", head.name, error)
                self._damaged[head.name] = head
                self._usage.add(head)
            else:
                snapshot = MapSnapshot(newest, layers, base, newest.sequence, index=None)
                segments += len(snapshot)
                if most_segments and segments > most_segments and len(snapshot):
                    segments -= len(snapshot)
                    self._cold[head.name] = ColdMap.of(snapshot)
                else:
                    loaded[head.name] = snapshot
        self._models.want(
            {each.model_id for each in loaded.values()}
            | {each.model_id for each in self._cold.values()}
        )
        # Published at once: a new dictionary for each map would take quadratic time.
        self._by_name = {
            name: replace(snapshot, index=self._index(snapshot.layers))
            for name, snapshot in loaded.items()
        }
        for entry in self.entries():
            self._usage.add(entry.head, entry)
            self._remember(entry)

    def serves(self, name: str) -> bool:
        """Return whether this service loads the map of this name, if there is one."""
        return not self.patterns or any(fnmatchcase(name, each) for each in self.patterns)

    def index_all(self) -> None:
        """Index the maps whose models have been loaded since."""
        self._models.want({entry.model_id for entry in self.entries()})
        for name in self._by_name:
            with self.writing(name):
                snapshot = self._by_name.get(name)
                if snapshot is not None and snapshot.index is None:
                    index = self._index(snapshot.layers)
                    self.exchange(snapshot, replace(snapshot, index=index))

    def __len__(self) -> int:
        return len(self._by_name) + len(self._cold)

    def take_refused(self) -> list[str]:
        """Return and forget the maps whose writes were refused for lack of space."""
        with self._committing:
            refused, self._refused = (
                sorted(self._refused & {each.name for each in self.entries()}),
                set(),
            )
        return refused

    @property
    def stored_bytes(self) -> int:
        """Return the bytes of all maps in the store, with their old versions."""
        return self._usage.bytes

    def trouble(self) -> str | None:
        """Return why no map can be stored; None if maps can be stored."""
        return self.store.trouble()

    def all(self) -> list[MapSnapshot]:
        """Return all maps in memory, sorted by name; without a limit, all maps."""
        return sorted(self._by_name.values(), key=lambda snapshot: snapshot.name)

    def entries(self) -> list[MapEntry]:
        """Return all maps, in memory or not, sorted by name."""
        # A map that is loaded meanwhile was cold before; one that is dropped is cold afterwards.
        before, loaded = self._cold, self._by_name
        found: dict[str, MapEntry] = {**before, **self._cold, **loaded}
        return sorted(found.values(), key=lambda entry: entry.name)

    def damaged(self) -> list[str]:
        """Return the names of the maps that are stored but cannot be read."""
        return sorted(self._damaged)

    def entry(self, name: str) -> MapEntry | None:
        """Return the map of this name, in memory or not; None if there is none.

        Raises:
            Problem: 500 if the map is damaged; 404 if this service does not load it.
        """
        if not self.serves(name):
            raise Problem(
                404,
                "unknown-map",
                f"This service loads only maps named {', '.join(self.patterns)}, so not "
                f"{name!r:.80}. Send the request to another service, or change PLACECELL_MAPS.",
            )
        if name in self._damaged:
            raise Problem(
                500,
                "map-damaged",
                f"Map {name!r} is damaged on disk; the log has the reason. Restore the data "
                "directory from a backup, or delete the map and upload it again.",
            )
        return self.peek(name)

    def find(self, name: str) -> MapSnapshot | None:
        """Return the map of this name, loaded if it is cold; None if there is none.

        Raises:
            Problem: 500 if the map is damaged; 404 if this service does not load it.
            StoreError: the map is cold, and the store cannot be read.
        """
        found = self.entry(name)
        if isinstance(found, ColdMap):
            found = self._warmed(name)
        if found is not None and self.most_segments:
            self._used[name] = next(self._uses)
        return found

    def peek(self, name: str) -> MapEntry | None:
        """Return the map of this name, if it is served; raise nothing and load nothing."""
        # A map that is loaded meanwhile was cold before; one that is dropped is cold afterwards.
        before, loaded = self._cold.get(name), self._by_name.get(name)
        if loaded is not None:
            return loaded
        return before if before is not None else self._cold.get(name)

    def check_fits(self, entries: Sequence[MapEntry]) -> None:
        """Check that the maps of a request fit into the memory at once.

        Raises:
            Problem: 413 if they exceed the limit together. One map always fits.
        """
        segments = sum(map(len, entries))
        if self.most_segments and segments > self.most_segments and len(entries) > 1:
            raise Problem(
                413,
                "too-much-work",
                f"The request searches {len(entries):,} maps with {segments:,} segments, and this "
                f"service keeps {self.most_segments:,} segments in memory. Name fewer maps or "
                "tags, or raise PLACECELL_LOADED_SEGMENTS.",
            )

    def _warmed(self, name: str) -> MapSnapshot | None:
        """Load a cold map; None if it was deleted meanwhile."""
        with self._guard:
            lock = self._loads.setdefault(name, Lock())
        with holding(lock):
            while True:
                cold = self.peek(name)
                if not isinstance(cold, ColdMap):
                    return cold
                try:
                    head, layers, base = load_newest(self.store, cold.head.uid, self._cache)
                except KeyError:
                    return None
                except (StoreError, MapFileError) as error:
                    if isinstance(error, StoreError) and error.kind != "damaged":
                        raise
                    logger.error("map %r is damaged and not served: %s", name, error)
                    self.exchange_damaged(name, cold.head)
                    self.entry(name)  # raises the problem of a damaged map
                    return None
                since = cold.frame_since if head.mark == cold.head.mark else head.sequence
                snapshot = MapSnapshot(head, layers, base, since, self.indexed(layers, None))
                if self.exchange(cold, snapshot):
                    return snapshot

    def named(self, name: str) -> MapEntry:
        """Return the map of this name, in memory or not; 404 if there is none."""
        entry = self.entry(name)
        if entry is None:
            raise unknown_map(name)
        return entry

    def get(self, name: str) -> MapSnapshot:
        """Return the map of this name; 404 if there is none."""
        snapshot = self.find(name)
        if snapshot is None:
            raise unknown_map(name)
        return snapshot

    @contextmanager
    def writing(self, name: str) -> Iterator[None]:
        """Hold the write lock of the map of this name.

        Raises:
            Cancelled: the deadline passed, or the client disconnected, before the lock was free.
        """
        with self._guard:
            lock = self._locks.setdefault(name, Lock())
        with holding(lock):
            yield

    def create(
        self, name: str, content: CompactMap, file: bytes, author: str, operation: str
    ) -> MapSnapshot:
        """Store a map under a new name; on return it is durable.

        Args:
            name: name of the map.
            content: its segments, in canonical form.
            file: the map file of this content.
            author: name of the key.
            operation: name of the operation in the history.

        Raises:
            Problem: 507 if a quota would be exceeded.
            StoreError: the store failed; nothing was changed.
        """
        layers = MapLayers.of(content)
        robots, index = layers.robots, self._index(layers)
        note = Note(self._clock(), author, operation, len(content), 0)
        with holding(self._committing):
            self._quotas.check_new(self._usage, author, robots, len(file))
            self.copied_segments += len(content)
            runs = runs_of(content.ids)
            try:
                head = self.store.create(name, file, note, 0, Ids(runs, runs))
            except ValueError as error:  # another service created it
                raise OutdatedError(name) from error
            return self._publish(
                MapSnapshot(head=head, layers=layers, base_sequence=1, frame_since=1, index=index)
            )

    def commit(
        self,
        snapshot: MapSnapshot,
        delta: Delta,
        author: str,
        operation: str,
        written: UInt32 | None = None,
    ) -> MapSnapshot:
        """Store the map's next version; on return it is durable. Raises as `create` does.

        Args:
            snapshot: the map as it is.
            delta: the delta of a `MapChange`.
            author: name of the key.
            operation: name of the operation in the history.
            written: ids of the segments that become the author's; None: owners stay.
        """
        since, until = snapshot.head.sequence, snapshot.head.sequence + 1
        blob = encode_delta(replace(delta, since=0 if delta.is_whole else since, until=until))
        layers = snapshot.layers.after(delta)
        kept = snapshot.index if layers.base is snapshot.layers.base else None
        robots, sources = layers.robots, len(layers.sources)
        index = self._index(layers, kept.base if kept is not None else None)
        # A write that only removes segments is stored even if there is no room for more.
        size = len(blob) if delta.is_whole or len(delta.changed) else 0
        # An empty map takes the frame of what is written next.
        keeps = operation in KEEPS_FRAME and len(snapshot)
        note = Note(self._clock(), author, operation, len(delta.changed), len(delta.removed))
        moved: Sequence[Annotation] = ()
        if self.anchors is not None and operation in MOVES_CAPTURES:
            moved = self.anchors.moved(snapshot, layers)
        with holding(self._committing):
            try:
                self._quotas.check_write(self._usage, snapshot, robots, sources, size)
            except NoRoomError:
                self._refused.add(snapshot.name)
                raise
            self.copied_segments += len(delta.changed) + len(layers.recent)
            self.copied_segments += len(snapshot) if delta.is_whole else 0
            own = runs_of(written) if written is not None else ()
            ids = Ids(runs_of(delta.changed.ids), own)
            frees = not len(delta.changed) and not delta.is_whole
            try:
                head = self.store.append(snapshot.head, blob, note, 0, ids, frees, moved)
            except KeyError as error:
                raise OutdatedError(snapshot.name) from error
            if self.anchors is not None and moved:
                self.anchors.adopt(snapshot, moved)
            return self._publish(
                MapSnapshot(
                    head=head,
                    layers=layers,
                    base_sequence=until if delta.is_whole else snapshot.base_sequence,
                    frame_since=snapshot.frame_since if keeps else until,
                    index=index,
                )
            )

    def free_ids(self, snapshot: MapSnapshot) -> MapHead:
        """Free all ids that no kept version has; the caller holds `writing`."""
        used = ids_ever(self.store, snapshot)
        with self._committing:
            try:
                head = self.store.free_ids(snapshot.head.uid, used.tolist(), snapshot.head.mark)
            except KeyError as error:
                raise OutdatedError(snapshot.name) from error
            self._publish(replace(self._by_name.get(snapshot.name, snapshot), head=head))
            return head

    def delete(self, name: str) -> None:
        """Remove a map, damaged or not; on return it is gone from the disk."""
        with holding(self._committing):
            snapshot = self.peek(name)
            head = self._damaged.get(name)
            if head is None:
                if snapshot is None:
                    raise unknown_map(name)
                head = snapshot.head
            try:
                self.store.delete(head.uid, snapshot.head.mark if snapshot is not None else None)
            except KeyError as error:
                raise OutdatedError(name) from error
            if snapshot is not None:
                self.copied_segments += len(snapshot)
                self._withdraw(snapshot)
            self._drop_damaged(name)
        self.on_delete(head.uid)

    def compact(self, head: MapHead, sequence: int, file: bytes) -> MapSnapshot:
        """Drop the versions before one.

        Args:
            head: an earlier or the present head of the map; 404 if the map was removed since.
            sequence: sequence of the oldest version to keep.
            file: the map file of that version.
        """
        with self.writing(head.name):
            snapshot = self.get(head.name)
            if snapshot.head.uid != head.uid:
                raise unknown_map(head.name)
            if snapshot.head.oldest >= sequence:
                return snapshot
            with self._committing:
                try:
                    kept = self.store.compact(head.uid, sequence, file)
                except KeyError as error:
                    raise OutdatedError(head.name) from error
                now = self._by_name.get(head.name)
                if now is None and head.name in self._cold:
                    now = snapshot  # it was dropped meanwhile
                if now is None or kept.mark != now.head.mark:
                    return snapshot  # the follower loads what another service wrote
                return self._publish(replace(now, head=kept))

    def flatten(self, snapshot: MapSnapshot) -> CompactMap | None:
        """Turn a map's two layers into one; writers wait only for the exchange.

        Returns:
            The segments of that version; None if the map has another base by now.
        """
        content = snapshot.layers.content()
        index = self._index(MapLayers.of(content))
        with self.writing(snapshot.name):
            now = self._by_name.get(snapshot.name)
            if now is None or now.layers.base is not snapshot.layers.base:
                return None
            layers = now.layers.rebased(content, snapshot.layers)
            both = self._index(layers, index.base if index is not None else None)
            base = snapshot.head.sequence
            after = replace(now, layers=layers, base_sequence=base, index=both)
            if not self.exchange(now, after):
                return None
        return content

    def has_had(self, name: str, tag: str) -> bool:
        """Return whether the map is at a version, or was at it lately."""
        return tag in self._had.get(name, ())

    def exchange(self, before: MapEntry | None, after: MapEntry | None) -> bool:
        """Publish a state of a map without a write to the store; None: there is no map.

        Returns:
            False if `before` is no longer the present state; then nothing was published.
        """
        known = after if after is not None else before
        assert known is not None  # nothing is exchanged for nothing
        with self._committing:
            if self.peek(known.name) is not before:
                return False
            self._drop_damaged(known.name)
            if after is not None:
                self._publish(after)
            elif before is not None:
                self._withdraw(before)
            return True

    def exchange_damaged(self, name: str, head: MapHead | None) -> None:
        """Serve a map no more whose stored data cannot be read; None: the map was deleted."""
        with self._committing:
            self._drop_damaged(name)
            before = self.peek(name)
            if before is not None:
                self._withdraw(before)
            if head is not None:
                self._damaged = self._damaged | {name: head}
                self._usage.add(head)

    def damaged_head(self, name: str) -> MapHead | None:
        """Return the head of a damaged map; None if there is none of this name."""
        return self._damaged.get(name)

    def indexed(self, layers: MapLayers, before: MapSnapshot | None) -> LayeredIndex | None:
        """Return the index of layers, with the base of an earlier version's if it is the same."""
        self._models.want({layers.base.model_id})
        kept = before.index if before is not None and layers.base is before.layers.base else None
        return self._index(layers, kept.base if kept is not None else None)

    def _withdraw(self, entry: MapEntry) -> None:
        """Serve a map no more, and forget which versions it had."""
        name = entry.name
        self._usage.remove(entry.head, entry)
        self._by_name = _without(self._by_name, name)
        self._cold = _without(self._cold, name)
        self._had.pop(name, None)
        self._used.pop(name, None)

    def _drop_damaged(self, name: str) -> None:
        head = self._damaged.get(name)
        if head is not None:
            self._usage.remove(head)
            self._damaged = _without(self._damaged, name)

    def _publish(self, entry: Entry) -> Entry:
        """Publish a map in a new dictionary, so that readers of the old one are undisturbed.

        `_committing` is held.
        """
        name, before = entry.name, self.peek(entry.name)
        if before is not None:
            self._usage.remove(before.head, before)
        self._usage.add(entry.head, entry)
        self._remember(entry)
        if isinstance(entry, ColdMap):
            self._cold = self._cold | {name: entry}
            self._by_name = _without(self._by_name, name)
            return entry
        assert isinstance(entry, MapSnapshot)
        self._by_name = self._by_name | {name: entry}
        if name in self._cold:
            self._cold = _without(self._cold, name)
        if self.most_segments:
            self._used[name] = next(self._uses)
            self._drop_coldest(name)
        return entry

    def _drop_coldest(self, kept: str) -> None:
        """Drop the maps that were used least recently, until the others are below the limit.

        The map of the given name, and maps that are being written, stay.
        """
        left = sum(map(len, self._by_name.values()))
        for name in sorted(self._by_name, key=lambda each: self._used.get(each, -1)):
            if left <= self.most_segments:
                return
            snapshot, lock = self._by_name[name], self._locks.get(name)
            if name == kept or not len(snapshot) or (lock is not None and lock.locked()):
                continue
            left -= len(snapshot)
            self._cold = self._cold | {name: ColdMap.of(snapshot)}
            self._by_name = _without(self._by_name, name)

    def _remember(self, entry: MapEntry) -> None:
        tags = self._had.setdefault(entry.name, deque(maxlen=KNOWN_VERSIONS))
        if entry.tag not in tags:
            tags.append(entry.tag)

    def _index(self, layers: MapLayers, base: MapIndex | None = None) -> LayeredIndex | None:
        model = self._models.find(layers.base.model_id)
        if model is None or layers.base.code_bytes != model.manifest.code_bytes:
            return None
        return LayeredIndex.of(layers, model.manifest.quantizer, base)


Value = TypeVar("Value")


def _without(values: dict[str, Value], name: str) -> dict[str, Value]:
    """Return a copy of a dictionary without a key."""
    return {key: value for key, value in values.items() if key != name}


def runs_of(ids: UInt32) -> tuple[tuple[int, int], ...]:
    """Convert ascending ids to runs of first id and exclusive end."""
    if not len(ids):
        return ()
    wide = ids.astype(np.int64)
    breaks = np.flatnonzero(np.diff(wide) > 1)
    starts = wide[np.concatenate([[0], breaks + 1])]
    ends = wide[np.concatenate([breaks, [len(wide) - 1]])] + 1
    return tuple(zip(starts.tolist(), ends.tolist(), strict=True))


def unknown_map(name: str) -> Problem:
    """Return the problem of a name that no map has."""
    return Problem(
        404,
        "unknown-map",
        f"No map is named {name!r:.80}. GET /maps (placecell maps list) lists the maps.",
    )
