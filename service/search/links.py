"""Links between maps: which maps hold the same segments, and the transform between their frames.

A merged map and its sources hold the same segments; so do two copies of one map. A rival pose in
such a map is the same place, so it does not make a pose ambiguous. The provenance of the segments
shows it: the map that each was first written to, its id there, and its capture time.
"""

import numpy as np

from placecell.core.spatial import evenly
from placecell.core.types import Float64, Int64, UInt32
from placecell.localization import LocalizationParameters, Pose
from placecell.localization.registration import register
from service.maps.layers import MapLayers
from service.maps.shared_index import live_rows
from service.maps.snapshot import MapSnapshot

SAMPLE = 2_048
"""Largest number of segments of one map that are looked up in the other."""

OFF = 0.5
"""Largest median distance between segments of linked maps, meters."""


def pose_between(one: MapSnapshot, other: MapSnapshot) -> Pose | None:
    """Return the pose of `other`'s frame in `one`'s; None if they share no segments."""
    rows, others = _common(one, other)
    if not len(rows):
        return None
    source = np.concatenate([_viewpoints(other.layers, others), _centroids(other.layers, others)])
    target = np.concatenate([_viewpoints(one.layers, rows), _centroids(one.layers, rows)])
    pose = register(source, target, np.ones(len(source)), LocalizationParameters())
    off = np.linalg.norm(pose.apply(source) - target, axis=1)
    return pose if np.median(off) <= OFF else None


def _common(one: MapSnapshot, other: MapSnapshot) -> tuple[Int64, Int64]:
    """Return rows of both maps that are the same segments, a sample, int64 (n,) each."""
    if _is_copy(one, other):
        by_id = (live_rows(each.layers) for each in (one, other))
        rows, others = (evenly(each, SAMPLE) for each in by_id)
        return rows, others
    pairs = [(np.zeros(0, np.int64), np.zeros(0, np.int64))]
    for name in sorted(_names(one) & _names(other)):
        ids, rows = _written_to(one, name)
        chosen = evenly(np.arange(len(ids)), SAMPLE)
        ids, rows = ids[chosen], rows[chosen]
        known, others = _written_to(other, name)
        order = np.argsort(known, kind="stable")
        known, others = known[order], others[order]
        at = np.searchsorted(known, ids)
        found = np.flatnonzero(at < len(known))
        found = found[known[at[found]] == ids[found]]
        pairs.append((rows[found], others[at[found]]))
    rows, others = (np.concatenate(each) for each in zip(*pairs, strict=True))
    # The map of this name may have been replaced: the same segment has the same descriptor.
    same = (one.layers.column("codes", rows) == other.layers.column("codes", others)).all(axis=1)
    same &= _capture_times(one.layers, rows) == _capture_times(other.layers, others)
    return rows[same], others[same]


def _is_copy(one: MapSnapshot, other: MapSnapshot) -> bool:
    """Return whether both maps hold the same segments, with the same capture times.

    Capture times tell a copy from a look-alike; if all segments have one time, nothing does.
    """
    if len(one) != len(other) or one.layers.robots != other.layers.robots:
        return False
    rows, others = live_rows(one.layers), live_rows(other.layers)
    for name in ("ids", "codes"):
        if not np.array_equal(one.layers.column(name, rows), other.layers.column(name, others)):
            return False
    times = _capture_times(one.layers, rows)
    if not np.array_equal(times, _capture_times(other.layers, others)):
        return False
    return bool(len(times)) and bool(times.min() < times.max())


def _names(snapshot: MapSnapshot) -> set[str]:
    """Return the names of maps that the segments may have been written to first."""
    return {snapshot.name, *snapshot.layers.base.sources, *snapshot.layers.recent.sources}


def _written_to(snapshot: MapSnapshot, name: str) -> tuple[UInt32, Int64]:
    """Return ids and rows of the segments that were first written to the map of this name."""
    layers = snapshot.layers
    ids, rows = [], []
    for layer, first in ((layers.base, 0), (layers.recent, len(layers.base))):
        if layer.source is None or layer.source_ids is None:
            here = np.full(len(layer), name == snapshot.name)
            original = layer.ids
        else:
            is_own = layer.source == 0
            here = is_own if name == snapshot.name else np.zeros(len(layer), dtype=bool)
            if name in layer.sources:
                here = here | (layer.source == layer.sources.index(name) + 1)
            original = np.where(is_own, layer.ids, layer.source_ids)
        if layer is layers.base:
            here = here & ~layers.gone
        at = np.flatnonzero(here)
        ids.append(original[at])
        rows.append(first + at)
    return np.concatenate(ids), np.concatenate(rows)


def _of_frames(layers: MapLayers, column: str, rows: Int64) -> Float64:
    """Return values of a frame table's column, at rows of the map."""
    base, recent = layers.base, layers.recent
    above = rows >= len(base)
    of_base = getattr(base, column)[base.frame_index[rows[~above]]]
    values = np.empty((len(rows), *of_base.shape[1:]))
    values[~above] = of_base
    values[above] = getattr(recent, column)[recent.frame_index[rows[above] - len(base)]]
    return values


def _capture_times(layers: MapLayers, rows: Int64) -> Float64:
    return _of_frames(layers, "frame_times", rows)


def _viewpoints(layers: MapLayers, rows: Int64) -> Float64:
    return _of_frames(layers, "frame_positions", rows)


def _centroids(layers: MapLayers, rows: Int64) -> Float64:
    return np.asarray(layers.column("centroids", rows), np.float64)
