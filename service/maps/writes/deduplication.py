"""Deduplication: does not store a segment again that was seen before, and notes when it was seen.

A static object has its centroid in one place. A new segment near a stored one adds little to the
map if both look the same or were seen from the same viewpoint. Otherwise it is another view of the
object. The map keeps a limited number of views of each object, for robots that come from other
sides (`docs/results/storage.md` shows the gain).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from placecell_client import CompactMap, Delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import apply, take, with_optional

from placecell.core.cancellation import current, is_cancelled
from placecell.core.grid_cells import neighboring
from placecell.core.jit import compiled
from placecell.core.segment_classes import STEPS, UNKNOWN, most_probable
from placecell.core.types import Bool, Float64, Int8, Int32, Int64, UInt8, UInt32
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer
from service.maps.layers import classes_of

RADIUS = 0.5
"""Largest distance in meters between centroids of views of one object. In `muehlburger_tor`, 85% of
pairs this near, seen at different times, were tracked as one object; within 1 m, 76%."""

SAME_VIEW = 0.6
"""Distance of views that look the same, as a share of the model's match threshold."""

SAME_VIEWPOINT = 5.0
"""Largest distance in meters between sensor positions that count as one viewpoint."""

VIEWS = 8
"""Largest number of views of an object."""

MOST_COMPARED = 1_024
"""Largest number of stored segments that a new one is compared with; the latest ones if more."""

MOST_VISITED = 4_096
"""Largest number of stored segments near a new one whose distance is checked, the latest ones."""

NO_VIEWS: Mapping[int, int] = MappingProxyType({})

NONE: UInt32 = np.zeros(0, dtype=np.uint32)


@dataclass(frozen=True, slots=True)
class SameView:
    """Criterion for views that look the same.

    Attributes:
        quantizer: quantizer of the model that described the segments.
        steps: largest distance of their descriptors, in the quantizer's steps.
    """

    quantizer: Quantizer
    steps: float

    @classmethod
    def of(cls, manifest: Manifest) -> "SameView":
        """Return the criterion for segments that a model described."""
        quantizer = manifest.quantizer
        return cls(quantizer, SAME_VIEW * manifest.pair_threshold / quantizer.step)


@dataclass(frozen=True, slots=True, eq=False)
class Deduplicated:
    """Upload without repeats.

    Attributes:
        changed: segments to store: new segments, further views of known objects, and known
            segments that were seen again, with a later `seen`.
        refreshed: ids of the known segments among them.
        repeats: number of segments of the upload that are not stored.
    """

    changed: CompactMap
    refreshed: UInt32
    repeats: int


def deduplicate(
    upload: CompactMap,
    stored: CompactMap,
    same: SameView,
    radius: float = RADIUS,
    same_viewpoint: float = SAME_VIEWPOINT,
    views: int = VIEWS,
    itself: bool = True,
    compared: Bool | None = None,
    views_elsewhere: Mapping[int, int] = NO_VIEWS,
) -> Deduplicated:
    """Compare an upload with nearby stored segments and with itself, in order of time.

    Memory and time are linear in the segments, apart from a logarithm: a segment is compared with
    a bounded number of kept ones (`MOST_COMPARED`, `MOST_VISITED`).

    Args:
        upload: the segments. A segment whose id is stored replaces that segment in any case.
        stored: at least all segments of the map within `radius` of any of the upload, and those
            with an id of the upload.
        same: criterion for views that look the same.
        radius: largest distance in meters between centroids of views of one object.
        same_viewpoint: largest distance in meters between sensor positions of one viewpoint.
        views: largest number of views of an object.
        itself: whether to compare the upload with itself, too.
        compared: which stored segments are compared, bool (stored,); the others only count as
            views of their objects. None: all are compared.
        views_elsewhere: number of segments of the map that are not in `stored`, by the object
            (`views`) that they are views of.

    Raises:
        Cancelled: the deadline passed, or the client disconnected.
    """
    stored, given = _filled(stored), _filled(upload)
    has_classes = stored.classes is not None or given.classes is not None
    if has_classes:
        stored, given = (with_optional(each, ["classes"]) for each in (stored, given))
    # A segment that replaces one is handled in order of time as well, so that a repeated upload
    # has the same result.
    stays = ~np.isin(stored.ids, given.ids)
    known = take(stored, stays)
    is_compared = np.ones(len(known), dtype=bool) if compared is None else compared[stays]
    given = take(given, np.lexsort((given.ids, _times_of(given))))
    given, replaces = _as_views_of(given, stored)

    both = [known, given]
    seen = np.concatenate([_column(each, "seen") for each in both])
    names, objects = np.unique(
        np.concatenate([_column(each, "views") for each in both]), return_inverse=True
    )
    count = np.bincount(objects[: len(known)], minlength=len(names))
    count += np.array([views_elsewhere.get(name, 0) for name in names.tolist()], dtype=np.int64)
    centroids = np.concatenate([each.centroids for each in both])
    numbers, around = neighboring(centroids, radius)
    is_kept = np.arange(len(seen)) < len(known)
    classes = np.concatenate([classes_of(each) for each in both])
    times = np.concatenate([_times_of(each) for each in both])
    token = current()
    _compare(
        centroids,
        numbers,
        around,
        times,
        np.floor(times).clip(0, np.iinfo(np.uint32).max).astype(np.uint32),
        _robots(known, given),
        np.concatenate([each.frame_positions[each.frame_index] for each in both]),
        same.quantizer.levels(np.concatenate([each.codes for each in both])),
        is_compared,
        replaces,
        itself,
        (float(radius), float(np.float32(same.steps)), float(same_viewpoint), int(views)),
        (MOST_COMPARED, MOST_VISITED),
        token.flag,
        objects,
        count,
        seen,
        classes,
        is_kept,
    )
    token.check()
    views_of = names[objects]

    of_known, of_given = slice(len(known)), slice(len(known), None)
    again = seen[of_known] > _column(known, "seen")
    if has_classes:
        again |= classes[of_known] != classes_of(known)
        known = replace(known, classes=classes[of_known])
        given = replace(given, classes=classes[of_given])
    refreshed = take(replace(known, seen=seen[of_known]), again)
    kept = take(replace(given, seen=seen[of_given], views=views_of[of_given]), is_kept[of_given])
    changed = apply(refreshed, Delta(canonical(kept), NONE))
    return Deduplicated(changed, refreshed.ids, len(given) - len(kept))


def count_elsewhere(content: CompactMap, stored: CompactMap) -> dict[int, int]:
    """Count a map's views of these segments' objects outside these segments, by object."""
    here, there = (_column(_filled(each), "views") for each in (stored, content))
    objects, counts = np.unique(here, return_counts=True)
    if not len(objects):
        return {}
    places = np.searchsorted(objects, there).clip(max=len(objects) - 1)
    every = np.bincount(places[objects[places] == there], minlength=len(objects))
    return dict(zip(objects.tolist(), (every - counts).tolist(), strict=True))


def _filled(content: CompactMap) -> CompactMap:
    return with_optional(content, ["views", "seen"])


def _as_views_of(given: CompactMap, stored: CompactMap) -> tuple[CompactMap, Bool]:
    """Give segments that replace stored ones the `views` of those and the later `seen`.

    Returns:
        The segments, and which of them replace a stored one.
    """
    if not len(stored):
        return given, np.zeros(len(given), dtype=bool)
    rows = np.searchsorted(stored.ids, given.ids).clip(max=len(stored) - 1)
    replaces = stored.ids[rows] == given.ids
    views = np.where(replaces, _column(stored, "views")[rows], _column(given, "views"))
    latest = np.maximum(_column(stored, "seen")[rows], _column(given, "seen"))
    seen = np.where(replaces, latest, _column(given, "seen"))
    if given.classes is not None and stored.classes is not None:
        likeliest = most_probable(stored.classes[rows], given.classes)
        given = replace(given, classes=np.where(replaces, likeliest, given.classes))
    return replace(given, views=views, seen=seen), replaces


def _column(content: CompactMap, name: str) -> UInt32:
    return np.asarray(getattr(content, name))


def _robots(known: CompactMap, given: CompactMap) -> Int64:
    """Assign a number to each robot name of two maps, int64 (known + given,) by segment."""
    numbers = {name: number for number, name in enumerate({*known.robots, *given.robots})}
    return np.concatenate(
        [
            np.array([numbers[name] for name in each.robots], np.int64)[each.robot]
            for each in (known, given)
        ]
    )


def _times_of(content: CompactMap) -> Float64:
    return content.frame_times[content.frame_index]


@compiled
def _compare(
    centroids: Float64,
    numbers: Int64,
    around: Int64,
    times: Float64,
    captured: UInt32,
    robots: Int64,
    viewpoints: Float64,
    levels: Int8,
    is_compared: Bool,
    replaces: Bool,
    itself: bool,
    limits: tuple[float, float, float, int],
    most: tuple[int, int],
    flag: Int32,
    objects: Int64,
    count: Int64,
    seen: UInt32,
    classes: UInt8,
    is_kept: Bool,
) -> None:
    """Decide for each given segment, in order, whether it is kept.

    Rows are the known segments, then the given ones. Each cell has a linked list of its kept rows,
    the latest first.

    Args:
        numbers: cell of each row.
        around: neighbors of each cell, see `neighboring`.
        captured: times of capture in whole seconds.
        robots: robot of each row, by number.
        limits: radius, steps of the same look, meters of the same viewpoint, views of an object.
        most: largest numbers of rows compared and visited.
        objects, count, seen, classes, is_kept: are filled; `count` by object. A segment takes the
            class of a repeat that is more probable than its own.
    """
    radius, steps, same_viewpoint, views = limits
    first_given = len(is_compared)
    heads = np.full(len(around), -1, dtype=np.int64)
    following = np.empty(len(numbers), dtype=np.int64)
    others = np.empty(most[0], dtype=np.int64)
    for row in range(first_given):
        if is_compared[row]:
            following[row] = heads[numbers[row]]
            heads[numbers[row]] = row
    for row in range(first_given, len(numbers)):
        if is_cancelled(flag):
            return
        found = 0
        if not replaces[row - first_given]:
            found = _comparable(
                row, centroids, around[numbers[row]], heads, following, times, viewpoints, radius,
                most[1], others,
            )  # fmt: skip
        if found:
            nearest, distance = _most_alike(row, others[:found], levels)
            object_ = objects[nearest]
            away = np.inf
            for place in range(found):
                other = others[place]
                if objects[other] == object_:
                    squared = 0.0
                    for axis in range(3):
                        squared += (viewpoints[other, axis] - viewpoints[row, axis]) ** 2
                    away = min(away, np.sqrt(squared))
            if distance <= steps or away <= same_viewpoint or count[object_] >= views:
                when = seen[row]
                if robots[nearest] != robots[row]:
                    # A robot confirms another robot's segment only for its own time of capture.
                    when = min(when, captured[row])
                seen[nearest] = max(seen[nearest], when)
                classes[nearest] = _likelier(classes[nearest], classes[row])
                continue
            objects[row] = object_
        is_kept[row] = True
        count[objects[row]] += 1
        if itself:
            following[row] = heads[numbers[row]]
            heads[numbers[row]] = row


@compiled
def _likelier(one: int, other: int) -> int:
    """Return the more probable of two classes; of equals, the first. See `most_probable`."""
    if UNKNOWN in (one, other):
        return max(one, other)
    return other if (other - 1) % (STEPS + 1) > (one - 1) % (STEPS + 1) else one


@compiled
def _comparable(
    row: int,
    centroids: Float64,
    around: Int64,
    heads: Int64,
    following: Int64,
    times: Float64,
    viewpoints: Float64,
    radius: float,
    most_visited: int,
    others: Int64,
) -> int:
    """Fill `others` with kept rows near a row; return their number.

    Rows seen at the same time by the same sensor are other objects and left out.
    """
    found = visited = 0
    # The row's own cell comes first, so that the nearest rows are compared if there are many.
    for cell in around:
        if cell < 0:
            break
        other = heads[cell]
        while other >= 0:
            if found == len(others) or visited == most_visited:
                return found
            visited += 1
            squared = 0.0
            for axis in range(3):
                squared += (centroids[other, axis] - centroids[row, axis]) ** 2
            if squared <= radius * radius and (
                times[other] != times[row]
                or viewpoints[other, 0] != viewpoints[row, 0]
                or viewpoints[other, 1] != viewpoints[row, 1]
                or viewpoints[other, 2] != viewpoints[row, 2]
            ):
                others[found] = other
                found += 1
            other = following[other]
    return found


@compiled
def _most_alike(row: int, others: Int64, levels: Int8) -> tuple[int, float]:
    """Return the row of `others` most similar to a row, the first of equals, and its distance.

    Distances are float32, as those of descriptors are; squares of levels are integers.
    """
    nearest, least = -1, np.float32(np.inf)
    for other in others:
        squared = np.int32(0)
        for place in range(levels.shape[1]):
            away = np.int32(levels[other, place]) - np.int32(levels[row, place])
            squared = np.int32(squared + np.int32(away * away))
        distance = np.sqrt(np.float32(squared))
        if distance < least or (distance == least and other < nearest):
            nearest, least = other, distance
    return nearest, float(least)
