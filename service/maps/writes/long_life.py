"""Long life: each upload confirms stored segments, or finds that they are gone."""

from dataclasses import replace
from typing import Any

import numpy as np
from placecell_client import CompactMap, Delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import apply, take, with_optional
from scipy.spatial.transform import Rotation

from placecell.core.cancellation import current
from placecell.core.types import UInt8, UInt32
from placecell.lasting.judgment import ABSENT, CONFIRMED, ObservedSegments, judge
from placecell.pose_graph.frames import NO_TRACK, headings, wrapped
from service.maps.layers import MapLayers

PASS_SECONDS = 300
"""Time in which a segment is judged once: a pass. What was seen within it is there."""

REACH = 60.0
"""Distance from its captures in which an upload judges segments, meters."""

MOST_CAPTURES = 64
"""Largest number of captures of an upload that segments are judged from, the last ones."""

MOST_PAIRS = 2_000_000
"""Largest number of pairs of segments that an upload compares. The map is locked meanwhile."""

LEAST_TURN = 0.01
"""Turn of a track in the map from which boxes are turned too, radians: orientations are float32."""

COLUMNS = ("seen", "missed", "confirmed", "absent")

NONE: UInt32 = np.zeros(0, dtype=np.uint32)


def observed_segments(content: CompactMap) -> ObservedSegments:
    """Return the segments of a map with their boxes and captures; unknown sizes are zeros.

    The sides of a box are along the axes of its odometry track, which a merge or an optimization
    turns in the map. The box in the map is then the one around the turned box.
    """
    sides = np.zeros((len(content), 3)) if content.extents is None else content.extents / 10.0
    if content.frame_tracks is not None and content.frame_odometry is not None:
        rotations = Rotation.from_quat(content.frame_orientations).as_matrix()
        turns = headings(rotations) - content.frame_odometry[:, 3]
        turns[content.frame_tracks == NO_TRACK] = 0.0
        turns[np.abs(wrapped(turns)) < LEAST_TURN] = 0.0
        cos, sin = np.abs([np.cos(turns), np.sin(turns)])[:, content.frame_index]
        x, y, z = sides.T
        sides = np.column_stack([cos * x + sin * y, sin * x + cos * y, z])
    return ObservedSegments(
        centroids=content.centroids,
        sides=sides,
        viewpoints=content.frame_positions,
        captures=content.frame_index.astype(np.int64),
    )


def judged_by(
    upload: CompactMap, unique: CompactMap, refreshed: UInt32, removed: UInt32, layers: MapLayers
) -> tuple[CompactMap, UInt32]:
    """Count for stored segments whether an upload confirms or misses them.

    Args:
        upload: all segments of the upload, in canonical form, with `extents`.
        unique: segments to store after the deduplication.
        refreshed: ids of the stored segments among them, which were seen again.
        removed: ids that the edit removes.
        layers: the map as it is.

    Returns:
        The segments to store, with the judged ones, and the ids of all stored ones whose counts or
        `seen` changes.

    Raises:
        Cancelled: the deadline passed, or the client disconnected.
    """
    captures = np.arange(len(upload.frame_times))[-MOST_CAPTURES:]
    near = layers.near(upload.frame_positions[captures], REACH)
    near = take(near, ~np.isin(near.ids, np.concatenate([upload.ids, removed])))
    if not len(near):
        return unique, refreshed
    near = with_optional(near, COLUMNS)
    columns: dict[str, Any] = {name: np.array(getattr(near, name)) for name in COLUMNS}
    begun, now = (
        int(np.clip(np.floor(time), 0, np.iinfo(np.uint32).max))
        for time in (upload.frame_times[captures[0]], upload.frame_times[-1])
    )
    before = columns["seen"].astype(np.int64)
    again = np.isin(near.ids, refreshed)
    recent = again | (before + PASS_SECONDS >= begun)
    open_rows = np.flatnonzero(
        ~recent & (columns["missed"].astype(np.int64) + PASS_SECONDS < begun)
    )
    found = judge(
        observed_segments(take(near, open_rows)),
        _pass_of(upload, take(near, recent), int(captures[0])),
        current().check,
        MOST_PAIRS,
    )
    there = np.zeros(len(near), dtype=bool)
    there[open_rows[found == CONFIRMED]] = True
    columns["seen"][there] = now
    there |= again & (before + PASS_SECONDS < begun)
    gone = np.zeros(len(near), dtype=bool)
    gone[open_rows[found == ABSENT]] = True
    columns["confirmed"][there] = _one_more(columns["confirmed"][there])
    columns["absent"][there] = 0
    columns["absent"][gone] = _one_more(columns["absent"][gone])
    columns["missed"][gone] = now
    if not (there | gone).any():
        return unique, refreshed
    # The deduplication told when refreshed segments were seen.
    rows = np.searchsorted(unique.ids, near.ids[again])
    columns["seen"][again] = np.asarray(with_optional(unique, ["seen"]).seen)[rows]
    updates = canonical(take(replace(near, **columns), there | gone))
    changed = apply(unique, Delta(updates, NONE))
    return changed, np.union1d(refreshed, updates.ids)


def _pass_of(upload: CompactMap, recent: CompactMap, first: int) -> ObservedSegments:
    """Return all segments of a pass: those of the upload, and stored ones that it saw lately.

    Segments are judged from the captures of the upload, the first one and later ones.
    """
    own, others = observed_segments(upload), observed_segments(recent)
    captures = np.where(own.captures >= first, own.captures, -1)
    return ObservedSegments(
        np.concatenate([own.centroids, others.centroids]),
        np.concatenate([own.sides, others.sides]),
        own.viewpoints,
        np.concatenate([captures, np.full(len(others), -1)]),
    )


def _one_more(counts: UInt8) -> UInt8:
    return np.minimum(counts.astype(np.int64) + 1, 255).astype(np.uint8)
