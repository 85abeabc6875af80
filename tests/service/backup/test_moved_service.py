"""A service whose maps were restored or migrated answers clients as the first one did."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.backup.counting import CountedSnapshot
from service.backup.databases import reading, shown, writing
from service.backup.folder import FolderTarget
from service.backup.migration import MigrationError, migrate
from service.backup.reading import BackupSnapshot
from service.backup.writing import BackupWriter
from service.maps.history import replay
from service.maps.sqlite.store import FILE, SqliteMapStore
from service.maps.store import MapStore
from tests.fixtures.drifted_maps import DATABASE, MOVED
from tests.service.annotations.test_anchors import DOCK, GEO
from tests.service.backup.builders import (
    NOTE,
    Countdown,
    KilledError,
    content,
    content_of,
    fill,
    steps,
)
from tests.service.service_builders import edit_of, map_of, random_codes

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"


ON_SQLITE: dict[str, Any] = {"database": ""}
"""Settings of a service whose maps are in its data directory, whatever store other tests use."""


def write(service: Any, manifest: Manifest) -> None:
    """Store maps with versions, a merge, tags, anchors and reserved ids."""
    for name, robot in (("yard", "ann"), ("hall", "zoe")):
        content = map_of(random_codes(40, seed=3), manifest.model_id, robot=robot)
        assert service.put(f"/maps/{name}", content=encode(content)).status_code == 201
    edit = edit_of(random_codes(4, seed=5), manifest.model_id, 110, removed=[100])
    assert service.post("/maps/yard/segments", content=edit).is_success
    assert service.post("/maps/yard/versions/1/restore").is_success
    assert service.post("/maps/yard/ids?count=9").is_success
    assert service.post("/maps/yard/segments", content=edit).is_success
    assert service.post("/maps/hall/compact?keep=1").is_success
    for path, body in (
        ("tags", {"tags": ["outdoor"]}),
        ("anchor", GEO),
        ("anchors/dock", DOCK),
    ):
        assert service.put(f"/maps/yard/{path}", json=body).is_success


def seen(service: Any) -> dict[str, object]:
    """Return all that a client sees of the maps: bytes and ETags."""
    paths = ["/maps"]
    for entry in service.get("/maps").json()["maps"]:
        name = f"/maps/{entry['name']}"
        paths += [f"{name}{tail}" for tail in ("", "/versions", "/tags", "/anchor", "/anchors")]
        for version in service.get(f"{name}/versions").json()["versions"]:
            paths += [f"{name}?version={version['sequence']}"]
            paths += [f"{name}/versions/{version['sequence']}/changes"]
            paths += [f"{name}/changes?since={version['sequence']}"]
    found: dict[str, object] = {}
    for path in paths:
        response = service.get(path)
        assert response.status_code < 500, response.text
        found[path] = (response.status_code, response.headers.get("ETag"), response.content)
    return found


def moved_by_backup(source: str, target: str, folder: Path) -> None:
    place = FolderTarget(folder)
    with reading(source) as maps:
        BackupWriter(place).write(maps, "1.0", 1.8e9)
    with writing(target) as store:
        store.import_maps(BackupSnapshot(place))


def moved_by_migration(source: str, target: str, folder: Path) -> None:
    del folder
    counts: list[int] = []
    heads = migrate(source, target, counts.append, counts.append)
    assert heads
    assert sum(counts[1:]) == counts[0]


MOVES = [moved_by_backup, moved_by_migration]


@pytest.mark.slow
@pytest.mark.parametrize("move", MOVES)
def test_moved_service_shows_the_same_bytes_and_etags(
    start: Any, manifest: Manifest, data_dir: Path, tmp_path: Path, move: Callable[..., None]
) -> None:
    with start(**ON_SQLITE) as service:
        write(service, manifest)
        before = seen(service)
        given = service.post("/maps/yard/ids?count=1").json()
    assert len(before) > 20
    move(str(data_dir), str(tmp_path / "other"), tmp_path / "copy")
    with start(data_dir=tmp_path / "other", **ON_SQLITE) as service:
        assert seen(service) == before
        later = service.post("/maps/yard/ids?count=1").json()
    assert later["first"] > given["first"]


@pytest.mark.slow
@pytest.mark.integration
@pytest.mark.parametrize("move", MOVES)
def test_maps_move_to_postgresql_and_back(
    start: Any,
    manifest: Manifest,
    data_dir: Path,
    tmp_path: Path,
    postgres_database: str,
    move: Callable[..., None],
) -> None:
    with start(**ON_SQLITE) as service:
        write(service, manifest)
        before = seen(service)
    move(str(data_dir), postgres_database, tmp_path / "there")
    with start(data_dir=tmp_path / "cache", database=postgres_database) as service:
        assert seen(service) == before
        later = service.post("/maps/yard/ids?count=1").json()
    move(postgres_database, str(tmp_path / "other"), tmp_path / "back")
    with start(data_dir=tmp_path / "other", **ON_SQLITE) as service:
        assert seen(service) == before
        assert service.post("/maps/yard/ids?count=1").json()["first"] > later["first"]
    with pytest.raises(ValueError, match=r"has (other maps|maps already)"):
        move(str(tmp_path / "other"), postgres_database, tmp_path / "again")


@pytest.mark.integration
def test_map_with_odometry_moves_to_postgresql(tmp_path: Path, postgres_database: str) -> None:
    shutil.copy(FIXTURES / DATABASE, tmp_path / FILE)
    counts: list[int] = []
    migrate(str(tmp_path), postgres_database, counts.append, counts.append)
    with reading(str(tmp_path)) as one, reading(postgres_database) as other:
        assert content(one) == content(other)
        (block,) = other.heads()
        assert encode(replay(other.history(block.uid), 2).content()) == encode(MOVED)


@pytest.mark.integration
def test_import_into_postgresql_that_is_killed_leaves_the_old_maps(
    tmp_path: Path, postgres_database: str
) -> None:
    with SqliteMapStore.owned(tmp_path / "one") as store:
        fill(store)
    with writing(postgres_database) as store:
        store.create("mine", b"file", NOTE, 3)
        before = content_of(store)
        with reading(str(tmp_path / "one")) as maps:
            for count in steps():
                countdown = Countdown(count)
                source = CountedSnapshot(maps, lambda _, to=countdown: to.step())  # type: ignore[misc]
                try:
                    store.import_maps(source, replaces=True)
                    break
                except KilledError:
                    assert content_of(store) == before
            assert count > 3
            assert content_of(store) == content(maps)
        assert "@" not in shown("postgresql://ann:hidden@db/maps")


def test_running_service_is_backed_up_at_one_moment(
    start: Any, manifest: Manifest, data_dir: Path, tmp_path: Path
) -> None:
    with start(**ON_SQLITE) as service:
        write(service, manifest)
        before = seen(service)
        with reading(str(data_dir)) as maps:
            assert service.delete("/maps/hall").is_success
            edit = edit_of(random_codes(4, seed=6), manifest.model_id, 120)
            assert service.post("/maps/yard/segments", content=edit).is_success
            BackupWriter(FolderTarget(tmp_path / "copy")).write(maps, "1.0", 1.8e9)
    with writing(str(tmp_path / "other")) as store:
        store.import_maps(BackupSnapshot(FolderTarget(tmp_path / "copy")))
    with start(data_dir=tmp_path / "other", **ON_SQLITE) as service:
        assert seen(service) == before


@pytest.mark.parametrize("name", ["version-1.sqlite", "version-2.sqlite", DATABASE])
def test_databases_of_earlier_versions_are_backed_up_and_migrated(
    tmp_path: Path, name: str
) -> None:
    folder = tmp_path / "old"
    folder.mkdir()
    shutil.copy(FIXTURES / name, folder / FILE)
    before = (folder / FILE).read_bytes()
    moved_by_migration(str(folder), str(tmp_path / "one"), tmp_path)
    assert (folder / FILE).read_bytes() == before
    # A file with any name can be read.
    moved_by_backup(str(FIXTURES / name), str(tmp_path / "other"), tmp_path / "copy")
    with reading(str(tmp_path / "one")) as one, reading(str(tmp_path / "other")) as other:
        assert content(one) == content(other)
    for each in ("one", "other"):
        with SqliteMapStore.owned(tmp_path / each) as store:
            assert store.verify() == []


def test_source_that_is_written_during_a_migration_leaves_the_target_empty(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with SqliteMapStore.owned(tmp_path / "one") as store:
        fill(store)
    from service.backup import migration

    def opened(database: str, owns: bool = False) -> Any:
        if not owns:  # the second look at the source
            with SqliteMapStore.owned(tmp_path / "two") as store:
                store.create("later", b"file", NOTE, 0)
            return reading(str(tmp_path / "two"))
        return reading(database)

    monkeypatch.setattr(migration, "reading", opened)
    with pytest.raises(MigrationError, match="a service wrote to it meanwhile"):
        migrate(str(tmp_path / "one"), str(tmp_path / "other"), print, print)
    with reading(str(tmp_path / "other")) as other:
        assert content(other) == {}


@pytest.mark.parametrize(
    ("alter", "words"),
    [
        ("UPDATE commits SET author = 'eve' WHERE sequence = 3", None),
        ("DELETE FROM owners", "owners of ids"),
        ("DELETE FROM annotations", "tags or anchors"),
        ("DELETE FROM maps WHERE name = 'yard'", "its head"),
    ],
)
def test_copy_that_differs_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, alter: str, words: str | None
) -> None:
    with SqliteMapStore.owned(tmp_path / "one") as store:
        fill(store)
    real = SqliteMapStore.import_maps
    altered: list[str] = []

    def import_maps(self: MapStore, *given: Any, **named: Any) -> Any:
        heads = real(self, *given, **named)  # type: ignore[arg-type]
        if heads and not altered:
            from tests.service.maps.test_store import behind

            with behind(tmp_path / "other") as connection:
                connection.execute(alter)
            altered.append(alter)
        return heads

    monkeypatch.setattr(SqliteMapStore, "import_maps", import_maps)
    with pytest.raises(Exception, match=words or "altered or lost"):
        migrate(str(tmp_path / "one"), str(tmp_path / "other"), print, print)
