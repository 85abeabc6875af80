"""Union of the segments of several maps."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import canonical
from placecell_client.maps.compact_map import (
    FRAME_COLUMNS,
    ODOMETRY_COLUMNS,
    ODOMETRY_WIDTH,
    OPTIONAL,
    SEGMENT_COLUMNS,
    SOURCE_LIMIT,
    CompactMap,
    MapFileError,
)

ROBOT_LIMIT = 1 << 16
"""Largest number of robots: the range of a robot index."""


def union(maps: Sequence[CompactMap], without: NDArray[np.intp] | None = None) -> CompactMap:
    """Unite the segments of all maps in canonical form, with the optional columns of all.

    Args:
        maps: One or more valid maps of the same kind. Apart from the rows left out, no id may occur
            in two maps.
        without: Rows of the first map to leave out.

    Raises:
        MapFileError: The maps differ in model, preprocessing, frame or code size, or have too many
            robots or sources.
    """
    check_same_kind(maps)
    tables = {
        "robots": _names(maps, "robots", ROBOT_LIMIT),
        "sources": _names(maps, "sources", SOURCE_LIMIT),
    }
    optional = tuple(name for name in OPTIONAL if any(name in each.optional for each in maps))
    frames = np.cumsum([0, *(len(each.frame_times) for each in maps)])
    aligned = [
        _renumbered(with_optional(each, optional), tables, int(before))
        for each, before in zip(maps, frames, strict=False)
    ]
    ids = np.concatenate([each.ids for each in aligned])
    rows = np.arange(len(ids))
    if without is not None:
        rows = np.delete(rows, without)
    rows = rows[np.argsort(ids[rows], kind="stable")]
    joined: dict[str, Any] = {
        name: np.concatenate([getattr(each, name) for each in aligned])[rows]
        for name in (*SEGMENT_COLUMNS, *optional)
    }
    if any(each.has_odometry for each in maps):
        maps = [with_odometry(each) for each in maps]
    for name in (*FRAME_COLUMNS, *ODOMETRY_COLUMNS):
        columns = [getattr(each, name) for each in maps]
        joined[name] = None if columns[0] is None else np.concatenate(columns)
    return canonical(replace(aligned[0], **joined))


def with_optional(compact_map: CompactMap, names: Iterable[str]) -> CompactMap:
    """Add missing optional columns to a map.

    Their values are 0 for `extents`, `points`, `classes` and `source`, the segment's own id for
    `views` and `source_ids`, and for `seen` the capture time, rounded down and clipped to uint32.
    """
    missing = [name for name in names if getattr(compact_map, name) is None]
    defaults: dict[str, Any] = {name: _default(compact_map, name) for name in missing}
    return replace(compact_map, **defaults)


def with_odometry(compact_map: CompactMap) -> CompactMap:
    """Add the columns of the odometry, if they are missing: no capture has an odometry."""
    if compact_map.has_odometry:
        return compact_map
    f = len(compact_map.frame_times)
    return replace(
        compact_map,
        frame_tracks=np.zeros(f, np.uint32),
        frame_odometry=np.zeros((f, ODOMETRY_WIDTH)),
    )


def places_of(names: tuple[str, ...], table: tuple[str, ...]) -> NDArray[np.int64]:
    """Return the index of each name in a table; -1 if it is missing."""
    places = {name: place for place, name in enumerate(table)}
    return np.array([places.get(name, -1) for name in names], np.int64)


def is_same_kind(one: CompactMap, other: CompactMap) -> bool:
    """Return whether two maps have the same model, preprocessing, frame and code size."""
    return _kind(one) == _kind(other)


def check_same_kind(maps: Sequence[CompactMap]) -> None:
    """Check that all maps have the same model, preprocessing, frame and code size.

    Raises:
        MapFileError: Two maps differ; the message names the property.
    """
    first = _kind(maps[0])
    for other in maps[1:]:
        for what, value in _kind(other).items():
            if value != first[what]:
                raise MapFileError(f"{what}: the maps have {first[what]!r} and {value!r}")


def _kind(compact_map: CompactMap) -> dict[str, str | int]:
    return {
        "model_id": compact_map.model_id,
        "preprocessing": compact_map.preprocessing,
        "frame": compact_map.frame,
        "code_bytes": compact_map.code_bytes,
    }


def _default(compact_map: CompactMap, name: str) -> NDArray[Any]:
    dtype, shape = OPTIONAL[name]
    if name in {"views", "source_ids"}:
        return compact_map.ids
    if name == "seen":
        seconds = np.floor(compact_map.frame_times).clip(0, np.iinfo(np.uint32).max)
        return seconds.astype(np.uint32)[compact_map.frame_index]
    return np.zeros((len(compact_map), *shape), dtype)


def _names(maps: Sequence[CompactMap], table: str, limit: int) -> tuple[str, ...]:
    """Return the names in the tables of all maps, without duplicates."""
    names = tuple({name: None for each in maps for name in getattr(each, table)})
    if len(names) > limit:
        raise MapFileError(f"{table}: {len(names)} names; the limit is {limit}")
    return names


def _renumbered(
    compact_map: CompactMap, tables: dict[str, tuple[str, ...]], frames_before: int
) -> CompactMap:
    """Replace the indices of a map by indices into the joined tables."""
    source = compact_map.source
    if source is not None:
        # Index 0 is the map itself, which has no name.
        places = places_of(("", *compact_map.sources), ("", *tables["sources"]))
        source = places.astype(np.uint16)[source]
    robots = places_of(compact_map.robots, tables["robots"]).astype(np.uint16)
    return replace(
        compact_map,
        robots=tables["robots"],
        robot=robots[compact_map.robot],
        frame_index=compact_map.frame_index + np.uint32(frames_before),
        source=source,
        sources=tables["sources"],
    )
