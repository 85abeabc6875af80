import logging
import re
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.engine import StartError
from tests.service.service_builders import (
    assert_problem,
    cloud,
    edit_of,
    map_of,
    random_codes,
    request_of,
)

NAMES = ["%2e%2e", ".hidden", "-a", "a%5Cb", "a%00", "a%0A", "a%20b", "%C3%BC", "a" * 65]
PATHS = ["a%2Fb", "..%2F..%2Fetc%2Fpasswd", "a/b", "%2Fetc%2Fpasswd", "a%2F..%2Fb"]


@pytest.fixture
def yard(manifest: Manifest) -> bytes:
    return encode(map_of(random_codes(30), manifest.model_id))


def whole(service: Any, yard: bytes) -> bool:
    """Return whether the stored map is the uploaded one and is searched."""
    return bool(
        service.get("/maps/yard").content == yard
        and [item["name"] for item in service.get("/maps").json()["maps"]] == ["yard"]
        and service.post("/match", json=request_of([cloud(0)])).json()["searched"] == ["yard"]
    )


def test_put_get_list_delete(service: Any, yard: bytes, manifest: Manifest) -> None:
    response = service.put("/maps/yard", content=yard)
    assert response.status_code == 201
    etag = response.json()["etag"]
    assert re.fullmatch("[0-9a-f]{16}-1", etag)
    assert response.headers["etag"] == f'"{etag}"'
    assert response.headers["location"] == "/maps/yard"
    summary = {
        "name": "yard",
        "segments": 30,
        "sequence": 1,
        "etag": etag,
        "bytes": len(yard),
        "model_id": manifest.model_id,
        "frame": "town",
        "robots": {"ann": 30},
        "sources": {},
        "time_span": [1.7e9, 1.7e9],
        "optional": [],
        "classes": {},
        "tags": [],
    }
    assert response.json() == summary
    listed = {"model_id": manifest.model_id, "maps": [summary], "damaged": []}
    assert service.get("/maps").json() == listed
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
def test_known_version_is_not_sent_again(
    service: Any, yard: bytes, header: str, status: int
) -> None:
    etag = service.put("/maps/yard", content=yard).json()["etag"]
    headers = {"If-None-Match": header.format(etag)}
    response = service.get("/maps/yard", headers=headers)
    assert response.status_code == status
    assert response.content == (b"" if status == 304 else yard)
    assert response.headers["etag"] == f'"{etag}"'


def test_put_of_equal_file_changes_nothing(service: Any, yard: bytes) -> None:
    first = service.put("/maps/yard", content=yard)
    # Under any precondition: it may be an upload repeated after a lost answer.
    for headers in ({}, {"If-Match": '"x"'}, {"If-None-Match": "*"}):
        again = service.put("/maps/yard", content=yard, headers=headers)
        assert again.status_code == 200
        assert again.json() == first.json()
    assert len(service.get("/maps/yard/versions").json()["versions"]) == 1


def test_put_of_other_content_needs_the_etag(service: Any, yard: bytes, manifest: Manifest) -> None:
    first = service.put("/maps/yard", content=yard).headers["etag"]
    other = encode(map_of(random_codes(4, 9), manifest.model_id, robot="zoe"))
    refused = service.put("/maps/yard", content=other)
    assert_problem(refused, 428, "precondition-required", "If-Match")
    assert refused.headers["etag"] == first
    for headers in ({"If-Match": '"x"'}, {"If-Match": f"W/{first}"}, {"If-None-Match": "*"}):
        refused = service.put("/maps/yard", content=other, headers=headers)
        assert_problem(refused, 412, "precondition-failed", first.strip('"'))
    assert whole(service, yard)
    replaced = service.put("/maps/yard", content=other, headers={"If-Match": f'"x", {first}'})
    assert replaced.status_code == 200
    assert replaced.json()["sequence"] == 2
    assert whole(service, other)
    body = {"model_id": manifest.model_id, "codes": random_codes(1).tolist(), "k": 100}
    found = service.post("/match", json=body).json()["queries"][0]["candidates"]
    assert {item["robot"] for item in found} == {"zoe"}
    assert len(found) == 4
    # The named version is outdated.
    back = service.put("/maps/yard", content=yard, headers={"If-Match": first})
    assert_problem(back, 412, "precondition-failed")
    anything = service.put("/maps/yard", content=yard, headers={"If-Match": "*"})
    assert anything.json()["sequence"] == 3
    assert whole(service, yard)


def test_if_match_on_missing_map_fails(service: Any, yard: bytes) -> None:
    for header in ('"x"', "*"):
        refused = service.put("/maps/yard", content=yard, headers={"If-Match": header})
        assert_problem(refused, 412, "precondition-failed", "does not exist")
    assert service.get("/maps/yard").status_code == 404
    made = service.put("/maps/yard", content=yard, headers={"If-None-Match": "*"})
    assert made.status_code == 201


def test_delete_under_an_outdated_etag_fails(service: Any, yard: bytes, manifest: Manifest) -> None:
    first = service.put("/maps/yard", content=yard).headers["etag"]
    service.post("/maps/yard/segments", content=edit_of(random_codes(1, 5), manifest.model_id))
    refused = service.delete("/maps/yard", headers={"If-Match": first})
    assert_problem(refused, 412, "precondition-failed")
    now = service.get("/maps/yard").headers["etag"]
    assert service.delete("/maps/yard", headers={"If-Match": now}).status_code == 204
    # A new map of the same name never has an earlier tag.
    assert service.put("/maps/yard", content=yard).headers["etag"] != first


def test_put_replaces_a_map_of_another_model(
    start: Any, yard: bytes, other_manifest: Manifest
) -> None:
    with start(also=["other"]) as service:
        service.put("/maps/yard", content=yard)
        anew = encode(map_of(random_codes(5, 2), other_manifest.model_id))
        put = service.put("/maps/yard", content=anew, headers={"If-Match": "*"})
        assert (put.status_code, put.json()["sequence"]) == (200, 2)
        assert service.get("/maps/yard").content == anew
        assert service.get("/maps/yard?version=1").content == yard
        body = {"model_id": other_manifest.model_id, "codes": random_codes(1).tolist()}
        found = service.post("/match", json=body | {"maps": ["yard"]}).json()
        assert len(found["queries"][0]["candidates"]) == 5
    with start(also=["other"]) as service:
        assert service.get("/maps/yard").content == anew
        assert service.post("/maps/yard/versions/1/restore").status_code == 200
        assert service.get("/maps/yard").content == yard


def test_maps_survive_a_restart(start: Any, yard: bytes, manifest: Manifest) -> None:
    body = {"model_id": manifest.model_id, "codes": random_codes(5, 8).tolist()}
    with start() as service:
        service.put("/maps/yard", content=yard)
        service.put("/maps/gone", content=yard)
        service.delete("/maps/gone")
        before = service.post("/match", json=body).json()
    with start() as service:
        assert whole(service, yard)
        assert service.post("/match", json=body).json() == before


def test_put_of_damaged_file_leaves_the_map(service: Any, yard: bytes) -> None:
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


def test_put_of_map_that_does_not_fit_the_model_fails(
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
def test_invalid_map_name_is_refused(
    service: Any, yard: bytes, data_dir: Path, method: str, name: str
) -> None:
    service.put("/maps/yard", content=yard)
    before = sorted(path for path in data_dir.parent.rglob("*"))
    content = yard if method == "PUT" else None
    response = service.request(method, f"/maps/{name}", content=content)
    if name in PATHS:
        assert_problem(response, 404, "not-found", "contains no slash")
    else:
        assert_problem(response, 422, "invalid-map-name", "letters, digits")
    assert sorted(path for path in data_dir.parent.rglob("*")) == before
    assert whole(service, yard)


def alter(data_dir: Path, statement: str) -> None:
    """Execute a statement on the database without the service."""
    with closing(sqlite3.connect(data_dir / "maps.sqlite")) as connection:
        connection.execute(statement)
        connection.commit()


@pytest.mark.sqlite
def test_damaged_map_is_reported_and_others_are_served(
    start: Any, yard: bytes, data_dir: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with start() as service:
        service.put("/maps/shed", content=yard)
        service.put("/maps/yard", content=yard)
    alter(data_dir, "UPDATE bases SET data = zeroblob(100) WHERE map = 1")
    with caplog.at_level(logging.ERROR), start() as service:
        assert "'shed' is damaged" in caplog.text
        assert whole(service, yard)
        assert service.get("/maps").json()["damaged"] == ["shed"]
        for response in (
            service.get("/maps/shed"),
            service.put("/maps/shed", content=yard),
            service.get("/maps/shed/changes"),
            service.get("/maps/shed/versions"),
            service.post("/match", json=request_of([cloud(0)]) | {"maps": ["shed"]}),
        ):
            assert_problem(response, 500, "map-damaged")
        assert service.get("/readyz").status_code == 200
        assert service.delete("/maps/shed").status_code == 204
        assert service.get("/maps").json()["damaged"] == []
        assert service.put("/maps/shed", content=yard).status_code == 201
        assert service.get("/maps/shed").content == yard


@pytest.mark.sqlite
def test_version_altered_on_disk_is_not_served(service: Any, yard: bytes, data_dir: Path) -> None:
    service.put("/maps/yard", content=yard)
    alter(data_dir, "UPDATE bases SET data = zeroblob(100)")
    assert_problem(service.get("/maps/yard"), 500, "map-damaged")


@pytest.mark.sqlite
@pytest.mark.parametrize("what", ["cut", "empty", "rubbish", "gone"])
def test_unreadable_database_stops_the_start(
    start: Any, yard: bytes, data_dir: Path, what: str
) -> None:
    with start() as service:
        service.put("/maps/yard", content=yard)
    file = data_dir / "maps.sqlite"
    data = file.read_bytes()
    if what == "gone":
        file.rename(data_dir / "maps.sqlite-wal")
    else:
        file.write_bytes({"cut": data[:-1], "empty": b"", "rubbish": b"rubbish" * 999}[what])
    with pytest.raises(StartError, match="from a backup"), start():
        pass


@pytest.mark.sqlite
@pytest.mark.parametrize(
    ("setting", "status", "kind"),
    [("max_page_count = 1", 507, "disk-full"), ("query_only = ON", 503, "store-unavailable")],
)
def test_failing_disk_leaves_the_map_unchanged(
    service: Any, yard: bytes, manifest: Manifest, setting: str, status: int, kind: str
) -> None:
    service.put("/maps/yard", content=yard)
    before = service.get("/maps").json()
    connection = service.app.state.placecell.engine.maps.store._database._connection
    connection.execute(f"PRAGMA {setting}")
    edit = edit_of(random_codes(300, 9), manifest.model_id, 200)
    other = encode(map_of(random_codes(300, 9), manifest.model_id))
    for response in (
        service.put("/maps/yard", content=other, headers={"If-Match": "*"}),
        service.put("/maps/new", content=other),
        service.post("/maps/yard/segments", content=edit),
    ):
        assert_problem(response, status, kind, "nothing was changed")
    assert service.get("/maps").json() == before
    assert whole(service, yard)
    connection.execute("PRAGMA max_page_count = 1000000")
    connection.execute("PRAGMA query_only = OFF")
    assert service.post("/maps/yard/segments", content=edit).json()["sequence"] == 2


@pytest.mark.slow
def test_robot_quota_covers_all_maps(start: Any, yard: bytes, manifest: Manifest) -> None:
    with start(limits={"robot_segments": 50, "map_segments": 60}) as service:
        assert service.put("/maps/a", content=yard).status_code == 201
        before = service.get("/maps").json()
        refused = service.put("/maps/b", content=yard)
        assert_problem(refused, 507, "quota-exceeded", "'ann' would have 60 segments in all maps")
        edit = edit_of(random_codes(21), manifest.model_id, 1000)
        refused = service.post("/maps/a/segments", content=edit)
        assert_problem(refused, 507, "quota-exceeded", "51 segments")
        edit = edit_of(random_codes(31), manifest.model_id, 1000, "zoe")
        refused = service.post("/maps/a/segments", content=edit)
        assert_problem(refused, 507, "quota-exceeded", "The map would have 61")
        assert service.get("/maps").json() == before
        edit = edit_of(random_codes(20), manifest.model_id, 1000)
        assert service.post("/maps/a/segments", content=edit).status_code == 200
    # A map stored under other limits stays; it may shrink, but not grow.
    with start(limits={"robot_segments": 10, "map_segments": 10}) as service:
        assert service.get("/maps/a").status_code == 200
        less = edit_of(random_codes(0), manifest.model_id, removed=[100])
        assert service.post("/maps/a/segments?robot=ann", content=less).json()["segments"] == 49
        more = edit_of(random_codes(1), manifest.model_id)
        assert_problem(service.post("/maps/a/segments", content=more), 507, "quota-exceeded")


def test_too_large_map_file_is_refused(start: Any, yard: bytes) -> None:
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
def test_put_accepts_media_types_of_map_files(
    service: Any, yard: bytes, media_type: str, status: int
) -> None:
    response = service.put("/maps/yard", content=yard, headers={"Content-Type": media_type})
    assert response.status_code == status
    if status == 415:
        assert_problem(response, 415, "unsupported-media-type", "octet-stream")


def test_map_with_several_robots_and_frames_is_stored(service: Any, manifest: Manifest) -> None:
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
    assert summary["robots"] == {"ann": 2, "zoe": 2}
    assert summary["time_span"] == [20, 50]
    body = {"model_id": manifest.model_id, "codes": codes.tolist(), "k": 1}
    queries = service.post("/match", json=body).json()["queries"]
    assert [item["candidates"][0]["robot"] for item in queries] == ["zoe", "ann", "zoe", "ann"]
