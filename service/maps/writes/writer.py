"""Writes to maps, each for one request: what is asked, whether it may be, and what it did."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from placecell_client import CompactMap, Delta, encode
from placecell_client.maps.edit import apply, delta_between, take

from placecell.core.types import UInt32
from service.core.auth import Holder
from service.core.preconditions import Preconditions
from service.core.problems import Problem
from service.inference.model_registry import Models
from service.maps.deduplication import NONE, RADIUS, VIEWS, SameView, Sighting, sighting
from service.maps.history import load_version, robots_ever
from service.maps.layers import MapLayers, robots_of
from service.maps.quotas import OverQuotaError
from service.maps.repository import MapRepository, unknown
from service.maps.snapshot import MapSnapshot
from service.maps.store import IDS, MapHead, OutOfIdsError, TooManyIdsError
from service.maps.visibility import written_by
from service.maps.writes.clock_check import check_times
from service.maps.writes.id_rules import check_added, check_authors, check_new
from service.maps.writes.validation import check_joins, edit_of, map_of


@dataclass(frozen=True, slots=True)
class WriteResult:
    """What a write did.

    Attributes:
        stored: the map after it.
        changed: segments added or replaced.
        removed: segments removed.
        is_new: whether there was no such map before.
        repeats: segments that were not stored, for they were seen before.
    """

    stored: MapSnapshot
    changed: int
    removed: int
    is_new: bool = False
    repeats: int = 0


Check = Callable[[MapSnapshot, CompactMap, Delta], None]
"""Check of an edit: takes the map, the segments that it replaces or removes, and the delta."""


@dataclass(frozen=True, slots=True)
class MapWriter:
    """Whoever sent a request, at work on the maps.

    What leads to where the map is already is done, not refused, and makes no version: so a `put` or
    an `edit` whose answer was lost can be sent again; at worst that brings back what others removed
    since. Under If-Match: *, or if it is an `age`, a `restore`, a merge or a `delete`, it would
    undo what others wrote since; under an ETag these are done to that version or not at all.
    `compact` heeds no conditions: sent again, it may let go of more.

    Attributes:
        maps: all.
        models: loaded.
        holder: of the key.
        conditions: under which they write.
    """

    maps: MapRepository
    models: Models
    holder: Holder
    conditions: Preconditions

    def put(self, name: str, data: bytes) -> WriteResult:
        """Make a map what a file says; what others wrote is replaced only if it was seen."""
        content = map_of(data, self.models)
        with self.maps.writing(name):
            stored = self.maps.find(name)
            content = written_by(self.holder, stored, content)
            if stored is None:
                return self.create(name, content, "put")
            delta = delta_to(stored, content)
            return self.commit(stored, delta, "put", replaces=True)

    def edit(
        self,
        name: str,
        data: bytes,
        robot: str | None,
        create: bool,
        deduplicate: bool,
        only_new: bool = False,
    ) -> WriteResult:
        """Add, replace and remove segments, all or none.

        Args:
            name: of the map.
            data: a delta file.
            robot: whose segments may be removed, beside the key's and those of changed segments.
            create: make the map if there is none.
            deduplicate: do not store again what is seen again.
            only_new: refuse to replace a segment, whoever wrote it.
        """
        edit = edit_of(data, self.models)
        self.holder.check_robots(robots_of(edit.changed))
        check_times(edit.changed)
        owners = {robot, self.holder.key.robot, *edit.changed.robots} - {None}
        refreshed = NONE

        def check(stored: MapSnapshot, before: CompactMap, delta: Delta) -> None:
            written = np.setdiff1d(delta.changed.ids, refreshed)
            replaced = np.intersect1d(before.ids, written)
            if only_new:
                check_added(replaced)
            if self.conditions.if_match is not None:
                return
            _check_own(before, delta, owners)
            # With `robot` the request says whose segments are removed.
            old = replaced if robot is not None else np.union1d(replaced, delta.removed)
            new = np.setdiff1d(written, before.ids)
            check_authors(self.maps.store, self.holder, stored.head, old, new)

        with self.maps.writing(name):
            stored = self.maps.find(name) if create else self.maps.get(name)
            edit = replace(edit, changed=written_by(self.holder, stored, edit.changed))
            layers = stored.layers if stored is not None else MapLayers.of(take(edit.changed, NONE))
            check_joins(edit.changed, name, layers.base)
            seen = self._sighting(edit, layers) if deduplicate else None
            if seen is not None:
                edit = replace(edit, changed=seen.changed)
            if stored is None:
                written = self.create(name, edit.changed, "edit")
            else:
                refreshed = seen.refreshed if seen is not None else NONE
                written = self.commit(stored, edit, "edit", check, refreshed)
            return replace(written, repeats=seen.repeats if seen is not None else 0)

    def restore(self, name: str, sequence: int) -> WriteResult:
        """Make a map again what it was."""
        with self.maps.writing(name):
            stored = self.maps.get(name)
            layers, _ = load_version(self.maps.store, stored, sequence)
            return self.commit(stored, delta_to(stored, layers.content()), "restore")

    def prune(self, name: str, unseen_since: float, dry_run: bool) -> WriteResult:
        """Remove what was last seen before a time, seconds of the frames' clock.

        Args:
            name: of the map.
            unseen_since: the time.
            dry_run: only tell how many they are.
        """
        with self.maps.writing(name):
            stored = self.maps.get(name)
            ids, seen = stored.layers.last_seen()
            removed = np.sort(ids[seen < unseen_since])
            if dry_run:
                return WriteResult(stored, 0, len(removed))
            nothing = stored.layers.take(removed[:0])
            return self.commit(stored, Delta(nothing, removed), "age")

    def delete(self, name: str) -> int:
        """Remove a map; how many segments it had, 0 if it was damaged."""
        with self.maps.writing(name):
            if name in self.maps.damaged():
                # Whose segments it had cannot be told.
                self.holder.check_all()
                self.maps.delete(name)
                return 0
            stored = self.maps.get(name)
            self.holder.check_robots(stored.layers.robots)
            if self.holder.key.robot is not None:
                # What others wrote and removed can be restored as long as the map is there.
                self.holder.check_robots(robots_ever(self.maps.store, stored))
            self.conditions.check(stored.tag)
            self.maps.delete(name)
            return len(stored)

    def compact(self, name: str, keep: int) -> MapSnapshot:
        """Let go of all but the last versions.

        Args:
            name: of the map.
            keep: so many, 1 or more.
        """
        self.holder.check_all()
        stored = self.maps.get(name)
        sequence = max(stored.head.sequence - keep + 1, stored.head.oldest)
        if sequence == stored.head.oldest:
            return stored
        layers, _ = load_version(self.maps.store, stored, sequence)
        return self.maps.compact(stored.head, sequence, encode(layers.content()))

    def reserve(self, name: str, count: int, most: int = IDS) -> int:
        """Reserve `count` ids that no segment ever had and no other key holds; return the first.

        Args:
            name: of the map.
            count: how many.
            most: ids that the key may have reserved lately and not written.

        Raises:
            Problem: 409 if there are not so many, or the key has too many.
        """
        try:
            uid = self.maps.get(name).head.uid
            return self.maps.store.reserve(uid, count, self.holder.name, most)
        except TooManyIdsError as error:
            raise Problem(
                409,
                "too-many-ids",
                f"Map {name!r:.80}: {error}. Write segments with these ids first. Reserved ids "
                "stop counting after a week; POST /maps/MAP/ids/reset frees all of them.",
            ) from error
        except KeyError as error:
            raise unknown(name) from error
        except OutOfIdsError as error:
            raise out_of_ids(name, error) from error

    def reset_ids(self, name: str) -> MapHead:
        """Make all ids free that no version of the map has; for administrators."""
        self.holder.check_admin()
        with self.maps.writing(name):
            return self.maps.free_ids(self.maps.get(name))

    def _sighting(self, edit: Delta, layers: MapLayers) -> Sighting:
        upload = edit.changed
        # As far as the views of a thing reach, for all of them count.
        there = layers.near(upload.centroids, VIEWS * RADIUS)
        stored = apply(there, Delta(layers.take(upload.ids), NONE))
        # What the edit removes was not seen again.
        stored = take(stored, ~np.isin(stored.ids, edit.removed))
        return sighting(upload, stored, SameView.of(self.models.named(upload.model_id).manifest))

    def create(self, name: str, content: CompactMap, operation: str) -> WriteResult:
        """Store a new map, as far as the key and the conditions allow; `Maps.writing` is held."""
        self.holder.check_robots(robots_of(content))
        self.conditions.check(None)
        check_times(content)
        check_new(self.maps.store, self.holder, None, content.ids)
        with self._told_quota():
            stored = self.maps.create(name, content, self.holder.name, operation)
        return WriteResult(stored, len(content), 0, is_new=True)

    def commit(
        self,
        stored: MapSnapshot,
        asked: Delta,
        operation: str,
        check: Check = lambda *_: None,
        refreshed: UInt32 = NONE,
        replaces: bool = False,
    ) -> WriteResult:
        """Do what a delta asks, as far as the key and the conditions allow; `Maps.writing` is held.

        Args:
            stored: the map as it is.
            asked: what to do; nothing is written if that changes nothing.
            operation: for the history.
            check: raises a problem if what is replaced or removed may not be.
            refreshed: ids of segments that were only seen again.
            replaces: whether other content is replaced, which needs If-Match.
        """
        before, delta = stored.layers.effect_of(asked)
        if not stored.layers.is_changed_by(delta):
            return WriteResult(stored, 0, 0)
        # To have seen another's segment again is not to write it.
        for content in (before, delta.changed):
            self.holder.check_robots(robots_of(take(content, ~np.isin(content.ids, refreshed))))
        if replaces:
            self.conditions.check_replaces(stored.tag)
        else:
            self.conditions.check(stored.tag)
        check(stored, before, delta)
        written = None
        if operation not in {"restore", "age"}:
            written = np.setdiff1d(delta.changed.ids, refreshed)
            new = np.setdiff1d(written, before.ids)
            check_times(delta.changed)
            if operation == "merge":
                written = new
            else:
                check_new(self.maps.store, self.holder, stored.head, new)
        with self._told_quota():
            stored = self.maps.commit(stored, delta, self.holder.name, operation, written)
        return WriteResult(stored, len(delta.changed), len(delta.removed))

    @contextmanager
    def _told_quota(self) -> Iterator[None]:
        """Show the totals of all maps only to a key that opens all maps."""
        try:
            yield
        except OverQuotaError as error:
            if self.holder.opens_all:
                error.detail = error.whole
            raise


def out_of_ids(name: str, error: OutOfIdsError) -> Problem:
    """What is told when a map has too few ids left."""
    return Problem(409, "out-of-ids", f"Map {name!r}: {error}.")


def delta_to(stored: MapSnapshot, content: CompactMap, present: CompactMap | None = None) -> Delta:
    """From a map as it is to a content.

    Args:
        present: what the map holds, for those who have put it together already.
    """
    sequence = stored.head.sequence
    present = stored.layers.content() if present is None else present
    return delta_between(present, content, sequence, sequence + 1)


def _check_own(before: CompactMap, delta: Delta, owners: set[str | None]) -> None:
    """See that no segment becomes another robot's, nor is removed by one; 409 if it would."""
    after = dict(zip(delta.changed.ids.tolist(), _names(delta.changed), strict=True))
    taken = {
        id_: robot
        for id_, robot in zip(before.ids.tolist(), _names(before), strict=True)
        if (after[id_] != robot if id_ in after else robot not in owners)
    }
    if taken:
        whose = ", ".join(sorted(set(taken.values())))
        raise Problem(
            409,
            "id-taken",
            f"{len(taken)} ids are of segments of {whose:.200}: take others (POST /maps/MAP/ids), "
            "or say If-Match if you mean to replace or remove these.",
            ids=list(taken),
        )


def _names(content: CompactMap) -> list[str]:
    """Of each segment's robot."""
    return [content.robots[index] for index in content.robot.tolist()]
