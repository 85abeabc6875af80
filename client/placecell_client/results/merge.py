"""What a merge of maps into a site did, or would do, as the service answers it."""

from dataclasses import dataclass
from typing import Any

from placecell_client.results.alignment import Overlap, overlap_of, pose_if_any
from placecell_client.results.localization import Pose


@dataclass(frozen=True, slots=True, eq=False)
class MergedPart:
    """What became of a map.

    Attributes:
        map: its name.
        etag: of its version that was merged.
        merged: False: it could not be laid on the site, and was left out.
        pose: of its frame in the site's; None if it was left out.
        added: segments that are new in the site.
        known: segments that were merged before, and stay as they are.
        repeats: segments left out, for another map's segment shows the same.
        removed: segments merged before that the map no longer has, or has replaced.
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
    """What was found of two of the maps; the site is one of them, if it held any segments.

    Attributes:
        map: name of the one.
        other: name of the other.
        aligned: whether they lie on each other.
        rejected: loops rule the alignment out.
        proven: the alignment is part of a loop that closes.
        reason: why they are not aligned; None if they are.
        detail: the reason in words.
        pose: of the other's frame in the one's; None if they are not aligned.
        overlap: what both have seen; None if they are not aligned.
        score: of the best way to lay them, aligned or not.
        agreement: of that.
        pairs: how many segments agree with the pose.
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
    """A way around from map to map, back to the first.

    Attributes:
        maps: their names.
        metres: by which one misses where one began.
        degrees: by which one is turned then.
        closes: whether that is little enough.
    """

    maps: tuple[str, ...]
    metres: float
    degrees: float
    closes: bool


@dataclass(frozen=True, slots=True, eq=False)
class Merge:
    """What a merge did, or would do.

    Attributes:
        map: the site's name.
        frame: name of its frame.
        dry_run: whether it was only asked what would be done.
        sequence: of the site's version after it; None of a dry run.
        etag: of that version; None of a dry run.
        previous: sequence of the site's version before, which `Client.restore_map` takes to undo
            the merge; None: there was no site, and `Client.delete_map` undoes it. The same as
            `sequence` if nothing was changed.
        segments: in the site after it.
        changed: segments added or replaced.
        removed: segments removed.
        parts: what became of each map, in the order of the request.
        alignments: of each two of site and maps.
        loops: of these alignments.
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


def merge_of(content: dict[str, Any]) -> Merge:
    """From the service's answer."""
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
            MapLoop(tuple(item["maps"]), item["metres"], item["degrees"], item["closes"])
            for item in content["loops"]
        ),
    )


def _part(item: dict[str, Any]) -> MergedPart:
    told = {name: item[name] for name in MergedPart.__slots__}
    return MergedPart(**told | {"pose": pose_if_any(item["pose"])})


def _pair(item: dict[str, Any]) -> MergePair:
    told = {name: item[name] for name in MergePair.__slots__}
    read = {"pose": pose_if_any(item["pose"]), "overlap": overlap_of(item["overlap"])}
    return MergePair(**told | read)
