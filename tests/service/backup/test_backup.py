"""Backups in folders and buckets: they keep every byte, and a killed one changes nothing."""

import errno
import json
import os
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC
from pathlib import Path
from typing import Any

import pytest

from service.backup.folder import LOCK, FolderTarget
from service.backup.format import MANIFEST, BackupError
from service.backup.reading import BackupSnapshot
from service.backup.targets import BackupTarget, target_at
from service.backup.writing import BackupWriter, packs_of, pieces_of
from service.maps.sqlite.id_ledger import SKIPPED
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import StoreError
from tests.service.backup.builders import (
    LARGE,
    NOTE,
    Countdown,
    FailingFolder,
    KilledError,
    content,
    content_of,
    fill,
    steps,
)
from tests.service.maps.test_store import behind

NOW = 1.8e9


@pytest.fixture
def store(tmp_path: Path) -> Iterator[SqliteMapStore]:
    with SqliteMapStore.owned(tmp_path / "var") as opened:
        yield opened


@pytest.fixture
def other(tmp_path: Path) -> Iterator[SqliteMapStore]:
    with SqliteMapStore.owned(tmp_path / "other") as opened:
        yield opened


@pytest.fixture
def folder(tmp_path: Path) -> FolderTarget:
    return FolderTarget(tmp_path / "deep" / "backup")


def back_up(store: SqliteMapStore, target: BackupTarget) -> int:
    """Back up a store; return the new bytes."""
    writer = BackupWriter(target)
    with store.snapshot() as source:
        writer.write(source, "1.0", NOW)
    return writer.new_bytes


def test_backup_has_all_that_the_store_has(store: SqliteMapStore, folder: FolderTarget) -> None:
    fill(store)
    back_up(store, folder)
    snapshot = BackupSnapshot(folder)
    assert content(snapshot) == content_of(store)
    assert snapshot.faults() == []
    assert snapshot.manifest.created == NOW
    assert [each.name for each in snapshot.manifest.maps] == ["shed", "yard"]
    with pytest.raises(KeyError):
        snapshot.history("no-uid")


def test_restored_store_has_all_that_the_backup_has(
    store: SqliteMapStore, other: SqliteMapStore, folder: FolderTarget
) -> None:
    fill(store)
    back_up(store, folder)
    other.import_maps(BackupSnapshot(folder))
    assert content_of(other) == content_of(store)
    assert other.verify() == []


def test_second_backup_writes_only_what_is_new(store: SqliteMapStore, folder: FolderTarget) -> None:
    head = fill(store)
    assert back_up(store, folder) > len(LARGE)
    assert back_up(store, folder) == 0
    store.append(head, b"one more", NOTE, 0)
    assert back_up(store, folder) < len(LARGE) / 10
    snapshot = BackupSnapshot(folder)
    assert content(snapshot) == content_of(store)
    assert set(folder.objects()) == set(snapshot.manifest.objects)


def test_backup_killed_at_any_write_leaves_the_previous_one(
    store: SqliteMapStore, tmp_path: Path
) -> None:
    head = fill(store)
    target = FailingFolder(tmp_path / "backup")
    target.countdown = Countdown()
    back_up(store, target)
    before = content_of(store)
    head = store.append(head, b"one more", NOTE, 0)
    store.compact(head.uid, head.sequence, b"a new base")
    after = content_of(store)
    outcomes = []
    for count in steps():
        target.countdown = Countdown(count)
        try:
            back_up(store, target)
            break
        except KilledError:
            outcomes.append(content(BackupSnapshot(target)) == after)
            assert outcomes[-1] or content(BackupSnapshot(target)) == before
            assert BackupSnapshot(target).faults() == []
    assert len(outcomes) >= 3
    assert outcomes == sorted(outcomes)
    assert content(BackupSnapshot(target)) == after
    assert set(target.objects()) == set(BackupSnapshot(target).manifest.objects)


def test_empty_store_does_not_replace_a_backup(
    store: SqliteMapStore, other: SqliteMapStore, folder: FolderTarget
) -> None:
    back_up(other, folder)
    fill(store)
    back_up(store, folder)
    with pytest.raises(BackupError, match=r"store has no maps, but the backup in .* has 2"):
        back_up(other, folder)
    assert content(BackupSnapshot(folder)) == content_of(store)


def test_damaged_map_ends_the_backup_and_the_previous_one_stays(
    store: SqliteMapStore, folder: FolderTarget, tmp_path: Path
) -> None:
    fill(store)
    back_up(store, folder)
    before = content_of(store)
    with behind(tmp_path / "var") as connection:
        connection.execute("UPDATE commits SET delta = x'00' WHERE sequence = 5")
    with pytest.raises(StoreError, match="map 'yard': its version 5"):
        back_up(store, folder)
    assert content(BackupSnapshot(folder)) == before


def test_objects_are_cut_and_joined_at_fixed_places() -> None:
    assert list(pieces_of(b"abcde", 2)) == [b"ab", b"cd", b"e"]
    assert list(pieces_of(b"", 2)) == []
    blobs = [b"a", b"bb", b"cccc", b"d"]
    assert list(packs_of(blobs, 3)) == [b"abb", b"cccc", b"d"]
    # Full packs do not change if blobs are added.
    assert list(packs_of([*blobs, b"e"], 3))[:2] == [b"abb", b"cccc"]


def test_deltas_are_read_across_packs(
    store: SqliteMapStore, folder: FolderTarget, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.backup.writing.packs_of", lambda blobs: packs_of(blobs, 7_000))
    head = fill(store)
    back_up(store, folder)
    snapshot = BackupSnapshot(folder)
    assert content(snapshot) == content_of(store)
    with store.read(head.uid) as wanted:
        found = snapshot.history(head.uid)
        assert list(found.blobs(4, 6)) == list(wanted.blobs(4, 6))
        assert list(found.blobs(3, 4)) == list(wanted.blobs(3, 4))
        assert found.mark(3) == wanted.mark(3)
    with pytest.raises(KeyError):
        found.mark(1)


@pytest.mark.parametrize("part", ["log", "base", "pack"])
def test_altered_object_is_noticed(
    store: SqliteMapStore, other: SqliteMapStore, folder: FolderTarget, part: str
) -> None:
    head = fill(store)
    back_up(store, folder)
    snapshot = BackupSnapshot(folder)
    log = snapshot._log(head.uid)
    entry = next(each for each in snapshot.manifest.maps if each.name == "yard")
    name = {"log": entry.log, "base": log.base[0], "pack": log.packs[0]}[part]
    path = Path(str(folder)) / "objects" / name[:2] / name
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    (fault,) = BackupSnapshot(folder).faults()
    assert f"map 'yard': the object {name}" in fault
    with pytest.raises(BackupError, match="was altered"):
        other.import_maps(BackupSnapshot(folder))
    assert other.heads() == []
    path.unlink()
    (fault,) = BackupSnapshot(folder).faults()
    assert "is missing" in fault
    # The next backup writes the object again.
    assert back_up(store, folder) > 0
    assert BackupSnapshot(folder).faults() == []


def test_next_backup_mends_an_altered_object(store: SqliteMapStore, folder: FolderTarget) -> None:
    fill(store)
    back_up(store, folder)
    whole = BackupSnapshot(folder)
    (name,) = next(log for log in map(whole._log, whole._logs) if log.head.name == "yard").base
    path = Path(str(folder)) / "objects" / name[:2] / name
    data = bytearray(path.read_bytes())
    data[7] ^= 1
    path.write_bytes(data)
    assert back_up(store, folder) == len(data)
    assert BackupSnapshot(folder).faults() == []


def test_full_disk_names_the_folder_and_leaves_no_part(
    store: SqliteMapStore, folder: FolderTarget, monkeypatch: pytest.MonkeyPatch
) -> None:
    fill(store)
    fsync = os.fsync

    def full(number: int) -> None:
        fsync(number)
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left") as raised:
        back_up(store, folder)
    assert raised.value.filename == str(folder)
    assert folder.objects() == {}
    monkeypatch.undo()
    back_up(store, folder)
    assert BackupSnapshot(folder).faults() == []


def test_logs_that_disagree_are_noticed(store: SqliteMapStore, folder: FolderTarget) -> None:
    fill(store)
    back_up(store, folder)
    snapshot = BackupSnapshot(folder)
    uids = {each.name: each.uid for each in snapshot.manifest.maps}
    log = snapshot._log(uids["yard"])
    for wrong, words in (
        (replace(log, base=[]), "its base"),
        (replace(log, packs=[]), "its version 3"),
        (replace(log, packs=log.base), "its version 3"),
        (replace(log, commits=log.commits[1:]), "its list of versions"),
        (replace(log, base=["0" * 64]), "not in the manifest"),
    ):
        snapshot._log = lambda _, wrong=wrong: wrong  # type: ignore[method-assign, misc]
        other, fault = snapshot.faults()
        assert "map 'shed': its log is the log of another map" in other
        assert words in fault


def test_manifest_is_checked(store: SqliteMapStore, folder: FolderTarget, tmp_path: Path) -> None:
    with pytest.raises(BackupError, match=r"backup.json is missing"):
        BackupSnapshot(folder)
    fill(store)
    back_up(store, folder)
    file = Path(str(folder)) / MANIFEST
    whole = json.loads(file.read_bytes())
    for wrong, words in (
        ("{", "no JSON"),
        ("[]", "no manifest"),
        (json.dumps(whole | {"created": 1.0}), "hash differs"),
        (json.dumps(whole | {"version": 2}), "version 2 of the format"),
    ):
        file.write_text(wrong)
        with pytest.raises(BackupError, match=words):
            BackupSnapshot(folder)
        with pytest.raises(BackupError, match="A new backup needs a new target"):
            back_up(store, folder)


def test_folder_with_other_files_and_a_second_backup_are_refused(
    store: SqliteMapStore, folder: FolderTarget, tmp_path: Path
) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").touch()
    with pytest.raises(BackupError, match=r"not empty and holds no backup: found 'thesis\.txt'"):
        back_up(store, FolderTarget(tmp_path / "mine"))
    with folder.writing(), pytest.raises(BackupError, match="Another backup"):
        back_up(store, FolderTarget(Path(str(folder))))
    assert LOCK in {path.name for path in Path(str(folder)).iterdir()}
    back_up(store, folder)


def test_restore_killed_at_any_map_leaves_the_old_maps(
    store: SqliteMapStore, other: SqliteMapStore, folder: FolderTarget
) -> None:
    from service.backup.counting import CountedSnapshot

    fill(store)
    back_up(store, folder)
    other.create("mine", b"file", NOTE, 3)
    before = content_of(other)
    for count in steps():
        countdown = Countdown(count)
        source = CountedSnapshot(BackupSnapshot(folder), lambda _, c=countdown: c.step())  # type: ignore[misc]
        try:
            other.import_maps(source, replaces=True)
            break
        except KilledError:
            assert content_of(other) == before
            assert other.verify() == []
    assert count > 5
    assert content_of(other) == content_of(store)


def test_A23_restored_store_gives_out_no_id_twice(
    store: SqliteMapStore, other: SqliteMapStore, folder: FolderTarget
) -> None:
    head = fill(store)
    back_up(store, folder)
    since = store.reserve(head.uid, 100, "ann")
    other.import_maps(BackupSnapshot(folder), SKIPPED)
    assert other.reserve(head.uid, 1, "ann") >= since + 100
    store.import_maps(BackupSnapshot(folder), SKIPPED, replaces=True)
    assert since + 100 <= store.reserve(head.uid, 1, "ann") < since + SKIPPED


def test_place_names() -> None:
    assert str(target_at("some/folder")) == "some/folder"
    with pytest.raises(ValueError, match="expected a folder or s3://BUCKET/PREFIX"):
        target_at("http://host/bucket")
    with pytest.raises(ValueError, match="expected s3://BUCKET/PREFIX"):
        target_at("s3:///prefix")


def test_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "boto3", None)
    with pytest.raises(BackupError, match=r"pip install 'placecell\[s3\]'"):
        target_at("s3://bucket/prefix")


class TestBucket:
    """A bucket of moto, in this process."""

    @pytest.fixture(autouse=True)
    def client(self, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
        boto3 = pytest.importorskip("boto3")
        moto = pytest.importorskip("moto")
        for name, value in {
            "AWS_ACCESS_KEY_ID": "a",
            "AWS_SECRET_ACCESS_KEY": "b",
            "AWS_DEFAULT_REGION": "us-east-1",
        }.items():
            monkeypatch.setenv(name, value)
        with moto.mock_aws():
            client = boto3.client("s3")
            client.create_bucket(Bucket="maps")
            yield client

    def test_bucket_keeps_a_backup_and_the_next_one(
        self, store: SqliteMapStore, other: SqliteMapStore, client: Any
    ) -> None:
        head = fill(store)
        target = target_at("s3://maps/fleet/a/")
        assert str(target) == "s3://maps/fleet/a"
        assert back_up(store, target) > len(LARGE)
        assert content(BackupSnapshot(target)) == content_of(store)
        assert back_up(store, target_at("s3://maps/fleet/a")) == 0
        store.append(head, b"one more", NOTE, 0)
        assert back_up(store, target) < len(LARGE) / 10
        assert BackupSnapshot(target).faults() == []
        other.import_maps(BackupSnapshot(target))
        assert content_of(other) == content_of(store)
        keys = [each["Key"] for each in client.list_objects_v2(Bucket="maps")["Contents"]]
        assert {key.startswith("fleet/a/") for key in keys} == {True}
        (name, *_) = BackupSnapshot(target).manifest.objects
        client.delete_object(Bucket="maps", Key=f"fleet/a/objects/{name}")
        assert BackupSnapshot(target).faults()

    def test_backup_killed_at_any_write_leaves_the_previous_one(
        self, store: SqliteMapStore, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        head = fill(store)
        target: Any = target_at("s3://maps/x")
        back_up(store, target)
        before = content_of(store)
        store.append(head, b"one more", NOTE, 0)
        after = content_of(store)
        put = target._put
        outcomes = []
        for count in steps():
            countdown = Countdown(count)

            def put_or_die(name: str, data: bytes, to: Countdown = countdown, **rest: str) -> None:
                to.step()
                put(name, data, **rest)

            monkeypatch.setattr(target, "_put", put_or_die)
            try:
                back_up(store, target)
                break
            except KilledError:
                outcomes.append(content(BackupSnapshot(target)) == before)
        assert outcomes == [True] * len(outcomes)
        assert len(outcomes) >= 2
        assert content(BackupSnapshot(target)) == after

    def test_old_objects_are_removed_and_new_ones_of_others_stay(
        self, store: SqliteMapStore, client: Any, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        from datetime import datetime, timedelta

        fill(store)
        target = target_at("s3://maps")
        old, new = "0" * 64, "1" * 64
        client.put_object(Bucket="maps", Key=f"objects/{old}", Body=b"left by a killed backup")
        client.put_object(Bucket="maps", Key=f"objects/{new}", Body=b"of a running backup")
        listed = target._listed  # type: ignore[attr-defined]
        ages = {old: -60, new: 60}
        now = datetime.now(UTC)
        monkeypatch.setattr(
            target,
            "_listed",
            lambda: [
                each | {"LastModified": now + timedelta(seconds=ages.get(each["Name"], 0))}
                for each in listed()
            ],
        )
        back_up(store, target)
        assert old not in target.objects()
        assert new in target.objects()
        assert BackupSnapshot(target).faults() == []

    def test_second_backup_at_once_fails_and_the_first_stays(
        self, store: SqliteMapStore, client: Any
    ) -> None:
        head = fill(store)
        slow, fast = target_at("s3://maps"), target_at("s3://maps")
        assert slow.manifest() is None
        back_up(store, fast)
        with pytest.raises(BackupError, match="Another backup"):
            slow.replace_manifest(b"{}")
        slow.manifest()
        store.append(head, b"one more", NOTE, 0)
        back_up(store, fast)
        with pytest.raises(BackupError, match="Another backup"):
            slow.replace_manifest(b"{}")
        assert BackupSnapshot(fast).faults() == []

    def test_errors_of_s3_name_the_place(self, store: SqliteMapStore) -> None:
        with pytest.raises(OSError, match=r"s3://no-such-bucket/x: .*bucket does not exist"):
            back_up(store, target_at("s3://no-such-bucket/x"))

    def test_service_without_conditions_keeps_backups(
        self, store: SqliteMapStore, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        from botocore.exceptions import ClientError

        fill(store)
        target: Any = target_at("s3://maps/x")
        put = target._put

        def without(name: str, data: bytes, **condition: str) -> None:
            if condition:
                raise ClientError({"Error": {"Code": "NotImplemented"}}, "PutObject")
            put(name, data)

        monkeypatch.setattr(target, "_put", without)
        back_up(store, target)
        assert BackupSnapshot(target).faults() == []

        def failing(name: str, data: bytes, **condition: str) -> None:
            raise ClientError({"Error": {"Code": "AccessDenied"}}, "PutObject")

        monkeypatch.setattr(target, "_put", failing)
        with pytest.raises(OSError, match="AccessDenied"):
            target.replace_manifest(b"{}")
