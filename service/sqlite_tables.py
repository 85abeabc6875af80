"""The tables of `maps.sqlite`: maps, their commits, and the files of their oldest versions."""

import hashlib
import sqlite3
from collections.abc import Sequence
from typing import Any

from service.map_store import Commit, Head, Note

VERSION = 1

PART_BYTES = 4 << 20
"""Of a base, a row at most: what is read and written in one piece."""

SCHEMA = """
CREATE TABLE maps (
    map INTEGER PRIMARY KEY,
    name TEXT NOT NULL UNIQUE,
    uid TEXT NOT NULL UNIQUE,
    sequence INTEGER NOT NULL,
    mark TEXT NOT NULL,
    base INTEGER NOT NULL,
    next_id INTEGER NOT NULL,
    base_bytes INTEGER NOT NULL,
    log_bytes INTEGER NOT NULL
) STRICT;
CREATE TABLE commits (
    map INTEGER NOT NULL REFERENCES maps,
    sequence INTEGER NOT NULL,
    time REAL NOT NULL,
    author TEXT NOT NULL,
    operation TEXT NOT NULL,
    changed INTEGER NOT NULL,
    removed INTEGER NOT NULL,
    mark TEXT NOT NULL,
    bytes INTEGER NOT NULL,
    delta BLOB,
    PRIMARY KEY (map, sequence)
) STRICT;
CREATE TABLE bases (
    map INTEGER NOT NULL REFERENCES maps,
    part INTEGER NOT NULL,
    sha256 TEXT NOT NULL,
    data BLOB NOT NULL,
    PRIMARY KEY (map, part)
) STRICT;
"""

HEAD = """
SELECT name, uid, sequence, mark, base, next_id, base_bytes, log_bytes, coalesce(
    (SELECT author FROM commits WHERE commits.map = maps.map AND commits.sequence = maps.base), ''
) FROM maps"""
COMMIT = "SELECT sequence, time, author, operation, changed, removed, bytes, mark"


def row_of(connection: sqlite3.Connection, uid: str) -> int:
    """Of a map; KeyError if there is none."""
    found = connection.execute("SELECT map FROM maps WHERE uid = ?", (uid,)).fetchone()
    if found is None:
        raise KeyError(uid)
    return int(found[0])


def head_of(connection: sqlite3.Connection, uid: str) -> Head:
    """Where a map stands."""
    return head_from(connection.execute(f"{HEAD} WHERE uid = ?", (uid,)).fetchone())


def head_from(row: tuple[Any, ...]) -> Head:
    """Of a row of `HEAD`."""
    return Head(*row)


def commit_from(row: Sequence[Any]) -> Commit:
    """Of a row of `COMMIT`."""
    sequence, *note, size, mark = row
    return Commit(sequence, Note(*note), size, mark)


def insert_commit(
    connection: sqlite3.Connection, row: int, commit: Commit, blob: bytes | None
) -> None:
    """Add a commit; the oldest one has no blob."""
    note = commit.note
    connection.execute(
        "INSERT INTO commits VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (
            *(row, commit.sequence, note.time, note.author, note.operation),
            *(note.changed, note.removed, commit.mark, commit.bytes, blob),
        ),
    )


def insert_base(connection: sqlite3.Connection, row: int, file: bytes) -> None:
    """Add a version's file, in parts."""
    for part, start in enumerate(range(0, len(file), PART_BYTES)):
        data = file[start : start + PART_BYTES]
        connection.execute(
            "INSERT INTO bases VALUES (?, ?, ?, ?)",
            (row, part, hashlib.sha256(data).hexdigest(), data),
        )
