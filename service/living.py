"""Segments that are seen again: not stored once more, but known to be still there.

Things that stand still have their centroid in one place. What is seen there again, and looks as it
did or is seen from where it was, adds little to the map. Anything else is another view, from
another side or of more of the thing: kept, up to a number, for whoever comes that way
(`docs/maps.md` shows what that gains).
"""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from placecell_client import CompactMap, Delta
from placecell_client.canonical import canonical
from placecell_client.map_edit import apply, take, with_optional
from scipy.spatial import KDTree

from segments.manifest import Manifest
from segments.quantiser import Quantiser
from segments.types import Bool, Float64, UInt32

RADIUS = 0.5
"""Metres between centroids of one thing. Of pairs this near, seen at different times, 85% were
tracked as one thing from frame to frame in `muehlburger_tor`; within 1 m, 76%."""

SAME_VIEW = 0.6
"""Of the distance below which the model calls a pair a match: views that look the same."""

SAME_STAND = 5.0
"""Metres between the sensor's positions: views from the same place."""

VIEWS = 8
"""Of a thing, at most."""

NONE: UInt32 = np.zeros(0, dtype=np.uint32)


@dataclass(frozen=True, slots=True)
class SameView:
    """When two segments show the same.

    Attributes:
        quantiser: of the model that described them.
        steps: up to which their descriptors are apart, in the quantiser's steps.
    """

    quantiser: Quantiser
    steps: float

    @classmethod
    def of(cls, manifest: Manifest) -> "SameView":
        """For the segments that a model described."""
        quantiser = manifest.quantiser
        return cls(quantiser, SAME_VIEW * manifest.pair_threshold / quantiser.step)


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
) -> Sighting:
    """Compare an upload with what is stored about there, and with itself, in the order of time.

    Args:
        upload: segments; those whose id is stored are replaced, whatever they look like.
        stored: at least all segments of the map within `radius` of any of the upload, and those
            with an id of the upload.
        same: when two views are the same.
        radius: metres between centroids of one thing.
        same_stand: metres between sensors up to which two views are the same.
        views: of a thing, at most.
        itself: whether to compare it with itself, too.
    """
    stored, given = _filled(stored), _filled(upload)
    # Those that replace others come in their turn, so that an upload that is sent again is told
    # the same.
    known = take(stored, ~np.isin(stored.ids, given.ids))
    given = take(given, np.lexsort((given.ids, _moments(given))))
    given, replaces = _as_views_of(given, stored)

    both = [known, given]
    seen = np.concatenate([_column(each, "seen") for each in both])
    things = np.concatenate([_column(each, "views") for each in both])
    moments = np.concatenate([_moments(each) for each in both])
    stands = np.concatenate([each.frame_positions[each.frame_index] for each in both])
    levels = same.quantiser.levels(np.concatenate([each.codes for each in both]))
    is_kept = np.arange(len(seen)) < len(known)
    count = Counter(things[is_kept].tolist())
    for row, about in enumerate(_neighbours(known, given, radius), start=len(known)):
        # What was seen at the same moment, by the same sensor, is something else.
        elsewhen = (moments[about] != moments[row]) | (stands[about] != stands[row]).any(axis=1)
        comparable = is_kept[about] & elsewhen
        others = [
            other
            for other, good in zip(about, comparable.tolist(), strict=True)
            if good and (itself or other < len(known))
        ]
        if others and not replaces[row - len(known)]:
            distances = np.linalg.norm(levels[others] - levels[row].astype(np.float32), axis=1)
            nearest = others[int(distances.argmin())]
            of_it = [other for other in others if things[other] == things[nearest]]
            away = np.linalg.norm(stands[of_it] - stands[row], axis=1).min()
            is_same = distances.min() <= same.steps or away <= same_stand
            if is_same or count[things[nearest]] >= views:
                seen[nearest] = max(seen[nearest], seen[row])
                continue
            things[row] = things[nearest]
        is_kept[row] = True
        count[things[row]] += 1

    of_known, of_given = slice(len(known)), slice(len(known), None)
    again = seen[of_known] > _column(known, "seen")
    refreshed = take(replace(known, seen=seen[of_known]), again)
    kept = take(replace(given, seen=seen[of_given], views=things[of_given]), is_kept[of_given])
    changed = apply(refreshed, Delta(canonical(kept), NONE))
    return Sighting(changed, refreshed.ids, len(given) - len(kept))


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


def _moments(content: CompactMap) -> Float64:
    return content.frame_times[content.frame_index]


def _neighbours(known: CompactMap, given: CompactMap, radius: float) -> list[list[int]]:
    """For each given segment those near it, known and given."""
    if not len(given):
        return []
    every = KDTree(np.concatenate([known.centroids, given.centroids]))
    return list(every.query_ball_point(given.centroids, radius))
