"""Rows of the tables of a store: maps, commits, files of the oldest versions."""

import hashlib
import json
from collections.abc import Sequence
from typing import Any

from service.maps.sql.rows import Rows
from service.maps.store import Commit, MapHead, MapHistory, Note, StoreError

PART_BYTES = 4 << 20
"""Largest number of bytes of a base in one row."""

OF_MAPS = ("commits", "bases", "owners", "annotations", "maps")
"""Tables whose rows belong to a map."""

HEAD = """
SELECT name, uid, sequence, mark, base, next_id, base_bytes, log_bytes, coalesce(
    (SELECT author FROM commits WHERE commits.map = maps.map AND commits.sequence = maps.base), ''
), end_id, digest FROM maps"""
NUMBERED = HEAD.replace(" FROM maps", ", maps.map FROM maps")
"""Columns of a head, and the row number of the map."""
COMMIT = "SELECT sequence, time, author, operation, changed, removed, bytes, mark, link"


def save_head(rows: Rows, row: int, head: MapHead) -> MapHead:
    """Write a map's head with its digest; return the head."""
    rows.execute(
        "UPDATE maps SET sequence = ?, mark = ?, base = ?, next_id = ?, base_bytes = ?, "
        "log_bytes = ?, end_id = ?, digest = ? WHERE map = ?",
        (*_values(head), digest_of(head), row),
    )
    return head


def digest_of(head: MapHead) -> str:
    """Hash a map's head, so that an altered row is noticed."""
    fields = [head.name, head.uid, *_values(head)]
    return hashlib.sha256(json.dumps(fields).encode()).hexdigest()


def _values(head: MapHead) -> tuple[int | str, ...]:
    """Return what changes in a map's row, in the order of its columns."""
    return (
        head.sequence,
        head.mark,
        head.oldest,
        head.next_id,
        head.base_bytes,
        head.log_bytes,
        head.end_id,
    )


def row_of(rows: Rows, uid: str) -> int:
    """Return the row number of a map; KeyError if there is no such map."""
    found = rows.execute("SELECT map FROM maps WHERE uid = ?", (uid,)).fetchone()
    if found is None:
        raise KeyError(uid)
    return int(found[0])


def head_of(rows: Rows, uid: str) -> MapHead:
    """Return a map's head; KeyError if there is no such map, StoreError if its row was altered."""
    return numbered_head_of(rows, uid)[1]


def numbered_head_of(rows: Rows, uid: str) -> tuple[int, MapHead]:
    """Return row number and head of a map by one statement; raises as `head_of` does."""
    found = rows.execute(f"{NUMBERED} WHERE uid = ?", (uid,)).fetchone()
    if found is None:
        raise KeyError(uid)
    *columns, row = found
    head = head_from(tuple(columns))
    if columns[-1] != digest_of(head):
        raise StoreError("damaged", f"map {head.name!r}: its row in the table maps was altered")
    return int(row), head


def head_from(row: tuple[Any, ...]) -> MapHead:
    """Build a head from a row of `HEAD`, unchecked."""
    return MapHead(*row[:-1])


def commit_from(row: Sequence[Any]) -> Commit:
    """Build a commit from a row of `COMMIT`."""
    sequence, *note, size, mark, link = row
    return Commit(sequence, Note(*note), size, mark, link)


def insert_map(rows: Rows, head: MapHead, history: MapHistory) -> int:
    """Add a map with all its versions; return its row number."""
    (row,) = rows.execute(
        "INSERT INTO maps (name, uid, sequence, mark, base, next_id, base_bytes, log_bytes, "
        "end_id) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING map",
        (head.name, head.uid, *_values(head)),
    ).fetchone()
    insert_commit(rows, row, history.commits()[0], None)
    for commit, blob in history.blobs(head.oldest, head.sequence):
        insert_commit(rows, row, commit, blob)
    insert_base(rows, row, history.base())
    save_head(rows, row, head)
    return int(row)


def insert_commit(rows: Rows, row: int, commit: Commit, blob: bytes | None) -> None:
    """Add a commit; the oldest one has no blob."""
    note = commit.note
    rows.execute(
        "INSERT INTO commits (map, sequence, time, author, operation, changed, removed, mark, "
        "bytes, delta, link) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (
            row,
            commit.sequence,
            note.time,
            note.author,
            note.operation,
            note.changed,
            note.removed,
            commit.mark,
            commit.bytes,
            blob,
            commit.link,
        ),
    )


def insert_base(rows: Rows, row: int, file: bytes) -> None:
    """Add a version's file, in parts."""
    for part, start in enumerate(range(0, len(file), PART_BYTES)):
        data = file[start : start + PART_BYTES]
        rows.execute(
            "INSERT INTO bases VALUES (?, ?, ?, ?)",
            (row, part, hashlib.sha256(data).hexdigest(), data),
        )
