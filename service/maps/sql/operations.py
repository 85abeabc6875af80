"""Writes to a map, within a transaction of the caller."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Protocol

from service.maps.sql.annotations import write_annotations
from service.maps.sql.owners import Owners
from service.maps.sql.rows import Rows
from service.maps.sql.tables import (
    OF_MAPS,
    head_of,
    insert_base,
    insert_commit,
    insert_map,
    numbered_head_of,
    row_of,
    save_head,
)
from service.maps.store import (
    IDS,
    Annotation,
    Ids,
    MapHead,
    Note,
    OutOfIdsError,
    StoreSnapshot,
    TooManyIdsError,
    commit_after,
    skipped_ids,
)

RESERVED_SECONDS = 7 * 24 * 3600.0
"""Time for which a reserved, unwritten id counts against its key's limit, seconds."""


class GivenOut(Protocol):
    """Record beside the database of the ids that were given out."""

    def raise_to(self, uid: str, until: int) -> None:
        """Record that the ids of a map below this id may be given out."""

    def forget(self, uid: str) -> None:
        """Forget a map."""


class Unrecorded:
    """No record: the database itself is the only one."""

    def raise_to(self, uid: str, until: int) -> None:
        """Record nothing."""

    def forget(self, uid: str) -> None:
        """Forget nothing."""


UNRECORDED = Unrecorded()


def create_map(
    rows: Rows, uid: str, name: str, file: bytes, note: Note, next_id: int, ids: Ids
) -> MapHead:
    """Add a map with its first version; ValueError if the name is in use."""
    if rows.execute("SELECT 1 FROM maps WHERE name = ?", (name,)).fetchone():
        raise ValueError(f"map {name!r} exists already")
    commit = commit_after(uid, 1, note, file, 0)
    first, end = ids.leave(next_id, IDS)
    head = MapHead(name, uid, 1, commit.mark, 1, first, len(file), 0, note.author, end)
    (row,) = rows.execute(
        "INSERT INTO maps (name, uid, sequence, mark, base, next_id, base_bytes, log_bytes)"
        " VALUES (?, ?, 1, ?, 1, ?, ?, 0) RETURNING map",
        (name, uid, commit.mark, next_id, len(file)),
    ).fetchone()
    Owners(rows, row).write(ids.written, note.author)
    insert_commit(rows, row, commit, None)
    insert_base(rows, row, file)
    return save_head(rows, row, head)


def append_commit(
    rows: Rows,
    head: MapHead,
    blob: bytes,
    note: Note,
    next_id: int,
    ids: Ids,
    given_out: GivenOut = UNRECORDED,
    annotations: Sequence[Annotation] = (),
) -> MapHead:
    """Add a commit after a head, and write annotations; KeyError if the map has another head."""
    row, found = numbered_head_of(rows, head.uid)
    if found.mark != head.mark:
        raise KeyError(head.name)
    commit = commit_after(head.mark, head.sequence + 1, note, blob, len(blob))
    first, end = ids.leave(max(found.next_id, next_id), found.end_id)
    after = replace(
        found,
        sequence=commit.sequence,
        mark=commit.mark,
        next_id=first,
        end_id=end,
        log_bytes=found.log_bytes + len(blob),
    )
    if after.next_id > found.next_id:
        given_out.raise_to(head.uid, after.next_id)
    Owners(rows, row).write(ids.written, note.author)
    insert_commit(rows, row, commit, blob)
    write_annotations(rows, row, annotations, ())
    return save_head(rows, row, after)


def reserve_ids(
    rows: Rows,
    uid: str,
    count: int,
    author: str,
    most: int,
    now: float,
    given_out: GivenOut = UNRECORDED,
) -> int:
    """Reserve ids that no segment ever had; return the first. Raises as `MapStore` does."""
    row, head = numbered_head_of(rows, uid)
    owners = Owners(rows, row)
    reserved = owners.reserved(author, now - RESERVED_SECONDS)
    if reserved + count > most:
        raise TooManyIdsError(
            f"this key has {reserved:,} reserved ids that it has not written; the limit is {most:,}"
        )
    if head.next_id + count > head.end_id:
        # A larger gap may be beside an id that a robot chose far from the others.
        first, end = owners.largest_gap()
        if end - first < max(count, head.end_id - head.next_id):
            first, end = head.next_id, head.end_id
        if first + count > end:
            raise OutOfIdsError(f"only {max(end - first, 0)} ids are left")
        head = replace(head, next_id=first, end_id=end)
        given_out.forget(uid)
    first = head.next_id
    given_out.raise_to(uid, first + count)
    owners.reserve(first, first + count, author, now)
    save_head(rows, row, replace(head, next_id=first + count))
    return first


def check_mark(rows: Rows, uid: str, mark: str | None) -> None:
    """Raise a KeyError if the newest version of a map has another mark; None: any."""
    if mark is None:
        return
    found = rows.execute("SELECT mark FROM maps WHERE uid = ?", (uid,)).fetchone()
    if found is None or found[0] != mark:
        raise KeyError(uid)


def free_unused(rows: Rows, uid: str, used: Iterable[int]) -> MapHead:
    """Forget the owners of ids that are not in `used`, which ascends."""
    row, head = numbered_head_of(rows, uid)
    owners = Owners(rows, row)
    owners.keep_only(used)
    first, end = owners.largest_gap()
    return save_head(rows, row, replace(head, next_id=first, end_id=end))


def compact_map(rows: Rows, uid: str, sequence: int, file: bytes) -> MapHead:
    """Drop the versions before one, whose file is given; KeyError if it is not kept."""
    row, head = numbered_head_of(rows, uid)
    found = rows.execute(
        "UPDATE commits SET delta = NULL, bytes = 0 WHERE map = ? AND sequence = ?",
        (row, sequence),
    )
    if not found.rowcount:
        raise KeyError(sequence)
    rows.execute("DELETE FROM commits WHERE map = ? AND sequence < ?", (row, sequence))
    rows.execute("DELETE FROM bases WHERE map = ?", (row,))
    insert_base(rows, row, file)
    (left,) = rows.execute(
        "SELECT coalesce(sum(bytes), 0) FROM commits WHERE map = ?", (row,)
    ).fetchone()
    after = replace(head, oldest=sequence, base_bytes=len(file), log_bytes=int(left))
    save_head(rows, row, after)
    return head_of(rows, uid)


def delete_map(rows: Rows, uid: str) -> None:
    """Remove a map with all its versions; KeyError if there is no such map."""
    row = row_of(rows, uid)
    for table in OF_MAPS:
        rows.execute(f"DELETE FROM {table} WHERE map = ?", (row,))


def import_all(
    rows: Rows,
    source: StoreSnapshot,
    skipped: int,
    replaces: bool,
    given_out: dict[str, int] | None = None,
) -> list[MapHead]:
    """Add all maps of a snapshot; ValueError if there are maps that may not be removed.

    Args:
        rows: the database.
        source: the maps.
        skipped: number of ids of each map that are not given out again.
        replaces: whether the present maps are removed.
        given_out: end of the ids that were given out, by uid, for the maps where it is known.
    """
    if not replaces and rows.execute("SELECT 1 FROM maps").fetchone():
        raise ValueError("the store has maps already")
    for table in OF_MAPS:
        rows.execute(f"DELETE FROM {table}")
    annotations = source.annotations()
    heads = []
    for head in source.heads():
        known = (given_out or {}).get(head.uid)
        # A known limit is exact: it was recorded before the ids were given out.
        first = skipped_ids(head, known or 0, skipped if known is None else 0)
        after = replace(head, next_id=first)
        row = insert_map(rows, after, source.history(head.uid))
        owners = Owners(rows, row)
        owners.insert(source.owned_ids(head.uid))
        if first > head.next_id:  # their owner is not known
            owners.reserve(head.next_id, first, "", 0.0)
        write_annotations(rows, row, annotations.get(head.uid, ()), ())
        heads.append(after)
    return heads
