"""Join: puts the segments of several maps into a merged map, with their provenance."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from placecell_client import CompactMap, Delta, moved, originated
from placecell_client.maps.edit import apply, difference, empty, take, with_optional
from placecell_client.maps.follow import followed
from scipy.spatial.transform import Rotation

from placecell.core.cancellation import current
from placecell.core.segment_classes import most_probable
from placecell.core.types import Int64, UInt32
from placecell.localization import Pose
from placecell.localization.registration import register
from placecell.map_alignment import AlignmentParameters
from service.maps.layers import MapLayers, classes_of
from service.maps.snapshot import MapSnapshot
from service.maps.store import IDS, OutOfIdsError
from service.maps.writes.deduplication import NONE, RADIUS, SameView, count_elsewhere, deduplicate
from service.merging.alignment import MapSide
from service.merging.provenance import keys_in, moments_of, of_source, shared

ROUNDED = 0.02
"""Largest distance in meters of equal centroids that were rounded before and after a rotation."""

COUNTS = ("missed", "confirmed", "absent")
"""Columns of the passes that confirmed or missed a segment; they come together."""

ROUNDS = 20
"""Largest number of rounds of `join_settled`; two or three are usual."""


@dataclass(frozen=True, slots=True, eq=False)
class MergePart:
    """Map to merge.

    Attributes:
        name: name of the map.
        content: its segments, with their provenance.
        pose: transform from its frame into the merged map's.
        slack: largest distance in meters along an axis between a segment's position in the merged
            map and its position by `pose`, if the segment did not move.
    """

    name: str
    content: CompactMap
    pose: Pose
    slack: float


@dataclass(frozen=True, slots=True)
class PartOutcome:
    """Numbers of a part's segments by outcome.

    Attributes:
        added: segments that are new in the merged map.
        known: segments that were merged before and stay, apart from a later `seen`.
        repeats: segments not stored, because another map's segment shows the same.
        removed: segments merged before that the part removed or replaced since.
    """

    added: int
    known: int
    repeats: int
    removed: int


def empty_merged_map(snapshot: MapSnapshot) -> CompactMap:
    """Return an empty merged map in the frame of a map."""
    base = snapshot.layers.base
    return empty(base.model_id, base.preprocessing, base.frame, base.code_bytes)


def content_of(side: MapSide) -> CompactMap:
    """Return the segments of a map to merge, with their provenance."""
    return originated(side.content, side.snapshot.name)


def known_pose(
    target: CompactMap, part: CompactMap, parameters: AlignmentParameters
) -> Pose | None:
    """Return a map's pose in a map that it was merged into; None if it is unclear.

    The pose follows from the shared segments. Sensor positions are transformed without rounding, so
    they determine the pose exactly. If they are on one line or point, the sensor's orientations
    determine the rotation. The centroids of most segments verify the result. So a single segment is
    enough.

    Args:
        target: the merged map.
        part: the map, with its provenance.
        parameters: parameters of the alignment.
    """
    rows, places = shared(part, with_optional(target, ("source", "source_ids")))
    same = moments_of(part, rows) == moments_of(
        target, places
    )  # otherwise it was seen again, elsewhere
    rows, places = rows[same], places[same]
    if not len(rows):
        return None
    frames, others = part.frame_index[rows], target.frame_index[places]
    positions, there = part.frame_positions[frames], target.frame_positions[others]
    by_positions = register(positions, there, np.ones(len(rows)), parameters.local)
    rotations = [
        Rotation.from_quat(orientations[0])
        for orientations in (part.frame_orientations[frames], target.frame_orientations[others])
    ]
    rotation = (rotations[1] * rotations[0].inv()).as_matrix()
    by_orientation = Pose(rotation, (there - positions @ rotation.T).mean(axis=0))
    for pose in (by_positions, by_orientation):
        away = np.abs(pose.apply(positions) - there).max()
        off = np.abs(pose.apply(part.centroids[rows]) - target.centroids[places]).max(axis=1)
        if away <= ROUNDED and np.median(off) <= ROUNDED:
            return pose
    return None


def join(
    target: CompactMap, parts: Sequence[MergePart], first_id: int, same: SameView | None
) -> tuple[CompactMap, list[PartOutcome]]:
    """Join the parts into the merged map, one after the other.

    A segment is identified by the map that it was first written to and its id there. So a map can
    be merged again when it has grown, and parts may have segments in common. If that map replaced a
    segment since, the merged map replaces it too. If any part saw a segment again, its `seen` is
    updated.

    Args:
        target: the merged map, in canonical form.
        parts: the maps to merge.
        first_id: id of the first new segment; the others follow without a gap.
        same: leave out segments that another map's segment shows already, by this criterion; None:
            leave nothing out.

    Raises:
        MapFileError: a part does not fit the merged map.
        OutOfIdsError: there are too few ids from the first on.
    """
    outcomes = []
    for part in parts:
        placed = placed_in(target, part)
        target = with_optional(target, ("source", "source_ids"))
        known = keys_in(placed, target)
        given = keys_in(target, placed)
        rows, places = shared(placed, target)
        later = seen_since(placed, target, rows, places)
        rows, places = replaced(part, placed, target, rows, places)
        known[rows], given[places] = False, False
        if len(later):
            target = apply(target, Delta(later, NONE))
        gone = ~given & of_source(target, part.name)
        added = renumbered(take(placed, ~known), first_id)
        changed, repeats = added, 0
        if same is not None:
            # Segments are repeats of other maps' segments only. The part's own earlier segments
            # still count as views, or an object's dropped view would be stored the next time.
            there = take(target, ~gone)
            near = MapLayers.of(there).near(added.centroids, RADIUS)
            seen = deduplicate(
                added,
                near,
                same,
                itself=False,
                compared=~np.isin(near.ids, target.ids[given]),
                views_elsewhere=count_elsewhere(there, near),
            )
            changed, repeats = closed_up(seen.changed, first_id), seen.repeats
        first_id += len(added) - repeats
        removed = np.sort(target.ids[gone])
        target = apply(target, Delta(changed, removed))
        outcomes.append(
            PartOutcome(
                added=len(added) - repeats,
                known=int(np.count_nonzero(known)),
                repeats=repeats,
                removed=len(removed),
            )
        )
    return target, outcomes


def placed_in(target: CompactMap, part: MergePart) -> CompactMap:
    """Return the content of a part in the merged map's frame.

    Captures that the merged map has follow those there, which an optimization may have moved.
    """
    placed = moved(part.content, part.pose.rotation, part.pose.translation, target.frame)
    return followed(placed, [target])


def join_settled(
    target: CompactMap,
    parts: Sequence[MergePart],
    first_id: int,
    same: SameView | None,
    parameters: AlignmentParameters,
) -> tuple[CompactMap, list[PartOutcome]]:
    """Join the parts repeatedly until another merge would change nothing.

    A segment that one part adds may be a view of another part's object. So the parts are joined
    until nothing changes, each at the pose of the next merge. The arguments are those of `join`.

    Raises:
        MapFileError: a part does not fit the merged map.
        OutOfIdsError: there are too few ids from the first on.
        Cancelled: the deadline passed, or the client disconnected.
    """
    token = current()
    content, outcomes = join(target, parts, first_id, same)
    for _ in range(ROUNDS):
        token.check()
        placed = [at_known_pose(content, part, parameters) for part in parts]
        free = first_id + sum(outcome.added for outcome in outcomes)
        after, more = join(content, placed, free, same)
        changed, removed = difference(content, after)
        if not len(changed) and not len(removed):
            break
        content = after
        outcomes = in_sequence(outcomes, more)
    return content, outcomes


def in_sequence(first: Sequence[PartOutcome], second: Sequence[PartOutcome]) -> list[PartOutcome]:
    """Return the outcome of each part of two joins, one after the other."""
    return [
        PartOutcome(one.added + other.added, one.known, other.repeats, one.removed + other.removed)
        for one, other in zip(first, second, strict=True)
    ]


def at_known_pose(
    target: CompactMap, part: MergePart, parameters: AlignmentParameters
) -> MergePart:
    """Return a part with its pose in the merged map; unchanged if the pose is unclear."""
    pose = known_pose(target, part.content, parameters)
    return part if pose is None else replace(part, pose=pose, slack=ROUNDED)


def replaced(
    part: MergePart, placed: CompactMap, target: CompactMap, rows: Int64, places: Int64
) -> tuple[Int64, Int64]:
    """Return segments that the part replaced since it was merged, rows of both, int64 (m,) each.

    A replaced segment differs in codes, time or position. Only segments that were first written to
    the part count: it may have older versions of others.

    Args:
        part: the part.
        placed: the part's content in the merged map's frame.
        target: the merged map.
        rows: rows of the shared segments in the part, int64 (n,).
        places: their rows in the merged map, int64 (n,).
    """
    off = np.abs(placed.centroids[rows] - target.centroids[places]).max(axis=1)
    differs = (
        (placed.codes[rows] != target.codes[places]).any(axis=1)
        | (moments_of(placed, rows) != moments_of(target, places))
        | (off > part.slack)
    )
    differs &= of_source(placed, part.name)[rows]
    return rows[differs], places[differs]


def seen_since(placed: CompactMap, target: CompactMap, rows: Int64, places: Int64) -> CompactMap:
    """Return segments of the merged map that the part saw or missed later, or knows better.

    Of its counts, the higher `confirmed` stays, and the `missed` and `absent` that are newer.

    Args:
        placed: the part's content in the merged map's frame.
        target: the merged map.
        rows: rows of the shared segments in the part, int64 (n,).
        places: their rows in the merged map, int64 (n,).
    """
    filled = with_optional(target, ["seen"])
    seen = last_seen(filled)
    np.maximum.at(seen, places, last_seen(placed)[rows])
    later = seen > last_seen(filled)
    if target.classes is not None or placed.classes is not None:
        classes = classes_of(target).copy()
        classes[places] = most_probable(classes[places], classes_of(placed)[rows])
        later |= classes != classes_of(target)
        filled = replace(filled, classes=classes)
    if placed.absent is not None:
        filled = with_optional(filled, COUNTS)
        newer = _judged_at(placed)[rows] > _judged_at(filled)[places]
        columns: dict[str, Any] = {name: np.array(getattr(filled, name)) for name in COUNTS}
        for name in ("missed", "absent"):
            columns[name][places[newer]] = getattr(placed, name)[rows[newer]]
        np.maximum.at(columns["confirmed"], places, np.asarray(placed.confirmed)[rows])
        later[places[newer]] = True
        later |= columns["confirmed"] != np.asarray(filled.confirmed)
        filled = replace(filled, **columns)
    return take(replace(filled, seen=seen), later)


def _judged_at(content: CompactMap) -> UInt32:
    """Return when each segment was last seen or missed, whole seconds, uint32 (n,)."""
    return np.asarray(np.maximum(last_seen(content), np.asarray(content.missed)))


def last_seen(content: CompactMap) -> UInt32:
    """Return when each segment was last seen, whole seconds, uint32 (n,)."""
    return np.array(with_optional(content, ["seen"]).seen)


def renumbered(content: CompactMap, first_id: int) -> CompactMap:
    """Assign ids to the segments from the first id on; views of one object stay together."""
    if first_id + len(content) > IDS:
        raise OutOfIdsError(f"only {IDS - first_id} ids are left")
    ids = np.arange(first_id, first_id + len(content), dtype=np.uint32)
    views = content.views
    if views is not None and len(views):
        # Name views after their first segment: the one that they name may be elsewhere.
        _, first, group = np.unique(views, return_index=True, return_inverse=True)
        views = ids[first[group]]
    return replace(content, ids=ids, views=views)


def closed_up(content: CompactMap, first_id: int) -> CompactMap:
    """Close gaps in the ids from the first on, which left out segments made."""
    rows = np.flatnonzero(content.ids >= first_id)
    ids, views = content.ids.copy(), np.array(content.views)
    ids[rows] = np.arange(first_id, first_id + len(rows), dtype=np.uint32)
    among = rows[views[rows] >= first_id]
    _, first, group = np.unique(views[among], return_index=True, return_inverse=True)
    views[among] = ids[among][first[group]]
    return replace(content, ids=ids, views=views)
