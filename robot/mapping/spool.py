"""Spool: edits that wait for the link, on disk, so that they survive a reboot or a SIGKILL."""

import hashlib
import sqlite3
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self, TextIO

from robot.core.status import SpoolStatus
from robot.mapping.state_lock import lock_state

FILE = "agent.sqlite"
"""Name of the database in the state folder."""

TABLES = """
CREATE TABLE IF NOT EXISTS sessions (
    session TEXT PRIMARY KEY, last INTEGER NOT NULL, finished INTEGER NOT NULL,
    scans INTEGER NOT NULL, checkpoint BLOB, digest TEXT
);
CREATE TABLE IF NOT EXISTS entries (
    number INTEGER PRIMARY KEY AUTOINCREMENT, session TEXT NOT NULL, sequence INTEGER NOT NULL,
    part INTEGER NOT NULL, content BLOB NOT NULL, UNIQUE (session, sequence)
);
CREATE TABLE IF NOT EXISTS maps (
    session TEXT NOT NULL, part INTEGER NOT NULL, name TEXT NOT NULL,
    PRIMARY KEY (session, part)
);
"""


@dataclass(frozen=True, slots=True)
class SpoolEntry:
    """Edit that waits for the link.

    Attributes:
        number: place in the spool; the smallest is sent first.
        session: session of the agent that made it.
        part: number of the map that the session writes, from 0.
        content: delta file.
    """

    number: int
    session: str
    part: int
    content: bytes


@dataclass(frozen=True, slots=True)
class Progress:
    """Progress of a session.

    Attributes:
        last: sequence number of the last edit that was stored; -1: none.
        finished: whether the drive was processed to its end.
        scans: number of scans that the checkpoint includes.
        checkpoint: state of the agent after these scans; None: there is none.
    """

    last: int = -1
    finished: bool = False
    scans: int = 0
    checkpoint: bytes | None = None


class Spool:
    """Edits of all sessions that are not sent, oldest first, and the progress of the session.

    Every change is one transaction that is on the disk when the call returns. If the spool or the
    disk is full, new edits are not stored, and their segments are counted; what is stored stays.

    Attributes:
        dropped_segments: segments that were not stored.
    """

    def __init__(
        self,
        database: sqlite3.Connection,
        session: str,
        most_bytes: int,
        lock: TextIO | None = None,
    ) -> None:
        self._database = database
        self._lock = lock
        self._session = session
        self._most = most_bytes
        self.dropped_segments = 0
        self._size: tuple[int, int] | None = None
        with database:
            database.executescript(TABLES)
            database.execute(
                "INSERT OR IGNORE INTO sessions VALUES (?, -1, 0, 0, NULL, NULL)", (session,)
            )
            database.execute(
                "DELETE FROM sessions WHERE session != ? AND session NOT IN "
                "(SELECT session FROM entries)",
                (session,),
            )

    @classmethod
    def open(
        cls,
        folder: Path | None,
        session: str,
        most_bytes: int,
        tell: Callable[[str], None] = lambda _: None,
    ) -> Self:
        """Open the spool of a state folder; a damaged one is set aside.

        Args:
            folder: state folder, created if it is missing; None: the spool is in memory.
            session: session of the agent.
            most_bytes: largest size of all edits, bytes.
            tell: receives a line if the file was damaged.

        Raises:
            OSError: the folder cannot be written, or another agent uses it.
        """
        if folder is None:
            return cls(sqlite3.connect(":memory:"), session, most_bytes)
        make_folder(folder)
        file = folder / FILE
        lock = lock_state(folder)
        try:
            return cls(connect(file), session, most_bytes, lock)
        except sqlite3.DatabaseError as error:
            if isinstance(error, sqlite3.OperationalError):
                lock.close()
                raise OSError(f"{file}: {error}. Check the folder, or give another one") from error
            aside = set_aside(file)
            tell(f"{file} is damaged ({error}). It is now {aside.name}; the agent starts anew.")
            return cls(connect(file), session, most_bytes, lock)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the database, and release the folder."""
        self._database.close()
        if self._lock is not None:
            self._lock.close()

    def progress(self) -> Progress:
        """Return the progress of the session; a damaged checkpoint is left out."""
        last, finished, scans, checkpoint, digest = self._database.execute(
            "SELECT last, finished, scans, checkpoint, digest FROM sessions WHERE session = ?",
            (self._session,),
        ).fetchone()
        if checkpoint is None or digest != digest_of(checkpoint):
            return Progress(last, bool(finished))
        return Progress(last, bool(finished), scans, checkpoint)

    def add(self, sequence: int, part: int, content: bytes, segments: int) -> bool:
        """Store an edit unless the session stored it before; return whether it is stored.

        Args:
            sequence: number of the edit in the session, ascending.
            part: number of the map that the session writes.
            content: delta file.
            segments: number of its segments.
        """
        if sequence <= self.progress_last():
            return True
        if self.status().bytes + len(content) > self._most:
            self.dropped_segments += segments
            return False
        self._size = None
        try:
            with self._database:
                self._database.execute(
                    "INSERT INTO entries (session, sequence, part, content) VALUES (?, ?, ?, ?)",
                    (self._session, sequence, part, content),
                )
                self._database.execute(
                    "UPDATE sessions SET last = ? WHERE session = ?", (sequence, self._session)
                )
        except sqlite3.OperationalError:  # The disk is full or failing.
            self.dropped_segments += segments
            return False
        return True

    def save(self, scans: int, checkpoint: bytes) -> bool:
        """Store the state of the agent after some scans; return whether it is stored."""
        return self._update(
            "UPDATE sessions SET scans = ?, checkpoint = ?, digest = ? WHERE session = ?",
            (scans, checkpoint, digest_of(checkpoint), self._session),
        )

    def finish(self) -> None:
        """Record that the drive was processed to its end."""
        self._update(
            "UPDATE sessions SET finished = 1, scans = 0, checkpoint = NULL WHERE session = ?",
            (self._session,),
        )

    def oldest(self, count: int) -> list[SpoolEntry]:
        """Return the oldest edits, at most `count`."""
        rows = self._database.execute(
            "SELECT number, session, part, content FROM entries ORDER BY number LIMIT ?", (count,)
        )
        return [SpoolEntry(*row) for row in rows]

    def remove(self, entry: SpoolEntry) -> None:
        """Remove an edit that is on the service."""
        self._size = None
        self._update("DELETE FROM entries WHERE number = ?", (entry.number,))

    def map_of(self, session: str, part: int) -> str | None:
        """Return the map that receives a part of a session; None if it is not chosen yet."""
        row = self._database.execute(
            "SELECT name FROM maps WHERE session = ? AND part = ?", (session, part)
        ).fetchone()
        return None if row is None else str(row[0])

    def set_map(self, session: str, part: int, name: str) -> None:
        """Record the map that receives a part of a session."""
        self._update("INSERT OR REPLACE INTO maps VALUES (?, ?, ?)", (session, part, name))

    def status(self) -> SpoolStatus:
        """Return the size of the spool."""
        if self._size is None:
            self._size = self._database.execute(
                "SELECT count(*), coalesce(sum(length(content)), 0) FROM entries"
            ).fetchone()
        entries, size = self._size
        return SpoolStatus(entries, size, self.dropped_segments)

    def progress_last(self) -> int:
        """Return the sequence number of the last edit that the session stored; -1: none."""
        (last,) = self._database.execute(
            "SELECT last FROM sessions WHERE session = ?", (self._session,)
        ).fetchone()
        return int(last)

    def _update(self, statement: str, values: tuple[object, ...]) -> bool:
        """Carry out a change; return False if the disk is full or failing.

        A lost change is harmless: the service ignores an edit that it has, and a checkpoint that is
        missing costs time only.
        """
        with suppress(sqlite3.OperationalError), self._database:
            self._database.execute(statement, values)
            return True
        return False


def make_folder(folder: Path) -> None:
    """Create a state folder, unless it is there.

    Raises:
        OSError: it cannot be created, or a file has its name.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise OSError(f"{folder} is a file, expected a folder. Give another one") from error


def connect(file: Path) -> sqlite3.Connection:
    """Open a database whose transactions survive a power failure.

    Raises:
        sqlite3.DatabaseError: the file is no database, or damaged.
    """
    database = sqlite3.connect(file, timeout=10)
    try:
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("PRAGMA synchronous = FULL")
        (told,) = database.execute("PRAGMA quick_check").fetchone()
        if told != "ok":
            raise sqlite3.DatabaseError(str(told).splitlines()[0])
    except sqlite3.DatabaseError:
        database.close()
        raise
    return database


def set_aside(file: Path) -> Path:
    """Rename a damaged database, together with its log, to the first free name."""
    number = 1
    while (aside := file.with_name(f"{file.name}.damaged-{number}")).exists():
        number += 1
    file.rename(aside)
    for suffix in ("-wal", "-shm"):
        log = file.with_name(file.name + suffix)
        if log.exists():
            log.rename(aside.with_name(aside.name + suffix))
    return aside


def digest_of(content: bytes) -> str:
    """Return the SHA-256 of a checkpoint."""
    return hashlib.sha256(content).hexdigest()
