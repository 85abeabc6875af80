"""Disks that fail under the running service: a clear answer, the old map, and nothing lost."""

import random
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from placecell_client import encode

from bench.server import Service
from segments.manifest import Manifest
from tests.service.faulty_disk import failing, make_read_only, small_disk
from tests.service.service_builders import assert_problem, map_of, random_codes

ANY = {"If-Match": "*"}
DATABASE = "maps.sqlite"


@pytest.fixture(scope="module")
def files(manifest: Manifest) -> list[bytes]:
    """Some versions of a map, of 20 to 30 kB."""
    return [encode(map_of(random_codes(1_000, seed), manifest.model_id)) for seed in range(6)]


@contextmanager
def running(models_dir: Path, data_dir: Path) -> Iterator[tuple[Service, httpx.Client]]:
    """The service as a process, killed at the end, and a client."""
    service = Service(data_dir, "--models-dir", str(models_dir), "--model", "tiny")
    try:
        with httpx.Client(base_url=service.address(), timeout=60) as client:
            yield service, client
    finally:
        service.kill()


def put(client: httpx.Client, file: bytes, name: str = "yard") -> httpx.Response:
    return client.put(f"/maps/{name}", content=file, headers=ANY if is_there(client, name) else {})


def is_there(client: httpx.Client, name: str) -> bool:
    return client.get(f"/maps/{name}").status_code == 200


def versions(client: httpx.Client, name: str = "yard") -> list[bytes]:
    """The files of all versions, oldest first."""
    listed = client.get(f"/maps/{name}/versions").json()["versions"]
    answers = [
        client.get(f"/maps/{name}", params={"version": each["sequence"]})
        for each in reversed(listed)
    ]
    assert [answer.status_code for answer in answers] == [200] * len(listed)
    return [answer.content for answer in answers]


@pytest.mark.parametrize(
    ("calls", "error", "status", "kind"),
    [
        ("fsync,fdatasync", "EIO", 503, "store-unavailable"),
        ("pwrite64", "EIO", 503, "store-unavailable"),
        ("pwrite64", "EROFS", 503, "store-unavailable"),
        ("pwrite64", "ENOSPC", 507, "disk-full"),
    ],
)
def test_a_write_that_the_disk_refuses_changes_nothing(
    models_dir: Path,
    data_dir: Path,
    tmp_path: Path,
    files: list[bytes],
    calls: str,
    error: str,
    status: int,
    kind: str,
) -> None:
    with running(models_dir, data_dir) as (service, client):
        assert put(client, files[0]).status_code == 201
        with failing(service.process.pid, calls, error, tmp_path / "strace.log"):
            for _ in range(3):
                assert_problem(put(client, files[1]), status, kind, "nothing was changed")
                assert client.get("/maps/yard").content == files[0]
            assert_problem(put(client, files[1], "new"), status, kind)
            assert_problem(client.delete("/maps/yard"), status, kind)
            assert_problem(client.post("/maps/yard/ids?count=3"), status, kind)
            assert versions(client) == files[:1]
            assert not is_there(client, "new")
        assert put(client, files[2]).json()["sequence"] == 2
        assert versions(client) == [files[0], files[2]]
    with running(models_dir, data_dir) as (_, client):
        assert versions(client) == [files[0], files[2]]
        assert not is_there(client, "new")


def test_what_was_refused_as_the_disk_failed_is_there_whole_or_not_at_all(
    models_dir: Path, data_dir: Path, tmp_path: Path, files: list[bytes]
) -> None:
    """A sync that fails says not how much came to the disk; a kill may leave all of it there."""
    with running(models_dir, data_dir) as (service, client):
        assert put(client, files[0]).status_code == 201
        with failing(service.process.pid, "fsync,fdatasync", "EIO", tmp_path / "strace.log"):
            assert put(client, files[1]).status_code == 503
            service.kill()
    with running(models_dir, data_dir) as (_, client):
        assert versions(client) in (files[:1], files[:2])
        assert put(client, files[2]).status_code == 200


def test_a_disk_that_cannot_be_read_is_told(
    models_dir: Path, data_dir: Path, tmp_path: Path, files: list[bytes]
) -> None:
    with running(models_dir, data_dir) as (service, client):
        for file in files[:2]:
            put(client, file)
        with failing(service.process.pid, "pread64", "EIO", tmp_path / "strace.log"):
            assert_problem(client.get("/maps/yard?version=1"), 503, "store-unavailable")
            assert client.get("/maps/yard").content == files[1]
        assert versions(client) == files[:2]


def test_a_full_disk(models_dir: Path, tmp_path: Path, files: list[bytes]) -> None:
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
            assert client.get("/readyz").status_code == 200
            ballast.unlink()
            assert put(client, files[-2]).status_code == 200
            stored.append(files[-2])
            assert versions(client) == stored
        with running(models_dir, data_dir) as (_, client):
            assert versions(client) == stored
