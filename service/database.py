"""An SQLite file that keeps what it has been given: its settings, its errors, its transactions."""

import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from threading import Lock

from service.map_store import StoreError, Trouble

APPLICATION = 0x506C6C63
"""In the file's header, so that a foreign database is not taken for one of ours: `Pllc`."""

WAL_BYTES = 16 << 20
"""That the write-ahead log keeps on disk after a large write."""

VACUUM_PAGES = 1_000
"""Given back to the disk at once, 4 kB each."""

BUSY_SECONDS = 5.0
"""To wait for another process, such as a backup, to let go."""

_KINDS: dict[str, Trouble] = {
    # The shared-memory file could not grow.
    "SQLITE_IOERR_SHMSIZE": "full",
    "SQLITE_FULL": "full",
    "SQLITE_READONLY": "read-only",
    "SQLITE_BUSY": "busy",
    "SQLITE_LOCKED": "busy",
    "SQLITE_CORRUPT": "damaged",
    "SQLITE_NOTADB": "damaged",
}


class Database:
    """One connection that writes, and one for each reader. For use from many threads."""

    def __init__(self, path: Path, version: int, schema: str) -> None:
        """Open the file, or make it.

        Args:
            path: of the file; other files beside it begin with the same name.
            version: of the schema.
            schema: statements that make an empty database.

        Raises:
            StoreError: it cannot be used; the message says what to do.
        """
        self.path = path
        self._writing = Lock()
        if not path.exists():
            _make(path, version, schema)
        elif not path.stat().st_size:
            # SQLite would take it for a new one, and throw the log beside it away.
            raise StoreError("damaged", f"{path} is empty: it was cut; {ADVICE}")
        with _translated(path):
            self._connection = _connect(path)
        try:
            with _translated(path):
                self._check(version)
        except StoreError:
            self._connection.close()
            raise
        self._file = path.stat().st_dev, path.stat().st_ino

    def close(self) -> None:
        """Let go of the file; what the log holds goes into it."""
        with self._writing:
            self._connection.close()

    @contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """Writes that happen together, and last when the context ends; or none of them.

        Raises:
            StoreError: none of them happened.
        """
        with self._writing, _translated(self.path):
            if not self.is_there():
                raise StoreError("failing", f"{self.path} was removed or put in place of another")
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield self._connection
                self._connection.execute("COMMIT")
            except BaseException:
                # Some errors have ended the transaction already.
                if self._connection.in_transaction:
                    self._connection.rollback()
                raise

    @contextmanager
    def snapshot(self) -> Iterator[sqlite3.Connection]:
        """Reads of one state of the database; they neither wait for writers nor hold them up."""
        with _translated(self.path), closing(_connect(self.path)) as connection:
            connection.execute("PRAGMA query_only = ON")
            connection.execute("BEGIN")
            yield connection

    def is_there(self) -> bool:
        """Whether the file is the one that was opened: SQLite goes on writing to one removed."""
        try:
            status = self.path.stat()
        except OSError:
            return False
        return (status.st_dev, status.st_ino) == self._file

    def give_back(self) -> None:
        """Return freed pages to the disk, if they are many; in steps, so that no writer waits long.

        Fewer are left, to be written to again.
        """
        before, free = 0, self._free_pages()
        while free > VACUUM_PAGES and free != before:
            with self._writing, _translated(self.path):
                self._connection.execute(f"PRAGMA incremental_vacuum({VACUUM_PAGES})").fetchall()
            before, free = free, self._free_pages()

    def _free_pages(self) -> int:
        with self._writing, _translated(self.path):
            return int(self._connection.execute("PRAGMA freelist_count").fetchone()[0])

    def integrity(self, table: str = "") -> list[str]:
        """What SQLite finds wrong with the file, or with one table and its indices, if anything."""
        part = f"({table})" if table else ""
        with self.snapshot() as connection:
            found = [str(row[0]) for row in connection.execute(f"PRAGMA integrity_check{part}")]
        return [] if found == ["ok"] else found

    def _check(self, version: int) -> None:
        (application,) = self._connection.execute("PRAGMA application_id").fetchone()
        (found,) = self._connection.execute("PRAGMA user_version").fetchone()
        if application != APPLICATION:
            raise StoreError("damaged", f"{self.path} is no database of Placecell; {ADVICE}")
        if found != version:
            raise StoreError(
                "damaged",
                f"{self.path} is of version {found}; this program reads version {version}: "
                "use the program that wrote it, or a later one",
            )
        (pages,) = self._connection.execute("PRAGMA page_count").fetchone()
        (page_bytes,) = self._connection.execute("PRAGMA page_size").fetchone()
        log = self.path.with_name(self.path.name + "-wal")
        # What the log holds may still have to go into the file. Without one the file is all there
        # is, and SQLite itself would take a last page that is cut for one that ends in zeros.
        has_log = log.exists() and log.stat().st_size
        if not has_log and self.path.stat().st_size < pages * page_bytes:
            raise StoreError("damaged", f"{self.path} was cut; {ADVICE}")


ADVICE = "bring it back from a backup, or move it and the files beside it away to begin anew"


def _connect(path: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(
        path, timeout=BUSY_SECONDS, isolation_level=None, check_same_thread=False
    )
    # FULL: a commit is on disk when it returns, not when the log is next moved into the database.
    # On macOS only a full fsync reaches the disk. Freed pages need not be overwritten.
    for pragma in (
        "synchronous = FULL",
        "fullfsync = ON",
        "checkpoint_fullfsync = ON",
        "secure_delete = OFF",
        "trusted_schema = OFF",
        f"journal_size_limit = {WAL_BYTES}",
    ):
        connection.execute(f"PRAGMA {pragma}")
    return connection


def _make(path: Path, version: int, schema: str) -> None:
    """Make the database under another name: one that is there under its own is complete."""
    left = [path.with_name(path.name + tail) for tail in ("-wal", "-journal")]
    if found := [file for file in left if file.exists()]:
        raise StoreError("damaged", f"{found[0]} is there, but not {path.name}; {ADVICE}")
    unfinished = path.with_name(path.name + ".unfinished")
    for tail in ("", "-wal", "-shm", "-journal"):
        unfinished.with_name(unfinished.name + tail).unlink(missing_ok=True)
    with _translated(path):
        with closing(_connect(unfinished)) as connection:
            connection.execute("PRAGMA auto_vacuum = INCREMENTAL")
            connection.execute("PRAGMA journal_mode = WAL")
            connection.executescript(
                f"BEGIN; {schema} PRAGMA application_id = {APPLICATION};"
                f"PRAGMA user_version = {version}; COMMIT;"
            )
        unfinished.replace(path)
        sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Make new names, renames and removals in a folder last."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextmanager
def _translated(path: Path) -> Iterator[None]:
    """SQLite's errors as the store's own."""
    try:
        yield
    except UnicodeDecodeError as error:
        # A schema was altered: SQLite quotes it in a message that Python cannot read.
        raise StoreError("damaged", f"{path}: its schema was altered; {ADVICE}") from error
    except sqlite3.Error as error:
        name = getattr(error, "sqlite_errorname", "")
        # Extended codes begin with the one they belong to.
        matching = [kind for code, kind in _KINDS.items() if name.startswith(code)]
        kind = matching[0] if matching else "failing"
        advice = f"; {ADVICE}" if kind == "damaged" else ""
        raise StoreError(kind, f"{path}: {error} ({name or 'no code'}){advice}") from error
