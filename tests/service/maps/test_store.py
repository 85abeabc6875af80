"""Store: contract, and behavior on power cuts and on full or damaged disks."""

import logging
import shutil
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from service.maps.sql.tables import PART_BYTES
from service.maps.sqlite.database import ADVICE, VACUUM_PAGES
from service.maps.sqlite.id_ledger import SKIPPED
from service.maps.sqlite.store import FILE, SqliteMapStore
from service.maps.store import MapHead, Note, StoreError, StoreLockedError

pytestmark = pytest.mark.sqlite

NOTE = Note(1.7e9, "ann", "edit", 3, 1)
LARGE = bytes(range(256)) * (PART_BYTES // 256) + b"a second part"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "deep" / "var"


@pytest.fixture
def store(folder: Path) -> Iterator[SqliteMapStore]:
    with SqliteMapStore.owned(folder) as opened:
        yield opened


@contextmanager
def behind(folder: Path) -> Iterator[sqlite3.Connection]:
    """Connect to the database as another process would."""
    with closing(sqlite3.connect(folder / FILE)) as connection:
        yield connection
        connection.commit()


def all_of(store: SqliteMapStore, uid: str) -> tuple[MapHead, bytes, list[tuple[int, bytes]]]:
    """Return all that the store has of a map."""
    with store.read(uid) as history:
        blobs = history.blobs(history.head.oldest, history.head.sequence)
        return history.head, history.base(), [(commit.sequence, blob) for commit, blob in blobs]


def grown(store: SqliteMapStore, name: str = "yard", commits: int = 4) -> MapHead:
    head = store.create(name, LARGE, replace(NOTE, operation="put"), 7)
    for count in range(commits):
        head = store.append(head, bytes([count]) * (count + 1) * 3_000, NOTE, 0)
    return head


def test_reopened_store_has_all_maps(folder: Path) -> None:
    with SqliteMapStore.owned(folder) as store:
        before = all_of(store, grown(store).uid), store.heads()
    with SqliteMapStore.owned(folder) as store:
        assert (all_of(store, store.heads()[0].uid), store.heads()) == before


def test_every_call_is_one_transaction(store: SqliteMapStore) -> None:
    said: list[str] = []
    store._database._connection.set_trace_callback(said.append)

    def transactions() -> int:
        begun, done = (sum(one.startswith(word) for one in said) for word in ("BEGIN", "COMMIT"))
        assert begun == done
        said.clear()
        return begun

    head = grown(store, commits=0)
    assert transactions() == 1
    head = store.append(head, LARGE, NOTE, 0)
    assert transactions() == 1
    store.reserve(head.uid, 3)
    assert transactions() == 1
    store.compact(head.uid, 2, LARGE)
    assert transactions() == 1
    store.delete(head.uid)
    assert transactions() == 1


def test_commit_is_on_disk_before_it_returns(store: SqliteMapStore) -> None:
    def pragma(name: str) -> Any:
        return store._database._connection.execute(f"PRAGMA {name}").fetchone()[0]

    assert pragma("journal_mode") == "wal"
    assert pragma("synchronous") == 2  # FULL
    assert pragma("fullfsync") == pragma("checkpoint_fullfsync") == 1
    assert pragma("auto_vacuum") == 2  # incremental


@pytest.mark.slow
def test_power_cut_leaves_an_earlier_state(folder: Path, tmp_path: Path) -> None:
    """If only a part of the log reached the disk, each call is there as a whole or not at all."""
    states: list[list[MapHead]] = []
    copy = tmp_path / "copy"
    copy.mkdir()
    with SqliteMapStore.owned(folder) as store:
        states.append(store.heads())
        other = store.create("other", b"z" * 10_000, NOTE, 0)
        states.append(store.heads())
        head = store.create("yard", b"x" * 10_000, NOTE, 7)
        states.append(store.heads())
        for count in range(3):
            head = store.append(head, bytes([count + 1]) * 9_000, NOTE, 0)
            states.append(store.heads())
        store.reserve(head.uid, 2)
        states.append(store.heads())
        store.compact(head.uid, 3, b"y" * 10_000)
        states.append(store.heads())
        store.delete(other.uid)
        states.append(store.heads())
        log = (folder / f"{FILE}-wal").read_bytes()
        main = (folder / FILE).read_bytes()
    seen = []
    for length in [*range(0, len(log), 2_777), len(log)]:
        for tail in (b"", b"\0" * 5_000):  # cut, or as long as it was to be, but not written
            for left in copy.iterdir():
                left.unlink()
            (copy / FILE).write_bytes(main)
            (copy / f"{FILE}-wal").write_bytes(log[:length] + tail)
            with SqliteMapStore.owned(copy) as store:
                assert store.verify() == []
                # The files were copied, so some ids were skipped.
                heads = store.heads()
                heads = [replace(head, next_id=head.next_id - SKIPPED) for head in heads]
                seen.append(states.index(heads))
    assert seen == sorted(seen)
    assert set(seen) == set(range(len(states)))


@pytest.mark.parametrize("kind", ["full", "read-only"])
def test_full_or_failing_disk_changes_nothing(folder: Path, kind: str) -> None:
    with SqliteMapStore.owned(folder) as store:
        head = grown(store)
        before = all_of(store, head.uid)
        connection = store._database._connection
        (pages,) = connection.execute("PRAGMA page_count").fetchone()
        setting = f"max_page_count = {pages + 2}" if kind == "full" else "query_only = ON"
        connection.execute(f"PRAGMA {setting}")
        writes: list[Callable[[], MapHead]] = [
            lambda: store.create("other", LARGE, NOTE, 0),
            lambda: store.append(head, LARGE, NOTE, 0),
            lambda: store.compact(head.uid, 4, LARGE * 3),
        ]
        for write in writes:
            with pytest.raises(StoreError) as raised:
                write()
            assert raised.value.kind == kind
            assert all_of(store, head.uid) == before
        connection.execute("PRAGMA max_page_count = 1000000")
        connection.execute("PRAGMA query_only = OFF")
        assert store.append(head, LARGE, NOTE, 0).sequence == head.sequence + 1
    with SqliteMapStore.owned(folder) as store:
        assert store.heads()[0].sequence == head.sequence + 1
        assert store.verify() == []


def test_locked_database_is_reported_after_a_wait(store: SqliteMapStore, folder: Path) -> None:
    head = grown(store)
    store._database._connection.execute("PRAGMA busy_timeout = 10")
    with behind(folder) as other:
        other.execute("BEGIN IMMEDIATE")
        with pytest.raises(StoreError) as raised:
            store.append(head, b"", NOTE, 0)
        assert raised.value.kind == "busy"
        assert store.heads() == [head]
    assert store.append(head, b"", NOTE, 0).sequence == head.sequence + 1


def test_truncated_database_does_not_open(folder: Path) -> None:
    with SqliteMapStore.owned(folder) as store:
        grown(store)
    whole = (folder / FILE).read_bytes()
    lengths = [0, 1, 99, 100, 4_000, *range(4_096, len(whole), len(whole) // 17), len(whole) - 1]
    for length in lengths:
        (folder / FILE).write_bytes(whole[:length])
        with pytest.raises(StoreError, match="from a backup") as raised:
            SqliteMapStore(folder)
        assert raised.value.kind == "damaged"
    (folder / FILE).write_bytes(whole)
    with SqliteMapStore.owned(folder) as store:
        assert store.verify() == []


def test_online_backup_is_a_valid_database(
    store: SqliteMapStore, folder: Path, tmp_path: Path
) -> None:
    head = grown(store)
    with behind(folder) as connection, closing(sqlite3.connect(tmp_path / FILE)) as copy:
        connection.backup(copy)
    after = store.append(head, b"later", NOTE, 0)
    with SqliteMapStore.owned(tmp_path) as restored:
        (came_back,) = restored.heads()
        assert came_back == replace(head, next_id=came_back.next_id)
        assert restored.verify() == []
        # From here on the maps differ, although their sequences are equal.
        other = restored.append(head, b"otherwise", NOTE, 0)
    assert other.sequence == after.sequence
    assert other.mark != after.mark


def test_foreign_database_does_not_open(folder: Path) -> None:
    folder.mkdir(parents=True)
    (folder / FILE).write_bytes(b"rubbish" * 1_000)
    with pytest.raises(StoreError, match=ADVICE):
        SqliteMapStore(folder)
    (folder / FILE).unlink()
    with behind(folder) as connection:
        connection.execute("CREATE TABLE theirs (a)")
    with pytest.raises(StoreError, match="not a database of Placecell"):
        SqliteMapStore(folder)
    (folder / FILE).unlink()
    SqliteMapStore(folder).close()
    with behind(folder) as connection:
        connection.execute("PRAGMA user_version = 99")
    with pytest.raises(StoreError, match="version 99; this program reads versions 1 to 3"):
        SqliteMapStore(folder)


def test_log_without_database_is_not_discarded(folder: Path) -> None:
    with SqliteMapStore.owned(folder) as store:
        grown(store)
        shutil.copy(folder / f"{FILE}-wal", folder / "kept")
    (folder / "kept").rename(folder / f"{FILE}-wal")
    (folder / FILE).unlink()
    with pytest.raises(StoreError, match=r"maps\.sqlite-wal exists, but maps\.sqlite does not"):
        SqliteMapStore(folder)


def test_interrupted_first_start_is_repeated(folder: Path) -> None:
    folder.mkdir(parents=True)
    for tail in ("", "-wal", "-journal"):
        (folder / f"{FILE}.unfinished{tail}").write_bytes(b"half")
    with SqliteMapStore.owned(folder) as store:
        grown(store)
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["ids", "ids.place", "lock", FILE, "reserve"]


def test_freed_pages_return_to_the_disk(store: SqliteMapStore, folder: Path) -> None:
    def pages() -> int:
        (found,) = store._database._connection.execute("PRAGMA page_count").fetchone()
        return int(found)

    head = store.create("yard", LARGE * 2, NOTE, 0)
    before = pages()
    store.delete(head.uid)
    assert pages() == before
    store.release_space()
    # A few free pages are kept for later writes.
    assert pages() <= VACUUM_PAGES + 20


def test_second_store_of_a_directory_is_refused(store: SqliteMapStore, folder: Path) -> None:
    with pytest.raises(StoreLockedError, match="in use"), SqliteMapStore.owned(folder):
        pass


def test_write_to_a_removed_file_fails(store: SqliteMapStore, folder: Path) -> None:
    head = grown(store)
    assert store.trouble() is None
    (folder / FILE).rename(folder / "gone")
    for _ in range(2):
        assert "Move the same file back" in str(store.trouble())
        with pytest.raises(StoreError, match="removed") as raised:
            store.append(head, b"", NOTE, 0)
        assert raised.value.kind == "moved"
        (folder / FILE).write_bytes(b"another")
    (folder / "gone").rename(folder / FILE)
    assert store.trouble() is None
    assert store.append(head, b"", NOTE, 0).sequence == head.sequence + 1


def test_map_files_of_version_0_are_logged_not_read(
    folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (folder / "maps").mkdir(parents=True)
    (folder / "maps" / "yard.safetensors").write_bytes(b"old")
    with caplog.at_level(logging.WARNING), SqliteMapStore.owned(folder) as store:
        assert store.heads() == []
    assert "1 map files" in caplog.text
    assert "version 0" in caplog.text
    assert (folder / "maps" / "yard.safetensors").read_bytes() == b"old"
