"""SQLite database of the store: durable settings, translated errors, and transactions."""

import logging
import os
import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Literal, TypeVar

from service.core.files import sync_folder
from service.maps.sqlite.disk_reserve import FULL, DiskReserve
from service.maps.store import StoreError, Trouble

Result = TypeVar("Result")

APPLICATION = 0x506C6C63
"""Application id in the file's header, `Pllc`, which foreign databases lack."""

WAL_BYTES = 16 << 20
"""Bytes of the write-ahead log that stay on disk after a large write."""

VACUUM_PAGES = 1_000
"""Number of pages of 4 kB that return to the disk per step."""

FULL_DISK_PAGES = 50
"""Number of pages that are returned per step on a full disk; the log needs as much space."""

MIGRATION_BYTES = 1 << 20
"""Free disk space that every migration needs, bytes."""

MIGRATION_PAGE_BYTES = 64
"""Free disk space that a migration needs for each page of the database, bytes."""

BUSY_SECONDS = 5.0
"""Seconds to wait for another process, such as a backup, to release its lock."""

logger = logging.getLogger("placecell")

_KINDS: dict[str, Trouble] = {
    # The disk has no space for the shared-memory file.
    "SQLITE_IOERR_SHMSIZE": "full",
    "SQLITE_FULL": "full",
    "SQLITE_READONLY": "read-only",
    "SQLITE_BUSY": "busy",
    "SQLITE_LOCKED": "busy",
    "SQLITE_CORRUPT": "damaged",
    "SQLITE_NOTADB": "damaged",
    # A statement that does not fit the tables: their schema was altered.
    "SQLITE_ERROR": "damaged",
}

_REMEDIES: dict[str, str] = {
    "SQLITE_IOERR_SHMSIZE": "the disk is full. Make room on it",
    "SQLITE_FULL": "the disk is full. Make room on it",
    "SQLITE_CANTOPEN": "the file or its folder cannot be opened for writing. Run the command as "
    "the user of the service, and copy the folder if its disk is read-only",
}


@dataclass(frozen=True, slots=True)
class Layout:
    """Tables of a database and the migrations from earlier versions.

    Attributes:
        version: version of the tables.
        schema: statements that create them in an empty database.
        fill: inserts the rows of an empty database.
        migrations: migration from each earlier version to the next one.
    """

    version: int
    schema: str
    fill: Callable[[sqlite3.Connection], None]
    migrations: Mapping[int, Callable[[sqlite3.Connection], None]]


Origin = Literal["made", "migrated", "found"]


class Database:
    """Database with one connection for writes and one for each reader. Safe for many threads.

    Attributes:
        path: path of the file; names of its companion files begin with the same name.
        origin: whether the file was created (`made`), `migrated`, or `found` as it is.
    """

    def __init__(
        self, path: Path, layout: Layout, lock_trouble: Callable[[], str | None] = lambda: None
    ) -> None:
        """Open or create the file.

        Args:
            path: path of the file.
            layout: layout of its tables.
            lock_trouble: returns what is wrong with the lock on the directory; None if nothing is.

        Raises:
            StoreError: the file cannot be used; the message says what to do.
        """
        self.path = path
        self.origin: Origin = "found"
        self._log_path = path.with_name(path.name + "-wal")
        self._lock_trouble = lock_trouble
        self._writing = Lock()
        self._failed: StoreError | None = None
        with _translated_os(path):
            self._reserve = DiskReserve(path.parent)
            if not path.exists():
                _make(path, layout)
                self.origin = "made"
            elif not path.stat().st_size:
                # SQLite would treat it as a new database and discard the log beside it.
                raise StoreError("damaged", f"{path} is empty: it was truncated; {ADVICE}")
        try:
            self._connection = self._opened(layout)
        except StoreError as error:
            if error.kind != "full":
                raise
            # The database needs a little space even on a full disk.
            self._reserve.lend(self._reserve.size // 4)
            try:
                self._connection = self._opened(layout)
            except StoreError:
                self._reserve.hold()
                raise
        with _translated_os(path):
            self._file = _inode_of(path)
            self._log = _inode_of(self._log_path)
            with _translated(path):
                self._reserve.hold_for_log(self._log_growth())

    def close(self) -> None:
        """Move the log into the file and close it."""
        with self._writing:
            self._reserve.release(self._reserve.size)
            self._connection.close()
        # On a full disk, the next start needs the space that the log had.
        self._reserve.hold_for_log(0)

    @contextmanager
    def transaction(self, frees: bool = False) -> Iterator[sqlite3.Connection]:
        """Run writes as one transaction, durable when the context ends, or undo all of them.

        Args:
            frees: whether the writes free the disk, so that they may use the reserve for that.

        Raises:
            StoreError: none of the writes happened.
        """
        with self._writing, self._noted(), _translated(self.path):
            if problem := self._misplaced() or self._lock_trouble():
                raise StoreError("moved", problem)
            if not frees and not self._holds_reserve():
                raise StoreError("full", f"{self.path}: the disk is full")
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield self._connection
                if not frees and not self._reserve.hold_for_log(self._log_growth()):
                    raise StoreError("full", f"{self.path}: the disk is full")
                self._connection.execute("COMMIT")
            except BaseException:
                # Some errors end the transaction themselves.
                if self._connection.in_transaction:
                    self._connection.rollback()
                raise
            if not frees and self._reserve.log_bytes:
                self._reserve.hold_for_log(self._log_growth())

    def _holds_reserve(self) -> bool:
        """Allocate the reserve and space for the content of the log; the caller holds the lock."""
        if self._reserve.hold() or self._reserve.hold_for_log(self._log_growth()):
            return True
        # Log pages that fit into the database need no space beside it.
        self._move_log("RESTART")
        return self._reserve.hold_for_log(self._log_growth())

    def _log_growth(self) -> int:
        """Return the bytes that the file grows by when the log moves into it."""
        (pages,) = self._connection.execute("PRAGMA page_count").fetchone()
        (page_bytes,) = self._connection.execute("PRAGMA page_size").fetchone()
        return int(pages) * int(page_bytes) - self.path.stat().st_size

    def freeing(self, work: Callable[[sqlite3.Connection], Result], share: float = 1.0) -> Result:
        """Run writes that free the disk; a full disk lends them its reserve.

        Args:
            work: the transaction; it may run twice, if the first run is undone.
            share: share of the reserve that may be used; the rest stays for other writes.
        """
        try:
            with self.transaction(frees=True) as connection:
                done = work(connection)
            is_short = self._reserve.free_bytes() < self._reserve.size // 4
            if is_short or not self._reserve.is_held():
                self._release_all(self._reserve.release_share(share))
            return done
        except StoreError as error:
            if error.kind != "full":
                raise
        left = self._reserve.release_share(share)
        # A restarted log is overwritten, which takes no space even without a reserve.
        self._empty_log("RESTART")
        try:
            with self.transaction(frees=True) as connection:
                done = work(connection)
        except StoreError:
            self._reserve.hold()
            raise
        self._release_all(left)
        return done

    def _release_all(self, bytes_left: int) -> None:
        """Return freed pages to a full disk; keep `bytes_left` of the reserve."""
        self._reserve.release(bytes_left)
        try:
            self.release_space()
        except StoreError as error:
            # The write succeeded. The freed pages return to the disk when there is space for that.
            logger.warning("freed pages were not returned to the disk: %s", error)

    @staticmethod
    @contextmanager
    def reading(path: Path, layout: Layout) -> Iterator[tuple[sqlite3.Connection, int]]:
        """Read one state of a database that another process may own; yield its version as well.

        Raises:
            StoreError: the file cannot be read; the message says what to do.
        """
        with _translated(path), closing(_connect(path)) as connection:
            log = path.with_name(path.name + "-wal")
            version = _checked(connection, path, log, layout)
            connection.execute("PRAGMA query_only = ON")
            connection.execute("BEGIN")
            connection.execute("PRAGMA user_version").fetchone()  # the first read fixes the state
            yield connection, version

    @contextmanager
    def snapshot(self) -> Iterator[sqlite3.Connection]:
        """Read one state of the database, without waiting for writers or blocking them."""
        self._check_placed()
        with _translated(self.path), closing(_connect(self.path)) as connection:
            connection.execute("PRAGMA query_only = ON")
            connection.execute("BEGIN")
            connection.execute("PRAGMA user_version").fetchone()  # the first read fixes the state
            self._check_placed()
            yield connection

    def trouble(self) -> str | None:
        """Return why writes fail; None if they work. Tries a small write after a failed one."""
        if problem := self._misplaced() or self._lock_trouble():
            return problem
        if not os.access(self.path, os.W_OK) or not os.access(self.path.parent, os.W_OK):
            return f"{self.path.name} cannot be written: the disk or the file is read-only."
        return self._lacks_room() or (self._tried(self._failed) if self._failed else None)

    def _lacks_room(self) -> str | None:
        free, failed = self._reserve.free_bytes(), self._failed
        is_full = failed is not None and failed.kind == "full"
        least = self._reserve.size if is_full else self._reserve.size // 4
        if not self._reserve.hold() and self._writing.acquire(blocking=False):
            try:
                with _translated(self.path):
                    self._holds_reserve()
            except (OSError, StoreError) as error:
                return str(error)
            finally:
                self._writing.release()
        if not self._reserve.is_held() or free < least:
            return (
                f"The disk is full: {free:,} bytes are free, and {self._reserve.size:,} are kept "
                "for deletions. Delete or compact maps, or free disk space."
            )
        if is_full:
            self._failed = None
        return None

    def _tried(self, failed: StoreError) -> str | None:
        if self._writing.locked():
            return str(failed)
        try:
            with self.transaction() as connection:
                (version,) = connection.execute("PRAGMA user_version").fetchone()
                connection.execute(f"PRAGMA user_version = {version}")
        except StoreError as error:
            return str(error)
        return None

    def release_space(self) -> None:
        """Return freed pages to the disk in steps, so that no writer waits long.

        It keeps up to `VACUUM_PAGES` free pages for later writes; on a full disk it keeps none.
        """
        if problem := self._misplaced() or self._lock_trouble():
            raise StoreError("moved", problem)
        before, free = 0, self._free_pages()
        step, least = VACUUM_PAGES, VACUUM_PAGES
        if not self._reserve.is_held():
            # A shorter database needs less space when the log moves into it, so an error here may
            # be temporary.
            self._empty_log()
            step, least = FULL_DISK_PAGES, 0
        while free > least and free != before:
            with self._writing, _translated(self.path):
                self._connection.execute(f"PRAGMA incremental_vacuum({step})").fetchall()
            if step == FULL_DISK_PAGES:
                self._empty_log()
            before, free = free, self._free_pages()
        with self._writing, _translated_os(self.path), _translated(self.path):
            self._reserve.hold_for_log(self._log_growth())

    def _empty_log(self, mode: Literal["TRUNCATE", "RESTART"] = "TRUNCATE") -> bool:
        """Move the log into the database; return its space to the disk, or reuse it.

        Returns:
            Whether it was moved; false if the disk is full or a reader is active.
        """
        with self._writing:
            return self._move_log(mode)

    def _move_log(self, mode: Literal["TRUNCATE", "RESTART"]) -> bool:
        try:
            with _translated(self.path):
                pragma = f"PRAGMA wal_checkpoint({mode})"
                (busy, *_), *_ = self._connection.execute(pragma).fetchall()
        except StoreError as error:
            if error.kind != "full":
                raise
            return False
        return not busy

    def _free_pages(self) -> int:
        with self._writing, _translated(self.path):
            return int(self._connection.execute("PRAGMA freelist_count").fetchone()[0])

    def _misplaced(self) -> str | None:
        """Return a text if the files are not the opened ones any more; None otherwise.

        SQLite continues to write to a removed file, and would accept a file in its place, even an
        empty one, as the database.
        """
        for path, inode, advice in (
            (self.path, self._file, "Move the same file back"),
            (
                self._log_path,
                self._log,
                "Stop the service, which then moves all data into the database",
            ),
        ):
            try:
                found = _inode_of(path)
            except OSError:
                found = None
            if found != inode:
                return (
                    f"{path.name} in the data directory was moved, removed or replaced while the "
                    f"service ran. {advice}, or restart the service to use the current files."
                )
        return None

    def _check_placed(self) -> None:
        if problem := self._misplaced():
            raise StoreError("moved", problem)

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """Record a write that failed because of the disk, until a write succeeds."""
        try:
            yield
        except StoreError as error:
            if error.kind in {"full", "read-only", "failing"}:
                self._failed = error
            raise
        self._failed = None

    def _opened(self, layout: Layout) -> sqlite3.Connection:
        """Connect, and check that the file is complete and has these tables."""
        with _translated(self.path):
            connection = _connect(self.path)
        try:
            with _translated(self.path):
                found = _checked(connection, self.path, self._log_path, layout)
                if found != layout.version:
                    self._migrate(connection, found, layout)
        except BaseException:
            connection.close()
            raise
        return connection

    def _migrate(self, connection: sqlite3.Connection, found: int, layout: Layout) -> None:
        (pages,) = connection.execute("PRAGMA page_count").fetchone()
        needed = MIGRATION_BYTES + pages * MIGRATION_PAGE_BYTES
        if (free := self._reserve.free_bytes()) < needed:
            raise StoreError(
                "full",
                f"{self.path} has version {found}. A migration to version {layout.version} needs "
                f"{needed:,} free bytes; the disk has {free:,}. The file was not changed.",
            )
        connection.execute("BEGIN IMMEDIATE")
        try:
            for version in range(found, layout.version):
                layout.migrations[version](connection)
                connection.execute(f"PRAGMA user_version = {version + 1}")
            connection.execute("COMMIT")
        except BaseException:
            if connection.in_transaction:
                connection.rollback()
            raise
        self.origin = "migrated"
        logger.info("migrated %s from version %d to version %d", self.path, found, layout.version)

    def integrity(self, table: str = "") -> list[str]:
        """Return errors that SQLite finds in the file, or in one table and its indices."""
        part = f"({table})" if table else ""
        with self.snapshot() as connection:
            found = [str(row[0]) for row in connection.execute(f"PRAGMA integrity_check{part}")]
        return [] if found == ["ok"] else found


ADVICE = "restore it from a backup, or move it and the files beside it away to start without maps"


def _connect(path: Path, mode: Literal["rw", "rwc"] = "rw") -> sqlite3.Connection:
    """Connect to an existing file; mode `rwc` may create it."""
    connection = sqlite3.connect(
        f"{path.absolute().as_uri()}?mode={mode}",
        timeout=BUSY_SECONDS,
        isolation_level=None,
        check_same_thread=False,
        uri=True,
    )
    # With FULL, a commit is on disk when it returns, not when the log moves into the database.
    # On macOS, only a full fsync reaches the disk. Freed pages need not be overwritten.
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


def _checked(connection: sqlite3.Connection, path: Path, log: Path, layout: Layout) -> int:
    """Check that the file is complete and return the version of its tables."""
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (found,) = connection.execute("PRAGMA user_version").fetchone()
    if application != APPLICATION:
        raise StoreError("damaged", f"{path} is not a database of Placecell; {ADVICE}")
    if found != layout.version and found not in layout.migrations:
        raise StoreError(
            "damaged",
            f"{path} has version {found}; this program reads versions "
            f"{min(layout.migrations, default=layout.version)} to {layout.version}. Use the "
            "program that wrote it, or a later one",
        )
    (pages,) = connection.execute("PRAGMA page_count").fetchone()
    (page_bytes,) = connection.execute("PRAGMA page_size").fetchone()
    # With a log, pages may still have to move into the file. Without one, SQLite would read
    # zeros in place of a truncated last page.
    has_log = log.exists() and log.stat().st_size
    if not has_log and path.stat().st_size < pages * page_bytes:
        raise StoreError("damaged", f"{path} was truncated; {ADVICE}")
    return int(found)


def _make(path: Path, layout: Layout) -> None:
    """Create the database under a temporary name, so that the final name is always complete."""
    left = [path.with_name(path.name + tail) for tail in ("-wal", "-journal")]
    if found := [file for file in left if file.exists()]:
        raise StoreError("damaged", f"{found[0]} exists, but {path.name} does not; {ADVICE}")
    unfinished = path.with_name(path.name + ".unfinished")
    for tail in ("", "-wal", "-shm", "-journal"):
        unfinished.with_name(unfinished.name + tail).unlink(missing_ok=True)
    with _translated(path):
        with closing(_connect(unfinished, "rwc")) as connection:
            connection.execute("PRAGMA auto_vacuum = INCREMENTAL")
            connection.execute("PRAGMA journal_mode = WAL")
            connection.executescript(
                f"BEGIN; {layout.schema} PRAGMA application_id = {APPLICATION};"
                f"PRAGMA user_version = {layout.version};"
            )
            layout.fill(connection)
            connection.execute("COMMIT")
        unfinished.replace(path)
        sync_folder(path.parent)


def _inode_of(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_dev, status.st_ino


@contextmanager
def _translated_os(path: Path) -> Iterator[None]:
    """Translate errors of the disk into a StoreError."""
    try:
        yield
    except OSError as error:
        full = error.errno in FULL
        raise StoreError("full" if full else "failing", f"{path}: {error}") from error


@contextmanager
def _translated(path: Path) -> Iterator[None]:
    """Translate errors of SQLite into a StoreError."""
    try:
        yield
    except UnicodeDecodeError as error:
        # SQLite quotes an altered schema in a message that Python cannot decode.
        raise StoreError("damaged", f"{path}: its schema was altered; {ADVICE}") from error
    except sqlite3.Error as error:
        name = getattr(error, "sqlite_errorname", "")
        # Extended codes begin with their basic code.
        matching = [kind for code, kind in _KINDS.items() if name.startswith(code)]
        kind = matching[0] if matching else "failing"
        remedies = (each for code, each in _REMEDIES.items() if name.startswith(code))
        remedy = ADVICE if kind == "damaged" else next(remedies, "")
        advice = f"; {remedy}" if remedy else ""
        raise StoreError(kind, f"{path}: {error} ({name or 'no code'}){advice}") from error
