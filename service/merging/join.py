"""A site map: what several maps hold, in one frame, each segment with where it comes from."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from placecell_client import CompactMap, Delta, moved, originated
from placecell_client.maps.edit import apply, difference, empty, take, with_optional
from scipy.spatial.transform import Rotation

from placecell.core.cancellation import current
from placecell.core.types import Int64, UInt32
from placecell.localization import Pose
from placecell.localization.registration import register
from placecell.map_alignment import AlignmentParameters
from service.maps.deduplication import NONE, RADIUS, SameView, count_elsewhere, deduplicate
from service.maps.layers import MapLayers
from service.maps.snapshot import MapSnapshot
from service.maps.store import IDS, OutOfIdsError
from service.merging.alignment import MapSide
from service.merging.provenance import keys_in, moments_of, of_source, shared

ROUNDED = 0.02
"""Metres: two centroids that are the same but for their rounding, before a turn and after it."""

ROUNDS = 20
"""Largest number of merge rounds; two or three are usual."""


@dataclass(frozen=True, slots=True, eq=False)
class MergePart:
    """A map that is to be merged.

    Attributes:
        name: under which it is stored.
        content: its segments, each with where it comes from.
        pose: from its frame to the site's.
        slack: metres along an axis, up to which what was merged before lies where it lay.
    """

    name: str
    content: CompactMap
    pose: Pose
    slack: float


@dataclass(frozen=True, slots=True)
class PartOutcome:
    """What became of a part's segments.

    Attributes:
        added: new in the site.
        known: were merged before, and stay as they are, but for a later `seen`.
        repeats: not stored, for another map's segment shows the same.
        removed: were merged before, and are gone from the part, or replaced there.
    """

    added: int
    known: int
    repeats: int
    removed: int


def empty_merged_map(stored: MapSnapshot) -> CompactMap:
    """An empty site, in the frame of a map."""
    base = stored.layers.base
    return empty(base.model_id, base.preprocessing, base.frame, base.code_bytes)


def content_of(side: MapSide) -> CompactMap:
    """The segments of a map that is to be merged, each with where it comes from."""
    return originated(side.content, side.stored.name)


def known_pose(site: CompactMap, part: CompactMap, parameters: AlignmentParameters) -> Pose | None:
    """How a map lies in a site that it was merged into, from what it gave; None if that is unclear.

    The stands tell it exactly, for they are moved without rounding; where all are on one line or
    spot and do not tell the direction, the sensor's orientation on them does, for it is moved, too.
    The centroids of most show where either is wrong. So a single segment is enough.

    Args:
        part: with where its segments come from.
    """
    rows, places = shared(part, with_optional(site, ("source", "source_ids")))
    same = moments_of(part, rows) == moments_of(site, places)  # else it was seen anew, elsewhere
    rows, places = rows[same], places[same]
    if not len(rows):
        return None
    frames, others = part.frame_index[rows], site.frame_index[places]
    viewpoints, there = part.frame_positions[frames], site.frame_positions[others]
    by_stands = register(viewpoints, there, np.ones(len(rows)), parameters.local)
    turned = [
        Rotation.from_quat(orientations[0])
        for orientations in (part.frame_orientations[frames], site.frame_orientations[others])
    ]
    turn = (turned[1] * turned[0].inv()).as_matrix()
    by_turn = Pose(turn, (there - viewpoints @ turn.T).mean(axis=0))
    for pose in (by_stands, by_turn):
        away = np.abs(pose.apply(viewpoints) - there).max()
        off = np.abs(pose.apply(part.centroids[rows]) - site.centroids[places]).max(axis=1)
        if away <= ROUNDED and np.median(off) <= ROUNDED:
            return pose
    return None


def join(
    site: CompactMap, parts: Sequence[MergePart], first_id: int, same: SameView | None
) -> tuple[CompactMap, list[PartOutcome]]:
    """The site with the parts in it, one after the other.

    A segment is known by the map that it was written to first, and its id there; so a map can be
    merged again when it has grown, and parts may share what was merged into both. What that map
    itself has replaced since under the same id is taken out, and anew; what any saw again is as
    lately seen in the site.

    Args:
        site: in canonical form.
        first_id: of new segments, which get this one and those after it, without a gap.
        same: leave out what another map's segment shows already; None: leave nothing out.

    Raises:
        MapFileError: a part cannot stand in the site.
        OutOfIdsError: there are too few ids from the first on.
    """
    shares = []
    for part in parts:
        laid = moved(part.content, part.pose.rotation, part.pose.translation, site.frame)
        site = with_optional(site, ("source", "source_ids"))
        known = keys_in(laid, site)
        given = keys_in(site, laid)
        both = shared(laid, site)
        rows, places = replaced(part, laid, site, *both)
        known[rows], given[places] = False, False
        later = seen_since(laid, site, *both)
        if len(later):
            site = apply(site, Delta(later, NONE))
        gone = ~given & of_source(site, part.name)
        added = renumbered(take(laid, ~known), first_id)
        changed, repeats = added, 0
        if same is not None:
            # Not with what the map itself gave before: it is another's that is left out. But its
            # views count, or what had no room in a thing would have it the next time.
            there = take(site, ~gone)
            about = MapLayers.of(there).near(added.centroids, RADIUS)
            seen = deduplicate(
                added,
                about,
                same,
                itself=False,
                compared=~np.isin(about.ids, site.ids[given]),
                views_elsewhere=count_elsewhere(there, about),
            )
            changed, repeats = closed_up(seen.changed, first_id), seen.repeats
        first_id += len(added) - repeats
        removed = np.sort(site.ids[gone])
        site = apply(site, Delta(changed, removed))
        shares.append(
            PartOutcome(len(added) - repeats, int(np.count_nonzero(known)), repeats, len(removed))
        )
    return site, shares


def join_settled(
    site: CompactMap,
    parts: Sequence[MergePart],
    first_id: int,
    same: SameView | None,
    parameters: AlignmentParameters,
) -> tuple[CompactMap, list[PartOutcome]]:
    """Merge the parts into the map until merging them again changes nothing.

    What one part adds may show a segment of another one from a new side; so the parts are joined
    until nothing changes, each as the next merge would lay it. The arguments are those of `join`.

    Raises:
        MapFileError: a part cannot stand in the site.
        OutOfIdsError: there are too few ids from the first on.
        Cancelled: nobody waits for it any longer.
    """
    token = current()
    content, shares = join(site, parts, first_id, same)
    for _ in range(ROUNDS):
        token.check()
        laid = [as_laid(content, part, parameters) for part in parts]
        free = first_id + sum(share.added for share in shares)
        after, more = join(content, laid, free, same)
        changed, removed = difference(content, after)
        if not len(changed) and not len(removed):
            break
        content = after
        shares = [
            PartOutcome(
                one.added + other.added, one.known, other.repeats, one.removed + other.removed
            )
            for one, other in zip(shares, more, strict=True)
        ]
    return content, shares


def as_laid(site: CompactMap, part: MergePart, parameters: AlignmentParameters) -> MergePart:
    """Return a part as it lies in the map that it was merged into; unchanged if unclear."""
    pose = known_pose(site, part.content, parameters)
    return part if pose is None else replace(part, pose=pose, slack=ROUNDED)


def replaced(
    part: MergePart, laid: CompactMap, site: CompactMap, rows: Int64, places: Int64
) -> tuple[Int64, Int64]:
    """What the part has replaced since it was merged, rows of both, int64 (m,) each.

    Told by codes, moment and place. Only what was written to the part first: of the rest it may
    have an older version than the site.

    Args:
        laid: the part's content, in the site's frame.
        rows: of the part, what both have, int64 (n,).
        places: of the site, the same, int64 (n,).
    """
    off = np.abs(laid.centroids[rows] - site.centroids[places]).max(axis=1)
    differs = (
        (laid.codes[rows] != site.codes[places]).any(axis=1)
        | (moments_of(laid, rows) != moments_of(site, places))
        | (off > part.slack)
    )
    differs &= of_source(laid, part.name)[rows]
    return rows[differs], places[differs]


def seen_since(laid: CompactMap, site: CompactMap, rows: Int64, places: Int64) -> CompactMap:
    """Segments of the site that the part has seen later, with that moment.

    Args:
        rows: of the part, what both have, int64 (n,).
        places: of the site, the same, int64 (n,).
    """
    filled = with_optional(site, ["seen"])
    seen = last_seen(filled)
    np.maximum.at(seen, places, last_seen(with_optional(laid, ["seen"]))[rows])
    return take(replace(filled, seen=seen), seen > last_seen(filled))


def last_seen(content: CompactMap) -> UInt32:
    """When each segment was seen last, whole seconds, uint32 (n,)."""
    return np.array(content.seen)


def renumbered(content: CompactMap, first_id: int) -> CompactMap:
    """With ids from the first on; views of one thing stay such."""
    if first_id + len(content) > IDS:
        raise OutOfIdsError(f"{IDS - first_id} ids are left")
    ids = np.arange(first_id, first_id + len(content), dtype=np.uint32)
    views = content.views
    if views is not None and len(views):
        # The first of them stands for all, for the one that they name may be no part of this.
        _, first, group = np.unique(views, return_index=True, return_inverse=True)
        views = ids[first[group]]
    return replace(content, ids=ids, views=views)


def closed_up(content: CompactMap, first_id: int) -> CompactMap:
    """Without gaps in the ids from the first on, for some were left out; as `renumbered` else."""
    rows = np.flatnonzero(content.ids >= first_id)
    ids, views = content.ids.copy(), np.array(content.views)
    ids[rows] = np.arange(first_id, first_id + len(rows), dtype=np.uint32)
    among = rows[views[rows] >= first_id]
    _, first, group = np.unique(views[among], return_index=True, return_inverse=True)
    views[among] = ids[among][first[group]]
    return replace(content, ids=ids, views=views)
