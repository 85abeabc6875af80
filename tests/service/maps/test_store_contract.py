"""Contract of `MapStore`, which the stores on SQLite and PostgreSQL fulfill alike."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from service.maps import store as map_store
from service.maps.postgres.store import PostgresStore
from service.maps.sql.tables import PART_BYTES
from service.maps.sqlite.store import FILE, SqliteMapStore
from service.maps.store import (
    IDS,
    Annotation,
    Ids,
    MapHead,
    Note,
    OutOfIdsError,
    Owner,
    SharedStore,
    StoreError,
    TooManyIdsError,
)

NOTE = Note(1.7e9, "ann", "edit", 3, 1)
LARGE = bytes(range(256)) * (PART_BYTES // 256) + b"a second part"

AnyStore = SqliteMapStore | PostgresStore


@dataclass(frozen=True)
class Kind:
    """A kind of store under test.

    Attributes:
        open: opens the store of the test.
        alter: runs a statement as another program would.
        blob: how a byte of zero is written in a statement.
    """

    open: Callable[[], AbstractContextManager[AnyStore]]
    alter: Callable[[str], object]
    blob: str


@pytest.fixture(params=["sqlite", pytest.param("postgres", marks=pytest.mark.integration)])
def kind(request: pytest.FixtureRequest, tmp_path: Path) -> Kind:
    if request.param == "postgres":
        server = request.getfixturevalue("postgres_server")
        url = request.getfixturevalue("postgres_database")
        return Kind(
            lambda: PostgresStore.opened(url),
            lambda statement: server.execute(f"SET search_path TO placecell; {statement}", url),
            r"'\x00'",
        )

    def alter(statement: str) -> None:
        with closing(sqlite3.connect(tmp_path / "var" / FILE)) as connection:
            connection.execute(statement)
            connection.commit()

    return Kind(lambda: SqliteMapStore.owned(tmp_path / "var"), alter, "x'00'")


@pytest.fixture
def store(kind: Kind) -> Iterator[AnyStore]:
    with kind.open() as opened:
        yield opened


def all_of(store: AnyStore, uid: str) -> tuple[MapHead, bytes, list[tuple[int, bytes]]]:
    """Return all that the store has of a map."""
    with store.read(uid) as history:
        blobs = history.blobs(history.head.oldest, history.head.sequence)
        return history.head, history.base(), [(commit.sequence, blob) for commit, blob in blobs]


def grown(store: AnyStore, name: str = "yard", commits: int = 4) -> MapHead:
    head = store.create(name, LARGE, replace(NOTE, operation="put"), 7)
    for count in range(commits):
        head = store.append(head, bytes([count]) * (count + 1) * 3_000, NOTE, 0)
    return head


def test_history_has_a_base_and_commits(store: AnyStore) -> None:
    first = store.create("yard", LARGE, NOTE, 7)
    assert (first.name, first.sequence, first.oldest, first.next_id) == ("yard", 1, 1, 7)
    second = store.append(first, b"one", NOTE, 9)
    third = store.append(second, b"three", replace(NOTE, author="zoe"), 8)
    assert (third.sequence, third.oldest, third.next_id) == (3, 1, 9)
    assert (third.base_bytes, third.log_bytes, third.commits) == (len(LARGE), 8, 2)
    assert all_of(store, first.uid) == (third, LARGE, [(2, b"one"), (3, b"three")])
    assert store.heads() == [third]
    with store.read(first.uid) as history:
        assert [commit.sequence for commit in history.commits()] == [1, 2, 3]
        assert [commit.note.author for commit in history.commits()] == ["ann", "ann", "zoe"]
        assert [commit.mark for commit in history.commits()] == [
            first.mark,
            second.mark,
            third.mark,
        ]
        assert [blob for _, blob in history.blobs(2, 3)] == [b"three"]
        assert list(history.blobs(3, 3)) == []
    assert store.verify() == []


def test_append_to_an_outdated_head_fails(store: AnyStore) -> None:
    first = store.create("yard", b"file", NOTE, 0)
    second = store.append(first, b"a", NOTE, 0)
    for wrong in (first, replace(second, mark="0" * 64), replace(second, uid="other")):
        with pytest.raises(KeyError):
            store.append(wrong, b"b", NOTE, 0)
    assert store.heads() == [second]
    with pytest.raises(ValueError, match="'yard' exists already"):
        store.create("yard", b"other", NOTE, 0)
    for call in (store.delete, lambda uid: store.reserve(uid, 1), lambda uid: all_of(store, uid)):
        with pytest.raises(KeyError):
            call("absent")


def test_marks_identify_a_version_and_its_history(store: AnyStore) -> None:
    one, other = (store.create(name, b"file", NOTE, 0) for name in ("a", "b"))
    assert one.mark != other.mark
    same = [store.append(head, b"delta", NOTE, 0).mark for head in (one, other)]
    assert same[0] != same[1]
    store.delete(one.uid)
    again = store.create("a", b"file", NOTE, 0)
    assert again.uid != one.uid
    assert store.append(again, b"delta", NOTE, 0).mark != same[0]


def test_compaction_drops_earlier_versions(store: AnyStore) -> None:
    head = grown(store)
    other = grown(store, "other")
    before = all_of(store, other.uid)
    compacted = store.compact(head.uid, 3, b"the file of version 3")
    assert compacted == replace(
        head, oldest=3, base_bytes=len(b"the file of version 3"), log_bytes=9_000 + 12_000
    )
    assert all_of(store, head.uid)[1:] == (
        b"the file of version 3",
        [(4, b"\2" * 9_000), (5, b"\3" * 12_000)],
    )
    with store.read(head.uid) as history:
        assert [commit.sequence for commit in history.commits()] == [3, 4, 5]
        with pytest.raises(KeyError):
            list(history.blobs(2, 4))
    for gone in (2, 6):
        with pytest.raises(KeyError):
            store.compact(head.uid, gone, b"")
    assert store.compact(head.uid, 5, b"head").log_bytes == 0
    assert all_of(store, other.uid) == before
    assert store.verify() == []


def test_reader_sees_one_state(store: AnyStore) -> None:
    head = grown(store)
    before = all_of(store, head.uid)
    with store.read(head.uid) as history:
        store.compact(store.append(head, b"more", NOTE, 0).uid, 5, b"later")
        assert (history.head, history.base()) == before[:2]
        assert len(list(history.blobs(1, 5))) == 4
        store.delete(head.uid)
        assert len(history.commits()) == 5
    assert store.heads() == []


def test_reserve_gives_out_ids_once(store: AnyStore) -> None:
    head = store.create("yard", b"file", NOTE, 10)
    assert [store.reserve(head.uid, count) for count in (5, 1, 3)] == [10, 15, 16]
    assert store.append(head, b"", NOTE, 12).next_id == 19
    (head,) = store.heads()
    store.append(head, b"", NOTE, IDS - 2, Ids((), ((0, IDS - 2),)))
    with pytest.raises(OutOfIdsError, match="2 ids"):
        store.reserve(head.uid, 3)
    assert store.reserve(head.uid, 2) == IDS - 2
    with pytest.raises(OutOfIdsError, match="0 ids"):
        store.reserve(head.uid, 1)


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("UPDATE commits SET delta = ZERO WHERE sequence = 3", "version 3"),
        ("UPDATE commits SET delta = NULL WHERE sequence = 5", "version 5"),
        ("UPDATE commits SET mark = 'x' WHERE sequence = 5", "version 5"),
        ("DELETE FROM commits WHERE sequence = 4", "version 4"),
        ("DELETE FROM commits WHERE sequence = 5", "version 5"),
        ("UPDATE bases SET data = ZERO WHERE part = 1", "base"),
        ("DELETE FROM bases WHERE part = 1", "base"),
    ],
)
def test_damaged_blob_is_reported_and_other_maps_are_read(
    store: AnyStore, kind: Kind, statement: str, words: str
) -> None:
    head, other = grown(store), grown(store, "other")
    kind.alter(f"{statement.replace('ZERO', kind.blob)} AND map = 1")
    with pytest.raises(StoreError, match=f"'yard': its {words} was altered or lost") as raised:
        all_of(store, head.uid)
    assert raised.value.kind == "damaged"
    assert len(all_of(store, other.uid)[2]) == 4
    (found,) = store.verify()
    assert words in found


def test_mark_depends_on_the_whole_history() -> None:
    marks = {
        map_store.mark_of(map_store.link_of(before, sequence, blob), note)
        for before in ("a", "b")
        for sequence in (1, 2)
        for blob in (b"", b"x")
        for note in (NOTE, replace(NOTE, author="zoe"), replace(NOTE, time=1.8e9))
    }
    assert len(marks) == 24


def test_reopened_store_has_all_maps(kind: Kind) -> None:
    with kind.open() as store:
        before = all_of(store, grown(store).uid), store.heads()
    with kind.open() as store:
        assert (all_of(store, store.heads()[0].uid), store.heads()) == before


def test_ids_have_the_owner_that_wrote_or_reserved_them_last(store: AnyStore) -> None:
    head = store.create("yard", b"file", NOTE, 0, Ids(((0, 5),), ((0, 5),)))
    assert store.reserve(head.uid, 3, "zoe", 10) == 5
    store.append(head, b"", NOTE, 0, Ids(((5, 6),), ((5, 6),)))
    ann, reserved = Owner("ann", False), Owner("zoe", True)
    assert store.owners(head.uid, [0, 4, 5, 6, 7, 8]) == [ann, ann, ann, reserved, reserved, None]
    with pytest.raises(TooManyIdsError, match="2 reserved ids"):
        store.reserve(head.uid, 9, "zoe", 10)
    freed = store.free_ids(head.uid, [0, 1])
    assert (freed.next_id, freed.end_id) == (2, IDS)
    assert store.owners(head.uid, [1, 6]) == [ann, None]


def test_annotations_are_written_with_a_commit_or_not_at_all(store: AnyStore) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    pose = Annotation("pose", "dock", "[1]", "ann", 1.75e9)
    store.annotate(head.uid, [pose])
    moved = replace(pose, value="[2]")
    after = store.append(head, b"delta", NOTE, 0, annotations=[moved])
    assert store.annotations() == {head.uid: [moved]}
    with pytest.raises(KeyError):
        store.append(head, b"other", NOTE, 0, annotations=[pose])
    assert store.annotations() == {after.uid: [moved]}
    if isinstance(store, SharedStore):
        assert [each.annotated for each in store.shared_maps()] == [2]


def test_annotations_are_replaced_and_removed(store: AnyStore) -> None:
    head, other = store.create("yard", b"f", NOTE, 0), store.create("other", b"f", NOTE, 0)
    tag, pose = Annotation("tag", "a", "{}", "ann", 1.0), Annotation("pose", "b", "[]", "ann", 2.5)
    store.annotate(head.uid, [tag, pose])
    store.annotate(other.uid, [tag])
    assert store.annotations() == {head.uid: [pose, tag], other.uid: [tag]}
    newer = replace(pose, value="[1]", author="zoe")
    store.annotate(head.uid, [newer], [("tag", "a")])
    assert store.annotations() == {head.uid: [newer], other.uid: [tag]}
    store.delete(other.uid)
    assert store.annotations() == {head.uid: [newer]}
    with pytest.raises(KeyError):
        store.annotate(other.uid, [tag])


def test_store_in_use_has_no_trouble(store: AnyStore) -> None:
    assert store.trouble() is None
    store.release_space()
    assert store.verify() == []


@pytest.mark.integration
def test_maps_move_from_one_kind_of_store_to_the_other_and_back(
    tmp_path: Path, postgres_database: str
) -> None:
    with (
        SqliteMapStore.owned(tmp_path / "one") as first,
        PostgresStore.opened(postgres_database) as second,
        SqliteMapStore.owned(tmp_path / "three") as third,
    ):
        head = grown(first)
        head = first.append(head, b"ids", NOTE, 0, Ids(((20, 30),), ((20, 30),)))
        first.reserve(head.uid, 50, "zoe")
        first.annotate(head.uid, [Annotation("tag", "wet", "true", "ann", 1.75e9)])
        first.create("shed", b"small", NOTE, 0)
        for source, target in ((first, second), (second, third)):
            with source.snapshot() as snapshot:
                target.import_maps(snapshot)
                assert target.heads() == snapshot.heads()
            with source.snapshot() as snapshot, pytest.raises(ValueError, match="maps already"):
                target.import_maps(snapshot)
            assert target.verify() == []
            assert target.annotations() == source.annotations()
            assert all_of(target, head.uid) == all_of(source, head.uid)
            ids = range(0, 100, 3)
            assert target.owners(head.uid, ids) == source.owners(head.uid, ids)
