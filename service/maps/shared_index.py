"""Shared indexes: search many small maps at once.

A search has a cost per map and a cost per segment. A thousand maps of a thousand segments take a
second one by one, but some hundredths of a second in one index. So small maps share indexes of some
ten thousand segments. Only maps that the same API keys open share an index: segments that a key
does not open are not searched for it and displace no candidate. A map that was written later is
searched by its own index, until enough maps changed and the shared index is rebuilt.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from threading import Lock

import numpy as np

from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Bool, Float32, Int64, UInt8
from placecell.descriptors.quantizer import Quantizer
from service.maps.index import FilteredIndex, MapIndex, index_of
from service.maps.layers import MapLayers
from service.maps.snapshot import MapSnapshot

SMALL = 8_192
"""Largest number of segments of a map in a shared index."""

ROOM = 65_536
"""Largest number of segments in a shared index."""

MEMBERS = 512
"""Largest number of maps in a shared index."""

STALE = 1 / 8
"""Share of changed maps above which an index is rebuilt."""

LOOSE = 16
"""Largest number of small maps searched one by one; more get a shared index."""

Patterns = tuple[tuple[str, ...], ...]
"""Map name patterns with * and ? that keys open, each distinct list once."""

ContentKey = tuple[str, int, int]
"""Key of a map's content: its uid, its sequence, and the sequence of its base."""


def key_of(snapshot: MapSnapshot) -> ContentKey:
    """Return the key of a map's content and row numbers."""
    return snapshot.head.uid, snapshot.head.sequence, snapshot.base_sequence


@dataclass(frozen=True, slots=True, eq=False)
class SharedIndex:
    """Index over several maps; rows are ordered by map name and id.

    Attributes:
        keys: content of each map.
        starts: where the rows of each map begin, int64 (maps + 1,).
        rows: row of each segment in its map's layers, int64 (n,).
        centroids: centroids relative to the middle of their map, float32 (n, 3), meters.
        index: index over the descriptors.
        classes: class of each segment, uint8 (n,).
    """

    keys: tuple[ContentKey, ...]
    starts: Int64
    rows: Int64
    centroids: Float32
    index: MapIndex
    classes: UInt8

    def among(self, wanted: ClassFilter | None) -> MapIndex | FilteredIndex:
        """Return the index over the segments that a filter keeps."""
        return self.index if wanted is None else self.index.filtered(self.classes, wanted)

    @property
    def has_room(self) -> bool:
        """Return whether it is less than half full."""
        return 2 * len(self.rows) < ROOM and 2 * len(self.keys) < MEMBERS

    @classmethod
    def of(cls, maps: Sequence[MapSnapshot], quantizer: Quantizer) -> "SharedIndex":
        """Build the index of these maps of one model."""
        maps = sorted(maps, key=lambda each: each.name)
        rows = [live_rows(each.layers) for each in maps]
        codes = [each.layers.column("codes", own) for each, own in zip(maps, rows, strict=True)]
        centroids = [
            centered(each.layers.column("centroids", own))
            for each, own in zip(maps, rows, strict=True)
        ]
        starts = np.concatenate([[0], np.cumsum([len(own) for own in rows])])
        return cls(
            tuple(key_of(each) for each in maps),
            starts.astype(np.int64),
            np.concatenate(rows),
            np.concatenate(centroids),
            index_of(np.concatenate(codes), quantizer),
            np.concatenate(
                [each.layers.classes(own) for each, own in zip(maps, rows, strict=True)]
            ),
        )


@dataclass(frozen=True, slots=True, eq=False)
class IndexPart:
    """Part of a search: one map by its own index, or several maps by a shared one.

    Attributes:
        places: index of each map among the searched maps, int64 (maps,); -1 if it is not searched.
        shared: the shared index; None for the map's own index.
    """

    places: Int64
    shared: SharedIndex | None

    @property
    def hidden(self) -> Bool | None:
        """Return which rows of the shared index are excluded; None if no row is."""
        assert self.shared is not None
        if (self.places >= 0).all():
            return None
        return np.repeat(self.places < 0, np.diff(self.shared.starts))


class SharedIndexes:
    """Shared indexes of all maps. Safe to use from many threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._patterns: Patterns = ()
        self._by_model: dict[str, list[SharedIndex]] = {}

    def parts(
        self,
        searched: Sequence[MapSnapshot],
        known: Iterable[MapSnapshot],
        model_id: str,
        quantizer: Quantizer,
        patterns: Patterns,
    ) -> list[IndexPart]:
        """Return the parts to search for these maps, each map in one part.

        Args:
            searched: maps with an index, of one model.
            known: all maps, since an index is built of all maps that the same keys open.
            model_id: id of the model.
            quantizer: quantizer of the model.
            patterns: map name patterns that keys open.
        """
        with self._lock:
            if patterns != self._patterns:
                self._by_model, self._patterns = {}, patterns
            own = [each for each in known if each.index is not None and each.model_id == model_id]
            kept = self._renewed(own, self._by_model.get(model_id, []), quantizer)
            self._by_model[model_id] = kept
        return _parts_of(searched, kept)

    def _renewed(
        self, maps: Sequence[MapSnapshot], before: Sequence[SharedIndex], quantizer: Quantizer
    ) -> list[SharedIndex]:
        """Keep the valid indexes; rebuild those with too many changed maps."""
        small = {key_of(each): each for each in maps if 0 < len(each) <= SMALL}
        by_uid = {each.head.uid: each for each in small.values()}
        kept, covered = [], set()
        for shared in before:
            good = sum(key in small for key in shared.keys)
            if len(shared.keys) - good <= STALE * len(shared.keys):
                kept.append(shared)
                covered |= {key[0] for key in shared.keys if key[0] in by_uid}
        loose = [each for uid, each in by_uid.items() if uid not in covered]
        if len(loose) < LOOSE:
            return kept
        # With the maps of indexes that have room.
        for shared in [each for each in kept if each.has_room]:
            kept.remove(shared)
            loose += [by_uid[uid] for uid, *_ in shared.keys if uid in by_uid]
        groups: dict[tuple[int, ...], list[MapSnapshot]] = {}
        for each in sorted(loose, key=lambda one: one.name):
            groups.setdefault(self._openers(each.name), []).append(each)
        for group in groups.values():
            kept += self._filled(group, quantizer)
        return kept

    def _filled(self, maps: Sequence[MapSnapshot], quantizer: Quantizer) -> list[SharedIndex]:
        made: list[SharedIndex] = []
        some: list[MapSnapshot] = []
        count = 0
        for each in maps:
            if some and (count + len(each) > ROOM or len(some) == MEMBERS):
                made.append(SharedIndex.of(some, quantizer))
                some, count = [], 0
            some.append(each)
            count += len(each)
        if len(some) > 1:
            made.append(SharedIndex.of(some, quantizer))
        return made

    def _openers(self, name: str) -> tuple[int, ...]:
        """Return the indices of the keys' patterns that open a map of this name."""
        return tuple(
            number
            for number, patterns in enumerate(self._patterns)
            if any(fnmatchcase(name, pattern) for pattern in patterns)
        )


def _parts_of(searched: Sequence[MapSnapshot], indexes: Sequence[SharedIndex]) -> list[IndexPart]:
    places = {key_of(each): place for place, each in enumerate(searched)}
    parts, done = [], set()
    for shared in indexes:
        at = np.array([places.get(key, -1) for key in shared.keys], dtype=np.int64)
        # Of few of its maps, each is searched by itself: what is hidden costs as what is not.
        if 2 * np.count_nonzero(at >= 0) > len(at):
            parts.append(IndexPart(at, shared))
            done |= {*at.tolist()}
    parts += [
        IndexPart(np.array([place]), None)
        for place, each in enumerate(searched)
        if place not in done and len(each)
    ]
    return parts


def live_rows(layers: MapLayers) -> Int64:
    """Return the rows of a map's live segments, by id, int64 (n,)."""
    rows = np.concatenate(
        [np.flatnonzero(~layers.gone), len(layers.base) + np.arange(len(layers.recent))]
    )
    return np.asarray(rows[np.argsort(layers.column("ids", rows), kind="stable")])


def centered(centroids: "np.ndarray") -> Float32:
    """Return centroids about their mean, float32, because maps may be 1,000 km off."""
    middle = np.median(centroids, axis=0) if len(centroids) else 0.0
    return np.asarray(centroids - middle, np.float32)
