"""Snapshot of `maps.sqlite`, also while a service writes to the file."""

import sqlite3
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from service.maps.sql.snapshot import SqlSnapshot
from service.maps.sqlite.database import Database, Layout


@contextmanager
def snapshot_of(path: Path, layout: Layout) -> Iterator[SqlSnapshot]:
    """Read a database that another process may own, at one moment.

    A database of an earlier version is copied to the temporary folder, and the copy is migrated.

    Raises:
        StoreError: the file cannot be used; the message says what to do.
    """
    with Database.reading(path, layout) as (connection, version):
        if version == layout.version:
            yield SqlSnapshot(connection)
            return
        with tempfile.TemporaryDirectory(prefix="placecell-") as folder:
            copy = Path(folder) / path.name
            with closing(sqlite3.connect(copy)) as target:
                connection.backup(target)
            connection.rollback()
            with closing(Database(copy, layout)) as migrated, migrated.snapshot() as reader:
                yield SqlSnapshot(reader)
