"""Segments that are seen again: not stored once more, but known to be still there.

Things that stand still have their centroid in one place. What is seen there again, and looks as it
did or is seen from where it was, adds little to the map. Anything else is another view, from
another side or of more of the thing: kept, up to a number, for whoever comes that way
(`docs/results/storage.md` shows what that gains).
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
from placecell.core.types import Bool, Float64, Int8, Int32, Int64, UInt32
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer

RADIUS = 0.5
"""Metres between centroids of one thing. Of pairs this near, seen at different times, 85% were
tracked as one thing from frame to frame in `muehlburger_tor`; within 1 m, 76%."""

SAME_VIEW = 0.6
"""Of the distance below which the model calls a pair a match: views that look the same."""

SAME_STAND = 5.0
"""Metres between the sensor's positions: views from the same place."""

VIEWS = 8
"""Of a thing, at most."""

MOST_COMPARED = 1_024
"""Largest number of stored segments that a new one is compared with; the latest ones if more."""

MOST_VISITED = 4_096
"""Largest number of stored segments near a new one whose distance is checked, the latest ones."""

NO_VIEWS: Mapping[int, int] = MappingProxyType({})

NONE: UInt32 = np.zeros(0, dtype=np.uint32)


@dataclass(frozen=True, slots=True)
class SameView:
    """When two segments show the same.

    Attributes:
        quantizer: of the model that described them.
        steps: up to which their descriptors are apart, in the quantiser's steps.
    """

    quantizer: Quantizer
    steps: float

    @classmethod
    def of(cls, manifest: Manifest) -> "SameView":
        """For the segments that a model described."""
        quantizer = manifest.quantizer
        return cls(quantizer, SAME_VIEW * manifest.pair_threshold / quantizer.step)


@dataclass(frozen=True, slots=True, eq=False)
class Sighting:
    """What is left of an upload when its repeats are taken out.

    Attributes:
        changed: what is to be stored: new segments, further views of known things, and known
            segments that were seen again, with a later `seen`.
        refreshed: ids of the latter.
        repeats: segments of the upload that are not stored.
    """

    changed: CompactMap
    refreshed: UInt32
    repeats: int


def sighting(
    upload: CompactMap,
    stored: CompactMap,
    same: SameView,
    radius: float = RADIUS,
    same_stand: float = SAME_STAND,
    views: int = VIEWS,
    itself: bool = True,
    compared: Bool | None = None,
    views_elsewhere: Mapping[int, int] = NO_VIEWS,
) -> Sighting:
    """Compare an upload with the stored segments around it and with itself, in order of time.

    Memory is linear in the segments. So is time, but for a logarithm: a segment is compared with a
    bounded number of those that were kept (`MOST_COMPARED`, `MOST_VISITED`).

    Args:
        upload: segments; those whose id is stored are replaced, whatever they look like.
        stored: at least all segments of the map within `radius` of any of the upload, and those
            with an id of the upload.
        same: when two views are the same.
        radius: metres between centroids of one thing.
        same_stand: metres between sensors up to which two views are the same.
        views: of a thing, at most.
        itself: whether to compare it with itself, too.
        compared: of each stored segment whether it is compared, bool (stored,); the others count
            as views of their things. None: all are.
        views_elsewhere: segments of the map that are not in `stored`, by the thing (`views`) that
            they are views of.

    Raises:
        Cancelled: nobody waits for it any longer.
    """
    stored, given = _filled(stored), _filled(upload)
    # Those that replace others come in their turn, so that an upload that is sent again is told
    # the same.
    stays = ~np.isin(stored.ids, given.ids)
    known = take(stored, stays)
    is_compared = np.ones(len(known), dtype=bool) if compared is None else compared[stays]
    given = take(given, np.lexsort((given.ids, _moments(given))))
    given, replaces = _as_views_of(given, stored)

    both = [known, given]
    seen = np.concatenate([_column(each, "seen") for each in both])
    names, things = np.unique(
        np.concatenate([_column(each, "views") for each in both]), return_inverse=True
    )
    count = np.bincount(things[: len(known)], minlength=len(names))
    count += np.array([views_elsewhere.get(name, 0) for name in names.tolist()], dtype=np.int64)
    centroids = np.concatenate([each.centroids for each in both])
    numbers, around = neighboring(centroids, radius)
    is_kept = np.arange(len(seen)) < len(known)
    moments = np.concatenate([_moments(each) for each in both])
    token = current()
    _compare(
        centroids,
        numbers,
        around,
        moments,
        np.floor(moments).clip(0, np.iinfo(np.uint32).max).astype(np.uint32),
        _robots(known, given),
        np.concatenate([each.frame_positions[each.frame_index] for each in both]),
        same.quantizer.levels(np.concatenate([each.codes for each in both])),
        is_compared,
        replaces,
        itself,
        (float(radius), float(np.float32(same.steps)), float(same_stand), int(views)),
        (MOST_COMPARED, MOST_VISITED),
        token.flag,
        things,
        count,
        seen,
        is_kept,
    )
    token.check()
    views_of = names[things]

    of_known, of_given = slice(len(known)), slice(len(known), None)
    again = seen[of_known] > _column(known, "seen")
    refreshed = take(replace(known, seen=seen[of_known]), again)
    kept = take(replace(given, seen=seen[of_given], views=views_of[of_given]), is_kept[of_given])
    changed = apply(refreshed, Delta(canonical(kept), NONE))
    return Sighting(changed, refreshed.ids, len(given) - len(kept))


def count_elsewhere(content: CompactMap, stored: CompactMap) -> dict[int, int]:
    """Count the views that a map has of its segments' things, without these segments, by thing."""
    here, there = (_column(_filled(each), "views") for each in (stored, content))
    things, counts = np.unique(here, return_counts=True)
    if not len(things):
        return {}
    places = np.searchsorted(things, there).clip(max=len(things) - 1)
    every = np.bincount(places[things[places] == there], minlength=len(things))
    return dict(zip(things.tolist(), (every - counts).tolist(), strict=True))


def _filled(content: CompactMap) -> CompactMap:
    return with_optional(content, ["views", "seen"])


def _as_views_of(given: CompactMap, stored: CompactMap) -> tuple[CompactMap, Bool]:
    """Segments as given, but those that replace stored ones are views of what those are views of.

    Returns:
        The segments, and of each whether it replaces one.
    """
    if not len(stored):
        return given, np.zeros(len(given), dtype=bool)
    rows = np.searchsorted(stored.ids, given.ids).clip(max=len(stored) - 1)
    replaces = stored.ids[rows] == given.ids
    views = np.where(replaces, _column(stored, "views")[rows], _column(given, "views"))
    latest = np.maximum(_column(stored, "seen")[rows], _column(given, "seen"))
    seen = np.where(replaces, latest, _column(given, "seen"))
    return replace(given, views=views, seen=seen), replaces


def _column(content: CompactMap, name: str) -> UInt32:
    return np.asarray(getattr(content, name))


def _robots(known: CompactMap, given: CompactMap) -> Int64:
    """Number the robots of two maps' segments, int64 (known + given,), one number per name."""
    numbers = {name: number for number, name in enumerate({*known.robots, *given.robots})}
    return np.concatenate(
        [
            np.array([numbers[name] for name in each.robots], np.int64)[each.robot]
            for each in (known, given)
        ]
    )


def _moments(content: CompactMap) -> Float64:
    return content.frame_times[content.frame_index]


@compiled
def _compare(
    centroids: Float64,
    numbers: Int64,
    around: Int64,
    moments: Float64,
    captured: UInt32,
    robots: Int64,
    stands: Float64,
    levels: Int8,
    is_compared: Bool,
    replaces: Bool,
    itself: bool,
    limits: tuple[float, float, float, int],
    most: tuple[int, int],
    flag: Int32,
    things: Int64,
    count: Int64,
    seen: UInt32,
    is_kept: Bool,
) -> None:
    """Decide for each given segment, in order, whether it is kept.

    Rows are the known segments, then the given ones. What is kept stands in a list of its cell,
    the latest first.

    Args:
        numbers: the cell of each row.
        around: of each cell, see `neighboring`.
        captured: moments in whole seconds.
        robots: whose each row is, by number.
        limits: radius, steps of the same look, meters of the same stand, views of a thing.
        most: how many are compared and visited.
        things, count, seen, is_kept: are filled; `count` by thing.
    """
    radius, steps, same_stand, views = limits
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
                row, centroids, around[numbers[row]], heads, following, moments, stands, radius,
                most[1], others,
            )  # fmt: skip
        if found:
            nearest, distance = _most_alike(row, others[:found], levels)
            thing = things[nearest]
            away = np.inf
            for place in range(found):
                other = others[place]
                if things[other] == thing:
                    squared = 0.0
                    for axis in range(3):
                        squared += (stands[other, axis] - stands[row, axis]) ** 2
                    away = min(away, np.sqrt(squared))
            if distance <= steps or away <= same_stand or count[thing] >= views:
                when = seen[row]
                if robots[nearest] != robots[row]:
                    # For another robot's segment it speaks of its own capture alone.
                    when = min(when, captured[row])
                seen[nearest] = max(seen[nearest], when)
                continue
            things[row] = thing
        is_kept[row] = True
        count[things[row]] += 1
        if itself:
            following[row] = heads[numbers[row]]
            heads[numbers[row]] = row


@compiled
def _comparable(
    row: int,
    centroids: Float64,
    around: Int64,
    heads: Int64,
    following: Int64,
    moments: Float64,
    stands: Float64,
    radius: float,
    most_visited: int,
    others: Int64,
) -> int:
    """Fill `others` with what was kept near a row; return their number.

    What was seen at the same moment, by the same sensor, is something else.
    """
    found = visited = 0
    # The row's own cell comes first: what is nearest is compared where there is too much.
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
                moments[other] != moments[row]
                or stands[other, 0] != stands[row, 0]
                or stands[other, 1] != stands[row, 1]
                or stands[other, 2] != stands[row, 2]
            ):
                others[found] = other
                found += 1
            other = following[other]
    return found


@compiled
def _most_alike(row: int, others: Int64, levels: Int8) -> tuple[int, float]:
    """Return the segment of `others` most similar to a row, the first of equals, and its distance.

    Distances are float32, as those of descriptors are; squares of levels are whole numbers.
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
