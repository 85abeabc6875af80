"""Snapshot of `maps.sqlite`: all maps at one moment, also while a service writes to the file."""

import sqlite3
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from service.maps.sqlite.annotations import read_annotations
from service.maps.sqlite.database import Database, Layout
from service.maps.sqlite.history import SqliteHistory
from service.maps.sqlite.owners import Owners
from service.maps.sqlite.tables import HEAD, head_from, head_of, row_of
from service.maps.store import Annotation, MapHead, OwnedIds, StoreError


class SqliteSnapshot:
    """All maps at one moment, within a read transaction."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name; StoreError if one was altered."""
        rows = self._connection.execute(f"{HEAD} ORDER BY name").fetchall()
        return [head_of(self._connection, head_from(row).uid) for row in rows]

    def history(self, uid: str) -> SqliteHistory:
        """Return a map's log, valid as long as the snapshot; KeyError if there is no such map."""
        row = row_of(self._connection, uid)
        return SqliteHistory(self._connection, row, head_of(self._connection, uid))

    def owned_ids(self, uid: str) -> list[OwnedIds]:
        """Return the ascending runs of owned ids; KeyError if there is no such map."""
        return Owners(self._connection, row_of(self._connection, uid)).all()

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid; StoreError if one was altered."""
        found, errors = read_annotations(self._connection)
        if errors:
            raise StoreError("damaged", errors[0])
        return found


@contextmanager
def snapshot_of(path: Path, layout: Layout) -> Iterator[SqliteSnapshot]:
    """Read a database that another process may own, at one moment.

    A database of an earlier version is copied to the temporary folder, and the copy is migrated.

    Raises:
        StoreError: the file cannot be used; the message says what to do.
    """
    with Database.reading(path, layout) as (connection, version):
        if version == layout.version:
            yield SqliteSnapshot(connection)
            return
        with tempfile.TemporaryDirectory(prefix="placecell-") as folder:
            copy = Path(folder) / path.name
            with closing(sqlite3.connect(copy)) as target:
                connection.backup(target)
            connection.rollback()
            with closing(Database(copy, layout)) as migrated, migrated.snapshot() as reader:
                yield SqliteSnapshot(reader)
