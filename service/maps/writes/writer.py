"""Map writer: carries out the writes of one request under its key and its preconditions."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from placecell_client import CompactMap, Delta, decode, decode_delta, encode
from placecell_client.maps.edit import apply, take
from placecell_client.maps.follow import followed

from placecell.core.types import UInt32
from service.core.auth import Principal
from service.core.preconditions import Preconditions
from service.core.problems import Problem
from service.inference.model_registry import Models
from service.maps.history import load_version, robots_ever
from service.maps.layers import MapChange, MapLayers, robots_of
from service.maps.quotas import OverQuotaError
from service.maps.repository import MapRepository, unknown_map
from service.maps.snapshot import MapSnapshot
from service.maps.store import IDS, MapHead, OutOfIdsError, TooManyIdsError
from service.maps.visibility import restore_names
from service.maps.writes.clock_check import check_times
from service.maps.writes.deduplication import (
    NONE,
    RADIUS,
    VIEWS,
    Deduplicated,
    SameView,
    deduplicate,
)
from service.maps.writes.id_rules import check_authors, check_new, check_only_new, check_own
from service.maps.writes.long_life import judged_by
from service.maps.writes.newest import on_newest
from service.maps.writes.validation import (
    FileKind,
    check_applies_to_any,
    check_joins,
    check_model,
    reading,
)


@dataclass(frozen=True, slots=True)
class WriteResult:
    """Result of a write.

    Attributes:
        snapshot: the map after the write.
        changed: number of segments added or replaced.
        removed: number of segments removed.
        is_new: whether the write created the map.
        repeats: number of segments that were not stored, because they had been seen before.
    """

    snapshot: MapSnapshot
    changed: int
    removed: int
    is_new: bool = False
    repeats: int = 0


@dataclass(frozen=True, slots=True)
class EditOptions:
    """Options of an edit.

    Attributes:
        robot: robot whose segments may be removed, besides the key's robot and the robots of the
            changed segments; None: no further robot.
        create: create the map if it does not exist.
        deduplicate: do not store segments that were seen before.
        only_new: refuse to replace segments.
    """

    robot: str | None = None
    create: bool = False
    deduplicate: bool = False
    only_new: bool = False


@dataclass(frozen=True, slots=True)
class MapWriter:
    """Writes to maps for one request.

    A write that leaves the map unchanged succeeds and creates no version. So a client can repeat a
    `put` or an `edit` whose answer was lost; at worst that restores segments that other clients
    removed in the meantime. A repeated `prune`, `restore`, merge or `delete` could undo writes of
    other clients, and so could any write under `If-Match: *`; under an ETag the write applies to
    that version or fails. `compact` ignores preconditions: a repeated call may drop more versions.

    Attributes:
        maps: the repository.
        models: the loaded models.
        principal: principal of the request.
        conditions: preconditions of the request.
    """

    maps: MapRepository
    models: Models
    principal: Principal
    conditions: Preconditions

    @on_newest
    def put(self, name: str, data: bytes) -> WriteResult:
        """Create a map from a file, or replace its content if the request names its version."""
        with reading("map"):
            content = decode(data)
        self._check_model(content, "map")
        with self.maps.writing(name):
            snapshot = self.maps.find(name)
            restored = restore_names(self.principal, snapshot, content)
            if snapshot is None:
                # The upload was proved canonical when it was read: it is stored as it came.
                file = data if restored is content else encode(restored)
                return self.create(name, restored, file, "put")
            change = snapshot.layers.change_to(restored, snapshot.head.sequence)
            return self.commit(snapshot, change, "put", replaces=True)

    @on_newest
    def edit(self, name: str, data: bytes, options: EditOptions = EditOptions()) -> WriteResult:
        """Add, replace and remove segments, all or none.

        Args:
            name: name of the map.
            data: a delta file.
            options: options of the edit.
        """
        with reading("delta"):
            edit = decode_delta(data)
        check_applies_to_any(edit)
        self._check_model(edit.changed, "delta")
        self.principal.check_robots(robots_of(edit.changed))
        check_times(edit.changed)
        owners = {options.robot, self.principal.key.robot, *edit.changed.robots} - {None}
        with self.maps.writing(name):
            snapshot = self.maps.find(name) if options.create else self.maps.get(name)
            edit = replace(edit, changed=restore_names(self.principal, snapshot, edit.changed))
            layers = MapLayers.of(take(edit.changed, NONE)) if snapshot is None else snapshot.layers
            check_joins(edit.changed, name, layers.base)
            # A robot writes in its odometry frame, also after its captures were moved.
            edit = replace(edit, changed=followed(edit.changed, [layers.base, layers.recent]))
            refreshed, repeats = NONE, 0
            if options.deduplicate:
                unique = self._deduplicated(edit, layers)
                changed, refreshed = unique.changed, unique.refreshed
                if edit.changed.extents is not None and len(edit.changed):
                    changed, refreshed = judged_by(
                        edit.changed, changed, refreshed, edit.removed, layers
                    )
                edit, repeats = replace(edit, changed=changed), unique.repeats
            if snapshot is None:
                result = self.create(name, edit.changed, encode(edit.changed), "edit")
                return replace(result, repeats=repeats)
            change = layers.effect_of(edit)
            if change.is_empty:
                return WriteResult(snapshot, 0, 0, repeats=repeats)
            self._authorize(snapshot, change, refreshed=refreshed)
            self._check_edit(snapshot, change, refreshed, owners, options)
            return replace(self._store(snapshot, change, "edit", refreshed), repeats=repeats)

    @on_newest
    def restore(self, name: str, sequence: int, dry_run: bool = False) -> WriteResult:
        """Write the content of an earlier version as a new version.

        Args:
            name: name of the map.
            sequence: sequence of the earlier version.
            dry_run: only count the segments that would change.
        """
        with self.maps.writing(name):
            snapshot = self.maps.get(name)
            layers, _ = load_version(self.maps.store, snapshot, sequence)
            change = snapshot.layers.change_to(layers.content(), snapshot.head.sequence)
            if dry_run:
                return WriteResult(snapshot, len(change.delta.changed), len(change.delta.removed))
            return self.commit(snapshot, change, "restore")

    @on_newest
    def prune(self, name: str, unseen_since: float, dry_run: bool) -> WriteResult:
        """Remove segments that were last seen before a time.

        Args:
            name: name of the map.
            unseen_since: the time, seconds of the frames' clock.
            dry_run: only count the segments.
        """
        with self.maps.writing(name):
            snapshot = self.maps.get(name)
            ids, seen = snapshot.layers.last_seen()
            removed = np.sort(ids[seen < unseen_since])
            if dry_run:
                return WriteResult(snapshot, 0, len(removed))
            change = snapshot.layers.effect_of(Delta(snapshot.layers.take(NONE), removed))
            return self.commit(snapshot, change, "age")

    @on_newest
    def delete(self, name: str) -> int:
        """Remove a map; return how many segments it had, 0 if it was damaged."""
        with self.maps.writing(name):
            if name in self.maps.damaged():
                # The robots of a damaged map are not known.
                self.principal.check_all()
                self.maps.delete(name)
                return 0
            snapshot = self.maps.get(name)
            self.principal.check_robots(snapshot.layers.robots)
            if self.principal.key.robot is not None:
                # Removed segments of other robots can be restored as long as the map exists.
                self.principal.check_robots(robots_ever(self.maps.store, snapshot))
            self.conditions.check(snapshot.tag)
            self.maps.delete(name)
            return len(snapshot)

    @on_newest
    def compact(self, name: str, keep: int) -> MapSnapshot:
        """Drop all but the last `keep` versions; `keep` is 1 or more."""
        self.principal.check_all()
        snapshot = self.maps.get(name)
        sequence = max(snapshot.head.sequence - keep + 1, snapshot.head.oldest)
        if sequence == snapshot.head.oldest:
            return snapshot
        layers, _ = load_version(self.maps.store, snapshot, sequence)
        return self.maps.compact(snapshot.head, sequence, encode(layers.content()))

    @on_newest
    def reserve(self, name: str, count: int, most: int = IDS) -> int:
        """Reserve `count` ids that no segment ever had and no other key holds; return the first.

        Args:
            name: name of the map.
            count: number of ids.
            most: largest number of ids that the key may hold reserved and unwritten.

        Raises:
            Problem: 409 if the map has too few free ids, or the key holds too many.
        """
        try:
            uid = self.maps.get(name).head.uid
            return self.maps.store.reserve(uid, count, self.principal.name, most)
        except TooManyIdsError as error:
            raise Problem(
                409,
                "too-many-ids",
                f"Map {name!r:.80}: {error}. Write segments with these ids first. Reserved ids "
                "stop counting after a week; POST /maps/MAP/ids/reset frees all of them.",
            ) from error
        except KeyError as error:
            raise unknown_map(name) from error
        except OutOfIdsError as error:
            raise out_of_ids(name, error) from error

    @on_newest
    def reset_ids(self, name: str) -> MapHead:
        """Free all ids that no kept version of the map has; for administrators."""
        self.principal.check_admin()
        with self.maps.writing(name):
            return self.maps.free_ids(self.maps.get(name))

    def create(self, name: str, content: CompactMap, file: bytes, operation: str) -> WriteResult:
        """Store a new map if the key and the preconditions allow it; `writing(name)` is held.

        Args:
            name: name of the map.
            content: its segments, in canonical form.
            file: the map file of this content.
            operation: name of the operation in the history.
        """
        self.principal.check_robots(robots_of(content))
        self.conditions.check(None)
        check_times(content)
        check_new(self.maps.store, self.principal, None, content.ids)
        with self._quota_detail():
            snapshot = self.maps.create(name, content, file, self.principal.name, operation)
        return WriteResult(snapshot, len(content), 0, is_new=True)

    def commit(
        self,
        snapshot: MapSnapshot,
        change: MapChange,
        operation: str,
        replaces: bool = False,
        refreshed: UInt32 = NONE,
    ) -> WriteResult:
        """Store the next version if the key and the preconditions allow it; `writing` is held.

        Args:
            snapshot: the map as it is.
            change: what to change; an empty change succeeds and creates no version.
            operation: name of the operation in the history.
            replaces: the write replaces other content, so it needs If-Match.
            refreshed: ids of segments whose counts and `seen` alone change.
        """
        if change.is_empty:
            return WriteResult(snapshot, 0, 0)
        self._authorize(snapshot, change, refreshed, replaces)
        return self._store(snapshot, change, operation, refreshed)

    def _check_model(self, content: CompactMap, kind: FileKind) -> None:
        model = self.models.find(content.model_id)
        if model is None:
            raise self.models.unknown(content.model_id)
        check_model(content, model, kind)

    def _deduplicated(self, edit: Delta, layers: MapLayers) -> Deduplicated:
        upload = edit.changed
        # All views of an object count, so the search reaches as far as they extend.
        near = layers.near(upload.centroids, VIEWS * RADIUS)
        stored = apply(near, Delta(layers.take(upload.ids), NONE))
        # The robot did not see again what its edit removes.
        stored = take(stored, ~np.isin(stored.ids, edit.removed))
        manifest = self.models.named(upload.model_id).manifest
        return deduplicate(upload, stored, SameView.of(manifest))

    def _authorize(
        self,
        snapshot: MapSnapshot,
        change: MapChange,
        refreshed: UInt32 = NONE,
        replaces: bool = False,
    ) -> None:
        """Check the key's scope and the preconditions.

        Args:
            snapshot: the map as it is.
            change: what to change.
            refreshed: ids of segments whose counts and `seen` alone change, which any robot may do.
            replaces: the write replaces other content, so it needs If-Match.
        """
        for content in (change.before, change.delta.changed):
            self.principal.check_robots(robots_of(take(content, ~np.isin(content.ids, refreshed))))
        if replaces:
            self.conditions.check_replaces(snapshot.tag)
        else:
            self.conditions.check(snapshot.tag)

    def _check_edit(
        self,
        snapshot: MapSnapshot,
        change: MapChange,
        refreshed: UInt32,
        owners: set[str | None],
        options: EditOptions,
    ) -> None:
        """Check that an edit takes no segment or id of others, unless If-Match confirms it."""
        before, delta = change.before, change.delta
        written = np.setdiff1d(delta.changed.ids, refreshed)
        replaced = np.intersect1d(before.ids, written)
        if options.only_new:
            check_only_new(replaced)
        if self.conditions.if_match is not None:
            return
        check_own(before, delta, owners)
        # An edit that names a robot states whose segments it removes.
        named = options.robot is not None
        old = replaced if named else np.union1d(replaced, delta.removed)
        new = np.setdiff1d(written, before.ids)
        check_authors(self.maps.store, self.principal, snapshot.head, old, new)

    def _store(
        self,
        snapshot: MapSnapshot,
        change: MapChange,
        operation: str,
        refreshed: UInt32 = NONE,
    ) -> WriteResult:
        owned = self._owned_ids(snapshot, change, operation, refreshed)
        with self._quota_detail():
            after = self.maps.commit(snapshot, change.delta, self.principal.name, operation, owned)
        return WriteResult(after, len(change.delta.changed), len(change.delta.removed))

    def _owned_ids(
        self, snapshot: MapSnapshot, change: MapChange, operation: str, refreshed: UInt32
    ) -> UInt32 | None:
        """Check times and new ids; return the ids that become this key's; None: owners stay."""
        if operation in {"restore", "age", "optimize"}:
            return None
        check_times(change.delta.changed)
        written = np.setdiff1d(change.delta.changed.ids, refreshed)
        new = np.setdiff1d(written, change.before.ids)
        if operation in {"merge", "bend"}:  # it reserved its ids
            return new
        check_new(self.maps.store, self.principal, snapshot.head, new)
        return written

    @contextmanager
    def _quota_detail(self) -> Iterator[None]:
        """Add the totals of all maps to a quota error for a key of all maps."""
        try:
            yield
        except OverQuotaError as error:
            if self.principal.covers_all:
                error.detail = error.whole
            raise


def out_of_ids(name: str, error: OutOfIdsError) -> Problem:
    """Return the problem of a map that has too few free ids."""
    return Problem(
        409,
        "out-of-ids",
        f"Map {name!r:.80}: {error}. Compact the map, then free unused ids "
        "(POST /maps/MAP/ids/reset).",
    )
