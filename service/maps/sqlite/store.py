"""SQLite map store: all maps in one file, `DATA_DIR/maps.sqlite`."""

import logging
import secrets
import sqlite3
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

from service.core.files import sync_folder
from service.maps.sql.annotations import errors_in, known_annotations, write_annotations
from service.maps.sql.history import SqlHistory
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
from service.maps.sqlite.data_lock import locked
from service.maps.sqlite.database import ADVICE, Database, Layout
from service.maps.sqlite.id_ledger import SKIPPED, IdLedger
from service.maps.sqlite.tables import SCHEMA, VERSION, add_annotations, fill, migrate
from service.maps.store import (
    IDS,
    NO_IDS,
    Annotation,
    Ids,
    MapHead,
    Note,
    Owner,
    StoreError,
    StoreSnapshot,
    skipped_ids,
)

FILE = "maps.sqlite"
LEDGER = "ids"

LAYOUT = Layout(VERSION, SCHEMA, fill, {1: migrate, 2: add_annotations})

logger = logging.getLogger("placecell")


class SqliteMapStore:
    """Store of one data directory. Safe to use from many threads."""

    def __init__(
        self,
        data_dir: Path,
        lock_trouble: Callable[[], str | None] = lambda: None,
        clock: Callable[[], float] = time.time,
    ) -> None:
        """Open the store; hold `owned` first, because one process at a time may use it.

        Args:
            data_dir: the data directory.
            lock_trouble: returns what is wrong with the lock on it; None if nothing is.
            clock: returns Unix seconds.

        Raises:
            StoreError: the database cannot be used; the message says what to do.
        """
        self._folder = data_dir
        self._clock = clock
        self._database = Database(data_dir / FILE, LAYOUT, lock_trouble)
        try:
            # The index of names must agree with the table, which is small enough to check.
            if wrong := self._database.integrity("maps"):
                raise StoreError("damaged", f"{data_dir / FILE}: {wrong[0]}; {ADVICE}")
            self._ledger = self._opened_ledger()
        except StoreError:
            self._database.close()
            raise

    @classmethod
    @contextmanager
    def owned(cls, data_dir: Path) -> "Iterator[SqliteMapStore]":
        """Lock a data directory and open its store until the context ends.

        Raises:
            StoreLockedError: another process holds the lock.
            StoreError: the database cannot be used.
            OSError: the directory cannot be created or written.
        """
        data_dir.mkdir(parents=True, exist_ok=True)
        with locked(data_dir) as lock:
            sync_folder(data_dir)
            sync_folder(data_dir.absolute().parent)
            if old := sorted((data_dir / "maps").glob("*.safetensors")):
                logger.warning(
                    "ignored %d map files of version 0 in %s; upload the maps again",
                    len(old),
                    data_dir / "maps",
                )
            with closing(cls(data_dir, lock.trouble)) as store:
                yield store

    def close(self) -> None:
        """Close the database."""
        try:
            # Ids that were only recorded ahead were not given out.
            self._ledger.rewrite({head.uid: head.next_id for head in self.heads()})
        except (StoreError, OSError) as error:
            logger.warning("%s was not updated: %s", self._folder / LEDGER, error)
        self._database.close()

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name."""
        with self._database.snapshot() as connection:
            return [head_from(row) for row in connection.execute(f"{HEAD} ORDER BY name")]

    @contextmanager
    def read(self, uid: str) -> Iterator[SqlHistory]:
        """Read a map's log; KeyError if there is no such map."""
        with self._database.snapshot() as connection:
            yield SqlHistory(connection, *numbered_head_of(connection, uid))

    def create(
        self, name: str, file: bytes, note: Note, next_id: int, ids: Ids = NO_IDS
    ) -> MapHead:
        """Create a map with its first version, sequence 1; ValueError if the name is in use."""
        with self._database.transaction() as rows:
            return create_map(rows, secrets.token_hex(8), name, file, note, next_id, ids)

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
        """Add a commit after a head; KeyError if the map has another head.

        Args:
            frees: whether the commit makes the map smaller, so that it may use the disk reserve.
        """

        def add(rows: Rows) -> MapHead:
            return append_commit(rows, head, blob, note, next_id, ids, self._ledger, annotations)

        if frees:
            return self._database.freeing(add, share=0.5)
        with self._database.transaction() as connection:
            return add(connection)

    def reserve(self, uid: str, count: int, author: str = "", most: int = IDS) -> int:
        """Reserve ids that no segment ever had; return the first. Raises as `MapStore` does."""
        with self._database.transaction() as rows:
            return reserve_ids(rows, uid, count, author, most, self._clock(), self._ledger)

    def owners(self, uid: str, ids: Iterable[int]) -> list[Owner | None]:
        """Return the last owner of each of these ids; None for ids without an owner."""
        with self._database.snapshot() as connection:
            return Owners(connection, row_of(connection, uid)).of(ids)

    def free_ids(self, uid: str, used: Iterable[int], mark: str | None = None) -> MapHead:
        """Forget the owners of unused ids. Parameters are those of `MapStore`."""
        with self._database.transaction() as rows:
            check_mark(rows, uid, mark)
            after = free_unused(rows, uid, used)
        try:
            # Otherwise the next start would treat freed ids as given out.
            self._ledger.forget(uid)
            self._ledger.rewrite(self._ledger.limits | {uid: after.next_id})
        except OSError as error:
            raise StoreError("failing", f"{self._folder / LEDGER}: {error}") from error
        return after

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid; altered ones are logged and left out."""
        with self._database.snapshot() as connection:
            return known_annotations(connection)

    def annotate(
        self, uid: str, put: Sequence[Annotation], removed: Collection[tuple[str, str]] = ()
    ) -> None:
        """Add or replace annotations of a map, and remove some; KeyError if there is no map."""

        def write(connection: sqlite3.Connection) -> None:
            write_annotations(connection, row_of(connection, uid), put, removed)

        if not put:
            self._database.freeing(write)
            return
        with self._database.transaction() as connection:
            write(connection)

    def compact(self, uid: str, sequence: int, file: bytes) -> MapHead:
        """Drop the versions before one, whose file is given; KeyError if it is not kept."""
        return self._database.freeing(lambda rows: compact_map(rows, uid, sequence, file))

    def delete(self, uid: str, mark: str | None = None) -> None:
        """Remove a map with all its versions; KeyError if there is no such map or version."""

        def remove(rows: Rows) -> None:
            check_mark(rows, uid, mark)
            delete_map(rows, uid)

        self._database.freeing(remove)

    @contextmanager
    def snapshot(self) -> Iterator[SqlSnapshot]:
        """Read all maps at one moment, without blocking writers."""
        with self._database.snapshot() as connection:
            yield SqlSnapshot(connection)

    def import_maps(
        self, source: StoreSnapshot, skipped: int = 0, replaces: bool = False
    ) -> list[MapHead]:
        """Store all maps of a snapshot in one transaction. Parameters are those of `MapStore`."""
        with self._database.transaction() as rows:
            return import_all(rows, source, skipped, replaces, self._ledger.limits)

    def release_space(self) -> None:
        """Return the space of removed data to the disk."""
        self._database.release_space()

    def trouble(self) -> str | None:
        """Return why the store accepts no writes; None if it accepts them."""
        return self._database.trouble()

    def _opened_ledger(self) -> IdLedger:
        """Open the id ledger; skip ids that were given out but are not in the database."""
        with self._database.snapshot() as connection:
            (token,) = connection.execute("SELECT token FROM opened").fetchone() or ("",)
        ledger = IdLedger(self._folder / LEDGER, token)
        is_new = self._database.origin != "found" and not ledger.is_there
        skipped = 0 if is_new or ledger.is_trusted else SKIPPED
        heads = self.heads()
        behind = {
            head.uid: skipped_ids(head, ledger.limits.get(head.uid, 0), skipped)
            for head in heads
            if skipped or ledger.limits.get(head.uid, 0) > head.next_id
        }
        behind = {uid: next_id for uid, next_id in behind.items() if next_id}
        if skipped and heads:
            logger.warning(
                "%s is not the file that the service wrote last: the maps may come from a backup. "
                "The service skips %d ids of each map, so that no id is given out twice.",
                self._folder / LEDGER,
                SKIPPED,
            )
        if behind:
            # On a full disk as well, or it could never be freed.
            self._database.freeing(lambda connection: _skip(connection, behind), share=0.5)
        try:
            ledger.rewrite({head.uid: behind.get(head.uid, head.next_id) for head in heads})
        except OSError as error:
            logger.warning("%s was not updated: %s", self._folder / LEDGER, error)
        return ledger

    def verify(self) -> list[str]:
        """Return errors of the database: of its structure, and of the mark of every blob."""
        found = self._database.integrity()
        with self._database.snapshot() as connection:
            (lost,) = connection.execute(
                "SELECT count(*) FROM owners WHERE map NOT IN (SELECT map FROM maps)"
            ).fetchone()
            found += [f"{lost} rows of the table owners belong to no map"] if lost else []
            found += errors_in(connection)
        for head in self.heads():
            try:
                with self._database.snapshot() as connection:
                    check_map(connection, head.uid)
            except StoreError as error:
                found.append(str(error))
        return found


def _skip(connection: sqlite3.Connection, first_free: Mapping[str, int]) -> None:
    """Skip ids of each map, up to its first free id."""
    for uid, next_id in first_free.items():
        try:
            row, head = numbered_head_of(connection, uid)
        except StoreError:
            continue  # a damaged map is not served
        # Their owner is not known.
        Owners(connection, row).reserve(head.next_id, next_id, "", 0.0)
        save_head(connection, row, replace(head, next_id=next_id))
