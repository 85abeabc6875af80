"""Full disk: writes that free space succeed, even after a restart."""

import os
import sqlite3
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.maps.sqlite import database
from service.maps.sqlite.database import Database
from service.maps.sqlite.disk_reserve import DiskReserve
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import MapHead, Note, StoreError
from tests.service.api.test_faults import put
from tests.service.faulty_disk import small_disk
from tests.service.service_builders import assert_problem, map_of, random_codes

pytestmark = pytest.mark.sqlite

NOTE = Note(1.7e9, "ann", "put", 3, 1)


@pytest.fixture
def files(manifest: Manifest) -> list[bytes]:
    return [encode(map_of(random_codes(1_000, seed), manifest.model_id)) for seed in range(3)]


def filled(data_dir: Path) -> Path:
    """Fill the disk to the last byte."""
    ballast = data_dir / "ballast"
    with ballast.open("ab", buffering=0) as file:
        for size in (1 << 16, 1 << 12, 1 << 9):
            while True:
                try:
                    if not file.write(bytes(size)):
                        break
                except OSError:
                    break
    return ballast


@pytest.mark.parametrize("restarted", [False, True])
@pytest.mark.parametrize("ways", [["age", "compact", "delete"], ["delete"]])
def test_A18_deletion_frees_a_full_disk(
    start: Any, tmp_path: Path, files: list[bytes], restarted: bool, ways: list[str]
) -> None:
    data_dir = tmp_path / "disk"
    with small_disk(data_dir, "16m"):
        with start(data_dir=data_dir) as client:
            for name in ("yard", "hall"):
                for file in files:
                    assert put(client, file, name).is_success
            assert client.get("/readyz").status_code == 200
            ballast = filled(data_dir)
            assert_problem(put(client, files[0]), 507, "disk-full")
            assert_problem(client.get("/readyz"), 503, "not-ready", "The disk is full")
            for way in ways if not restarted else []:
                freed(client, way)
        if restarted:
            filled(data_dir)
            with start(data_dir=data_dir) as client:
                assert client.get("/readyz").status_code == 503
                filled(data_dir)
                for way in ways:
                    freed(client, way)
        with start(data_dir=data_dir) as client:
            assert client.get("/maps/hall").content == files[-1]
            ballast.unlink()
            assert client.get("/readyz").status_code == 200
            assert put(client, files[0], "shed").status_code == 201
            names = {each["name"] for each in client.get("/maps").json()["maps"]}
            assert names == {"hall", "shed"}


def freed(client: Any, way: str) -> None:
    if way == "delete":
        assert client.delete("/maps/yard").status_code == 204
        assert client.get("/maps/yard").status_code == 404
    elif way == "age":
        told = client.post("/maps/yard/age?unseen_since=1.75e9")
        assert told.json()["removed"] == 1_000
    else:
        assert client.post("/maps/yard/compact").status_code == 200
        assert len(client.get("/maps/yard/versions").json()["versions"]) == 1


def test_A18_writes_succeed_again_after_deletions(
    start: Any, tmp_path: Path, manifest: Manifest
) -> None:
    """A deletion frees enough space to continue and restores the reserve."""
    large = [encode(map_of(random_codes(20_000, seed), manifest.model_id)) for seed in range(2)]
    data_dir = tmp_path / "disk"
    with small_disk(data_dir, "24m"), start(data_dir=data_dir) as client:
        for number in range(100):
            if put(client, large[number % 2], f"map-{number}").status_code != 201:
                break
        assert number > 3
        assert client.get("/readyz").status_code == 503
        for gone in range(number):
            assert client.delete(f"/maps/map-{gone}").status_code == 204, gone
            if gone >= 2 and client.get("/readyz").status_code == 200:
                break
        assert client.get("/readyz").status_code == 200
        assert put(client, large[0], "again").status_code == 201


def test_A18_reserve_is_allocated_again_after_use(tmp_path: Path) -> None:
    reserve = DiskReserve(tmp_path)
    assert not reserve.is_held()
    assert reserve.hold()
    assert (tmp_path / "reserve").stat().st_blocks * 512 >= reserve.size > 0
    reserve.release(100)
    assert not reserve.is_held()
    assert (tmp_path / "reserve").stat().st_size == 100
    assert reserve.hold()
    (tmp_path / "reserve").unlink()
    assert reserve.hold()


def test_A18_only_writes_that_free_space_use_the_reserve(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with SqliteMapStore.owned(tmp_path / "var") as store:
        head = store.create("yard", b"file", NOTE, 0)
        database = store._database
        assert isinstance(database, Database)
        real, allowed = os.posix_fallocate, [False]

        def full(*arguments: Any) -> None:
            if not allowed[0]:
                raise OSError(28, "No space left on device")
            real(*arguments)

        monkeypatch.setattr(os, "posix_fallocate", full)
        (tmp_path / "var" / "reserve").unlink()
        for write in (
            lambda: store.append(head, b"", NOTE, 0),
            lambda: store.create("hall", b"", NOTE, 0),
            lambda: store.reserve(head.uid, 1),
        ):
            with pytest.raises(StoreError, match="full") as raised:
                write()
            assert raised.value.kind == "full"
        assert "The disk is full" in str(store.trouble())
        aged = store.append(head, b"", NOTE, 0, frees=True)
        assert store.compact(head.uid, 2, b"file").sequence == aged.sequence
        store.delete(head.uid)
        allowed[0] = True
        assert store.trouble() is None
        store.create("hall", b"", NOTE, 0)


def appended(store: SqliteMapStore, head: MapHead, size: int) -> MapHead | None:
    """Add a commit of a number of bytes; return None if the disk is full."""
    try:
        return store.append(head, os.urandom(size), NOTE, 0)
    except StoreError as error:
        if error.kind != "full":
            raise
        return None


@pytest.mark.parametrize("is_cut", [False, True])
def test_A18_a_log_that_is_larger_than_the_reserve_moves_into_the_database(
    tmp_path: Path, is_cut: bool
) -> None:
    """The reserve also covers the log, and a failed checkpoint does not use it up."""
    disk = tmp_path / "disk"
    with small_disk(disk, "24m"):
        with SqliteMapStore.owned(disk / "var") as store:
            hoard, yard = (store.create(name, b"file", NOTE, 0) for name in ("hoard", "yard"))
            while (added := appended(store, hoard, 700_000)) is not None:
                hoard = added
            filled(disk)
            while (added := appended(store, yard, 2_000)) is not None:
                yard = added
                filled(disk)
            filled(disk)
            assert "The disk is full" in str(store.trouble())
            if is_cut:
                (disk / "var" / "reserve").unlink()
                ballast = filled(disk)
                with store.read(yard.uid) as history:
                    assert len(history.commits()) == yard.sequence
                with pytest.raises(StoreError, match="full"):
                    store.append(yard, b"", NOTE, 0)
                ballast.unlink()
            store.delete(hoard.uid)
            assert store.trouble() is None
            assert store.verify() == []
            store.append(yard, b"", NOTE, 0)
        with SqliteMapStore.owned(disk / "var") as store:
            assert [head.name for head in store.heads()] == ["yard"]
            assert store.heads()[0].sequence == yard.sequence + 1


def test_A18_partly_released_reserve_keeps_the_rest(tmp_path: Path) -> None:
    reserve = DiskReserve(tmp_path)
    assert reserve.hold_for_log(3_000_000)
    held = reserve.size + reserve.log_bytes
    assert reserve.log_bytes >= 3_000_000
    assert (tmp_path / "reserve").stat().st_size == held
    assert reserve.release_share(0.5) == reserve.size // 2
    assert (tmp_path / "reserve").stat().st_size == reserve.size // 2
    assert reserve.hold()
    reserve.lend(1_000)
    assert (tmp_path / "reserve").stat().st_size == held - 1_000
    assert reserve.hold_for_log(0)
    assert (tmp_path / "reserve").stat().st_size == reserve.size
    (tmp_path / "reserve").unlink()
    assert reserve.release_share(0.5) == 0


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("SQLITE_IOERR_SHMSIZE", "Make room"),
        ("SQLITE_FULL", "Make room"),
        ("SQLITE_CANTOPEN_FULLPATH", "Run the command as the user of the service"),
    ],
)
def test_errors_of_the_disk_say_what_to_do(code: str, words: str) -> None:
    error = sqlite3.OperationalError("words of SQLite")
    error.sqlite_errorname = code
    with pytest.raises(StoreError, match=words), database._translated(Path("maps.sqlite")):
        raise error
