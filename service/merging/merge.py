"""Merge: aligns stored maps, joins their segments, and writes the merged map."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from placecell_client import CompactMap, MapFileError, encode
from placecell_client.maps.edit import difference, with_optional

from placecell.core.types import UInt32
from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters
from placecell.pose_graph import PoseGraphParameters
from service.core.problems import Problem
from service.inference.model_registry import Model
from service.maps.snapshot import MapSnapshot
from service.maps.store import OutOfIdsError
from service.maps.writes.deduplication import NONE, RADIUS, SameView
from service.maps.writes.writer import MapWriter, WriteResult, out_of_ids
from service.merging.alignment import CancellationCheck, check_same_model
from service.merging.bending import bend_content, straightened
from service.merging.join import (
    ROUNDED,
    MergePart,
    PartOutcome,
    content_of,
    empty_merged_map,
    in_sequence,
    join_settled,
    known_pose,
)
from service.merging.judging import judged_map
from service.merging.local_agreement import plan_by_loops
from service.merging.plan import MergePlan, plan_merge

AnchorOutcome = Literal["carried", "kept", "conflict"]

TRIES = 3
"""Number of times that a merge is tried while the merged map is written. A rigid one then keeps
writes waiting, and one that bends fails."""

BENDS = 5
"""Largest number of times that a merge bends the merged map; one or two are usual."""


@dataclass(frozen=True, slots=True)
class CarriedAnchor:
    """AnchorOutcome of one anchor of a merged map.

    Attributes:
        map: name of the map that has the anchor.
        anchor: name of the anchor; None for the place on the Earth.
        outcome: `carried` into the merged map; `kept`, because the merged map has it already; or
            `conflict`, because the merged map has another one, which stays.
        meters: distance from the one that stays, meters; None if it was carried.
    """

    map: str
    anchor: str | None
    outcome: AnchorOutcome
    meters: float | None


@dataclass(frozen=True, slots=True, eq=False)
class MergeResult:
    """Result of a merge or of its dry run.

    Attributes:
        plan: poses of the maps.
        outcomes: outcome of each map that was merged, by number.
        segments: number of segments of the merged map after it.
        written: result of the write; None after a dry run.
        previous: sequence of the merged map's version before; None: the map is new.
        changed: number of segments added or replaced.
        removed: number of segments removed.
        anchors: outcome of each anchor of the merged maps.
        bent: the merged map before and after its optimization; None if no capture was moved.
    """

    plan: MergePlan
    outcomes: dict[int, PartOutcome]
    segments: int
    written: WriteResult | None
    previous: int | None
    changed: int
    removed: int
    anchors: tuple[CarriedAnchor, ...] = ()
    bent: tuple[CompactMap, CompactMap] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _JoinedMaps:
    """Maps that were joined, and not yet written.

    Attributes:
        before: version of the merged map that they were joined on; None: there was no map.
        present: its segments.
        content: segments of the merged map.
        bent: the same after the optimization; None if it is rigid, or no capture moves.
        written: the same after the judgment: the segments to write.
        refreshed: ids of segments whose counts alone the judgment changed.
        outcomes: outcome of each map that was merged, by number.
        reserved: ids that were reserved for the new segments, in the order of their use.
    """

    before: MapSnapshot | None
    present: CompactMap | None
    content: CompactMap
    bent: CompactMap | None
    written: CompactMap
    refreshed: UInt32
    outcomes: dict[int, PartOutcome]
    reserved: tuple[range, ...]


@dataclass(frozen=True, slots=True)
class Merger:
    """Merges maps for one request.

    Attributes:
        writer: writes the merged map.
        parameters: parameters of the alignments.
        deduplicate: leave out segments that another map's segment shows already.
        dry_run: write nothing; only return what would change.
        check: raises `Cancelled` if the deadline passed or the client disconnected.
        rigid: move each map as a whole; else the merged map is optimized before it is written.
    """

    writer: MapWriter
    parameters: AlignmentParameters
    deduplicate: bool
    dry_run: bool
    check: CancellationCheck
    rigid: bool = True

    def merge(self, name: str, names: Sequence[str]) -> MergeResult:
        """Merge stored maps into a merged map, which is created if it does not exist.

        A new merged map has the frame of the first map. Maps that cannot be aligned with it are
        left out; if no map can be aligned, nothing is written. A merge that bends first lays maps
        that do not align as a whole on each other by the loops between them.

        Args:
            name: name of the merged map.
            names: names of the maps to merge.

        Raises:
            Problem: 404 if a map does not exist, 409 if no map can be aligned or the merged map
                was replaced in the meantime, and the problems of `MapWriter`.
        """
        maps = self.writer.maps
        target = maps.find(name)
        parts = [maps.get(each) for each in names]
        aligned = parts if target is None or not len(target) else [target, *parts]
        for each in aligned[1:]:
            check_same_model(aligned[0], each)
        # Checked again when the map is written, which may be minutes later.
        self.writer.conditions.check(None if target is None else target.tag)
        model = self.writer.models.named(aligned[0].model_id)
        prepare = None if self.rigid else straightened
        plan = plan_merge(aligned, model, self.parameters, self.check, prepare)
        before: dict[int, Pose] = {}
        if target is not None and aligned[0] is target:
            before = self._known_poses(plan)
            plan = replace(plan, poses=plan.poses | before)
        if not self.rigid and len(plan.poses) < len(plan.sides):
            plan = plan_by_loops(plan, before, model, self.parameters, self.check)
        # A known pose is exact but for rounding; a new one is as exact as an alignment.
        joining = {
            number: ROUNDED if number in before else RADIUS
            for number, each in enumerate(aligned)
            if number in plan.poses and each is not target
        }
        if len(plan.poses) < 2:
            if self.dry_run:
                segments, previous = (len(target), target.head.sequence) if target else (0, None)
                return MergeResult(plan, {}, segments, None, previous, 0, 0)
            raise Problem(
                409,
                "not-aligned",
                f"None of the maps {', '.join(names)} can be aligned with map {aligned[0].name!r}; "
                "nothing was changed. Send the request with dry_run for the reasons.",
            )
        self.check()
        # This may take minutes: nobody waits for it, and a write makes it void.
        free: tuple[range, ...] = ()
        for _ in range(TRIES):
            joined = self._joined(name, target, plan, joining, free)
            with maps.writing(name):
                if _is_same(maps.find(name), joined.before):
                    return self._write(name, plan, joined)
            free = joined.reserved
            self.check()
        if self.rigid:  # seconds: writes can wait
            with maps.writing(name):
                return self._write(name, plan, self._joined(name, target, plan, joining, free))
        raise Problem(
            409,
            "map-changed",
            f"Map {name!r:.80} was written {TRIES} times during the merge; nothing was changed. "
            "Try again when robots write less.",
        )

    def _known_poses(self, plan: MergePlan) -> dict[int, Pose]:
        """Return the poses of maps that were merged before, by number.

        A new alignment would differ a little; with these poses, merging again changes nothing.
        """
        target = plan.sides[0].content
        poses = {}
        for number, side in enumerate(plan.sides[1:], start=1):
            pose = known_pose(target, content_of(side), self.parameters)
            if pose is not None:
                poses[number] = pose
        return poses

    def _joined(
        self,
        name: str,
        before: MapSnapshot | None,
        plan: MergePlan,
        joining: Mapping[int, float],
        free: tuple[range, ...] = (),
    ) -> _JoinedMaps:
        """Join these parts, by number, each with its slack, on the newest version of the map.

        Args:
            name: name of the merged map.
            before: the merged map when the parts were aligned.
            plan: poses of the maps.
            joining: slack of each part, by number.
            free: ids that an earlier try reserved and did not write.
        """
        writer = self.writer
        snapshot = writer.maps.find(name)
        self._check_frame_kept(name, before, snapshot)
        parts = [
            MergePart(
                plan.maps[number].name, content_of(plan.sides[number]), plan.poses[number], slack
            )
            for number, slack in joining.items()
        ]
        model = writer.models.named(plan.maps[0].model_id)
        same = SameView.of(model.manifest) if self.deduplicate else None
        present = None if snapshot is None else snapshot.layers.content()
        # A merged map without segments takes the frame of the first map.
        target = present if present is not None and len(present) else empty_merged_map(plan.maps[0])
        first_id = 0 if snapshot is None else snapshot.head.next_id
        given, left = next(iter(free), None), free[1:]
        first_id = first_id if given is None else given.start
        try:
            content, found, reserved = self._with_ids(
                snapshot, target, parts, same, first_id, name, given
            )
            bent = None
            if not self.rigid:
                begin = first_id + sum(each.added for each in found)
                begin = begin if reserved is None else reserved.stop
                bent, found, left = self._bent(
                    snapshot, content, parts, same, begin, name, model, plan, found, left
                )
        except MapFileError as error:
            raise Problem(
                409, "cannot-merge", f"The maps cannot be joined: {error}. Leave one of them out."
            ) from error
        except OutOfIdsError as error:
            raise out_of_ids(name, error) from error
        written, refreshed = content if bent is None else bent, NONE
        if self.deduplicate:
            judged = judged_map(written, present, parts, self.parameters)
            if present is not None:
                alike = with_optional(present, written.optional)
                untouched = np.setdiff1d(judged.ids, difference(alike, written)[0].ids)
                refreshed = np.intersect1d(untouched, present.ids)
            written = judged.content
        outcomes = dict(zip(joining, found, strict=True))
        ids = left if reserved is None else (reserved, *left)
        return _JoinedMaps(snapshot, present, content, bent, written, refreshed, outcomes, ids)

    def _with_ids(
        self,
        snapshot: MapSnapshot | None,
        target: CompactMap,
        parts: Sequence[MergePart],
        same: SameView | None,
        first_id: int,
        name: str,
        free: range | None = None,
    ) -> tuple[CompactMap, list[PartOutcome], range | None]:
        """Join the parts, and reserve the ids of new segments.

        Returns:
            The joined maps, the outcome of each part, and the ids that are reserved.
        """
        content, found = join_settled(target, parts, first_id, same, self.parameters)
        count = sum(outcome.added for outcome in found)
        is_free = free is not None and count <= len(free)
        if snapshot is None or not count or self.dry_run or is_free:
            return content, found, free
        first = self.writer.reserve(name, count)
        if first != first_id:  # another request reserved ids in the meantime
            content, found = join_settled(target, parts, first, same, self.parameters)
        return content, found, range(first, first + count)

    def _bent(
        self,
        snapshot: MapSnapshot | None,
        content: CompactMap,
        parts: Sequence[MergePart],
        same: SameView | None,
        first_id: int,
        name: str,
        model: Model,
        plan: MergePlan,
        outcomes: list[PartOutcome],
        free: tuple[range, ...],
    ) -> tuple[CompactMap | None, list[PartOutcome], tuple[range, ...]]:
        """Bend the merged map, and join again, until another merge would change nothing.

        Captures that were moved show other segments of the same objects, so some repeats are none
        any more.

        Returns:
            The merged map; None if no capture moved; the outcome of each part; and the ids that are
            reserved: an earlier try reserved the first ones (`free`).
        """
        bent, loops = None, plan.loops
        ids: list[range] = []
        for _ in range(BENDS):
            self.check()
            now = content if bent is None else bent
            _, after = bend_content(now, model, PoseGraphParameters(), loops)
            if after is None:
                break
            bent = after
            if same is None:
                break
            given, free = next(iter(free), None), free[1:]
            begin = first_id if given is None else given.start
            joined, more, reserved = self._with_ids(snapshot, bent, parts, same, begin, name, given)
            ids += [] if reserved is None else [reserved]
            changed, removed = difference(bent, joined)
            if not len(changed) and not len(removed):
                break
            first_id += sum(each.added for each in more)
            first_id = first_id if reserved is None else reserved.stop
            bent, loops = joined, None  # the loops that the next merge would find
            outcomes = in_sequence(outcomes, more)
        return bent, outcomes, (*ids, *free)

    def _write(self, name: str, plan: MergePlan, joined: _JoinedMaps) -> MergeResult:
        """Store the merged map; the caller holds its write lock."""
        writer, snapshot, content = self.writer, joined.before, joined.written
        result = MergeResult(
            plan=plan,
            outcomes=joined.outcomes,
            segments=len(content),
            written=None,
            previous=None if snapshot is None else snapshot.head.sequence,
            changed=len(content),
            removed=0,
            bent=None if joined.bent is None else (joined.content, joined.bent),
        )
        if snapshot is None:
            if self.dry_run:
                return result
            return replace(result, written=writer.create(name, content, encode(content), "merge"))
        change = snapshot.layers.change_to(content, snapshot.head.sequence, joined.present)
        if self.dry_run:
            changed, removed = len(change.delta.changed), len(change.delta.removed)
            return replace(result, changed=changed, removed=removed)
        operation = "merge" if joined.bent is None else "bend"
        written = writer.commit(snapshot, change, operation, refreshed=joined.refreshed)
        return replace(result, written=written, changed=written.changed, removed=written.removed)

    def _check_frame_kept(
        self, name: str, before: MapSnapshot | None, snapshot: MapSnapshot | None
    ) -> None:
        """Check that the merged map kept its frame during the alignment; 409 if not."""
        if before is snapshot:
            return
        if before is not None and snapshot is not None and snapshot.shares_frame_with(before):
            return
        raise Problem(
            409,
            "map-changed",
            f"Map {name!r:.80} was replaced during the merge; nothing was changed. Try again.",
        )


def _is_same(one: MapSnapshot | None, other: MapSnapshot | None) -> bool:
    """Return whether two snapshots are the same version of a map, or both None."""
    if one is None or other is None:
        return one is other
    return one.tag == other.tag
