"""Judgment of segments by a later pass: each is confirmed, changed, absent, or was not in sight.

A segment is missed only if it should have been seen: from a capture as near as the one that saw it,
with a free line of sight, and with a segment behind it that this capture did see.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.types import Bool, Float64, Int8, Int64

UNSEEN, CONFIRMED, CHANGED, ABSENT = 0, 1, 2, 3
"""Verdicts: it was not in sight; it is there; something else is there; nothing is there."""

SAME_PLACE = 0.5
"""Distance of centroids up to which two segments are the same object, meters; the deduplication
has the same one."""

SAME_BOX = 0.3
"""Share of the common volume in the volume of both boxes from which they are the same object."""

MARGIN = 0.5
"""Depth by which a segment must be nearer or farther to count so, meters."""

LEAST_REACH = 8.0
"""Distance up to which every segment should be seen, from however near it was seen, meters."""

UNKNOWN_HALF = 0.3
"""Half side of the box of a segment whose size is unknown, meters."""

SURE = np.array([0.5, 0.5, 0.9])
"""Share of a box's sides whose inside surely ends a ray: a wall that stands askew in its box fills
only the middle, but over all its height."""

HEIGHTS = (0.0, 0.6)
"""Heights of the points of a segment that should be seen, as a share of its half height above its
centroid. The upper ones of low things have more behind them than the ground."""

NEIGHBORS = 60.0
"""Distance from a capture up to which segments can hide others or stand behind them, meters."""


@dataclass(frozen=True, slots=True, eq=False)
class ObservedSegments:
    """Segments and the captures that saw them: n segments, f captures, in one level frame.

    Attributes:
        centroids: float64 (n, 3), meters.
        sides: float64 (n, 3), sides of the axis-aligned boxes, meters; zeros: unknown.
        viewpoints: float64 (f, 3), sensor positions of the captures, meters.
        captures: int64 (n,), capture of each segment; -1 in a pass: none that the pass is judged
            from.
    """

    centroids: Float64
    sides: Float64
    viewpoints: Float64
    captures: Int64

    def __len__(self) -> int:
        return len(self.centroids)

    @property
    def halves(self) -> Float64:
        """Half sides of the boxes, float64 (n, 3); those of unknown size are small."""
        return np.where(self.sides > 0, self.sides / 2, UNKNOWN_HALF)

    def take(self, rows: Int64 | Bool) -> "ObservedSegments":
        """Return some segments, with all captures."""
        return ObservedSegments(
            self.centroids[rows], self.sides[rows], self.viewpoints, self.captures[rows]
        )


def judge(
    stored: ObservedSegments,
    later: ObservedSegments,
    check: Callable[[], None] = lambda: None,
    most_pairs: int | None = None,
) -> Int8:
    """Judge stored segments by a later pass, int8 (stored,): one of the verdicts.

    Args:
        stored: the segments.
        later: all segments that the pass saw, also those that it found stored already.
        check: is called often; it may raise to cancel the work.
        most_pairs: largest number of pairs of a stored and a later segment to compare, which bounds
            the time. If there are more, segments are judged from every second capture, or fewer.
            None: no limit.
    """
    verdicts = np.full(len(stored), UNSEEN, dtype=np.int8)
    if not len(stored) or not len(later):
        return verdicts
    reach = _reach(stored)
    if most_pairs is not None:
        later = thinned(stored, later, most_pairs)
    for capture in _judging(later).tolist():
        check()
        viewpoint = later.viewpoints[capture]
        distance = np.linalg.norm(stored.centroids - viewpoint, axis=1)
        rows = np.flatnonzero((distance <= reach) & (verdicts != CONFIRMED))
        near = _around(later, viewpoint)
        if not len(rows) or not near.any():
            continue
        around = later.take(near)
        found = _judged_from(viewpoint, stored.take(rows), around, around.captures == capture)
        # Absence from one capture is enough, unless another one sees the segment.
        verdicts[rows] = np.where(found == CONFIRMED, CONFIRMED, np.maximum(verdicts[rows], found))
    return verdicts


def thinned(stored: ObservedSegments, later: ObservedSegments, most_pairs: int) -> ObservedSegments:
    """Return a pass that judges segments from every second capture, or fewer.

    Args:
        stored: the segments.
        later: all segments of the pass.
        most_pairs: largest number of pairs of a stored and a later segment to compare.
    """
    captures, reach = _judging(later), _reach(stored)
    pairs = sum(
        int((np.linalg.norm(stored.centroids - later.viewpoints[each], axis=1) <= reach).sum())
        * int(_around(later, later.viewpoints[each]).sum())
        for each in captures.tolist()
    )
    kept = np.isin(later.captures, captures[:: max(1, -(-pairs // most_pairs))])
    return replace(later, captures=np.where(kept, later.captures, -1))


def _judging(later: ObservedSegments) -> Int64:
    """Return the captures that a pass is judged from, int64 (captures,)."""
    return np.unique(later.captures[later.captures >= 0])


def _reach(stored: ObservedSegments) -> Float64:
    """Return the distance up to which each segment should be seen, meters, float64 (n,)."""
    away = np.linalg.norm(stored.centroids - stored.viewpoints[stored.captures], axis=1)
    return np.asarray(np.maximum(away, LEAST_REACH))


def _around(later: ObservedSegments, viewpoint: Float64) -> Bool:
    """Return which segments of a pass lie around a capture, bool (later,)."""
    return np.asarray(np.linalg.norm(later.centroids - viewpoint, axis=1) <= NEIGHBORS)


def _judged_from(
    viewpoint: Float64, stored: ObservedSegments, around: ObservedSegments, own: Bool
) -> Int8:
    """Judge segments in reach of one capture.

    Args:
        viewpoint: sensor position of the capture, (3,).
        stored: the segments.
        around: segments of the pass around the capture.
        own: which of them the capture itself saw.
    """
    gaps = np.abs(stored.centroids[:, None] - around.centroids[None])
    halves, others = stored.halves[:, None], around.halves[None]
    same = np.linalg.norm(gaps, axis=2) <= SAME_PLACE
    same |= _common_share(gaps, halves, others) >= SAME_BOX
    touches: Bool = np.asarray((gaps <= halves + others).all(axis=2))
    inside: Bool = np.asarray((gaps <= halves).all(axis=2))
    in_sight = np.zeros(len(stored), dtype=bool)
    hidden = np.zeros(len(stored), dtype=bool)
    for height in HEIGHTS:
        targets = stored.centroids + stored.halves * [0.0, 0.0, height]
        rays = targets - viewpoint
        length = np.linalg.norm(rays, axis=1)[:, None]
        # Boxes that are no sure occluders hide as well: in doubt, nothing is missed.
        entered = _entries(viewpoint, rays, around.centroids, around.halves)
        hides = np.any((entered < length - MARGIN) & ~touches, axis=1)
        surely = _entries(viewpoint, rays, around.centroids, SURE * around.sides / 2)
        behind = np.any((surely > length + MARGIN) & np.isfinite(surely) & own, axis=1)
        in_sight |= behind & ~hides
        hidden |= hides
    found = np.full(len(stored), UNSEEN, dtype=np.int8)
    found[in_sight & ~touches.any(axis=1)] = ABSENT
    # Something that this capture saw inside the old box stands there now.
    found[(inside & own).any(axis=1) & ~hidden] = CHANGED
    found[same.any(axis=1)] = CONFIRMED
    return found


def _common_share(gaps: Float64, halves: Float64, others: Float64) -> Float64:
    """Return the volume of the intersection of boxes as a share of that of their union, (n, m)."""
    overlap = np.minimum(halves + others - gaps, 2 * np.minimum(halves, others)).clip(min=0)
    common = overlap.prod(axis=2)
    volume = (2 * halves).prod(axis=2) + (2 * others).prod(axis=2)
    return np.asarray(common / (volume - common))


def _entries(viewpoint: Float64, rays: Float64, centroids: Float64, halves: Float64) -> Float64:
    """Return the distance at which each ray (n, 3) enters each box (m, 3), meters, (n, m).

    Infinite where a ray misses a box, or the box has no size along an axis.
    """
    length = np.linalg.norm(rays, axis=1)[:, None, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = rays[:, None] / length
        low = (centroids - halves - viewpoint)[None] / steps
        high = (centroids + halves - viewpoint)[None] / steps
    enter = np.nanmax(np.minimum(low, high), axis=2)
    leave = np.nanmin(np.maximum(low, high), axis=2)
    flat: Bool = np.asarray(halves.min(axis=1) <= 0, dtype=bool)
    misses = (enter > leave) | (leave < 0) | flat
    return np.where(misses, np.inf, np.maximum(enter, 0.0))
