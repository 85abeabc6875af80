"""Databases of version 1 stay readable."""

import hashlib
import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from service.maps.history import replay
from service.maps.sqlite.store import FILE, SqliteMapStore
from service.maps.store import Note
from tests.fixtures import drifted_maps
from tests.fixtures.killed_service import EXPECTED

pytestmark = pytest.mark.sqlite

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
DATABASE = FIXTURES / "version-1.sqlite"
KILLED = FIXTURES / "version-1-killed"
"""Database of a killed service with its log; made by `killed_service.py`."""

IDS = {
    2: [0, 2, 4, 6, 10, 23, 24, 25, 27, 30, 32, 33, 34],
    3: [0, 2, 4, 7, 8, 10, 11, 23, 24, 25, 27, 30, 32, 33, 34],
    4: [0, 1, 2, 3, 4, 7, 8, 10, 11, 24, 25, 27, 30, 32, 33, 34],
}
"""Database of a map whose version 1 was compacted."""

FILES = {
    2: "271e5c7e11fd4f9f4a421255c1c1485f16c7668ca72a7d948f5d5b45d58a3d04",
    3: "d5b6772f455841f6e8dfd0d13e54924cfc7cef7b1b1726d018809c7b8cdaa94c",
    4: "b23c2017e852142d5edc4646e1c8e4e98389b69dc2d33d743b79ce65dbc267a0",
}
"""SHA-256 of the file of each version."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(DATABASE, tmp_path / FILE)
    return tmp_path


def test_stored_database_has_all_versions(folder: Path) -> None:
    with SqliteMapStore.owned(folder) as store:
        assert store.verify() == []
        shed, yard = store.heads()
        assert (shed.name, shed.sequence, shed.next_id) == ("shed", 1, 0)
        assert (yard.name, yard.uid) == ("yard", "11c07ada40e63fb8")
        assert (yard.sequence, yard.oldest, yard.next_id) == (4, 2, 40)
        assert yard.mark.startswith("52ce06127c563fa6")
        with store.read(yard.uid) as history:
            for sequence, file in FILES.items():
                content = replay(history, sequence).content()
                assert content.ids.tolist() == IDS[sequence]
                assert content.optional == ("seen",)
                assert hashlib.sha256(encode(content)).hexdigest() == file
            notes = [commit.note for commit in history.commits()]
        assert [note.operation for note in notes] == ["edit", "edit", "edit"]
        assert notes[-1] == Note(1_700_000_003.5, "zoe", "edit", 4, 2)


def test_stored_database_accepts_writes(folder: Path) -> None:
    with SqliteMapStore.owned(folder) as store:
        _, yard = store.heads()
        assert store.reserve(yard.uid, 1) == 40
        again = store.append(yard, b"delta", Note(0.0, "ann", "edit", 0, 0), 0)
        assert (again.sequence, again.next_id) == (5, 41)
        assert store.verify() == []


def test_data_of_a_killed_service_is_served(start: Any, data_dir: Path) -> None:
    shutil.copytree(KILLED, data_dir)
    expected = json.loads((KILLED / EXPECTED).read_text())
    with start() as service:
        assert [each["name"] for each in service.get("/maps").json()["maps"]] == [*expected]
        for name, versions in expected.items():
            found = []
            for each in reversed(service.get(f"/maps/{name}/versions").json()["versions"]):
                response = service.get(f"/maps/{name}", params={"version": each["sequence"]})
                file = hashlib.sha256(response.content).hexdigest()
                found.append([each["sequence"], each["etag"], file])
            assert found == versions
            assert service.post(f"/maps/{name}/versions/{versions[0][0]}/restore").is_success


def test_database_of_an_optimized_map_has_both_versions(tmp_path: Path) -> None:
    shutil.copy(FIXTURES / drifted_maps.DATABASE, tmp_path / FILE)
    with SqliteMapStore.owned(tmp_path) as store:
        assert store.verify() == []
        (block,) = store.heads()
        with store.read(block.uid) as history:
            for sequence, content in ((1, drifted_maps.DRIFTED), (2, drifted_maps.MOVED)):
                assert encode(replay(history, sequence).content()) == encode(content)
            assert history.commits()[-1].note.operation == "optimize"
