"""Maps in one SQLite file: `DATA_DIR/maps.sqlite`."""

import logging
import os
import secrets
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

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
from service.sqlite_history import SqliteHistory
from service.sqlite_tables import (
    HEAD,
    SCHEMA,
    VERSION,
    head_from,
    head_of,
    insert_base,
    insert_commit,
    row_of,
)

FILE = "maps.sqlite"
logger = logging.getLogger("placecell")


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
            return [head_from(row) for row in connection.execute(f"{HEAD} ORDER BY name")]

    @contextmanager
    def read(self, uid: str) -> Iterator[SqliteHistory]:
        """A map's log; KeyError if there is none."""
        with self._database.snapshot() as connection:
            yield SqliteHistory(connection, row_of(connection, uid), head_of(connection, uid))

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
            insert_commit(connection, row, Commit(1, note, 0, mark), None)
            insert_base(connection, row, file)
            return head_of(connection, uid)

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
            insert_commit(connection, found[0], commit, blob)
            return head_of(connection, head.uid)

    def reserve(self, uid: str, count: int) -> int:
        """The first of so many ids that nobody has had; OutOfIdsError, or KeyError for the map."""
        with self._database.transaction() as connection:
            row = row_of(connection, uid)
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
            row = row_of(connection, uid)
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
            insert_base(connection, row, file)
            return head_of(connection, uid)

    def delete(self, uid: str) -> None:
        """Remove a map with all its versions; KeyError if there is none."""
        with self._database.transaction() as connection:
            row = row_of(connection, uid)
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
