"""Answers of the routes about alignments and merges."""

from collections.abc import Sequence
from dataclasses import asdict

from placecell.core.types import UInt32
from placecell.map_alignment import MapAlignment, Overlap
from service.api.responses import pose_of
from service.api.schemas.alignment import (
    AlignmentOut,
    CarriedAnchorOut,
    LaidOut,
    LoopOut,
    MergedOut,
    MergedPartOut,
    MergePairOut,
    OverlapOut,
    PairOut,
)
from service.api.schemas.localization import PoseOut
from service.maps.snapshot import MapSnapshot
from service.merging.join import PartOutcome
from service.merging.merge import MergeResult
from service.merging.plan import AlignedPair, MergePlan

NOTHING = PartOutcome(added=0, known=0, repeats=0, removed=0)


def alignment_of(
    found: MapAlignment,
    one: MapSnapshot,
    other: MapSnapshot,
    ids: tuple[UInt32, UInt32] | None = None,
) -> AlignmentOut:
    """Return the answer about the alignment of two maps.

    Args:
        found: the alignment.
        one: the one map.
        other: the other map.
        ids: ids of the rows of both maps, to list the pairs that agree; None: do not list them.
    """
    best, pose = found.best, found.pose
    others = [found.second] if pose is not None else [best, found.second]
    accepted = best if pose is not None else None
    return AlignmentOut(
        map=one.name,
        etag=one.tag,
        frame=one.frame,
        other=other.name,
        other_etag=other.tag,
        other_frame=other.frame,
        aligned=pose is not None,
        reason=found.reason,
        detail=found.detail,
        pose=None if pose is None else PoseOut(**pose_of(pose)),
        covariance=None if accepted is None else accepted.covariance.tolist(),
        overlap=None
        if accepted is None
        else OverlapOut(of_map=accepted.parts[0], of_other=accepted.parts[1]),
        score=0.0 if best is None else best.score,
        agreement=0.0 if best is None else best.agreement,
        pairs=0 if accepted is None else len(accepted),
        inliers=[] if accepted is None or ids is None else pairs_of(accepted, ids),
        others=[hypothesis_of(each) for each in others if each is not None],
    )


def hypothesis_of(overlap: Overlap) -> LaidOut:
    """Return the answer about one hypothesis of an alignment."""
    return LaidOut(
        pose=PoseOut(**pose_of(overlap.pose)),
        score=overlap.score,
        agreement=overlap.agreement,
        pairs=len(overlap),
    )


def pairs_of(overlap: Overlap, ids: tuple[UInt32, UInt32]) -> list[PairOut]:
    """Return the pairs of segments that agree."""
    here, there = ids
    rows = zip(
        here[overlap.rows_a].tolist(),
        there[overlap.rows_b].tolist(),
        overlap.residuals.tolist(),
        strict=True,
    )
    return [PairOut(id=id_, other_id=other, residual=meters) for id_, other, meters in rows]


def merged_of(merged: MergeResult, name: str, names: Sequence[str]) -> MergedOut:
    """Return the answer about a merge.

    Args:
        merged: the result.
        name: name of the merged map.
        names: names of the maps, in the order of the request.
    """
    plan, written = merged.plan, merged.written
    numbers = {stored.name: number for number, stored in enumerate(plan.maps)}
    return MergedOut(
        map=name,
        frame=plan.maps[0].frame,
        dry_run=written is None,
        sequence=None if written is None else written.snapshot.head.sequence,
        etag=None if written is None else written.snapshot.tag,
        previous=merged.previous,
        segments=merged.segments,
        changed=merged.changed,
        removed=merged.removed,
        parts=[_part(merged, numbers[each]) for each in names],
        alignments=[_pair(plan, each) for each in plan.pairs],
        loops=[
            LoopOut(
                maps=[plan.maps[number].name for number in loop.maps],
                meters=loop.meters,
                degrees=loop.degrees,
                closes=loop.closes,
            )
            for loop in plan.checked.loops
        ],
        anchors=[CarriedAnchorOut(**asdict(each)) for each in merged.anchors],
    )


def _part(merged: MergeResult, number: int) -> MergedPartOut:
    stored, is_merged = merged.plan.maps[number], number in merged.outcomes
    pose = merged.plan.poses[number] if is_merged else None
    outcome = merged.outcomes.get(number, NOTHING)
    return MergedPartOut(
        map=stored.name,
        etag=stored.tag,
        merged=is_merged,
        pose=None if pose is None else PoseOut(**pose_of(pose)),
        added=outcome.added,
        known=outcome.known,
        repeats=outcome.repeats,
        removed=outcome.removed,
    )


def _pair(plan: MergePlan, pair: AlignedPair) -> MergePairOut:
    accepted = alignment_of(pair.found, plan.maps[pair.one], plan.maps[pair.other])
    return MergePairOut(
        rejected=pair.is_rejected,
        proven=pair.is_proven,
        **accepted.model_dump(include=set(MergePairOut.model_fields)),
    )
