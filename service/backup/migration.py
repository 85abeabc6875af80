"""Moves all maps from one store into another, and compares both at the end."""

from collections.abc import Callable, Iterator
from dataclasses import replace

from service.backup.counting import CountedSnapshot
from service.backup.databases import check_name, is_same, reading, shown, writing
from service.maps.store import Annotation, MapHead, MapHistory, OwnedIds, StoreSnapshot


class MigrationError(ValueError):
    """Maps were not moved."""


def differences(one: StoreSnapshot, other: StoreSnapshot) -> Iterator[str]:
    """Yield what differs between two snapshots: marks, bytes, owners, annotations."""
    heads = {head.uid: head for head in other.heads()}
    annotations, others = one.annotations(), other.annotations()
    for head in one.heads():
        found = heads.pop(head.uid, None)
        # A store may know ids that were given out since, and never gives them out again.
        if (
            found is None
            or found.next_id < head.next_id
            or replace(found, next_id=head.next_id) != head
        ):
            yield f"map {head.name!r}: its head"
            continue
        left, right = one.history(head.uid), other.history(head.uid)
        span = head.oldest, head.sequence
        if left.commits() != right.commits():
            yield f"map {head.name!r}: its list of versions"
        elif left.base() != right.base():
            yield f"map {head.name!r}: version {head.oldest}"
        elif any(a != b for a, b in zip(left.blobs(*span), right.blobs(*span), strict=True)):
            yield f"map {head.name!r}: its changes"
        is_same = found.next_id == head.next_id
        if is_same and one.owned_ids(head.uid) != other.owned_ids(head.uid):
            yield f"map {head.name!r}: its owners of ids"
        if _sorted(annotations.get(head.uid)) != _sorted(others.get(head.uid)):
            yield f"map {head.name!r}: its tags or anchors"
    for extra in heads.values():
        yield f"map {extra.name!r}: it is in one store only"


def migrate(
    source: str, target: str, on_total: Callable[[int], None], on_bytes: Callable[[int], None]
) -> list[MapHead]:
    """Move all maps of a store into an empty store, in one transaction; return their heads.

    Args:
        source: store to read, which no service may use meanwhile; it stays as it is.
        target: store to fill.
        on_total: is called with the number of bytes to read.
        on_bytes: is called with each number of bytes that were read.

    Raises:
        ValueError: a name is not that of a store.
        MigrationError: both names are of one store; the target has other maps; or the copy
            differs, and the target is empty.
        StoreLockedError: a service uses one of the two.
        StoreError: one of the two cannot be used.
    """
    for database in (source, target):
        check_name(database)
    if is_same(source, target):
        raise MigrationError(
            f"{shown(source)} is both the source and the target. Name another target. Nothing was "
            "changed."
        )
    with reading(source, owns=True) as maps, writing(target) as store:
        counted = CountedSnapshot(maps, on_bytes)
        # All is read once to copy it, and once to compare it.
        on_total(2 * sum(head.bytes for head in maps.heads()))
        if store.heads():
            # A command that was killed after the copy is complete can be repeated.
            with store.snapshot() as copied:
                if next(differences(counted, copied), None):
                    raise MigrationError(
                        f"{shown(target)} has other maps. Name an empty target. Nothing was "
                        "changed."
                    )
            return store.heads()
        heads = store.import_maps(counted)
        with store.snapshot() as copied:
            wrong = next(differences(counted, copied), None)
        with reading(source) as now:
            written = now.heads() != maps.heads()
        if wrong or written:
            store.import_maps(NoMaps(), replaces=True)
            reason = f"{wrong} differs in the copy" if wrong else "a service wrote to it meanwhile"
            raise MigrationError(
                f"{shown(source)} was not moved: {reason}. The target is empty again. Stop all "
                "services that use the source, and repeat the command."
            )
        return heads


class NoMaps:
    """Snapshot without maps."""

    def heads(self) -> list[MapHead]:
        """Return no heads."""
        return []

    def history(self, uid: str) -> MapHistory:
        """Raise a KeyError."""
        raise KeyError(uid)

    def owned_ids(self, uid: str) -> list[OwnedIds]:
        """Raise a KeyError."""
        raise KeyError(uid)

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return no annotations."""
        return {}


def _sorted(rows: list[Annotation] | None) -> list[Annotation]:
    return sorted(rows or (), key=lambda row: (row.kind, row.name))
