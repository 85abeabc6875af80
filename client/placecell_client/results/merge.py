"""Results of merging maps."""

from dataclasses import dataclass
from typing import Any

from placecell_client.results.alignment import Overlap, overlap_of, pose_if_any
from placecell_client.results.localization import Pose


@dataclass(frozen=True, slots=True, eq=False)
class MergedPart:
    """Outcome of a merge for one map.

    Attributes:
        map: Name of the map.
        etag: ETag of its version.
        merged: Whether the map was merged; False if it could not be aligned and was left out.
        pose: Pose of its frame in the merged map's frame; None if it was left out.
        added: Number of segments that are new in the merged map.
        known: Number of segments that an earlier merge added and that are unchanged.
        repeats: Number of segments left out, because they repeat a segment of another map.
        removed: Number of segments that an earlier merge added and that the map has since removed
            or replaced.
    """

    map: str
    etag: str
    merged: bool
    pose: Pose | None
    added: int
    known: int
    repeats: int
    removed: int


@dataclass(frozen=True, slots=True, eq=False)
class MergePair:
    """Alignment of two maps of a merge; the merged map is one of the maps if it held segments.

    Attributes:
        map: Name of the first map.
        other: Name of the other map.
        aligned: Whether the maps are aligned.
        rejected: Whether the alignment was rejected, because loops with it do not close.
        proven: Whether the alignment is part of a loop that closes.
        reason: Reason why the maps are not aligned; None if they are.
        detail: The reason in words.
        pose: Pose of the other map's frame in the first map's frame; None if they are not aligned.
        overlap: Overlap of the maps; None if they are not aligned.
        score: Score of the best hypothesis, whether accepted or not.
        agreement: Agreement of the best hypothesis, 0 to 1.
        pairs: Number of pairs of segments that agree with the pose.
    """

    map: str
    other: str
    aligned: bool
    rejected: bool
    proven: bool
    reason: str | None
    detail: str
    pose: Pose | None
    overlap: Overlap | None
    score: float
    agreement: float
    pairs: int


@dataclass(frozen=True, slots=True)
class MapLoop:
    """Loop of alignments: from map to map, back to the first.

    Attributes:
        maps: Names of the maps in order.
        meters: Translation error of the loop, meters.
        degrees: Rotation error of the loop, degrees.
        closes: Whether both errors are within the tolerance.
    """

    maps: tuple[str, ...]
    meters: float
    degrees: float
    closes: bool


@dataclass(frozen=True, slots=True)
class MergedAnchor:
    """Outcome of one anchor of a merged map.

    Attributes:
        map: Name of the map that has the anchor.
        anchor: Name of the anchor; None: the place of the map on the Earth.
        outcome: `carried` into the merged map; `kept`, as the merged map has it already; or
            `conflict`, as the merged map has another one, which stays.
        meters: Distance from the one that stays, meters; None if it was carried.
    """

    map: str
    anchor: str | None
    outcome: str
    meters: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Merge:
    """Result of a merge, or of its dry run.

    Attributes:
        map: Name of the merged map.
        frame: Name of its coordinate frame.
        dry_run: Whether nothing was written.
        sequence: Sequence number of the merged map's new version; None for a dry run.
        etag: ETag of that version; None for a dry run.
        previous: Sequence number of the version before. Pass it to `Client.restore_map` to undo the
            merge. None if the merge created the map; `Client.delete_map` undoes it then. Equal to
            `sequence` if nothing was changed.
        segments: Number of segments in the merged map.
        changed: Number of segments added or replaced.
        removed: Number of segments removed.
        parts: Outcome for each map, in the order of the request.
        alignments: Alignment of each pair of maps.
        loops: Loops of these alignments.
        anchors: Outcome of each anchor of the maps. Empty if the service is older than this field.
    """

    map: str
    frame: str
    dry_run: bool
    sequence: int | None
    etag: str | None
    previous: int | None
    segments: int
    changed: int
    removed: int
    parts: tuple[MergedPart, ...]
    alignments: tuple[MergePair, ...]
    loops: tuple[MapLoop, ...]
    anchors: tuple[MergedAnchor, ...] = ()


def merge_of(content: dict[str, Any]) -> Merge:
    """Build a merge from the service's response."""
    return Merge(
        map=content["map"],
        frame=content["frame"],
        dry_run=content["dry_run"],
        sequence=content["sequence"],
        etag=content["etag"],
        previous=content["previous"],
        segments=content["segments"],
        changed=content["changed"],
        removed=content["removed"],
        parts=tuple(_part(item) for item in content["parts"]),
        alignments=tuple(_pair(item) for item in content["alignments"]),
        loops=tuple(
            MapLoop(tuple(item["maps"]), item["meters"], item["degrees"], item["closes"])
            for item in content["loops"]
        ),
        anchors=tuple(
            MergedAnchor(item["map"], item["anchor"], item["outcome"], item["meters"])
            for item in content.get("anchors", ())
        ),
    )


def _part(item: dict[str, Any]) -> MergedPart:
    told = {name: item[name] for name in MergedPart.__slots__}
    return MergedPart(**told | {"pose": pose_if_any(item["pose"])})


def _pair(item: dict[str, Any]) -> MergePair:
    told = {name: item[name] for name in MergePair.__slots__}
    read = {"pose": pose_if_any(item["pose"]), "overlap": overlap_of(item["overlap"])}
    return MergePair(**told | read)
