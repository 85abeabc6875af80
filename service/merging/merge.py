"""Merge: aligns stored maps, joins their segments, and writes the merged map."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from placecell_client import MapFileError, encode

from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters
from placecell.pose_graph import PoseGraphParameters
from service.core.problems import Problem
from service.maps.snapshot import MapSnapshot
from service.maps.store import OutOfIdsError
from service.maps.writes.deduplication import RADIUS, SameView
from service.maps.writes.writer import MapWriter, WriteResult, out_of_ids
from service.merging.alignment import CancellationCheck, check_same_model
from service.merging.bending import bend_content
from service.merging.join import (
    ROUNDED,
    MergePart,
    PartOutcome,
    content_of,
    empty_merged_map,
    join_settled,
    known_pose,
)
from service.merging.plan import MergePlan, plan_merge

AnchorOutcome = Literal["carried", "kept", "conflict"]


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
    """

    plan: MergePlan
    outcomes: dict[int, PartOutcome]
    segments: int
    written: WriteResult | None
    previous: int | None
    changed: int
    removed: int
    anchors: tuple[CarriedAnchor, ...] = ()


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
        left out; if no map can be aligned, nothing is written.

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
        plan = plan_merge(aligned, model, self.parameters, self.check)
        before: dict[int, Pose] = {}
        if target is not None and aligned[0] is target:
            before = self._known_poses(plan)
            plan = replace(plan, poses=plan.poses | before)
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
        with maps.writing(name):
            return self._write(name, target, plan, joining)

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

    def _write(
        self, name: str, before: MapSnapshot | None, plan: MergePlan, joining: Mapping[int, float]
    ) -> MergeResult:
        """Join these parts, by number, each with its slack, and store the merged map."""
        writer, maps = self.writer, self.writer.maps
        snapshot = maps.find(name)
        self._check_frame_kept(name, before, snapshot)
        parts = [
            MergePart(
                plan.maps[number].name, content_of(plan.sides[number]), plan.poses[number], slack
            )
            for number, slack in joining.items()
        ]
        manifest = writer.models.named(plan.maps[0].model_id).manifest
        same = SameView.of(manifest) if self.deduplicate else None
        present = None if snapshot is None else snapshot.layers.content()
        # A merged map without segments takes the frame of the first map.
        target = present if present is not None and len(present) else empty_merged_map(plan.maps[0])
        first_id = 0 if snapshot is None else snapshot.head.next_id
        try:
            content, found = join_settled(target, parts, first_id, same, self.parameters)
            count = sum(outcome.added for outcome in found)
            if snapshot is not None and count and not self.dry_run:
                reserved = writer.reserve(name, count)
                if reserved != first_id:  # another request reserved ids in the meantime
                    content, found = join_settled(target, parts, reserved, same, self.parameters)
        except MapFileError as error:
            raise Problem(
                409, "cannot-merge", f"The maps cannot be joined: {error}. Leave one of them out."
            ) from error
        except OutOfIdsError as error:
            raise out_of_ids(name, error) from error
        if not self.rigid:
            self.check()
            model = writer.models.named(plan.maps[0].model_id)
            _, bent = bend_content(content, model, PoseGraphParameters())
            content = content if bent is None else bent
        outcomes = dict(zip(joining, found, strict=True))
        previous = snapshot.head.sequence if snapshot is not None else None
        if snapshot is None:
            written = None
            if not self.dry_run:
                written = writer.create(name, content, encode(content), "merge")
            return MergeResult(plan, outcomes, len(content), written, previous, len(content), 0)
        change = snapshot.layers.change_to(content, snapshot.head.sequence, present)
        if self.dry_run:
            changed, removed = len(change.delta.changed), len(change.delta.removed)
            return MergeResult(plan, outcomes, len(content), None, previous, changed, removed)
        written = writer.commit(snapshot, change, "merge")
        return MergeResult(
            plan, outcomes, len(content), written, previous, written.changed, written.removed
        )

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
