"""The maps that the service knows: stored, and searchable if the model that made them is loaded."""

import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from threading import Lock
from weakref import WeakValueDictionary

import numpy as np
from placecell_client import CompactMap, Delta, MapFileError, encode, encode_delta

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
from service.maps.snapshot import KEEPS_FRAME, MapSnapshot
from service.maps.store import Ids, MapHead, MapStore, Note, StoreError

logger = logging.getLogger("placecell")


class MapRepository:
    """All maps in memory, by name. Safe to use from many threads.

    A reader takes a `MapSnapshot`, which never changes, and waits for no writer. A writer holds
    `writing(name)` from reading the snapshot until `commit` returns.

    Attributes:
        copied_segments: segments that writes have copied.
    """

    def __init__(
        self,
        store: MapStore,
        models: Models,
        quotas: Quotas,
        cache: MapCache,
        clock: Callable[[], float] = time.time,
    ) -> None:
        """Load what is stored. A damaged map is left out, with a line in the log."""
        self.store = store
        self.copied_segments = 0
        self._models = models
        self._quotas = quotas
        self._clock = clock
        self._guard = Lock()
        self._locks: WeakValueDictionary[str, Lock] = WeakValueDictionary()
        self._committing = Lock()
        self._damaged: dict[str, MapHead] = {}
        self._by_name: dict[str, MapSnapshot] = {}
        self.shared = SharedIndexes()
        self._usage = Usage()
        self._refused: set[str] = set()
        loaded = {}
        for head in store.heads():
            try:
                layers, base_sequence = load_newest(store, head, cache)
            except (StoreError, MapFileError) as error:
                logger.error("map %r is damaged and not served: %s", head.name, error)
                self._damaged[head.name] = head
                self._usage.add(head)
            else:
                loaded[head.name] = MapSnapshot(head, layers, base_sequence, head.sequence, None)
        self._models.want({stored.model_id for stored in loaded.values()})
        # Shown at once: a new dictionary for each map would take a time that grows with its square.
        self._by_name = {
            name: replace(stored, index=self._index(stored.layers))
            for name, stored in loaded.items()
        }
        for stored in self._by_name.values():
            self._usage.add(stored.head, stored)

    def index_all(self) -> None:
        """Make those maps searchable whose models can be had by now."""
        self._models.want({stored.model_id for stored in self.all()})
        for name in self._by_name:
            with self.writing(name):
                stored = self._by_name.get(name)
                if stored is not None and stored.index is None:
                    index = self._index(stored.layers)
                    with self._committing:
                        self._swap(replace(stored, index=index))

    def __len__(self) -> int:
        return len(self._by_name)

    def take_refused(self) -> list[str]:
        """Return and forget the maps whose writes were refused for lack of space."""
        with self._committing:
            refused, self._refused = sorted(self._refused & self._by_name.keys()), set()
        return refused

    @property
    def stored_bytes(self) -> int:
        """Return the bytes of all maps in the store, with their old versions."""
        return self._usage.bytes

    def trouble(self) -> str | None:
        """Return why no map can be stored; None if maps can be."""
        return self.store.trouble()

    def all(self) -> list[MapSnapshot]:
        """Sorted by name."""
        return sorted(self._by_name.values(), key=lambda stored: stored.name)

    def damaged(self) -> list[str]:
        """Names of the maps that are stored, but cannot be read."""
        return sorted(self._damaged)

    def find(self, name: str) -> MapSnapshot | None:
        """One map, if there is one.

        Raises:
            Problem: 500 if it is damaged.
        """
        if name in self._damaged:
            raise Problem(
                500,
                "map-damaged",
                f"Map {name!r} is damaged on disk; the log says how. Bring the data directory back "
                "from a backup, or delete the map and put it again.",
            )
        return self._by_name.get(name)

    def get(self, name: str) -> MapSnapshot:
        """One map; 404 if there is none."""
        stored = self.find(name)
        if stored is None:
            raise unknown(name)
        return stored

    @contextmanager
    def writing(self, name: str) -> Iterator[None]:
        """Hold the write lock of the map of this name.

        Raises:
            Cancelled: the request became late, or its client left, before its turn.
        """
        with self._guard:
            lock = self._locks.setdefault(name, Lock())
        with holding(lock):
            yield

    def create(self, name: str, content: CompactMap, author: str, operation: str) -> MapSnapshot:
        """Store a map under a new name; on return it is safely on disk.

        Raises:
            Problem: 507 if it is more than a quota allows.
            StoreError: nothing was changed.
        """
        layers, file = MapLayers.of(content), encode(content)
        robots, index = layers.robots, self._index(layers)
        note = Note(self._clock(), author, operation, len(content), 0)
        with self._committing:
            self._quotas.check_new(self._usage, author, robots, len(file))
            self.copied_segments += len(content)
            runs = runs_of(content.ids)
            head = self.store.create(name, file, note, 0, Ids(runs, runs))
            return self._swap(MapSnapshot(head, layers, 1, 1, index))

    def commit(
        self,
        stored: MapSnapshot,
        delta: Delta,
        author: str,
        operation: str,
        written: UInt32 | None = None,
    ) -> MapSnapshot:
        """Store the map's next version; on return it is durable. Raises as `create` does.

        Args:
            stored: the map as it is.
            delta: as `MapLayers.effect_of` gives it.
            author: name of the key.
            operation: for the history.
            written: ids of the segments that are the author's from now on.
        """
        since, until = stored.head.sequence, stored.head.sequence + 1
        blob = encode_delta(replace(delta, since=0 if delta.is_whole else since, until=until))
        layers = stored.layers.after(delta)
        kept = stored.index if layers.base is stored.layers.base else None
        robots, sources = layers.robots, len(layers.sources)
        index = self._index(layers, kept.base if kept is not None else None)
        # What only removes is stored even where there is no room for more.
        size = len(blob) if delta.is_whole or len(delta.changed) else 0
        base_sequence = until if delta.is_whole else stored.base_sequence
        # One without segments takes the frame of whatever comes next.
        keeps = operation in KEEPS_FRAME and len(stored)
        frame_since = stored.frame_since if keeps else until
        note = Note(self._clock(), author, operation, len(delta.changed), len(delta.removed))
        with self._committing:
            try:
                self._quotas.check_write(self._usage, stored, robots, sources, size)
            except NoRoomError:
                self._refused.add(stored.name)
                raise
            self.copied_segments += len(delta.changed) + len(layers.recent)
            self.copied_segments += len(stored) if delta.is_whole else 0
            own = runs_of(written) if written is not None else ()
            ids = Ids(runs_of(delta.changed.ids), own)
            frees = not len(delta.changed) and not delta.is_whole
            head = self.store.append(stored.head, blob, note, 0, ids, frees)
            return self._swap(MapSnapshot(head, layers, base_sequence, frame_since, index))

    def free_ids(self, stored: MapSnapshot) -> MapHead:
        """Free all ids that no kept version has; the caller holds `writing`."""
        used = ids_ever(self.store, stored)
        with self._committing:
            head = self.store.free_ids(stored.head.uid, used.tolist())
            self._swap(replace(self._by_name[stored.name], head=head))
            return head

    def delete(self, name: str) -> None:
        """Remove a map, damaged or not; on return it is gone from the disk."""
        with self._committing:
            stored = self._by_name.get(name)
            head = self._damaged.get(name) or self.get(name).head
            self.store.delete(head.uid)
            self._usage.remove(head, stored)
            self.copied_segments += len(stored) if stored is not None else 0
            self._damaged = {key: kept for key, kept in self._damaged.items() if key != name}
            self._by_name = {key: kept for key, kept in self._by_name.items() if key != name}

    def compact(self, head: MapHead, sequence: int, file: bytes) -> MapSnapshot:
        """Let go of the versions before one.

        Args:
            head: of the map at some time; 404 if it was removed since.
            sequence: of the version.
            file: of the version.
        """
        with self.writing(head.name):
            stored = self.get(head.name)
            if stored.head.uid != head.uid:
                raise unknown(head.name)
            if stored.head.oldest >= sequence:
                return stored
            with self._committing:
                kept = self.store.compact(head.uid, sequence, file)
                return self._swap(replace(stored, head=kept))

    def flatten(self, stored: MapSnapshot) -> CompactMap | None:
        """Make one layer of a map's two. Nobody waits for it, and what is written meanwhile stays.

        Returns:
            All segments of that version; None if the map has become another meanwhile.
        """
        content = stored.layers.content()
        index = self._index(MapLayers.of(content))
        with self.writing(stored.name):
            now = self._by_name.get(stored.name)
            if now is None or now.layers.base is not stored.layers.base:
                return None
            layers = now.layers.rebased(content, stored.layers)
            both = self._index(layers, index.base if index is not None else None)
            with self._committing:
                self._swap(
                    replace(now, layers=layers, base_sequence=stored.head.sequence, index=both)
                )
        return content

    def _swap(self, stored: MapSnapshot) -> MapSnapshot:
        """Publish a map in a new dictionary, so that readers of the old one are undisturbed.

        `_committing` is held.
        """
        before = self._by_name.get(stored.name)
        if before is not None:
            self._usage.remove(before.head, before)
        self._usage.add(stored.head, stored)
        self._by_name = self._by_name | {stored.name: stored}
        return stored

    def _index(self, layers: MapLayers, base: MapIndex | None = None) -> LayeredIndex | None:
        made_by = layers.base.model_id
        model = self._models.find(made_by)
        if model is None or layers.base.code_bytes != model.manifest.code_bytes:
            return None
        return LayeredIndex.of(layers, model.manifest.quantizer, base)


def runs_of(ids: UInt32) -> tuple[tuple[int, int], ...]:
    """Convert ascending ids to runs of first id and exclusive end."""
    if not len(ids):
        return ()
    wide = ids.astype(np.int64)
    breaks = np.flatnonzero(np.diff(wide) > 1)
    starts = wide[np.concatenate([[0], breaks + 1])]
    ends = wide[np.concatenate([breaks, [len(wide) - 1]])] + 1
    return tuple(zip(starts.tolist(), ends.tolist(), strict=True))


def unknown(name: str) -> Problem:
    """The problem of a name that no map has."""
    return Problem(404, "unknown-map", f"No map is named {name!r:.80}.")
