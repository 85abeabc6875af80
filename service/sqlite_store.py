"""Maps in one SQLite file: `DATA_DIR/maps.sqlite`."""

import hashlib
import logging
import os
import secrets
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import filelock

from service.database import ADVICE, Database, sync_folder
from service.map_store import (
    IDS,
    Commit,
    Head,
    Note,
    OutOfIdsError,
    StoreError,
    StoreLockedError,
    mark_of,
)

FILE = "maps.sqlite"
VERSION = 1

PART_BYTES = 4 << 20
"""Of a base, a row at most: what is read and written in one piece."""

logger = logging.getLogger("placecell")

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

_HEAD = "SELECT name, uid, sequence, mark, base, next_id, base_bytes, log_bytes FROM maps"
_COMMIT = "SELECT sequence, time, author, operation, changed, removed, bytes, mark"


class SqliteMapStore:
    """The store of one data directory. For use from many threads."""

    def __init__(self, data_dir: Path) -> None:
        """Open it; see `owned`, for one process at a time may.

        Raises:
            StoreError: the database cannot be used; the message says what to do.
        """
        self._folder = data_dir
        self._database = Database(data_dir / FILE, VERSION, SCHEMA)
        try:
            # No mark tells whether a map's name was altered; and the table is small.
            if wrong := self._database.integrity("maps"):
                raise StoreError("damaged", f"{data_dir / FILE}: {wrong[0]}; {ADVICE}")
        except StoreError:
            self.close()
            raise

    @classmethod
    @contextmanager
    def owned(cls, data_dir: Path) -> "Iterator[SqliteMapStore]":
        """The store of a data directory, which nobody else has until the context ends.

        Raises:
            StoreLockedError: another process has it.
            StoreError: the database cannot be used.
            OSError: the directory cannot be made or written.
        """
        data_dir.mkdir(parents=True, exist_ok=True)
        try:
            lock = filelock.FileLock(data_dir / "lock").acquire(timeout=0)
        except filelock.Timeout as error:
            raise StoreLockedError(f"{data_dir} is in use by another service") from error
        with lock:
            sync_folder(data_dir)
            sync_folder(data_dir.absolute().parent)
            if old := sorted((data_dir / "maps").glob("*.safetensors")):
                logger.warning(
                    "%d map files in %s are of version 0 and are not read; let the robots put "
                    "their maps again",
                    len(old),
                    data_dir / "maps",
                )
            with closing(cls(data_dir)) as store:
                yield store

    def close(self) -> None:
        """Let go of the database."""
        self._database.close()

    def heads(self) -> list[Head]:
        """Of the maps, by name."""
        with self._database.snapshot() as connection:
            return [_head(row) for row in connection.execute(f"{_HEAD} ORDER BY name")]

    @contextmanager
    def read(self, uid: str) -> "Iterator[SqliteHistory]":
        """A map's log; KeyError if there is none."""
        with self._database.snapshot() as connection:
            yield SqliteHistory(connection, _row_of(connection, uid), _head_of(connection, uid))

    def create(self, name: str, file: bytes, note: Note, next_id: int) -> Head:
        """Begin a map with its first version, of sequence 1; ValueError if the name is taken."""
        uid = secrets.token_hex(8)
        mark = mark_of(uid, 1, file)
        with self._database.transaction() as connection:
            if connection.execute("SELECT 1 FROM maps WHERE name = ?", (name,)).fetchone():
                raise ValueError(f"there is a map {name!r} already")
            row = connection.execute(
                "INSERT INTO maps (name, uid, sequence, mark, base, next_id, base_bytes, log_bytes)"
                " VALUES (?, ?, 1, ?, 1, ?, ?, 0)",
                (name, uid, mark, next_id, len(file)),
            ).lastrowid
            assert row is not None
            _insert_commit(connection, row, Commit(1, note, 0, mark), None)
            _insert_base(connection, row, file)
            return _head_of(connection, uid)

    def append(self, head: Head, blob: bytes, note: Note, next_id: int) -> Head:
        """Add a commit that follows a head; KeyError if the map stands elsewhere."""
        sequence = head.sequence + 1
        commit = Commit(sequence, note, len(blob), mark_of(head.mark, sequence, blob))
        with self._database.transaction() as connection:
            found = connection.execute(
                "UPDATE maps SET sequence = ?, mark = ?, next_id = max(next_id, ?), "
                "log_bytes = log_bytes + ? WHERE uid = ? AND mark = ? RETURNING map",
                (sequence, commit.mark, next_id, len(blob), head.uid, head.mark),
            ).fetchone()
            if found is None:
                raise KeyError(head.name)
            _insert_commit(connection, found[0], commit, blob)
            return _head_of(connection, head.uid)

    def reserve(self, uid: str, count: int) -> int:
        """The first of so many ids that nobody has had; OutOfIdsError, or KeyError for the map."""
        with self._database.transaction() as connection:
            row = _row_of(connection, uid)
            (first,) = connection.execute(
                "SELECT next_id FROM maps WHERE map = ?", (row,)
            ).fetchone()
            if first + count > IDS:
                raise OutOfIdsError(f"{IDS - first} ids are left")
            connection.execute("UPDATE maps SET next_id = ? WHERE map = ?", (first + count, row))
            return int(first)

    def compact(self, uid: str, sequence: int, file: bytes) -> Head:
        """Let go of the versions before one, whose file is given; KeyError if it is not there."""
        with self._database.transaction() as connection:
            row = _row_of(connection, uid)
            found = connection.execute(
                "UPDATE commits SET delta = NULL, bytes = 0 WHERE map = ? AND sequence = ?",
                (row, sequence),
            )
            if not found.rowcount:
                raise KeyError(sequence)
            connection.execute(
                "DELETE FROM commits WHERE map = ? AND sequence < ?", (row, sequence)
            )
            connection.execute(
                "UPDATE maps SET base = ?1, base_bytes = ?2, log_bytes = "
                "(SELECT coalesce(sum(bytes), 0) FROM commits WHERE map = ?3) WHERE map = ?3",
                (sequence, len(file), row),
            )
            connection.execute("DELETE FROM bases WHERE map = ?", (row,))
            _insert_base(connection, row, file)
            return _head_of(connection, uid)

    def delete(self, uid: str) -> None:
        """Remove a map with all its versions; KeyError if there is none."""
        with self._database.transaction() as connection:
            row = _row_of(connection, uid)
            for table in ("commits", "bases", "maps"):
                connection.execute(f"DELETE FROM {table} WHERE map = ?", (row,))

    def give_back(self) -> None:
        """Return the room of what was removed to the disk."""
        self._database.give_back()

    def writable(self) -> bool:
        """Whether the store can take a write."""
        return self._database.is_there() and os.access(self._database.path, os.W_OK)

    def verify(self) -> list[str]:
        """What is wrong with the database, if anything: its structure, and every blob's mark."""
        found = self._database.integrity()
        for head in self.heads():
            try:
                with self.read(head.uid) as history:
                    history.base()
                    for _ in history.blobs(head.oldest, head.sequence):
                        pass
            except StoreError as error:
                found.append(str(error))
        return found


class SqliteHistory:
    """One map's log as it stood at one moment."""

    def __init__(self, connection: sqlite3.Connection, row: int, head: Head) -> None:
        self._connection = connection
        self._row = row
        self._head = head

    @property
    def head(self) -> Head:
        """Where the map stood."""
        return self._head

    def commits(self) -> list[Commit]:
        """From the base's own to the newest."""
        rows = self._connection.execute(
            f"{_COMMIT} FROM commits WHERE map = ? ORDER BY sequence", (self._row,)
        )
        return [_commit(row) for row in rows]

    def mark(self, sequence: int) -> str:
        """Of one version; KeyError if it is not kept."""
        found = self._connection.execute(
            "SELECT mark FROM commits WHERE map = ? AND sequence = ?", (self._row, sequence)
        ).fetchone()
        if found is None:
            if self._head.oldest <= sequence <= self._head.sequence:
                raise self._damaged(f"version {sequence}")
            raise KeyError(sequence)
        return str(found[0])

    def base(self) -> bytes:
        """The oldest version's file; StoreError if it is damaged."""
        parts = []
        for sha256, data in self._connection.execute(
            "SELECT sha256, data FROM bases WHERE map = ? ORDER BY part", (self._row,)
        ):
            if not isinstance(data, bytes) or hashlib.sha256(data).hexdigest() != sha256:
                raise self._damaged("base")
            parts.append(data)
        if sum(map(len, parts)) != self._head.base_bytes:
            raise self._damaged("base")
        return b"".join(parts)

    def blobs(self, after: int, until: int) -> Iterator[tuple[Commit, bytes]]:
        """The commits from `after`, exclusive, to `until`; StoreError if one is damaged."""
        before, sequence = self.mark(after), after
        for *columns, blob in self._connection.execute(
            f"{_COMMIT}, delta FROM commits "
            "WHERE map = ? AND sequence > ? AND sequence <= ? ORDER BY sequence",
            (self._row, after, until),
        ):
            commit, sequence = _commit(columns), sequence + 1
            if not isinstance(blob, bytes) or mark_of(before, sequence, blob) != commit.mark:
                raise self._damaged(f"version {sequence}")
            yield commit, blob
            before = commit.mark
        if sequence != until or (until == self._head.sequence and before != self._head.mark):
            raise self._damaged(f"version {until}")

    def _damaged(self, part: str) -> StoreError:
        return StoreError("damaged", f"map {self._head.name!r}: its {part} was altered or lost")


def _row_of(connection: sqlite3.Connection, uid: str) -> int:
    found = connection.execute("SELECT map FROM maps WHERE uid = ?", (uid,)).fetchone()
    if found is None:
        raise KeyError(uid)
    return int(found[0])


def _head_of(connection: sqlite3.Connection, uid: str) -> Head:
    return _head(connection.execute(f"{_HEAD} WHERE uid = ?", (uid,)).fetchone())


def _head(row: tuple[Any, ...]) -> Head:
    return Head(*row)


def _commit(row: Sequence[Any]) -> Commit:
    sequence, *note, size, mark = row
    return Commit(sequence, Note(*note), size, mark)


def _insert_commit(
    connection: sqlite3.Connection, row: int, commit: Commit, blob: bytes | None
) -> None:
    note = commit.note
    connection.execute(
        "INSERT INTO commits VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        (
            *(row, commit.sequence, note.time, note.author, note.operation),
            *(note.changed, note.removed, commit.mark, commit.bytes, blob),
        ),
    )


def _insert_base(connection: sqlite3.Connection, row: int, file: bytes) -> None:
    for part, start in enumerate(range(0, len(file), PART_BYTES)):
        data = file[start : start + PART_BYTES]
        connection.execute(
            "INSERT INTO bases VALUES (?, ?, ?, ?)",
            (row, part, hashlib.sha256(data).hexdigest(), data),
        )
