"""Long life: each upload confirms stored segments, or finds that they are gone."""

from dataclasses import replace
from typing import Any

import numpy as np
from placecell_client import CompactMap, Delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.compact_map import OPTIONAL
from placecell_client.maps.edit import apply, take, with_optional
from scipy.spatial.transform import Rotation

from placecell.core.cancellation import current
from placecell.core.types import Bool, Float64, Int64, UInt32
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


class SegmentCounts:
    """Counts of the passes that confirmed or missed some segments, while passes are judged.

    Attributes:
        seen: int64 (n,), time when each segment was last seen, whole seconds.
        changed: bool (n,), segments whose counts changed.
    """

    def __init__(self, content: CompactMap) -> None:
        """Begin with the counts of a map."""
        self._content = with_optional(content, COLUMNS)
        self._columns = {
            name: np.asarray(getattr(self._content, name)).astype(np.int64) for name in COLUMNS
        }
        self.seen = self._columns["seen"]
        self.changed = np.zeros(len(content), dtype=bool)

    def seen_since(self, begun: int) -> Bool:
        """Return which segments were seen in or after a pass that begins then, bool (n,)."""
        return np.asarray(self.seen + PASS_SECONDS >= begun)

    def missed_since(self, begun: int) -> Bool:
        """Return which segments were missed in or after a pass that begins then, bool (n,)."""
        return np.asarray(self._columns["missed"] + PASS_SECONDS >= begun)

    def confirm(self, rows: Int64 | Bool) -> None:
        """Count a pass that saw these segments."""
        self._columns["confirmed"][rows] += 1
        self._columns["absent"][rows] = 0
        self.changed[rows] = True

    def judge(
        self,
        rows: Int64,
        stored: ObservedSegments,
        later: ObservedSegments,
        now: int,
        most_pairs: int | None = None,
    ) -> None:
        """Count a pass that may have seen or missed segments.

        Args:
            rows: rows of the segments to judge, int64 (m,).
            stored: these segments.
            later: all segments of the pass.
            now: time of the pass, whole seconds.
            most_pairs: largest number of pairs of segments to compare; see `judge`.

        Raises:
            Cancelled: the deadline passed, or the client disconnected.
        """
        found = judge(stored, later, current().check, most_pairs)
        there, gone = rows[found == CONFIRMED], rows[found == ABSENT]
        self.seen[there] = now
        self.confirm(there)
        self._columns["absent"][gone] += 1
        self._columns["missed"][gone] = now
        self.changed[gone] = True

    def counted(self) -> CompactMap:
        """Return the segments with their counts."""
        columns: dict[str, Any] = {
            name: values.clip(max=np.iinfo(OPTIONAL[name][0]).max).astype(OPTIONAL[name][0])
            for name, values in self._columns.items()
        }
        return replace(self._content, **columns)


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
    counts = SegmentCounts(near)
    begun, now = whole_seconds(upload.frame_times[[captures[0], -1]]).tolist()
    again = np.isin(near.ids, refreshed)
    before = counts.seen_since(begun)
    recent = again | before
    rows = np.flatnonzero(~recent & ~counts.missed_since(begun))
    counts.judge(
        rows,
        observed_segments(take(near, rows)),
        _pass_of(upload, take(near, recent), int(captures[0])),
        now,
        MOST_PAIRS,
    )
    counts.confirm(again & ~before)
    if not counts.changed.any():
        return unique, refreshed
    # The deduplication told when refreshed segments were seen.
    rows = np.searchsorted(unique.ids, near.ids[again])
    counts.seen[again] = np.asarray(with_optional(unique, ["seen"]).seen)[rows]
    updates = canonical(take(counts.counted(), counts.changed))
    changed = apply(unique, Delta(updates, NONE))
    return changed, np.union1d(refreshed, updates.ids)


def whole_seconds(times: Float64) -> Int64:
    """Return times as `seen` and `missed` have them: whole seconds, clipped to uint32."""
    return np.floor(times).clip(0, np.iinfo(np.uint32).max).astype(np.int64)


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
