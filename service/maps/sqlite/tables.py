"""Tables of `maps.sqlite`: maps, commits, files of the oldest versions, owners of ids."""

import hashlib
import json
import secrets
import sqlite3
from collections.abc import Sequence
from typing import Any

from service.maps.sqlite.owners import Owners
from service.maps.store import Commit, MapHead, MapHistory, Note, StoreError

VERSION = 3

PART_BYTES = 4 << 20
"""Largest number of bytes of a base in one row."""

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
    log_bytes INTEGER NOT NULL,
    end_id INTEGER NOT NULL DEFAULT 4294967296,
    digest TEXT NOT NULL DEFAULT ''
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
    link TEXT NOT NULL DEFAULT '',
    PRIMARY KEY (map, sequence)
) STRICT;
CREATE TABLE bases (
    map INTEGER NOT NULL REFERENCES maps,
    part INTEGER NOT NULL,
    sha256 TEXT NOT NULL,
    data BLOB NOT NULL,
    PRIMARY KEY (map, part)
) STRICT;
CREATE TABLE owners (
    map INTEGER NOT NULL REFERENCES maps,
    first INTEGER NOT NULL,
    until INTEGER NOT NULL,
    author TEXT NOT NULL,
    reserved REAL,
    digest TEXT NOT NULL,
    PRIMARY KEY (map, first)
) STRICT;
CREATE TABLE opened (
    token TEXT NOT NULL
) STRICT;
CREATE TABLE annotations (
    map INTEGER NOT NULL REFERENCES maps,
    kind TEXT NOT NULL,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    author TEXT NOT NULL,
    time REAL NOT NULL,
    digest TEXT NOT NULL,
    PRIMARY KEY (map, kind, name)
) STRICT;
"""

HEAD = """
SELECT name, uid, sequence, mark, base, next_id, base_bytes, log_bytes, coalesce(
    (SELECT author FROM commits WHERE commits.map = maps.map AND commits.sequence = maps.base), ''
), end_id, digest FROM maps"""
COMMIT = "SELECT sequence, time, author, operation, changed, removed, bytes, mark, link"


def fill(connection: sqlite3.Connection) -> None:
    """Insert the rows that every database has."""
    connection.execute("INSERT INTO opened VALUES (?)", (secrets.token_hex(16),))


def migrate(connection: sqlite3.Connection) -> None:
    """Migrate a database from version 1 to version 2, within a transaction.

    Commits stay as they are: their link is empty, and their mark covers no note.
    """
    connection.execute("ALTER TABLE maps ADD COLUMN end_id INTEGER NOT NULL DEFAULT 4294967296")
    connection.execute("ALTER TABLE maps ADD COLUMN digest TEXT NOT NULL DEFAULT ''")
    connection.execute("ALTER TABLE commits ADD COLUMN link TEXT NOT NULL DEFAULT ''")
    for statement in SCHEMA.split(";"):
        if "TABLE owners" in statement or "TABLE opened" in statement:
            connection.execute(statement)
    fill(connection)
    for row, *columns in connection.execute(HEAD.replace("SELECT", "SELECT map,", 1)).fetchall():
        head = save_head(connection, row, head_from(tuple(columns)))
        if head.next_id:  # the owners of these ids are not known
            Owners(connection, row).write([(0, head.next_id)], "")


def add_annotations(connection: sqlite3.Connection) -> None:
    """Migrate a database from version 2 to version 3, within a transaction."""
    for statement in SCHEMA.split(";"):
        if "TABLE annotations" in statement:
            connection.execute(statement)


def save_head(connection: sqlite3.Connection, row: int, head: MapHead) -> MapHead:
    """Write a map's head with its digest; return the head."""
    connection.execute(
        "UPDATE maps SET sequence = ?, mark = ?, base = ?, next_id = ?, base_bytes = ?, "
        "log_bytes = ?, end_id = ?, digest = ? WHERE map = ?",
        (
            head.sequence,
            head.mark,
            head.oldest,
            head.next_id,
            head.base_bytes,
            head.log_bytes,
            head.end_id,
            digest_of(head),
            row,
        ),
    )
    return head


def digest_of(head: MapHead) -> str:
    """Hash a map's head, so that an altered row is noticed."""
    fields = [
        head.name,
        head.uid,
        head.sequence,
        head.mark,
        head.oldest,
        head.next_id,
        head.base_bytes,
        head.log_bytes,
        head.end_id,
    ]
    return hashlib.sha256(json.dumps(fields).encode()).hexdigest()


def row_of(connection: sqlite3.Connection, uid: str) -> int:
    """Return the row number of a map; KeyError if there is no such map."""
    found = connection.execute("SELECT map FROM maps WHERE uid = ?", (uid,)).fetchone()
    if found is None:
        raise KeyError(uid)
    return int(found[0])


def head_of(connection: sqlite3.Connection, uid: str) -> MapHead:
    """Return a map's head; KeyError if there is no such map, StoreError if its row was altered."""
    row = connection.execute(f"{HEAD} WHERE uid = ?", (uid,)).fetchone()
    if row is None:
        raise KeyError(uid)
    head = head_from(row)
    if row[-1] != digest_of(head):
        raise StoreError("damaged", f"map {head.name!r}: its row in the table maps was altered")
    return head


def head_from(row: tuple[Any, ...]) -> MapHead:
    """Build a head from a row of `HEAD`, unchecked."""
    return MapHead(*row[:-1])


def commit_from(row: Sequence[Any]) -> Commit:
    """Build a commit from a row of `COMMIT`."""
    sequence, *note, size, mark, link = row
    return Commit(sequence, Note(*note), size, mark, link)


def insert_map(connection: sqlite3.Connection, head: MapHead, history: MapHistory) -> int:
    """Add a map with all its versions; return its row number."""
    row = connection.execute(
        "INSERT INTO maps (name, uid, sequence, mark, base, next_id, base_bytes, log_bytes)"
        " VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
        (
            head.name,
            head.uid,
            head.sequence,
            head.mark,
            head.oldest,
            head.next_id,
            head.base_bytes,
            head.log_bytes,
        ),
    ).lastrowid
    assert row is not None
    insert_commit(connection, row, history.commits()[0], None)
    for commit, blob in history.blobs(head.oldest, head.sequence):
        insert_commit(connection, row, commit, blob)
    insert_base(connection, row, history.base())
    save_head(connection, row, head)
    return row


def insert_commit(
    connection: sqlite3.Connection, row: int, commit: Commit, blob: bytes | None
) -> None:
    """Add a commit; the oldest one has no blob."""
    note = commit.note
    connection.execute(
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


def insert_base(connection: sqlite3.Connection, row: int, file: bytes) -> None:
    """Add a version's file, in parts."""
    for part, start in enumerate(range(0, len(file), PART_BYTES)):
        data = file[start : start + PART_BYTES]
        connection.execute(
            "INSERT INTO bases VALUES (?, ?, ?, ?)",
            (row, part, hashlib.sha256(data).hexdigest(), data),
        )
