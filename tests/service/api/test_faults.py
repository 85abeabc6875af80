"""Disks that fail under the running service: clear errors, the old map, and no lost data."""

import random
import re
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.child_process import Service
from service.engine import StartError
from tests.service.faulty_disk import failing, make_read_only, small_disk
from tests.service.service_builders import assert_problem, map_of, random_codes

pytestmark = pytest.mark.sqlite

ANY = {"If-Match": "*"}
DATABASE = "maps.sqlite"


@pytest.fixture(scope="module")
def files(manifest: Manifest) -> list[bytes]:
    """Return several versions of a map, each of 20 to 30 kB."""
    return [encode(map_of(random_codes(1_000, seed), manifest.model_id)) for seed in range(6)]


@contextmanager
def running(models_dir: Path, data_dir: Path) -> Iterator[tuple[Service, httpx.Client]]:
    """Run the service as a process, and kill it at the end; yield it and a client."""
    service = Service(data_dir, "--models-dir", str(models_dir), "--model", "tiny")
    try:
        with httpx.Client(base_url=service.address(), timeout=60) as client:
            yield service, client
    finally:
        service.kill()


def put(client: Any, file: bytes, name: str = "yard") -> Any:
    return client.put(f"/maps/{name}", content=file, headers=ANY if is_there(client, name) else {})


def is_there(client: Any, name: str) -> bool:
    return bool(client.get(f"/maps/{name}").status_code == 200)


def versions(client: Any, name: str = "yard") -> list[bytes]:
    """Return the files of all versions, oldest first."""
    listed = client.get(f"/maps/{name}/versions").json()["versions"]
    answers = [
        client.get(f"/maps/{name}", params={"version": each["sequence"]})
        for each in reversed(listed)
    ]
    assert [answer.status_code for answer in answers] == [200] * len(listed)
    return [answer.content for answer in answers]


FAULTS = [
    ("fsync,fdatasync", "EIO", 503, "store-unavailable"),
    ("pwrite64", "EIO", 503, "store-unavailable"),
    ("pwrite64", "EROFS", 503, "store-unavailable"),
    ("pwrite64", "ENOSPC", 507, "disk-full"),
]


def test_write_that_fails_on_disk_changes_nothing(
    models_dir: Path, data_dir: Path, tmp_path: Path, files: list[bytes]
) -> None:
    stored = files[:1]
    with running(models_dir, data_dir) as (service, client):
        assert put(client, files[0]).status_code == 201
        for number, (calls, error, status, kind) in enumerate(FAULTS, 1):
            with failing(service.process.pid, calls, error, tmp_path / f"strace-{number}.log"):
                for _ in range(2):
                    assert_problem(put(client, files[-1]), status, kind, "nothing was changed")
                assert_problem(put(client, files[-1], "new"), status, kind)
                assert_problem(client.delete("/maps/yard"), status, kind)
                assert_problem(client.post("/maps/yard/ids?count=3"), status, kind)
                assert client.get("/maps/yard").content == stored[-1]
                assert versions(client) == stored
                assert not is_there(client, "new")
            assert put(client, files[number]).json()["sequence"] == number + 1
            stored.append(files[number])
            assert versions(client) == stored
    with running(models_dir, data_dir) as (_, client):
        assert versions(client) == stored
        assert not is_there(client, "new")


def test_refused_write_is_stored_whole_or_not_at_all(
    models_dir: Path, data_dir: Path, tmp_path: Path, files: list[bytes]
) -> None:
    """A failed fsync leaves unknown what was stored; after a kill all of it may be there."""
    with running(models_dir, data_dir) as (service, client):
        assert put(client, files[0]).status_code == 201
        with failing(service.process.pid, "fsync,fdatasync", "EIO", tmp_path / "strace.log"):
            assert put(client, files[1]).status_code == 503
            service.kill()
    with running(models_dir, data_dir) as (_, client):
        assert versions(client) in (files[:1], files[:2])
        assert put(client, files[2]).status_code == 200


def test_unreadable_disk_answers_503(
    models_dir: Path, data_dir: Path, tmp_path: Path, files: list[bytes]
) -> None:
    with running(models_dir, data_dir) as (service, client):
        for file in files[:2]:
            put(client, file)
        with failing(service.process.pid, "pread64", "EIO", tmp_path / "strace.log"):
            assert_problem(client.get("/maps/yard?version=1"), 503, "store-unavailable")
            assert client.get("/maps/yard").content == files[1]
        assert versions(client) == files[:2]


def test_full_disk_answers_507_and_changes_nothing(
    models_dir: Path, tmp_path: Path, files: list[bytes]
) -> None:
    data_dir = tmp_path / "disk"
    ballast = data_dir / "ballast"
    with small_disk(data_dir, "4m"):
        with running(models_dir, data_dir) as (_, client):
            stored = [files[0]]
            assert put(client, files[0]).status_code == 201
            ballast.write_bytes(bytes(3 << 20))
            for number in range(1, 1_000):
                file = files[number % len(files)]
                response = put(client, file)
                if response.status_code != 200:
                    break
                stored.append(file)
            assert_problem(response, 507, "disk-full", "nothing was changed")
            assert client.get("/maps/yard").content == stored[-1]
            assert_problem(client.get("/readyz"), 503, "not-ready", "The disk is full")
        # Almost full. The refused write is absent after a kill, too.
        with running(models_dir, data_dir) as (_, client):
            assert versions(client) == stored
            ballast.unlink()
            file = files[0] if stored[-1] != files[0] else files[1]
            assert put(client, file).status_code == 200
            assert versions(client) == [*stored, file]


def test_read_only_disk_prevents_the_start(start: Any, tmp_path: Path, files: list[bytes]) -> None:
    data_dir = tmp_path / "disk"
    with small_disk(data_dir, "8m"):
        with start(data_dir=data_dir) as service:
            assert put(service, files[0]).status_code == 201
        make_read_only(data_dir)
        with pytest.raises(StartError, match=r"(?i)read-?only"), start(data_dir=data_dir):
            pass


@pytest.mark.slow
def test_flipped_bits_never_change_a_map_unnoticed(
    start: Any, data_dir: Path, manifest: Manifest
) -> None:
    """A database with a flipped bit does not open, sets the damaged map aside, or is unchanged."""
    draw = random.Random(0)
    small = [encode(map_of(random_codes(20, seed), manifest.model_id)) for seed in range(3)]
    with start() as service:
        for name in ("yard", "hall"):
            for file in small:
                put(service, file, name)
    database = data_dir / DATABASE
    whole = database.read_bytes()
    written = [place for place, byte in enumerate(whole) if byte]
    named = [match.start() for match in re.finditer(b"yard|CREATE TABLE", whole)]
    results = set()
    for place in [*draw.sample(written, 60), *named]:
        # With the highest bit flipped, text is no longer UTF-8.
        altered = whole[place] ^ (draw.choice((1, 16, 128)))
        database.write_bytes(whole[:place] + bytes([altered]) + whole[place + 1 :])
        with ExitStack() as stack:
            try:
                service = stack.enter_context(start())
            except StartError as error:
                results.add("from a backup" in str(error))
                continue
            for name in ("yard", "hall"):
                response = service.get(f"/maps/{name}")
                results.add(response.status_code)
                if response.status_code == 200:
                    assert response.content == small[-1], place
                else:
                    assert_problem(response, 500, "map-damaged")
    assert results == {True, 200, 500}


@pytest.mark.slow
def test_damaged_log_leaves_an_earlier_version_intact(
    start: Any, data_dir: Path, tmp_path: Path, manifest: Manifest
) -> None:
    """Lost commits of a log go unnoticed, but no commit is stored in part."""
    draw = random.Random(0)
    small = [encode(map_of(random_codes(20, seed), manifest.model_id)) for seed in range(6)]
    with start() as service:
        for file in small:
            put(service, file)
        shutil.copytree(data_dir, tmp_path / "copy")
    log = (tmp_path / "copy" / f"{DATABASE}-wal").read_bytes()
    found = set()
    for place in draw.sample(range(len(log)), 30):
        cut = log[:place]
        for altered in (cut, cut + bytes([log[place] ^ 1]) + log[place + 1 :]):
            shutil.rmtree(data_dir)
            shutil.copytree(tmp_path / "copy", data_dir)
            (data_dir / f"{DATABASE}-wal").write_bytes(altered)
            with start() as service:
                there = versions(service) if is_there(service, "yard") else []
                assert there == small[: len(there)]
                found.add(len(there))
                assert put(service, small[0]).status_code in {200, 201}
    assert len(found) > 3
