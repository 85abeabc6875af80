"""Judging: counts for the segments of a merged map what the captures of the maps confirm or miss.

The captures of a map are judged as its uploads would have been, in order of time: in passes of at
most 64 captures. A pass that was judged is not judged again, so merging again changes nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from placecell_client import CompactMap

from placecell.core.cancellation import current
from placecell.core.spatial import within
from placecell.core.types import Int64, UInt32
from placecell.lasting.judgment import NEIGHBORS, ObservedSegments, thinned
from placecell.map_alignment import AlignmentParameters
from service.maps.writes.long_life import (
    MOST_CAPTURES,
    MOST_PAIRS,
    PASS_SECONDS,
    REACH,
    SegmentCounts,
    observed_segments,
    whole_seconds,
)
from service.merging.join import MergePart, at_known_pose, last_seen, placed_in
from service.merging.provenance import shared

SAME, MOST_PLACES = 0.3, 0.9
"""Distance within which this share of a map's segments must lie where the merged map has them,
meters: farther off, segments that still stand there are found absent (`docs/results/drift.md`)."""

MOST_PAIRS_OF_A_MERGE = 64_000_000
"""Largest number of pairs of segments that a merge compares, which bounds its time."""


@dataclass(frozen=True, slots=True, eq=False)
class JudgedMap:
    """Merged map whose segments were judged.

    Attributes:
        content: the map with the counts.
        ids: ids of the segments whose counts changed, uint32 (m,).
    """

    content: CompactMap
    ids: UInt32


@dataclass(frozen=True, slots=True, eq=False)
class _Pass:
    """Captures of a map that are judged together.

    Attributes:
        part: segments of the map, in the merged map's frame.
        captures: int64 (c,), the captures, in order of time.
        begun: time of the first one, whole seconds.
        now: time of the last one.
    """

    part: CompactMap
    captures: Int64
    begun: int
    now: int

    def observed(self) -> ObservedSegments:
        """Return the segments of the map that stood there during the pass.

        Segments are judged from the captures of the pass only.
        """
        part = self.part
        rows = within(part.centroids, part.frame_positions[self.captures], NEIGHBORS)
        first = whole_seconds(part.frame_times)[part.frame_index[rows]]
        last = last_seen(part)[rows].astype(np.int64)
        rows = rows[(first <= self.now + PASS_SECONDS) & (last >= self.begun - PASS_SECONDS)]
        found = observed_segments(part).take(rows)
        own = np.isin(found.captures, self.captures)
        return ObservedSegments(
            found.centroids, found.sides, found.viewpoints, np.where(own, found.captures, -1)
        )


def judged_map(
    content: CompactMap,
    before: CompactMap | None,
    parts: Sequence[MergePart],
    parameters: AlignmentParameters,
) -> JudgedMap:
    """Judge the segments of a merged map by the captures of its parts.

    A part without `extents` judges nothing, and neither does one whose captures were moved in the
    merged map and that states no odometry, because its segments cannot follow them.

    Args:
        content: the merged map with its parts, in canonical form.
        before: the merged map before the merge; None if there was none.
        parts: the maps.
        parameters: parameters of the alignments.

    Raises:
        Cancelled: the deadline passed, or the client disconnected.
    """
    placed = (
        placed_in(content, at_known_pose(content, part, parameters))
        for part in parts
        if part.content.extents is not None and len(part.content)
    )
    passes = sorted(
        (each for part in placed if _lies_as_merged(part, content) for each in _passes_of(part)),
        key=lambda each: (each.begun, each.now),
    )
    if not passes or not len(content):
        return JudgedMap(content, content.ids[:0])
    counts = SegmentCounts(content)
    # The join has told when other maps' segments were seen again.
    counts.confirm(counts.seen > seen_before(content, before, parts) + PASS_SECONDS)
    observed = observed_segments(content)
    most_pairs = min(MOST_PAIRS, MOST_PAIRS_OF_A_MERGE // len(passes))
    token = current()
    for each in passes:
        token.check()
        near = within(content.centroids, each.part.frame_positions[each.captures], REACH)
        is_open = ~counts.seen_since(each.begun)[near] & ~counts.missed_since(each.begun)[near]
        if not is_open.any():
            continue
        # Thinned by all segments: fewer are open when maps are merged again.
        later = thinned(observed.take(near), each.observed(), most_pairs)
        counts.judge(near[is_open], observed.take(near[is_open]), later, each.now)
    if not counts.changed.any():
        return JudgedMap(content, content.ids[:0])
    return JudgedMap(counts.counted(), content.ids[counts.changed])


def seen_before(
    content: CompactMap, before: CompactMap | None, parts: Sequence[MergePart]
) -> Int64:
    """Return when each segment was last seen by its own map or an earlier merge, int64 (n,)."""
    seen = np.zeros(len(content), dtype=np.int64)
    if before is not None and len(before):
        places = np.searchsorted(before.ids, content.ids).clip(max=len(before) - 1)
        known = before.ids[places] == content.ids
        seen[known] = last_seen(before)[places[known]]
    for part in parts:
        rows, places = shared(content, part.content)
        np.maximum.at(seen, rows, last_seen(part.content)[places].astype(np.int64))
    return seen


def _lies_as_merged(placed: CompactMap, content: CompactMap) -> bool:
    """Return whether a part's segments lie where the merged map has them."""
    rows, places = shared(placed, content)
    off = np.linalg.norm(placed.centroids[rows] - content.centroids[places], axis=1)
    return not len(off) or float(np.quantile(off, MOST_PLACES)) <= SAME


def _passes_of(part: CompactMap) -> list[_Pass]:
    """Return the captures of a map in passes, in order of time."""
    order = np.argsort(part.frame_times, kind="stable")
    times = part.frame_times[order]
    gaps = np.flatnonzero(np.diff(times) > PASS_SECONDS) + 1
    passes = []
    for captures in np.split(order, gaps):
        for begin in range(0, len(captures), MOST_CAPTURES):
            some = captures[begin : begin + MOST_CAPTURES]
            begun, now = whole_seconds(part.frame_times[some[[0, -1]]]).tolist()
            passes.append(_Pass(part, some, begun, now))
    return passes
