"""Files that are moved, altered or replaced while the service runs, or come from a backup."""

import json
import os
import random
import shutil
import signal
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from placecell_client import MapFileError, decode, encode

from placecell.descriptors.manifest import Manifest
from service.maps.history import replay
from service.maps.sqlite.database import Database
from service.maps.sqlite.id_ledger import LEASE, SKIPPED
from service.maps.sqlite.store import FILE, LEDGER, SqliteMapStore
from service.maps.sqlite.tables import VERSION
from service.maps.store import Ids, Note, StoreError, StoreLockedError
from tests.fixtures.killed_service import EXPECTED
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

pytestmark = pytest.mark.sqlite

NOTE = Note(1.7e9, "ann", "edit", 3, 1)
ANY = {"If-Match": "*"}
OLD = Path(__file__).resolve().parents[2] / "fixtures" / "user-version-1"
"""Database of a killed service with tables of version 1, with its log."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "var"


@pytest.fixture
def store(folder: Path) -> Iterator[SqliteMapStore]:
    with SqliteMapStore.owned(folder) as opened:
        yield opened


@pytest.fixture
def file(manifest: Manifest) -> bytes:
    return encode(map_of(random_codes(20), manifest.model_id))


def flipped(value: Any) -> list[Any]:
    """Return some values that differ from this one by one flipped bit."""
    if isinstance(value, int):
        return [value ^ 1, value ^ 4, value ^ (1 << 33)]
    if isinstance(value, float):
        return [value + 1.0, -value or 1.0]
    if isinstance(value, bytes):
        places = (0, len(value) // 2, len(value) - 1)
        return [value[:at] + bytes([value[at] ^ 1]) + value[at + 1 :] for at in places]
    if isinstance(value, str):
        if not value:
            return ["x"]
        ends = sorted({0, len(value) // 2, len(value) - 1})
        return [value[:at] + chr(ord(value[at]) ^ 1) + value[at + 1 :] for at in ends]
    assert value is None
    return [b"x", 0.5]


def told_by(folder: Path) -> Any:
    """Return all content of the store, or its error for altered bytes."""
    try:
        store = SqliteMapStore(folder)
    except StoreError as error:
        return f"not opened: {error}"
    with closing(store):
        if wrong := store.verify():
            return f"noticed: {wrong[0]}"
        told: list[Any] = []
        for head in store.heads():
            try:
                with store.read(head.uid) as history:
                    versions = [
                        encode(replay(history, commit.sequence).content())
                        for commit in history.commits()
                    ]
                    commits = history.commits()
            except (StoreError, MapFileError) as error:
                return f"noticed: {error}"
            owners = store.owners(head.uid, range(200))
            told.append((replace(head, next_id=0), commits, versions, owners))
            told.append(store.reserve(head.uid, 1, "ann"))
        return told


@pytest.mark.slow
def test_A28_flipped_bit_is_noticed_or_changes_nothing(
    start: Any,
    data_dir: Path,
    manifest: Manifest,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Flip bits in each column of each row of each table."""
    monkeypatch.setattr(os, "fsync", lambda _: None)
    with start() as service:
        for name in ("yard", "hall"):
            for first in (100, 105, 120):
                data = edit_of(random_codes(8, first), manifest.model_id, first)
                path = f"/maps/{name}/segments?create=true"
                assert service.post(path, content=data, headers=ANY).is_success or first == 100
                service.post(path, content=data)
            assert service.post(f"/maps/{name}/ids?count=3").status_code == 200
        assert service.post("/maps/hall/compact?keep=2").status_code == 200
    whole = tmp_path / "whole"
    shutil.copytree(data_dir, whole)
    (whole / "reserve").unlink()

    def opened() -> Any:
        shutil.rmtree(data_dir)
        shutil.copytree(whole, data_dir)

    opened()
    right = told_by(data_dir)
    assert isinstance(right, list)
    with closing(sqlite3.connect(whole / FILE)) as connection:
        cells = [
            (table, row, column, value)
            for table in ("maps", "commits", "bases", "owners", "opened")
            for row, *values in connection.execute(f"SELECT rowid, * FROM {table}").fetchall()
            for (_, column, *_), value in zip(
                connection.execute(f"PRAGMA table_info({table})").fetchall(), values, strict=True
            )
        ]
    columns, noticed, draw = set(), set(), random.Random(0)
    for table, row, column, value in cells:
        columns.add((table, column))
        for altered in draw.sample(flipped(value), 1):
            opened()
            with closing(sqlite3.connect(data_dir / FILE)) as connection:
                try:
                    connection.execute(
                        f"UPDATE {table} SET {column} = ? WHERE rowid = ?", (altered, row)
                    )
                except sqlite3.IntegrityError:
                    continue  # another row has this key, or the type is another
                connection.commit()
            found = told_by(data_dir)
            if isinstance(found, str):
                noticed.add((table, column))
            else:
                assert found == right or (table, column) == ("opened", "token"), (
                    *(table, row, column, value, altered),
                )
    # Only these may go unnoticed: map numbers, and the token, which decides if ids are skipped.
    assert columns - noticed <= {("opened", "token"), ("maps", "map")}


def test_A28_altered_author_or_time_is_not_served(start: Any, data_dir: Path, file: bytes) -> None:
    with start() as service:
        service.put("/maps/yard", content=file)
        service.put("/maps/hall", content=file)
    with closing(sqlite3.connect(data_dir / FILE)) as connection:
        connection.execute("UPDATE commits SET author = 'anyonf' WHERE map = 1")
        connection.commit()
    with start() as service:
        assert_problem(service.get("/maps/yard/versions"), 500, "map-damaged")
        assert service.get("/maps/hall/versions").status_code == 200


def test_A28_database_of_version_1_is_migrated(start: Any, data_dir: Path) -> None:
    shutil.copytree(OLD, data_dir)
    expected = json.loads((OLD / EXPECTED).read_text())
    with start() as service:
        for name, versions in expected.items():
            listed = service.get(f"/maps/{name}/versions").json()["versions"]
            assert [[each["sequence"], each["etag"]] for each in reversed(listed)] == [
                version[:2] for version in versions
            ]
            data = service.get(f"/maps/{name}").content
            ids = decode(data).ids
            first = service.post(f"/maps/{name}/ids?count=2").json()["first"]
            assert first > ids.max(initial=0)
            restored = service.post(f"/maps/{name}/versions/{versions[0][0]}/restore")
            assert restored.status_code == 200
    with closing(sqlite3.connect(data_dir / FILE)) as connection:
        assert connection.execute("PRAGMA user_version").fetchone() == (VERSION,)
        links = connection.execute("SELECT map, sequence, link FROM commits").fetchall()
        newest_link = {row: link for row, _, link in sorted(links)}
        assert newest_link[1]  # that of the other changed nothing
        # Marks of old commits do not cover notes; marks of new commits do.
        connection.execute("UPDATE commits SET author = 'zoe' WHERE link = ''")
        connection.commit()
    with SqliteMapStore.owned(data_dir) as store:
        assert store.verify() == []
    with closing(sqlite3.connect(data_dir / FILE)) as connection:
        connection.execute("UPDATE commits SET author = 'zoe' WHERE link != '' AND map = 1")
        connection.commit()
    with SqliteMapStore.owned(data_dir) as store:
        (wrong,) = store.verify()
        assert "was altered or lost" in wrong


@pytest.mark.integration
@pytest.mark.parametrize("statement", range(1, 12, 2))
def test_A28_killed_migration_leaves_version_1(
    data_dir: Path, monkeypatch: pytest.MonkeyPatch, statement: int
) -> None:
    shutil.copytree(OLD, data_dir)
    child = os.fork()
    if not child:  # pragma: no cover -- it is killed
        try:
            told = [0]

            def kill(text: str) -> None:
                told[0] += text.strip().startswith(
                    ("ALTER", "CREATE", "UPDATE", "INSERT", "COMMIT")
                )
                if told[0] == statement:
                    os.kill(os.getpid(), signal.SIGKILL)

            real = Database._migrate

            def traced(self: Database, connection: Any, *rest: Any) -> None:
                connection.set_trace_callback(kill)
                real(self, connection, *rest)

            monkeypatch.setattr(Database, "_migrate", traced)
            SqliteMapStore(data_dir)
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    assert os.WIFSIGNALED(status)
    with closing(sqlite3.connect(data_dir / FILE)) as connection:
        assert connection.execute("PRAGMA user_version").fetchone() == (1,)
        tables = {row[0] for row in connection.execute("SELECT name FROM sqlite_master")}
        assert not tables & {"owners", "opened"}
    with SqliteMapStore.owned(data_dir) as store:
        assert store.verify() == []
        assert len(store.heads()) == 2


def test_A28_migration_without_space_changes_nothing(
    data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(OLD, data_dir)
    with monkeypatch.context() as full:
        full.setattr("service.maps.sqlite.disk_reserve.DiskReserve.free_bytes", lambda _: 1_000)
        with pytest.raises(StoreError, match="free bytes") as raised:
            SqliteMapStore(data_dir)
        assert raised.value.kind == "full"
    with closing(sqlite3.connect(data_dir / FILE)) as connection:
        assert connection.execute("PRAGMA user_version").fetchone() == (1,)
    with SqliteMapStore.owned(data_dir) as store:
        assert store.verify() == []


def test_A10_moved_database_is_reported_and_nothing_is_lost(
    start: Any, data_dir: Path, file: bytes, manifest: Manifest
) -> None:
    other = encode(map_of(random_codes(30, 1), manifest.model_id))
    moved = data_dir / "moved"
    with start() as service:
        assert service.put("/maps/yard", content=file).status_code == 201
        (data_dir / FILE).rename(moved)
        requests: list[Callable[[], Any]] = [
            lambda: service.get("/maps/yard/versions"),
            lambda: service.get("/maps/yard?version=1"),
            lambda: service.put("/maps/hall", content=file),
            lambda: service.put("/maps/yard", content=other, headers=ANY),
            lambda: service.post("/maps/yard/ids?count=1"),
            lambda: service.delete("/maps/yard"),
        ]
        for request in requests:
            assert_problem(request(), 503, "store-unavailable", "Move the same file back")
            assert not (data_dir / FILE).exists()
            assert (data_dir / f"{FILE}-wal").exists()
        assert_problem(service.get("/readyz"), 503, "not-ready", "Move the same file back")
        # Another database in its place is refused, too.
        for content in (b"", b"rubbish", moved.read_bytes()):
            (data_dir / FILE).write_bytes(content)
            for request in requests:
                assert_problem(request(), 503, "store-unavailable")
        moved.rename(data_dir / FILE)
        assert service.get("/readyz").status_code == 200
        assert service.get("/maps/yard?version=1").content == file
        assert service.put("/maps/yard", content=other, headers=ANY).status_code == 200
        (data_dir / FILE).rename(moved)
    # The service stopped while its database was moved away.
    assert (data_dir / f"{FILE}-wal").stat().st_size
    moved.rename(data_dir / FILE)
    with start() as service:
        assert service.get("/maps/yard").content == other
        assert service.get("/maps/yard?version=1").content == file


def test_A10_removed_log_is_reported_and_nothing_is_lost(
    start: Any, data_dir: Path, file: bytes
) -> None:
    log = data_dir / f"{FILE}-wal"
    for name, replacement in (("yard", None), ("hall", b"")):
        with start() as service:
            assert service.put(f"/maps/{name}", content=file).status_code == 201
            log.unlink()
            if replacement is not None:
                log.write_bytes(replacement)
            assert_problem(service.get(f"/maps/{name}/versions"), 503, "store-unavailable")
            refused = service.put("/maps/shed", content=file)
            assert_problem(refused, 503, "store-unavailable", "Stop the service")
            assert_problem(service.get("/readyz"), 503, "not-ready", f"{FILE}-wal")
        with start() as service:
            assert service.get(f"/maps/{name}?version=1").content == file
            assert service.get("/maps/shed").status_code == 404


@pytest.mark.slow
def test_A10_replaced_directory_is_reported(start: Any, data_dir: Path, file: bytes) -> None:
    with start() as service:
        assert service.put("/maps/yard", content=file).status_code == 201
        data_dir.rename(data_dir.with_name("moved"))
        for _ in range(2):
            assert_problem(service.put("/maps/hall", content=file), 503, "store-unavailable")
            assert_problem(service.get("/maps/yard/versions"), 503, "store-unavailable")
            assert_problem(service.get("/readyz"), 503, "not-ready")
            data_dir.mkdir(exist_ok=True)
        assert [*data_dir.iterdir()] == []
        data_dir.rmdir()
        data_dir.with_name("moved").rename(data_dir)
        assert service.put("/maps/hall", content=file).status_code == 201
    with start() as service:
        assert len(service.get("/maps").json()["maps"]) == 2


@pytest.mark.parametrize("replaced", [False, True])
def test_A22_removed_lock_file_admits_no_second_service(
    start: Any, data_dir: Path, file: bytes, replaced: bool
) -> None:
    with start() as service:
        assert service.put("/maps/yard", content=file).status_code == 201
        (data_dir / "lock").unlink()
        if replaced:
            (data_dir / "lock").touch()
        with pytest.raises(StoreLockedError, match="in use"), SqliteMapStore.owned(data_dir):
            pass
        for refused in (
            service.put("/maps/hall", content=file),
            service.delete("/maps/yard"),
            service.post("/maps/yard/ids?count=1"),
        ):
            assert_problem(refused, 503, "store-unavailable", "Restart this service")
        assert_problem(service.get("/readyz"), 503, "not-ready", "lock")
        assert service.get("/maps/yard?version=1").content == file
    with start() as service:
        assert service.put("/maps/hall", content=file).status_code == 201
        assert service.get("/readyz").status_code == 200


def backed_up(folder: Path, copy: Path) -> None:
    with closing(sqlite3.connect(folder / FILE)) as one, closing(sqlite3.connect(copy)) as other:
        one.backup(other)


def brought_back(folder: Path, copy: Path) -> None:
    for tail in ("", "-wal", "-shm"):
        (folder / f"{FILE}{tail}").unlink(missing_ok=True)
    shutil.copy(copy, folder / FILE)


@pytest.mark.parametrize("killed", [False, True])
def test_A23_restored_backup_gives_no_id_twice(folder: Path, tmp_path: Path, killed: bool) -> None:
    with SqliteMapStore.owned(folder) as store:
        head = store.create("yard", b"file", NOTE, 10)
        backed_up(folder, tmp_path / "copy")
        given = [store.reserve(head.uid, 100_000, "ann") for _ in range(3)]
        self_chosen = given[-1] + 200_000
        store.append(head, b"", NOTE, 0, Ids(((self_chosen, self_chosen + 1),)))
        if killed:
            shutil.copy(folder / LEDGER, tmp_path / "as killed")
    if killed:
        (folder / LEDGER).write_bytes((tmp_path / "as killed").read_bytes())
    brought_back(folder, tmp_path / "copy")
    with SqliteMapStore.owned(folder) as store:
        first = store.reserve(head.uid, 1, "zoe")
        assert first > self_chosen
    # A start without a restored backup skips nothing.
    with SqliteMapStore.owned(folder) as store:
        assert store.reserve(head.uid, 1, "zoe") == first + 1


@pytest.mark.parametrize("how", ["no ledger", "directory copied", "ledger copied", "altered"])
def test_A23_foreign_ledger_skips_ids(folder: Path, tmp_path: Path, how: str) -> None:
    with SqliteMapStore.owned(folder) as store:
        head = store.create("yard", b"file", NOTE, 10)
        backed_up(folder, tmp_path / "copy")
    kept = tmp_path / "kept"
    shutil.copytree(folder, kept)
    with SqliteMapStore.owned(folder) as store:
        given = store.reserve(head.uid, 100_000, "ann")
    if how == "directory copied":
        shutil.rmtree(folder)
        shutil.copytree(kept, folder)
    else:
        brought_back(folder, tmp_path / "copy")
        if how == "altered":
            said = (folder / LEDGER).read_bytes()
            (folder / LEDGER).write_bytes(said.replace(b" 1", b" 2"))
        elif how == "ledger copied":
            (folder / LEDGER).write_bytes((kept / LEDGER).read_bytes())
        else:
            (folder / LEDGER).unlink()
    with SqliteMapStore.owned(folder) as store:
        first = store.reserve(head.uid, 1, "zoe")
        assert first >= max(given + 100_000, SKIPPED)
    with SqliteMapStore.owned(folder) as store:
        assert store.reserve(head.uid, 1, "zoe") == first + 1


@pytest.mark.integration
def test_A23_kill_skips_few_ids(folder: Path) -> None:
    child = os.fork()
    if not child:  # pragma: no cover -- it is killed
        try:
            with SqliteMapStore.owned(folder) as store:
                head = store.create("yard", b"file", NOTE, 10)
                store.reserve(head.uid, 5, "ann")
                os.kill(os.getpid(), signal.SIGKILL)
        finally:
            os._exit(0)
    os.waitpid(child, 0)
    with SqliteMapStore.owned(folder) as store:
        (found,) = store.heads()
        assert 15 <= store.reserve(found.uid, 1, "ann") <= 15 + LEASE
