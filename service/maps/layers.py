"""Layers of a map in memory: a large base, and a small layer above it that writes copy.

This is a log-structured merge tree (O'Neil et al., 1996) with two levels, both in memory.
"""

from collections import Counter
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from placecell_client import CompactMap, Delta
from placecell_client.maps.edit import (
    apply,
    canonical_difference,
    delta_between,
    difference,
    empty,
    take,
    with_optional,
)

from placecell.core.segment_classes import CLASSES, ClassFilter, class_indices
from placecell.core.spatial import within
from placecell.core.types import Bool, Float64, Int64, UInt8, UInt32
from placecell.descriptors.site_calibration import milestone, sample_rows
from service.inference.site_calibrations import SiteCalibrations, SiteSample


@dataclass(frozen=True, slots=True, eq=False)
class MapChange:
    """Change of a map, without entries that change nothing.

    Attributes:
        before: the segments that are replaced or removed, as they are.
        delta: segments that are added or replaced, and ids that are removed.
        is_empty: the map stays as it is.
    """

    before: CompactMap
    delta: Delta
    is_empty: bool


@dataclass(frozen=True, eq=False)
class MapLayers:
    """All segments of one version of a map; immutable.

    The segments are the rows of `base` that are not gone, and the rows of `recent`. A *row* of the
    map is a row of `base`, or len(base) plus a row of `recent`.

    Attributes:
        base: segments in canonical form.
        recent: segments added or replaced since the base was made, in canonical form.
        gone: bool (len(base),), rows of the base that were removed, or replaced in `recent`.
        base_robots: number of segments of each robot in the base, gone ones included.
        sites: calibrations of this map's versions; later versions share them.
    """

    base: CompactMap
    recent: CompactMap
    gone: Bool
    base_robots: Counter[str]
    sites: SiteCalibrations = field(default_factory=SiteCalibrations, repr=False)

    @classmethod
    def of(cls, content: CompactMap) -> "MapLayers":
        """Return the layers of a map in canonical form."""
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
        """Number of rows of the base that are gone."""
        return int(np.count_nonzero(self.gone))

    @cached_property
    def ids(self) -> UInt32:
        """Ids of all segments, uint32 (n,), ascending."""
        return np.sort(np.concatenate([self.base.ids[~self.gone], self.recent.ids]))

    @cached_property
    def robots(self) -> Counter[str]:
        """Number of segments of each robot."""
        buried = self.base.robot[np.flatnonzero(self.gone)]
        return self.base_robots - _counted(self.base.robots, buried) + robots_of(self.recent)

    @cached_property
    def sources(self) -> Counter[str]:
        """Number of segments that were merged from each map, as far as that is known."""
        return _sources_of(self.base, ~self.gone) + _sources_of(self.recent)

    @cached_property
    def time_span(self) -> tuple[float, float] | None:
        """Earliest and latest time of the segments' frames, seconds; None without segments."""
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

    @property
    def has_odometry(self) -> bool:
        """Whether the map has the columns of the odometry."""
        return self.base.has_odometry or self.recent.has_odometry

    def content(self) -> CompactMap:
        """Return the map in one piece, in canonical form."""
        is_base = not self.gone_count and not len(self.recent)
        has_columns = self.optional == {*self.base.optional}
        if is_base and has_columns and self.has_odometry == self.base.has_odometry:
            return self.base
        return apply(self.base, self._above())

    def take(self, ids: UInt32) -> CompactMap:
        """Return the segments that have one of these ids, in canonical form."""
        base = _rows_of(self.base, ids)
        recent = take(self.recent, _rows_of(self.recent, ids))
        return apply(
            take(self.base, base[~self.gone[base]]), Delta(recent, np.zeros(0, dtype=np.uint32))
        )

    def near(self, places: Float64, meters: float) -> CompactMap:
        """Return all segments within a distance of any place, (p, 3), and some farther ones."""
        if not len(places):
            return self.take(self.recent.ids[:0])
        return self.take(self.column("ids", self.rows_near(places, meters)))

    def rows_near(self, places: Float64, meters: float, wanted: ClassFilter | None = None) -> Int64:
        """Return rows of the map near these places, (p, 3), one place or more; see `within`.

        Args:
            places: the places, float64 (p, 3), meters.
            meters: largest distance.
            wanted: filter of the segments.
        """
        base, recent = (
            within(layer.centroids, places, meters) for layer in (self.base, self.recent)
        )
        rows = np.concatenate([base[~self.gone[base]], recent + len(self.base)])
        return rows if wanted is None else rows[wanted.keeps(self.classes(rows))]

    def classes(self, rows: Int64) -> UInt8:
        """Return the classes at rows of the map, uint8 (n,); 0 in a layer without classes."""
        above = rows >= len(self.base)
        values = np.zeros(len(rows), np.uint8)
        values[~above] = classes_of(self.base)[rows[~above]]
        values[above] = classes_of(self.recent)[rows[above] - len(self.base)]
        return values

    @cached_property
    def class_counts(self) -> dict[str, int]:
        """Number of segments of each class; `unknown` comes last. Empty without the column."""
        if "classes" not in self.optional:
            return {}
        every = np.concatenate([classes_of(self.base)[~self.gone], classes_of(self.recent)])
        counts = np.bincount(class_indices(every) + 1, minlength=len(CLASSES) + 1).tolist()
        named = dict(zip(CLASSES, counts[1:], strict=True)) | {"unknown": counts[0]}
        return {name: count for name, count in named.items() if count}

    def column(self, name: str, rows: Int64) -> NDArray[Any]:
        """Return a required column's values at rows of the map, an array of any shape."""
        base, recent = getattr(self.base, name), getattr(self.recent, name)
        above = rows >= len(self.base)
        if not above.any():
            return np.asarray(base[rows])
        values = np.empty((*rows.shape, *base.shape[1:]), base.dtype)
        values[~above] = base[rows[~above]]
        values[above] = recent[rows[above] - len(self.base)]
        return values

    def capture_positions(self, rows: Int64) -> Float64:
        """Return the sensor position from which each row was seen, (..., 3), meters."""
        above = rows >= len(self.base)
        if not above.any():
            return np.asarray(self.base.frame_positions[self.base.frame_index[rows]])
        positions = np.empty((*rows.shape, 3))
        for layer, here, first in ((self.base, ~above, 0), (self.recent, above, len(self.base))):
            positions[here] = layer.frame_positions[layer.frame_index[rows[here] - first]]
        return positions

    def heights(self, rows: Int64) -> Float64:
        """Return the heights of the boxes of rows, float64 (n,), meters; NaN where unknown.

        A map rounds them up to decimeters; half a decimeter is subtracted. From 25.5 m on they are
        unknown.
        """
        above = rows >= len(self.base)
        stored = np.zeros(len(rows))
        for layer, here, first in ((self.base, ~above, 0), (self.recent, above, len(self.base))):
            if layer.extents is not None:
                stored[here] = layer.extents[rows[here] - first, 2]
        known = (stored > 0) & (stored < 255)  # 255: this or higher
        return np.where(known, (stored - 0.5) / 10, np.nan)

    def presence(self, rows: Int64) -> Float64 | None:
        """Return how surely the segments of rows still stand there, 0 to 1, as an array like rows.

        It is (1 + confirmed) / (1 + confirmed + absent). None: no pass judged this map.
        """
        if "absent" not in self.optional:
            return None
        above = rows >= len(self.base)
        counts = np.zeros((2, *rows.shape))
        for layer, here, first in ((self.base, ~above, 0), (self.recent, above, len(self.base))):
            for count, column in zip(counts, (layer.confirmed, layer.absent), strict=True):
                if column is not None:
                    count[here] = column[rows[here] - first]
        confirmed, absent = counts
        return np.asarray((1 + confirmed) / (1 + confirmed + absent))

    def site_sample(self) -> SiteSample:
        """Return the segments that a calibration reads, whatever layers hold them."""
        rows = _first_rows(self, milestone(len(self)))
        rows = rows[sample_rows(len(rows))]
        return SiteSample(
            self.column("codes", rows), self.column("centroids", rows), _captures(self, rows)
        )

    def robot_names(self, rows: Int64) -> NDArray[np.object_]:
        """Return the robots of rows, an array of any shape."""
        names = np.array([*self.base.robots, *self.recent.robots], dtype=object)
        places = self.column("robot", rows).astype(np.int64)
        return np.asarray(names[places + (rows >= len(self.base)) * len(self.base.robots)])

    def last_seen(self) -> tuple[UInt32, UInt32]:
        """Return all ids, and when each segment was last seen, whole seconds; unordered."""
        kept = take(self.base, ~self.gone)
        layers = [with_optional(layer, ["seen"]) for layer in (kept, self.recent)]
        ids, seen = zip(*((layer.ids, layer.seen) for layer in layers), strict=True)
        return np.concatenate(ids), np.concatenate(seen)

    def after(self, delta: Delta) -> "MapLayers":
        """Return the map after a delta."""
        if delta.is_whole:
            return MapLayers.of(delta.changed)
        gone = self.gone.copy()
        gone[_rows_of(self.base, delta.changed.ids)] = True
        gone[_rows_of(self.base, delta.removed)] = True
        return replace(self, recent=apply(self.recent, delta), gone=gone)

    def effect_of(self, delta: Delta) -> "MapChange":
        """Return the effect of a delta on this map.

        Args:
            delta: the delta; its segments are in canonical form.
        """
        if delta.is_whole:
            return MapChange(self.content(), delta, is_empty=False)
        before = self.take(np.union1d(delta.changed.ids, delta.removed))
        after = with_optional(delta.changed, before.optional)
        before = with_optional(before, after.optional)
        changed, removed = canonical_difference(before, after)
        return self._change(before, replace(delta, changed=changed, removed=removed))

    def change_to(
        self, content: CompactMap, sequence: int, present: CompactMap | None = None
    ) -> "MapChange":
        """Return the change that turns this map into another content.

        Args:
            content: the other content, in canonical form.
            sequence: sequence of this version.
            present: `self.content()`, if the caller has it already.
        """
        present = self.content() if present is None else present
        delta = delta_between(present, content, sequence, sequence + 1)
        if delta.is_whole:
            return MapChange(present, delta, is_empty=False)
        return self._change(present, delta)

    def _change(self, content: CompactMap, delta: Delta) -> "MapChange":
        """Return a change, given this map's content at least where the delta changes it."""
        touched = np.isin(content.ids, np.concatenate([delta.changed.ids, delta.removed]))
        is_empty = not len(delta) and not {*delta.changed.optional} - self.optional
        is_empty = is_empty and (self.has_odometry or not delta.changed.has_odometry)
        return MapChange(take(content, touched), delta, is_empty)

    def rebased(self, base: CompactMap, before: "MapLayers") -> "MapLayers":
        """Return the same segments as layers above a new base.

        Args:
            base: `before.content()`.
            before: an earlier version, with the same base as this one.
        """
        changed, removed = difference(before.recent, self.recent)
        buried = self.base.ids[self.gone & ~before.gone]
        removed = np.setdiff1d(np.union1d(removed, buried), self.recent.ids)
        return MapLayers.of(base).after(Delta(changed, removed))

    def _above(self) -> Delta:
        """Return the delta from the base to the map."""
        removed = np.setdiff1d(self.base.ids[self.gone], self.recent.ids)
        return Delta(self.recent, removed)


def classes_of(content: CompactMap) -> UInt8:
    """Return the class of each segment, uint8 (n,); 0 without the column `classes`."""
    return np.zeros(len(content), np.uint8) if content.classes is None else content.classes


def of_wanted(content: CompactMap, wanted: ClassFilter | None) -> CompactMap:
    """Return a map without the segments that a filter leaves out; it keeps its captures."""
    return content if wanted is None else take(content, wanted.keeps(classes_of(content)))


def robots_of(content: CompactMap) -> Counter[str]:
    """Return the number of segments of each robot."""
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
    """Return the rows of these ids in a map in canonical form; ids it lacks are left out."""
    rows = np.searchsorted(content.ids, ids)
    inside = rows < len(content)
    return np.asarray(rows[inside][content.ids[rows[inside]] == ids[inside]])


def _first_rows(layers: MapLayers, count: int) -> Int64:
    """Return the rows of the segments with the smallest ids, by id."""
    base = np.flatnonzero(~layers.gone)[:count]
    ids = layers.base.ids[base]
    above = np.arange(len(layers.recent))
    if len(base) == count and count:
        above = above[layers.recent.ids < ids[-1]]
    places = np.searchsorted(ids, layers.recent.ids[above])
    return np.insert(base, places, above + len(layers.base))[:count]


def _captures(layers: MapLayers, rows: Int64) -> Int64:
    """Return the number of each row's capture: its sensor position and time."""
    frames = layers.column("frame_index", rows).astype(np.int64)
    above = rows >= len(layers.base)
    frames[above] += len(layers.base.frame_times)
    positions = np.concatenate([layers.base.frame_positions, layers.recent.frame_positions])
    times = np.concatenate([layers.base.frame_times, layers.recent.frame_times])
    used, inverse = np.unique(frames, return_inverse=True)
    table = np.column_stack([positions[used], times[used]])
    numbers = np.unique(table, axis=0, return_inverse=True)[1].reshape(-1)
    return np.asarray(numbers[inverse.reshape(-1)])
