"""PostgreSQL map store: all maps in one database, which several services read and write."""

import logging
import math
import secrets
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from typing import Any

from service.maps.postgres.database import READ_IDLE_SECONDS, PostgresDatabase
from service.maps.postgres.durability import durability_warnings, right_warnings
from service.maps.postgres.tables import (
    CHANNEL,
    CREATION_LOCK,
    LAYOUT,
    MAINTENANCE_LOCK,
    PostgresLayout,
    extend,
    is_current,
)
from service.maps.sql.annotations import errors_in, known_annotations, write_annotations
from service.maps.sql.history import SqlHistory, commits_since
from service.maps.sql.operations import (
    append_commit,
    check_mark,
    compact_map,
    create_map,
    delete_map,
    free_unused,
    import_all,
    reserve_ids,
)
from service.maps.sql.owners import Owners
from service.maps.sql.rows import Rows
from service.maps.sql.snapshot import SqlSnapshot, check_map
from service.maps.sql.tables import HEAD, head_from, numbered_head_of, row_of, save_head
from service.maps.store import (
    IDS,
    NO_IDS,
    Annotation,
    Commit,
    Ids,
    MapHead,
    Note,
    Owner,
    SharedMap,
    StoreError,
    StoreSnapshot,
    commit_after,
)

logger = logging.getLogger("placecell")


SHARED = HEAD.replace("digest FROM", "digest, annotated FROM")
"""Columns of a head, and the number of writes of its annotations."""


class PostgresStore:
    """Store of one database. Safe to use from many threads, and from several services at once.

    `append` compares the chained mark of the map and sets the next one in one transaction, so two
    services never add to the same version. If the answer to a commit is lost, the store connects
    again and looks for the commit by its mark.
    """

    def __init__(
        self,
        url: str,
        connections: int = 16,
        clock: Callable[[], float] = time.time,
        layout: PostgresLayout = LAYOUT,
    ) -> None:
        """Open the store; create or extend its tables if the database lacks them.

        Args:
            url: URL of the database.
            connections: largest number of connections at once.
            clock: returns Unix seconds.
            layout: tables of this program.

        Raises:
            StoreError: the database cannot be used; the message says what to do.
        """
        self._clock = clock
        self._database = PostgresDatabase(url, connections)
        try:
            with self._database.connected() as (connection, rows):
                if not is_current(rows, layout):
                    # One service at a time, until the connection ends.
                    rows.execute("SELECT pg_advisory_lock(?)", (CREATION_LOCK,))
                    with connection.transaction():
                        if extend(rows, layout):
                            logger.info("created tables of version %s.%s", *layout.version)
                for warning in (*right_warnings(rows), *durability_warnings(rows)):
                    logger.warning("%s", warning)
            self._database.open()
        except StoreError:
            self._database.close()
            raise

    @classmethod
    @contextmanager
    def opened(cls, url: str, connections: int = 16) -> "Iterator[PostgresStore]":
        """Open the store of a database until the context ends; raises as the constructor does."""
        with closing(cls(url, connections)) as store:
            yield store

    def close(self) -> None:
        """Close all connections."""
        self._database.close()

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name."""
        with self._database.snapshot() as rows:
            return [head_from(row) for row in rows.execute(f"{HEAD} ORDER BY name")]

    @contextmanager
    def read(self, uid: str) -> Iterator[SqlHistory]:
        """Read a map's log; KeyError if there is no such map."""
        with self._database.snapshot() as rows:
            yield SqlHistory(rows, *numbered_head_of(rows, uid))

    def create(
        self, name: str, file: bytes, note: Note, next_id: int, ids: Ids = NO_IDS
    ) -> MapHead:
        """Create a map with its first version, sequence 1; ValueError if the name is in use."""
        uid = secrets.token_hex(8)

        def make(rows: Rows, again: bool) -> MapHead:
            # Two services that create a map of one name at once wait for each other.
            rows.execute("SELECT pg_advisory_xact_lock(hashtext(?))", (name,))
            if again and _locked(rows, uid):
                return _synced(rows, uid)
            head = create_map(rows, uid, name, file, note, next_id, ids)
            return _told(rows, head)

        return self._database.transaction(make)

    def append(
        self,
        head: MapHead,
        blob: bytes,
        note: Note,
        next_id: int,
        ids: Ids = NO_IDS,
        frees: bool = False,
        annotations: Sequence[Annotation] = (),
    ) -> MapHead:
        """Add a commit after a head; KeyError if the map has another head."""
        del frees  # the server's disk has no reserve
        mark = commit_after(head.mark, head.sequence + 1, note, blob, len(blob)).mark

        def add(rows: Rows, again: bool) -> MapHead:
            _lock(rows, head.uid)
            if again and _has_commit(rows, head.uid, head.sequence + 1, mark):
                found = _synced(rows, head.uid)
                # Later commits of others are not part of the answer.
                size = head.log_bytes + len(blob)
                return replace(found, sequence=head.sequence + 1, mark=mark, log_bytes=size)
            after = append_commit(rows, head, blob, note, next_id, ids, annotations=annotations)
            if annotations:
                _count_annotated(rows, row_of(rows, head.uid))
            return _told(rows, after)

        return self._database.transaction(add, is_short=True)

    def reserve(self, uid: str, count: int, author: str = "", most: int = IDS) -> int:
        """Reserve ids that no segment ever had; return the first. Raises as `MapStore` does."""

        def take(rows: Rows, again: bool) -> int:
            del again  # ids that were reserved without an answer are never given out
            _lock(rows, uid)
            return reserve_ids(rows, uid, count, author, most, self._clock())

        return self._database.transaction(take, is_short=True)

    def owners(self, uid: str, ids: Iterable[int]) -> list[Owner | None]:
        """Return the last owner of each of these ids; None for ids without an owner."""
        wanted = list(ids)
        return self._database.read(lambda rows: Owners(rows, row_of(rows, uid)).of(wanted))

    def free_ids(self, uid: str, used: Iterable[int], mark: str | None = None) -> MapHead:
        """Forget the owners of unused ids. Parameters are those of `MapStore`."""
        kept = list(used)

        def free(rows: Rows, again: bool) -> MapHead:
            del again  # a second run changes nothing more
            _lock(rows, uid)
            check_mark(rows, uid, mark)
            return _told(rows, free_unused(rows, uid, kept))

        return self._database.transaction(free)

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid; altered ones are logged and left out."""
        with self._database.snapshot() as rows:
            return known_annotations(rows)

    def annotate(
        self, uid: str, put: Sequence[Annotation], removed: Collection[tuple[str, str]] = ()
    ) -> None:
        """Add or replace annotations of a map, and remove some; KeyError if there is no map."""

        def write(rows: Rows, again: bool) -> None:
            del again  # a second run changes nothing more
            _lock(rows, uid)
            row, head = numbered_head_of(rows, uid)
            write_annotations(rows, row, put, removed)
            _count_annotated(rows, row)
            _told(rows, head)

        self._database.transaction(write, is_short=True)

    def compact(self, uid: str, sequence: int, file: bytes) -> MapHead:
        """Drop the versions before one, whose file is given; KeyError if it is not kept."""

        def shorten(rows: Rows, again: bool) -> MapHead:
            del again  # a second run writes the same rows
            _lock(rows, uid)
            return _told(rows, compact_map(rows, uid, sequence, file))

        return self._database.transaction(shorten)

    def delete(self, uid: str, mark: str | None = None) -> None:
        """Remove a map with all its versions; KeyError if there is no such map or version."""

        def remove(rows: Rows, again: bool) -> None:
            if not _locked(rows, uid):
                if again:
                    return
                raise KeyError(uid)
            check_mark(rows, uid, mark)
            # A row whose digest is wrong can be deleted too.
            (name,) = rows.execute("SELECT name FROM maps WHERE uid = ?", (uid,)).fetchone()
            delete_map(rows, uid)
            rows.execute("SELECT pg_notify(?, ?)", (CHANNEL, name))

        self._database.transaction(remove)

    def find(self, name: str) -> SharedMap | None:
        """Return the newest state of a map; None if there is no such map."""
        found = self._database.read(
            lambda rows: rows.execute(f"{SHARED} WHERE name = ?", (name,)).fetchone()
        )
        return None if found is None else _shared(found)

    def shared_maps(self) -> list[SharedMap]:
        """Return the newest states of all maps, by name."""
        found = self._database.read(lambda rows: rows.execute(f"{SHARED} ORDER BY name").fetchall())
        return [_shared(row) for row in found]

    def commits_since(self, before: MapHead, head: MapHead) -> list[tuple[Commit, bytes]]:
        """Return the commits after one version of a map, up to a newer one, with their deltas.

        Raises:
            KeyError: the later version does not follow the other, or not all commits are kept.
        """
        return self._database.read(lambda rows: commits_since(rows, before, head))

    def annotations_of(self, uid: str) -> list[Annotation]:
        """Return the annotations of a map; none if there is no such map."""
        return self._database.read(lambda rows: known_annotations(rows, uid).get(uid, []))

    @contextmanager
    def listen(self) -> Iterator[Callable[[float], set[str]]]:
        """Listen to writes; yield a function that waits some seconds for the names of maps."""
        with self._database.connected() as (connection, rows):
            rows.execute(f"LISTEN {CHANNEL}")

            def wait(seconds: float) -> set[str]:
                with self._database.watching(connection, seconds):
                    notices = connection.notifies(timeout=seconds, stop_after=1)
                    return {notice.payload for notice in notices}

            yield wait

    @contextmanager
    def alone(self) -> Iterator[bool]:
        """Yield whether this service may do maintenance, which one service does at a time."""
        with self._database.snapshot() as rows:
            (is_held,) = rows.execute(
                "SELECT pg_try_advisory_xact_lock(?)", (MAINTENANCE_LOCK,)
            ).fetchone()
            yield bool(is_held)

    @contextmanager
    def snapshot(self) -> Iterator[SqlSnapshot]:
        """Read all maps at one moment, without blocking writers."""
        with self._database.snapshot() as rows:
            yield SqlSnapshot(rows)

    def import_maps(
        self, source: StoreSnapshot, skipped: int = 0, replaces: bool = False
    ) -> list[MapHead]:
        """Store all maps of a snapshot in one transaction. Parameters are those of `MapStore`."""

        def store(rows: Rows, again: bool) -> list[MapHead]:
            rows.execute("LOCK TABLE maps IN SHARE ROW EXCLUSIVE MODE")
            # The source may be slow, such as a bucket beyond a bad uplink.
            rows.execute(
                f"SET LOCAL idle_in_transaction_session_timeout = '{READ_IDLE_SECONDS:.0f}s'"
            )
            heads = import_all(rows, source, skipped, replaces or again)
            rows.execute("SELECT pg_notify(?, '')", (CHANNEL,))
            return heads

        # A large database takes its time, and no service waits for this.
        return self._database.transaction(store, seconds=math.inf)

    def release_space(self) -> None:
        """Do nothing: PostgreSQL reuses the space of removed rows by itself."""

    def trouble(self) -> str | None:
        """Return why the store accepts no writes; None if it accepts them."""
        try:
            with self._database.snapshot() as rows:
                (standby,) = rows.execute("SELECT pg_is_in_recovery()").fetchone()
                (setting,) = rows.execute("SHOW default_transaction_read_only").fetchone()
        except StoreError as error:
            return str(error)
        if standby:
            return (
                "The database is a standby. Promote it, or name the primary in PLACECELL_DATABASE."
            )
        if setting == "on":
            return "The database is read-only (default_transaction_read_only). Set it to off."
        return None

    def verify(self) -> list[str]:
        """Return errors of the database: of the mark of every blob, and of every row."""
        with self._database.snapshot() as rows:
            found = [*errors_in(rows)]
            heads = [head_from(row) for row in rows.execute(f"{HEAD} ORDER BY name").fetchall()]
            for head in heads:
                try:
                    check_map(rows, head.uid)
                except StoreError as error:
                    found.append(str(error))
        return found


def _shared(row: tuple[Any, ...]) -> SharedMap:
    """Build the state of a map from a row of `SHARED`."""
    return SharedMap(head_from(row[:-1]), row[-1])


def _locked(rows: Rows, uid: str) -> bool:
    """Lock a map's row until the transaction ends; return whether there is one."""
    return _lock(rows, uid).fetchone() is not None


def _lock(rows: Rows, uid: str) -> Any:
    """Lock a map's row until the transaction ends, if there is one; return the answer."""
    return rows.execute("SELECT 1 FROM maps WHERE uid = ? FOR UPDATE", (uid,))


def _has_commit(rows: Rows, uid: str, sequence: int, mark: str) -> bool:
    found = rows.execute(
        "SELECT 1 FROM commits WHERE map = ? AND sequence = ? AND mark = ?",
        (row_of(rows, uid), sequence, mark),
    ).fetchone()
    return found is not None


def _count_annotated(rows: Rows, row: int) -> None:
    """Count a write of a map's annotations, so that the followers read them again."""
    rows.execute("UPDATE maps SET annotated = annotated + 1 WHERE map = ?", (row,))


def _synced(rows: Rows, uid: str) -> MapHead:
    """Return a map's head; write it again, so that this commit waits for the standby.

    A commit that is found by its mark may be on the primary only. The standby has it when it has
    this later one.
    """
    return save_head(rows, *numbered_head_of(rows, uid))


def _told(rows: Rows, head: MapHead) -> MapHead:
    """Notify the followers of a map's new state when the transaction is committed."""
    rows.execute("SELECT pg_notify(?, ?)", (CHANNEL, head.name))
    return head
