"""Maps put into a site, for one request: laid on each other, joined, and written."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from placecell_client import MapFileError, encode

from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters
from service.core.problems import Problem
from service.maps.deduplication import RADIUS, SameView
from service.maps.snapshot import MapSnapshot
from service.maps.store import OutOfIdsError
from service.maps.writes.writer import MapWriter, WriteResult, out_of_ids
from service.merging.alignment import Check, check_same_model
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


@dataclass(frozen=True, slots=True, eq=False)
class MergeResult:
    """What a merge did, or would do.

    Attributes:
        plan: how the maps lie.
        shares: by number, what became of the segments of those that were merged.
        segments: of the site after it.
        written: what was stored; None of a dry run.
        previous: sequence of the site's version before; None: there was no site.
        changed: segments that were, or would be, added or replaced.
        removed: segments that were, or would be, removed.
    """

    plan: MergePlan
    shares: dict[int, PartOutcome]
    segments: int
    written: WriteResult | None
    previous: int | None
    changed: int
    removed: int


@dataclass(frozen=True, slots=True)
class Merger:
    """Whoever sent a request, as one who merges.

    Attributes:
        writer: who writes the site.
        parameters: of the alignments.
        deduplicate: leave out what another map's segment shows already.
        dry_run: only tell what would be done.
        check: raises an exception when nobody waits any longer.
    """

    writer: MapWriter
    parameters: AlignmentParameters
    deduplicate: bool
    dry_run: bool
    check: Check

    def merge(self, name: str, names: Sequence[str]) -> MergeResult:
        """Merge stored maps into a site, which is made if there is none.

        A site's frame is that of the first map, and stays. Maps that cannot be laid on it are left
        out; if that is all of them, nothing is done.

        Raises:
            Problem: 404 for a map that is not there, 409 if the maps do not go together or the site
                changed meanwhile, and what `MapWriter` finds wrong.
        """
        maps = self.writer.maps
        site = maps.find(name)
        parts = [maps.get(each) for each in names]
        laid = parts if site is None or not len(site) else [site, *parts]
        for each in laid[1:]:
            check_same_model(laid[0], each)
        # It is checked again when the site is written; but that is minutes later.
        self.writer.conditions.check(None if site is None else site.tag)
        model = self.writer.models.named(laid[0].model_id)
        plan = plan_merge(laid, model, self.parameters, self.check)
        before: dict[int, Pose] = {}
        if site is not None and laid[0] is site:
            before = self._as_before(plan)
            plan = replace(plan, poses=plan.poses | before)
        # What lies as it lay is known within its rounding, else within how well maps are aligned.
        joining = {
            number: ROUNDED if number in before else RADIUS
            for number, each in enumerate(laid)
            if number in plan.poses and each is not site
        }
        if len(plan.poses) < 2:
            if self.dry_run:
                segments, previous = (len(site), site.head.sequence) if site else (0, None)
                return MergeResult(plan, {}, segments, None, previous, 0, 0)
            raise Problem(
                409,
                "not-aligned",
                f"No map of {', '.join(names)} can be laid on {laid[0].name!r}; nothing was "
                "changed. With dry_run the answer tells why.",
            )
        self.check()
        with maps.writing(name):
            return self._write(name, site, plan, joining)

    def _as_before(self, plan: MergePlan) -> dict[int, Pose]:
        """How maps that are part of the site already were laid, by number.

        So merging them again changes nothing, where alignment would lay them a little elsewhere.
        """
        site = plan.sides[0].content
        poses = {}
        for number, side in enumerate(plan.sides[1:], start=1):
            pose = known_pose(site, content_of(side), self.parameters)
            if pose is not None:
                poses[number] = pose
        return poses

    def _write(
        self, name: str, before: MapSnapshot | None, plan: MergePlan, joining: Mapping[int, float]
    ) -> MergeResult:
        """Join these parts, by number, each with its slack, and store the site."""
        writer, maps = self.writer, self.writer.maps
        stored = maps.find(name)
        self._check_lies_still(name, before, stored)
        parts = [
            MergePart(
                plan.maps[number].name, content_of(plan.sides[number]), plan.poses[number], slack
            )
            for number, slack in joining.items()
        ]
        manifest = writer.models.named(plan.maps[0].model_id).manifest
        same = SameView.of(manifest) if self.deduplicate else None
        present = None if stored is None else stored.layers.content()
        # One without segments is begun anew, in the first map's frame.
        site = present if present is not None and len(present) else empty_merged_map(plan.maps[0])
        first_id = 0 if stored is None else stored.head.next_id
        try:
            content, found = join_settled(site, parts, first_id, same, self.parameters)
            count = sum(share.added for share in found)
            if stored is not None and count and not self.dry_run:
                reserved = writer.reserve(name, count)
                if reserved != first_id:  # others have reserved some since
                    content, found = join_settled(site, parts, reserved, same, self.parameters)
        except MapFileError as error:
            raise Problem(409, "cannot-merge", f"The maps do not go together: {error}.") from error
        except OutOfIdsError as error:
            raise out_of_ids(name, error) from error
        shares = dict(zip(joining, found, strict=True))
        previous = stored.head.sequence if stored is not None else None
        if stored is None:
            written = None
            if not self.dry_run:
                written = writer.create(name, content, encode(content), "merge")
            return MergeResult(plan, shares, len(content), written, previous, len(content), 0)
        change = stored.layers.change_to(content, stored.head.sequence, present)
        if self.dry_run:
            changed, removed = len(change.delta.changed), len(change.delta.removed)
            return MergeResult(plan, shares, len(content), None, previous, changed, removed)
        written = writer.commit(stored, change, "merge")
        return MergeResult(
            plan, shares, len(content), written, previous, written.changed, written.removed
        )

    def _check_lies_still(
        self, name: str, before: MapSnapshot | None, stored: MapSnapshot | None
    ) -> None:
        """See that the site is the one that the maps were laid on; 409 if not."""
        if before is stored:
            return
        if before is not None and stored is not None and stored.shares_frame_with(before):
            return
        raise Problem(
            409, "map-changed", f"Map {name!r:.80} was replaced during the merge; try again."
        )
