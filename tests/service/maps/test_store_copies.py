"""Copies of a store: a snapshot of all maps, and its import into another store."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from service.maps.sqlite.id_ledger import SKIPPED
from service.maps.sqlite.snapshot import snapshot_of
from service.maps.sqlite.store import FILE, LAYOUT, SqliteMapStore
from service.maps.store import (
    IDS,
    Annotation,
    Ids,
    MapHead,
    Note,
    StoreError,
    skipped_ids,
)
from tests.service.backup.builders import content
from tests.service.maps.test_store import behind, grown

pytestmark = pytest.mark.sqlite

NOTE = Note(1.7e9, "ann", "edit", 3, 1)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[SqliteMapStore]:
    with SqliteMapStore.owned(tmp_path / "one") as opened:
        yield opened


@pytest.fixture
def other(tmp_path: Path) -> Iterator[SqliteMapStore]:
    with SqliteMapStore.owned(tmp_path / "other") as opened:
        yield opened


def fill(store: SqliteMapStore) -> MapHead:
    """Store two maps with owners, reservations and annotations; return the head of `yard`."""
    head = grown(store)
    head = store.append(head, b"ids", NOTE, 0, Ids(((20, 30),), ((20, 30),)))
    store.reserve(head.uid, 50, "zoe")
    store.annotate(head.uid, [Annotation("tag", "wet", "true", "ann", 1.75e9)])
    store.create("shed", b"small", NOTE, 0, Ids(((0, 4),), ((0, 4),)))
    return next(each for each in store.heads() if each.name == "yard")


def test_import_keeps_all_that_a_snapshot_has(store: SqliteMapStore, other: SqliteMapStore) -> None:
    head = fill(store)
    store.compact(head.uid, 3, b"the third")
    with store.snapshot() as source:
        wanted = content(source)
        store.append(head, b"later", NOTE, 0)
        assert content(source) == wanted
        assert other.import_maps(source) == source.heads()
    with other.snapshot() as found:
        assert content(found) == wanted
    assert other.verify() == []
    with pytest.raises(ValueError, match="has maps already"), store.snapshot() as source:
        other.import_maps(source)


def test_import_replaces_all_maps_or_none(
    store: SqliteMapStore, other: SqliteMapStore, tmp_path: Path
) -> None:
    fill(store)
    grown(other, "mine")
    with other.snapshot() as source:
        before = content(source)
    with behind(tmp_path / "one") as connection:
        connection.execute("UPDATE commits SET delta = x'00' WHERE sequence = 5")
    with store.snapshot() as source, pytest.raises(StoreError, match="altered or lost"):
        other.import_maps(source, replaces=True)
    with other.snapshot() as source:
        assert content(source) == before
    with SqliteMapStore.owned(tmp_path / "third") as third:
        grown(third, "new")
        with third.snapshot() as source:
            other.import_maps(source, replaces=True)
            wanted = content(source)
    with other.snapshot() as source:
        assert content(source) == wanted
    assert other.verify() == []


def test_A23_imported_maps_skip_ids_that_the_source_may_not_know(
    store: SqliteMapStore, other: SqliteMapStore
) -> None:
    head = fill(store)
    with store.snapshot() as source:
        other.import_maps(source, SKIPPED)
        given_out = store.reserve(head.uid, 9, "ann")
        store.import_maps(source, SKIPPED, replaces=True)
    assert other.reserve(head.uid, 1, "ann") == head.next_id + SKIPPED
    (owner,) = other.owners(head.uid, [head.next_id])
    assert owner is not None
    assert owner.author == ""
    # This store knows which ids it gave out, so it skips few.
    assert given_out + 9 <= store.reserve(head.uid, 1, "ann") < given_out + SKIPPED
    assert other.verify() == store.verify() == []


def test_database_of_an_earlier_version_is_read_and_stays(tmp_path: Path) -> None:
    folder = tmp_path / "var"
    with SqliteMapStore.owned(folder) as store:
        grown(store)
        with store.snapshot() as source:
            wanted = content(source)
    with behind(folder) as connection:
        connection.execute("DROP TABLE annotations")
        connection.execute("PRAGMA user_version = 2")
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    before = (folder / FILE).read_bytes()
    with snapshot_of(folder / FILE, LAYOUT) as source:
        assert content(source) == wanted
    assert (folder / FILE).read_bytes() == before


def test_altered_rows_are_noticed_by_a_snapshot(store: SqliteMapStore, tmp_path: Path) -> None:
    fill(store)
    with behind(tmp_path / "one") as connection:
        connection.execute("UPDATE annotations SET value = 'false'")
    with store.snapshot() as source, pytest.raises(StoreError, match="annotations"):
        source.annotations()
    with behind(tmp_path / "one") as connection:
        connection.execute("UPDATE maps SET next_id = 1")
    with store.snapshot() as source, pytest.raises(StoreError, match="was altered"):
        source.heads()
    with (
        pytest.raises(StoreError, match="unable to open"),
        snapshot_of(tmp_path / FILE, LAYOUT),
    ):
        pass


def test_last_ids_are_not_skipped(store: SqliteMapStore) -> None:
    head = replace(store.create("yard", b"", NOTE, 0), next_id=IDS - 2)
    assert skipped_ids(head, 0, SKIPPED) == IDS - 1
    assert skipped_ids(head, IDS - 2, 0) == IDS - 2
