"""Canonical form of a compact map: equal maps become equal files."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.compact_map import SEGMENT_COLUMNS, CompactMap, is_ascending

Rows = NDArray[np.bool_] | NDArray[np.integer] | slice


def canonical(compact_map: CompactMap) -> CompactMap:
    """Return a map in canonical form.

    Rows are sorted by id. Tables are sorted, without duplicates and unused entries. Centroids are
    rounded to centimeters.

    Args:
        compact_map: A valid map (`CompactMap.check`). The result shares columns that are sorted
            already.
    """
    ordered = compact_map
    if not is_ascending(ordered.ids):
        ordered = take(ordered, np.argsort(ordered.ids, kind="stable"))
    robots, robot_ranks = _sorted_names(ordered.robots, ordered.robot)
    table, frame_ranks = _sorted_frames(ordered)
    return replace(
        ordered,
        centroids=snap(ordered.centroids),
        robots=robots,
        robot=robot_ranks[ordered.robot],
        frame_index=frame_ranks[ordered.frame_index],
        frame_times=table[:, 0].copy(),
        frame_positions=table[:, 1:4].copy(),
        frame_orientations=table[:, 4:8].astype(np.float32),
        **_odometry_columns(ordered, table[:, 8:]),
        **_sorted_sources(ordered),
    )


def take(compact_map: CompactMap, rows: Rows) -> CompactMap:
    """Select segments of a map, in the order of `rows`; the tables are unchanged.

    Args:
        compact_map: The map.
        rows: Mask (n,), indices (m,), or slice.
    """
    columns = (*SEGMENT_COLUMNS, *compact_map.optional)
    return replace(compact_map, **{name: getattr(compact_map, name)[rows] for name in columns})


def snap(centroids: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round centroids to whole centimeters from the frame's origin; meters.

    The reference is the frame's origin, not the map's corner. So adding or removing segments never
    rounds a map a second time.
    """
    snapped = centimeters(centroids)
    snapped /= 100
    snapped += 0.0  # makes -0.0 and 0.0 the same
    return snapped


def centimeters(meters: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round meters to whole centimeters, halves to even."""
    whole = meters * 100
    return np.rint(whole, out=whole)


def frame_rows(compact_map: CompactMap) -> NDArray[np.float64]:
    """Return the frame table, float64 (f, 8 or 16): time, position, orientation, odometry.

    Equal frames are equal rows.
    """
    parts: list[NDArray[Any]] = [
        compact_map.frame_times,
        compact_map.frame_positions,
        one_sign(compact_map.frame_orientations),
    ]
    if compact_map.frame_tracks is not None and compact_map.frame_odometry is not None:
        parts += [compact_map.frame_tracks, compact_map.frame_odometry]
    table = np.column_stack(parts)
    table += 0.0  # makes -0.0 and 0.0 the same
    return table


def distinct_rows(
    table: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """Return the distinct rows of a table in ascending order, and the index of each given row."""
    order = np.lexsort(table.T[::-1])
    ordered = table[order]
    is_new = np.ones(len(table), dtype=bool)
    is_new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    ranks = np.empty(len(table), dtype=np.uint32)
    ranks[order] = np.cumsum(is_new) - 1
    return ordered[is_new], ranks


def _sorted_frames(compact_map: CompactMap) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """Return the used frames like `distinct_rows`, and the new index of each frame."""
    used = _used(compact_map.frame_index, len(compact_map.frame_times))
    table, places = distinct_rows(frame_rows(compact_map)[used])
    ranks = np.zeros(len(used), dtype=np.uint32)
    ranks[used] = places
    return table, ranks


def _odometry_columns(compact_map: CompactMap, rows: NDArray[np.float64]) -> dict[str, Any]:
    """Return the columns of the odometry of a sorted table, if the map has them."""
    if not compact_map.has_odometry:
        return {}
    return {"frame_tracks": rows[:, 0].astype(np.uint32), "frame_odometry": rows[:, 1:].copy()}


def _sorted_sources(compact_map: CompactMap) -> dict[str, Any]:
    """Return the provenance columns in canonical form, if the map has them."""
    if compact_map.source is None:
        return {}
    merged = compact_map.source > 0
    sources, ranks = _sorted_names(compact_map.sources, compact_map.source[merged] - 1)
    source = np.zeros_like(compact_map.source)
    source[merged] = ranks[compact_map.source[merged] - 1] + 1
    return {"sources": sources, "source": source}


def _sorted_names(
    names: tuple[str, ...], indices: NDArray[np.uint16]
) -> tuple[tuple[str, ...], NDArray[np.uint16]]:
    """Return the used names in ascending order, and the new index of each name."""
    used = np.flatnonzero(_used(indices, len(names)))
    order = sorted(used.tolist(), key=lambda index: names[index])
    ranks = np.zeros(len(names), dtype=np.uint16)
    ranks[order] = np.arange(len(order))
    return tuple(names[index] for index in order), ranks


def _used(indices: NDArray[np.integer], size: int) -> NDArray[np.bool_]:
    used = np.zeros(size, dtype=bool)
    used[indices] = True
    return used


def one_sign(orientations: NDArray[np.float32]) -> NDArray[np.float32]:
    """Choose between q and -q (the same rotation): make the last non-zero component positive."""
    last = np.zeros(len(orientations), dtype=np.float32)
    for component in orientations.T:
        last = np.where(component != 0, component, last)
    return np.where(last[:, None] < 0, -orientations, orientations)
