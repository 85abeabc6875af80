import errno
import hashlib
import logging
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import encode

from segments.manifest import Manifest
from tests.service.service_builders import assert_problem, cloud, map_of, random_codes, request_of

NAMES = ["%2e%2e", ".hidden", "-a", "a%5Cb", "a%00", "a%0A", "a%20b", "%C3%BC", "a" * 65]
PATHS = ["a%2Fb", "..%2F..%2Fetc%2Fpasswd", "a/b", "%2Fetc%2Fpasswd", "a%2F..%2Fb"]


@pytest.fixture
def yard(manifest: Manifest) -> bytes:
    return encode(map_of(random_codes(30), manifest.model_id))


def whole(service: Any, yard: bytes) -> bool:
    """The stored map is what was put, and is searched."""
    return bool(
        service.get("/maps/yard").content == yard
        and [item["name"] for item in service.get("/maps").json()["maps"]] == ["yard"]
        and service.post("/match", json=request_of([cloud(0)])).json()["searched"] == ["yard"]
    )


def test_put_get_list_delete(service: Any, yard: bytes, manifest: Manifest) -> None:
    etag = hashlib.sha256(yard).hexdigest()
    response = service.put("/maps/yard", content=yard)
    assert response.status_code == 201
    assert response.headers["etag"] == f'"{etag}"'
    summary = {
        "name": "yard",
        "segments": 30,
        "bytes": len(yard),
        "model_id": manifest.model_id,
        "robots": ["ann"],
        "time_span": [1.7e9, 1.7e9],
        "etag": etag,
        "frame": "town",
    }
    assert response.json() == summary
    assert service.get("/maps").json() == {"model_id": manifest.model_id, "maps": [summary]}
    response = service.get("/maps/yard")
    assert response.content == yard
    assert response.headers["etag"] == f'"{etag}"'
    assert response.headers["content-type"] == "application/vnd.placecell.map"
    response = service.delete("/maps/yard")
    assert (response.status_code, response.content) == (204, b"")
    assert_problem(service.get("/maps/yard"), 404, "unknown-map", "'yard'")
    assert_problem(service.delete("/maps/yard"), 404, "unknown-map", "'yard'")
    assert service.get("/maps").json()["maps"] == []


@pytest.mark.parametrize(
    ("header", "status"),
    [('"{}"', 304), ('W/"{}"', 304), ('"x", "{}"', 304), ("*", 304), ('"x"', 200), ("{}", 200)],
)
def test_what_the_client_has_is_not_sent_again(
    service: Any, yard: bytes, header: str, status: int
) -> None:
    etag = service.put("/maps/yard", content=yard).json()["etag"]
    headers = {"If-None-Match": header.format(etag)}
    response = service.get("/maps/yard", headers=headers)
    assert response.status_code == status
    assert response.content == (b"" if status == 304 else yard)
    assert response.headers["etag"] == f'"{etag}"'


def test_the_same_file_again_changes_nothing(service: Any, yard: bytes, data_dir: Path) -> None:
    service.put("/maps/yard", content=yard)
    before = (data_dir / "maps" / "yard.safetensors").stat()
    assert service.put("/maps/yard", content=yard).status_code == 200
    after = (data_dir / "maps" / "yard.safetensors").stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


def test_another_file_replaces_it(service: Any, yard: bytes, manifest: Manifest) -> None:
    service.put("/maps/yard", content=yard)
    other = encode(map_of(random_codes(4, 9), manifest.model_id, robot="zoe"))
    assert service.put("/maps/yard", content=other).status_code == 200
    assert whole(service, other)
    body = {"model_id": manifest.model_id, "codes": random_codes(1).tolist(), "k": 100}
    found = service.post("/match", json=body).json()["queries"][0]["candidates"]
    assert {item["robot"] for item in found} == {"zoe"}
    assert len(found) == 4


def test_maps_are_there_after_a_restart(start: Any, yard: bytes, manifest: Manifest) -> None:
    body = {"model_id": manifest.model_id, "codes": random_codes(5, 8).tolist()}
    with start() as service:
        service.put("/maps/yard", content=yard)
        service.put("/maps/gone", content=yard)
        service.delete("/maps/gone")
        before = service.post("/match", json=body).json()
    with start() as service:
        assert whole(service, yard)
        assert service.post("/match", json=body).json() == before


def test_damaged_files_are_refused_and_the_map_stays(service: Any, yard: bytes) -> None:
    service.put("/maps/yard", content=yard)
    damaged = [yard[:length] for length in range(0, len(yard), 97)]
    for bit in range(0, len(yard) * 8, 331):
        flipped = bytearray(yard)
        flipped[bit // 8] ^= 1 << bit % 8
        damaged.append(bytes(flipped))
    for data in [*damaged, yard + b"\0", b"PK\x03\x04", b"{}"]:
        assert_problem(service.put("/maps/yard", content=data), 422, "invalid-map-file")
        assert_problem(service.put("/maps/new", content=data), 422, "invalid-map-file")
    assert whole(service, yard)


def test_maps_that_do_not_fit_the_model_are_refused(
    service: Any, yard: bytes, manifest: Manifest, other_manifest: Manifest
) -> None:
    service.put("/maps/yard", content=yard)
    foreign = encode(map_of(random_codes(3), other_manifest.model_id))
    response = service.put("/maps/yard", content=foreign)
    assert_problem(response, 409, "other-model", other_manifest.model_id)
    narrow = encode(map_of(random_codes(3, dimension=6), manifest.model_id))
    response = service.put("/maps/yard", content=narrow)
    assert_problem(response, 422, "invalid-map-file", "6 bytes")
    assert whole(service, yard)


@pytest.mark.parametrize("method", ["PUT", "GET", "DELETE"])
@pytest.mark.parametrize("name", NAMES + PATHS)
def test_a_path_is_not_a_maps_name(
    service: Any, yard: bytes, data_dir: Path, method: str, name: str
) -> None:
    service.put("/maps/yard", content=yard)
    before = sorted(path for path in data_dir.parent.rglob("*"))
    content = yard if method == "PUT" else None
    response = service.request(method, f"/maps/{name}", content=content)
    if name in PATHS:
        assert_problem(response, 404, "not-found", "holds no slash")
    else:
        assert_problem(response, 422, "invalid-map-name", "letters, digits")
    assert sorted(path for path in data_dir.parent.rglob("*")) == before
    assert whole(service, yard)


def test_a_damaged_file_is_set_aside_at_the_start(
    start: Any, yard: bytes, data_dir: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with start() as service:
        service.put("/maps/yard", content=yard)
        service.put("/maps/shed", content=yard)
    (data_dir / "maps" / "shed.safetensors").write_bytes(yard[:-1])
    (data_dir / "maps" / ".abc.unfinished").write_bytes(yard[:50])
    with caplog.at_level(logging.ERROR), start() as service:
        assert whole(service, yard)
    assert "'shed' is damaged" in caplog.text
    files = sorted(path.name for path in (data_dir / "maps").iterdir())
    assert len(files) == 2
    assert files[0].startswith("shed.safetensors.")
    assert files[0].endswith(".broken")
    assert (data_dir / "maps" / files[0]).read_bytes() == yard[:-1]
    assert files[1] == "yard.safetensors"


def test_a_file_altered_while_the_service_runs_is_not_given_out(
    service: Any, yard: bytes, data_dir: Path
) -> None:
    service.put("/maps/yard", content=yard)
    file = data_dir / "maps" / "yard.safetensors"
    file.write_bytes(yard[:-1])
    assert_problem(service.get("/maps/yard"), 500, "map-damaged")
    assert service.put("/maps/yard", content=yard).status_code == 200
    assert whole(service, yard)
    file.unlink()
    assert_problem(service.get("/maps/yard"), 500, "map-damaged")


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO])
def test_a_failing_disk_leaves_the_map_as_it_was(
    service: Any,
    yard: bytes,
    manifest: Manifest,
    data_dir: Path,
    monkeypatch: pytest.MonkeyPatch,
    code: int,
) -> None:
    service.put("/maps/yard", content=yard)
    files = sorted((data_dir / "maps").iterdir())

    def failing(_: int) -> None:
        raise OSError(code, os.strerror(code))

    other = encode(map_of(random_codes(4, 9), manifest.model_id))
    with monkeypatch.context() as patched:
        patched.setattr("os.fsync", failing)
        response = service.put("/maps/yard", content=other)
    if code == errno.ENOSPC:
        assert_problem(response, 507, "disk-full")
    else:
        assert_problem(response, 500, "internal-error")
    assert sorted((data_dir / "maps").iterdir()) == files
    assert whole(service, yard)


def test_every_write_is_synced_before_the_answer(
    service: Any, yard: bytes, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[tuple[str, bool]] = []
    fsync, final = os.fsync, data_dir / "maps" / "yard.safetensors"

    def recorded(descriptor: int) -> None:
        kind = "folder" if Path(f"/dev/fd/{descriptor}").is_dir() else "file"
        synced.append((kind, final.exists()))
        fsync(descriptor)

    monkeypatch.setattr("os.fsync", recorded)
    service.put("/maps/yard", content=yard)
    # The file before its name is there, the folder after.
    assert synced == [("file", False), ("folder", True)]
    synced.clear()
    service.delete("/maps/yard")
    assert synced == [("folder", False)]


def test_a_map_file_is_limited(start: Any, yard: bytes) -> None:
    with start(limits={"map_bytes": len(yard), "body_bytes": 10}) as service:
        assert service.put("/maps/yard", content=yard).status_code == 201
        response = service.put("/maps/yard", content=yard + b"\0")
        assert_problem(response, 413, "body-too-large", str(len(yard)))
        assert service.get("/maps/yard").content == yard


@pytest.mark.parametrize(
    ("media_type", "status"),
    [
        ("application/octet-stream", 201),
        ("application/vnd.placecell.map", 201),
        ("application/json", 415),
        ("multipart/form-data; boundary=x", 415),
    ],
)
def test_media_types_of_a_map(service: Any, yard: bytes, media_type: str, status: int) -> None:
    response = service.put("/maps/yard", content=yard, headers={"Content-Type": media_type})
    assert response.status_code == status
    if status == 415:
        assert_problem(response, 415, "unsupported-media-type", "octet-stream")


def test_a_map_with_several_robots_and_frames(service: Any, manifest: Manifest) -> None:
    codes = random_codes(4)
    two = replace(
        map_of(codes, manifest.model_id),
        robots=("zoe", "ann"),
        robot=np.array([0, 1, 0, 1], np.uint16),
        frame_index=np.array([0, 0, 1, 1], np.uint32),
        frame_times=np.array([50.0, 20.0]),
        frame_positions=np.zeros((2, 3)),
        frame_orientations=np.array([[0, 0, 0, 1]] * 2, np.float32),
    )
    summary = service.put("/maps/two", content=encode(two)).json()
    assert summary["robots"] == ["ann", "zoe"]
    assert summary["time_span"] == [20, 50]
    body = {"model_id": manifest.model_id, "codes": codes.tolist(), "k": 1}
    queries = service.post("/match", json=body).json()["queries"]
    assert [item["candidates"][0]["robot"] for item in queries] == ["zoe", "ann", "zoe", "ann"]
