"""A map in memory, such that a write copies little of it: a large layer, and a small one above it.

As in a log-structured merge tree (O'Neil et al., 1996), but of two levels, for all is in memory.
"""

from collections import Counter
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from placecell_client import CompactMap, Delta
from placecell_client.maps.edit import apply, difference, empty, take, with_optional

from placecell.core.spatial import within
from placecell.core.types import Bool, Float64, Int64, UInt32


@dataclass(frozen=True, eq=False)
class MapLayers:
    """All segments of one version of a map; nothing in it ever changes.

    The segments are the rows of `base` that are not gone, and those of `recent`. A *row* of the map
    is one of `base`, or len(base) plus one of `recent`.

    Attributes:
        base: in canonical form.
        recent: in canonical form; what was added or replaced since the base was made.
        gone: bool (len(base),), rows of the base that were removed, or are replaced in `recent`.
        base_robots: how many segments of each robot the base has, those that are gone among them.
    """

    base: CompactMap
    recent: CompactMap
    gone: Bool
    base_robots: Counter[str]

    @classmethod
    def of(cls, content: CompactMap) -> "MapLayers":
        """Of a map in canonical form."""
        none = empty(
            content.model_id,
            content.preprocessing,
            content.frame,
            content.code_bytes,
            content.optional,
        )
        return cls(content, none, np.zeros(len(content), dtype=bool), robots_of(content))

    def __len__(self) -> int:
        return len(self.base) - self.gone_count + len(self.recent)

    @cached_property
    def gone_count(self) -> int:
        """Rows of the base that are gone."""
        return int(np.count_nonzero(self.gone))

    @cached_property
    def ids(self) -> UInt32:
        """Of all segments, uint32 (n,), ascending."""
        return np.sort(np.concatenate([self.base.ids[~self.gone], self.recent.ids]))

    @cached_property
    def robots(self) -> Counter[str]:
        """How many segments each robot has."""
        buried = self.base.robot[np.flatnonzero(self.gone)]
        return self.base_robots - _counted(self.base.robots, buried) + robots_of(self.recent)

    @cached_property
    def sources(self) -> Counter[str]:
        """How many segments were merged from each map, as far as that is known."""
        return _sources_of(self.base, ~self.gone) + _sources_of(self.recent)

    @cached_property
    def time_span(self) -> tuple[float, float] | None:
        """Earliest and latest time of frames that segments name, seconds; None without segments."""
        times = np.concatenate(
            [
                self.base.frame_times[np.unique(self.base.frame_index[~self.gone])],
                self.recent.frame_times,
            ]
        )
        return (float(times.min()), float(times.max())) if len(times) else None

    @property
    def optional(self) -> set[str]:
        """Names of the optional columns."""
        return {*self.base.optional, *self.recent.optional}

    def content(self) -> CompactMap:
        """The map in one piece, in canonical form."""
        if not self.gone_count and not len(self.recent) and self.optional == {*self.base.optional}:
            return self.base
        return apply(self.base, self._above())

    def take(self, ids: UInt32) -> CompactMap:
        """The segments that have one of these ids, in canonical form."""
        base = _rows_of(self.base, ids)
        recent = take(self.recent, _rows_of(self.recent, ids))
        return apply(
            take(self.base, base[~self.gone[base]]), Delta(recent, np.zeros(0, dtype=np.uint32))
        )

    def near(self, places: Float64, meters: float) -> CompactMap:
        """The segments about these places, (p, 3): all that are so near to one, and some around."""
        if not len(places):
            return self.take(self.recent.ids[:0])
        return self.take(self.column("ids", self.rows_near(places, meters)))

    def rows_near(self, places: Float64, meters: float) -> Int64:
        """Rows of the map about these places, (p, 3), at least one; see `within`."""
        base, recent = (
            within(layer.centroids, places, meters) for layer in (self.base, self.recent)
        )
        return np.concatenate([base[~self.gone[base]], recent + len(self.base)])

    def column(self, name: str, rows: Int64) -> NDArray[Any]:
        """Values of a column that every map has, at rows of the map, of any shape."""
        base, recent = getattr(self.base, name), getattr(self.recent, name)
        above = rows >= len(self.base)
        if not above.any():
            return np.asarray(base[rows])
        values = np.empty((*rows.shape, *base.shape[1:]), base.dtype)
        values[~above] = base[rows[~above]]
        values[above] = recent[rows[above] - len(self.base)]
        return values

    def robot_names(self, rows: Int64) -> NDArray[np.object_]:
        """Whose segments these rows are, of any shape."""
        names = np.array([*self.base.robots, *self.recent.robots], dtype=object)
        places = self.column("robot", rows).astype(np.int64)
        return np.asarray(names[places + (rows >= len(self.base)) * len(self.base.robots)])

    def last_seen(self) -> tuple[UInt32, UInt32]:
        """Ids of all segments, and when each was last seen, whole seconds; in no order."""
        kept = take(self.base, ~self.gone)
        layers = [with_optional(layer, ["seen"]) for layer in (kept, self.recent)]
        ids, seen = zip(*((layer.ids, layer.seen) for layer in layers), strict=True)
        return np.concatenate(ids), np.concatenate(seen)

    def after(self, delta: Delta) -> "MapLayers":
        """The map after a delta."""
        if delta.is_whole:
            return MapLayers.of(delta.changed)
        gone = self.gone.copy()
        gone[_rows_of(self.base, delta.changed.ids)] = True
        gone[_rows_of(self.base, delta.removed)] = True
        return replace(self, recent=apply(self.recent, delta), gone=gone)

    def effect_of(self, delta: Delta) -> tuple[CompactMap, Delta]:
        """What a delta does to this map.

        Returns:
            The segments that it replaces or removes, as they are; and the delta without what
            changes nothing: segments that are there already, ids of none.
        """
        if delta.is_whole:
            return self.content(), delta
        before = self.take(np.union1d(delta.changed.ids, delta.removed))
        after = with_optional(delta.changed, before.optional)
        changed, removed = difference(before, after)
        touched = np.isin(before.ids, np.concatenate([changed.ids, removed]))
        return take(before, touched), replace(delta, changed=changed, removed=removed)

    def is_changed_by(self, delta: Delta) -> bool:
        """Whether a delta, as `effect_of` gives it, makes another map of this one."""
        return bool(delta.is_whole or len(delta) or {*delta.changed.optional} - self.optional)

    def rebased(self, base: CompactMap, before: "MapLayers") -> "MapLayers":
        """The same segments above a new base.

        Args:
            base: `before.content()`.
            before: an earlier version, whose own base is this one's.
        """
        changed, removed = difference(before.recent, self.recent)
        buried = self.base.ids[self.gone & ~before.gone]
        removed = np.setdiff1d(np.union1d(removed, buried), self.recent.ids)
        return MapLayers.of(base).after(Delta(changed, removed))

    def _above(self) -> Delta:
        """From the base to the map."""
        removed = np.setdiff1d(self.base.ids[self.gone], self.recent.ids)
        return Delta(self.recent, removed)


def robots_of(content: CompactMap) -> Counter[str]:
    """How many segments each robot has."""
    return _counted(content.robots, content.robot)


def _sources_of(content: CompactMap, rows: Bool | slice = slice(None)) -> Counter[str]:
    if content.source is None:
        return Counter()
    source = content.source[rows]
    return _counted(content.sources, source[source > 0] - 1)


def _counted(names: tuple[str, ...], indices: NDArray[np.uint16]) -> Counter[str]:
    counts = np.bincount(indices, minlength=len(names)).tolist()
    return Counter({name: n for name, n in zip(names, counts, strict=True) if n})


def _rows_of(content: CompactMap, ids: UInt32) -> Int64:
    """The rows of those ids that a map in canonical form has."""
    rows = np.searchsorted(content.ids, ids)
    inside = rows < len(content)
    return np.asarray(rows[inside][content.ids[rows[inside]] == ids[inside]])
