"""Partial uploads: a map larger than one request is uploaded in parts and written as a whole."""

import asyncio
import hashlib
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import AsyncClient, Client, CompactMap, Retries, ServiceError, decode, encode
from placecell_client.maps.edit import take

from placecell.descriptors.manifest import Manifest
from service.maps.writes.partial_uploads import KEEP_SECONDS, KEY_UPLOADS
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

LIMIT = 4_000
"""Largest body of this service, bytes; the maps have some 40 kB."""

ONCE = Retries(attempts=1)
Forward = Callable[[httpx.Request], httpx.Response]


@pytest.fixture
def service(start: Any) -> Iterator[Any]:
    with start(limits={"map_bytes": LIMIT, "body_bytes": 100_000}) as service:
        yield service


@pytest.fixture
def yard(manifest: Manifest) -> CompactMap:
    return map_of(random_codes(1_000), manifest.model_id)


def forward_to(service: Any) -> Forward:
    def forward(request: httpx.Request) -> httpx.Response:
        url = request.url.raw_path.decode()
        told = service.request(
            request.method, url, content=request.content, headers=request.headers
        )
        return httpx.Response(told.status_code, content=told.content, headers=told.headers)

    return forward


def client_of(forward: Forward, **options: Any) -> Client:
    return Client("http://127.0.0.1", transport=httpx.MockTransport(forward), **options)


def cut_after(forward: Forward, parts: int) -> Forward:
    """Cut the link after a number of parts; the last part arrives, its answer does not."""
    sent = 0

    def cut(request: httpx.Request) -> httpx.Response:
        nonlocal sent
        if request.method == "PUT" and "/uploads/" in request.url.path:
            sent += 1
        answer = forward(request)
        if sent >= parts:
            raise httpx.ReadError("cut")
        return answer

    return cut


def digest_of(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def send_parts(service: Any, name: str, data: bytes, **options: Any) -> str:
    digest = digest_of(data)
    for at in range(0, len(data), LIMIT):
        path = f"/maps/{name}/uploads/{digest}?offset={at}"
        assert service.put(path, content=data[at : at + LIMIT], **options).status_code == 200
    return digest


def test_B9_map_grown_by_edits_is_pulled_and_pushed(service: Any, manifest: Manifest) -> None:
    client = client_of(forward_to(service))
    for at in range(5):
        delta = edit_of(random_codes(200, at), manifest.model_id, first_id=200 * at, robot="ann")
        client.edit_map("grown", delta, create=True)
    pulled = client.pull("grown").content
    assert pulled is not None
    assert_problem(service.put("/maps/x", content=encode(pulled)), 413, "body-too-large")
    stored = client.put_map("copy", pulled)
    assert (stored.name, stored.segments, stored.sequence) == ("copy", 1_000, 1)
    assert client.get_map_file("copy") == encode(pulled) == client.get_map_file("grown")
    again = client.pull("copy").content
    assert again is not None
    assert encode(again) == encode(pulled)
    assert client.uploads("copy") == ()
    # A repeated upload in parts changes nothing.
    assert client.put_map("copy", pulled).sequence == 1
    operations = [version.operation for version in client.versions("copy")]
    assert operations == ["put"]


@pytest.mark.parametrize("asynchronous", [False, True])
@pytest.mark.parametrize("compress", [False, True])
def test_B9_repeated_push_continues(
    service: Any, yard: CompactMap, asynchronous: bool, compress: bool
) -> None:
    asked: list[httpx.Request] = []
    forward = forward_to(service)

    def put(handler: Forward) -> Any:
        def noted(request: httpx.Request) -> httpx.Response:
            asked.append(request)
            return handler(request)

        transport = httpx.MockTransport(noted)
        options: dict[str, Any] = {
            "transport": transport, "compress": compress, "retries": ONCE
        }  # fmt: skip
        if not asynchronous:
            with Client("http://127.0.0.1", **options) as client:
                return client.put_map("yard", yard)

        async def run() -> Any:
            async with AsyncClient("http://127.0.0.1", **options) as client:
                return await client.put_map("yard", yard)

        return asyncio.run(run())

    data = encode(yard)
    with pytest.raises(httpx.ReadError):
        put(cut_after(forward, 3))
    (held,) = service.get("/maps/yard/uploads").json()["uploads"]
    assert (held["digest"], held["bytes"]) == (digest_of(data), 3 * LIMIT)
    # Readers see no map yet.
    assert_problem(service.get("/maps/yard"), 404, "unknown-map")
    assert service.get("/maps").json()["maps"] == []
    asked.clear()
    assert put(forward).sequence == 1
    sent = [request for request in asked if "/uploads/" in request.url.path]
    assert len(sent) == -(-len(data) // LIMIT) - 3 + 1
    assert service.get("/maps/yard").content == data
    assert service.get("/maps/yard/uploads").json()["uploads"] == []


def test_B9_upload_survives_a_restart(start: Any, yard: CompactMap) -> None:
    limits = {"map_bytes": LIMIT}
    with start(limits=limits) as service:
        digest = send_parts(service, "yard", encode(yard))
    with start(limits=limits) as service:
        assert service.post(f"/maps/yard/uploads/{digest}").status_code == 201
        assert service.get("/maps/yard").content == encode(yard)


def test_B9_readers_see_the_old_map_until_the_push_is_complete(
    service: Any, yard: CompactMap
) -> None:
    forward, before = forward_to(service), encode(take(yard, np.arange(20)))
    client = client_of(forward)
    first = client.put_map("yard", before)
    seen = []

    def watched(request: httpx.Request) -> httpx.Response:
        seen.append(service.get("/maps/yard").content)
        return forward(request)

    stored = client_of(watched).put_map("yard", yard, if_match=first.etag)
    assert stored.sequence == 2
    assert len(seen) >= 4 + -(-len(encode(yard)) // LIMIT)
    assert set(seen) == {before}
    assert client.get_map_file("yard") == encode(yard)
    assert [item["name"] for item in service.get("/maps").json()["maps"]] == ["yard"]


def test_B9_completion_needs_the_etag_to_replace(service: Any, yard: CompactMap) -> None:
    client = client_of(forward_to(service))
    stored = client.put_map("yard", yard)
    other = encode(take(yard, np.arange(900)))
    for status, conditions in [
        (428, {}),
        (412, {"if_match": "0123456789abcdef-1"}),
        (412, {"create_only": True, "if_match": "*"}),
    ]:
        with pytest.raises(ServiceError) as caught:
            client.put_map("yard", other, **conditions)  # type: ignore[arg-type]
        assert caught.value.status == status
        assert client.get_map_file("yard") == encode(yard)
    # The parts stay, so the push completes with the right ETag and without sending them again.
    (held,) = client.uploads("yard")
    assert held.bytes == len(other)
    assert client.put_map("yard", other, if_match=stored.etag).sequence == 2
    with pytest.raises(ServiceError) as caught:
        client.put_map("yard", yard, if_match=stored.etag)
    assert caught.value.status == 412
    assert client.put_map("yard", yard, if_match="*").sequence == 3
    new = client.put_map("new", yard, create_only=True)
    assert new.sequence == 1


def test_B9_completion_after_a_lost_answer_succeeds(service: Any, yard: CompactMap) -> None:
    forward = forward_to(service)
    lost: list[int] = []

    def losing(request: httpx.Request) -> httpx.Response:
        answer = forward(request)
        if request.method == "POST" and not lost:
            lost.append(answer.status_code)
            raise httpx.ReadError("lost")
        return answer

    stored = client_of(losing, sleep=lambda _: None).put_map("yard", yard)
    assert (lost, stored.sequence) == ([201], 1)
    assert service.get("/maps/yard").content == encode(yard)
    assert service.get("/maps/yard/uploads").json()["uploads"] == []


def test_B9_damaged_upload_is_removed(service: Any, yard: CompactMap, data_dir: Path) -> None:
    client = client_of(cut_after(forward_to(service), 2), retries=ONCE)
    with pytest.raises(httpx.ReadError):
        client.put_map("yard", yard)
    (file,) = (data_dir / "uploads").iterdir()
    file.write_bytes(bytes(len(file.read_bytes())))
    assert client_of(forward_to(service)).put_map("yard", yard).segments == 1_000
    assert service.get("/maps/yard").content == encode(yard)
    # Lasting damage is reported.
    digest = "0" * 64
    service.put(f"/maps/yard/uploads/{digest}?offset=0", content=b"not this")
    assert_problem(service.post(f"/maps/yard/uploads/{digest}"), 422, "upload-damaged")
    assert_problem(service.post(f"/maps/yard/uploads/{digest}"), 404, "unknown-upload")


def test_B9_parts_come_in_order_and_may_come_twice(service: Any, yard: CompactMap) -> None:
    data = encode(yard)
    path = f"/maps/yard/uploads/{digest_of(data)}"

    def put(at: int, until: int) -> Any:
        return service.put(f"{path}?offset={at}", content=data[at:until])

    assert_problem(put(100, 200), 409, "wrong-offset", "offset=0")
    assert put(0, 3_000).json()["bytes"] == 3_000
    assert put(0, 3_000).json()["bytes"] == 3_000
    assert put(1_000, 2_000).json()["bytes"] == 3_000
    assert put(2_000, 5_000).json()["bytes"] == 5_000
    assert_problem(put(5_001, 6_000), 409, "wrong-offset", "offset=5000")
    assert_problem(put(5_000, 5_000 + LIMIT + 1), 413, "body-too-large")
    assert put(5_000, 5_000).json()["bytes"] == 5_000
    assert_problem(service.post(path), 422, "upload-damaged")


def test_B9_upload_of_invalid_map_is_refused_as_put_is(
    service: Any, other_manifest: Manifest
) -> None:
    digest = send_parts(service, "yard", bytes(LIMIT + 10))
    assert_problem(service.post(f"/maps/yard/uploads/{digest}"), 422, "invalid-map-file")
    assert service.get("/maps/yard/uploads").json()["uploads"] == []
    foreign = map_of(random_codes(300), other_manifest.model_id)
    digest = send_parts(service, "yard", encode(foreign))
    assert_problem(service.post(f"/maps/yard/uploads/{digest}"), 409, "other-model")
    assert_problem(service.get("/maps/yard"), 404, "unknown-map")
    assert service.put("/maps/yard/uploads/xyz?offset=0", content=b"").status_code == 422


def test_B9_uploads_have_quotas(start: Any, yard: CompactMap) -> None:
    limits = {"map_bytes": LIMIT, "upload_bytes": 6_000, "unfinished_bytes": 14_000}
    part = bytes(LIMIT)
    with start(limits=limits) as service:

        def put(digest: str, offset: int, content: bytes = part) -> Any:
            return service.put(f"/maps/yard/uploads/{digest}?offset={offset}", content=content)

        one, two = "1" * 64, "2" * 64
        assert put(one, 0).status_code == 200
        assert_problem(put(one, LIMIT), 413, "upload-too-large", "6000")
        assert_problem(put(two, 0), 507, "quota-exceeded", "7000")
        assert service.delete(f"/maps/yard/uploads/{one}").status_code == 204
        assert_problem(service.delete(f"/maps/yard/uploads/{one}"), 404, "unknown-upload")
        assert put(two, 0).status_code == 200
        for number in range(KEY_UPLOADS - 1):
            assert put(f"{number + 10:064}", 0, b"").status_code == 200
        assert_problem(put("3" * 64, 0, b""), 507, "quota-exceeded", "64 uploads")
        client = client_of(forward_to(service))
        with pytest.raises(ServiceError) as caught:
            client.put_map("yard", yard)
        assert caught.value.status == 507


def test_B9_abandoned_uploads_are_removed_after_a_day(
    service: Any, yard: CompactMap, data_dir: Path
) -> None:
    send_parts(service, "yard", encode(yard))
    uploads = service.app.state.placecell.engine.partial_uploads
    (file,) = (data_dir / "uploads").iterdir()
    uploads.forget_old()
    assert file.exists()
    old = time.time() - KEEP_SECONDS - 10
    os.utime(file, (old, old))
    uploads.forget_old()
    assert not file.exists()


def test_B9_key_scope_covers_uploads(start: Any, tmp_path: Path, yard: CompactMap) -> None:
    file, data = tmp_path / "keys.toml", encode(yard)
    keys = {
        "ann": 'write = true\nmaps = ["yard"]\nrobot = "ann"',
        "bob": 'write = true\nmaps = ["yard"]\nrobot = "bob"',
        "reader": 'maps = ["yard"]',
    }
    file.write_text("".join(
        f'[{name}]\nsha256 = "{digest_of(name.encode())}"\n{rest}\n' for name, rest in keys.items()
    ))  # fmt: skip
    ann, bob, reader = ({"headers": {"Authorization": f"Bearer {name}"}} for name in keys)
    with start(limits={"map_bytes": LIMIT}, keys_file=file) as service:
        digest = send_parts(service, "yard", data, **ann)
        path = f"/maps/yard/uploads/{digest}"
        assert_problem(service.get("/maps/yard/uploads", **reader), 403, "forbidden")
        assert_problem(service.put(f"{path}?offset=0", content=b"", **reader), 403, "forbidden")
        assert_problem(service.post(path, **reader), 403, "forbidden")
        assert_problem(service.delete(path, **reader), 403, "forbidden")
        assert_problem(service.post(path.replace("yard", "hall"), **ann), 403, "forbidden")
        # Another key neither sees nor completes it, and writes only segments of its robot.
        assert service.get("/maps/yard/uploads", **bob).json()["uploads"] == []
        assert_problem(service.post(path, **bob), 404, "unknown-upload")
        send_parts(service, "yard", data, **bob)
        assert_problem(service.post(path, **bob), 403, "forbidden", "bob")
        assert service.post(path, **ann).status_code == 201
        assert service.get("/maps/yard", **reader).content == data
        assert service.get("/maps/yard/versions", **reader).json()["versions"][0]["author"]


def test_B9_client_reports_limit_of_service_without_uploads(yard: CompactMap) -> None:
    def old(request: httpx.Request) -> httpx.Response:
        if request.url.path == "/info":
            told = {"version": "1", "model": {"model_id": "m"}, "limits": {"map_bytes": LIMIT}}
            return httpx.Response(200, json=told | {"map_file": {"version": 1}})
        problem = {"type": "urn:placecell:problem:body-too-large", "title": "Body too large"}
        headers = {"content-type": "application/problem+json"}
        return httpx.Response(413, json=problem, headers=headers)

    with pytest.raises(ServiceError) as caught:
        client_of(old).put_map("yard", yard)
    assert caught.value.status == 413


def test_parts_of_an_upload_have_no_preconditions(service: Any) -> None:
    operations = service.get("/openapi.json").json()["paths"]["/maps/{map}/uploads/{digest}"]
    conditional = {
        method
        for method, operation in operations.items()
        if "if-match" in {each["name"] for each in operation["parameters"]}
    }
    assert conditional == {"post"}


def test_only_new_and_reset_ids_of_the_client(service: Any, manifest: Manifest) -> None:
    client = client_of(forward_to(service))
    client.edit_map("yard", edit_of(random_codes(5), manifest.model_id, 0), create=True)
    edit = edit_of(random_codes(5, seed=1), manifest.model_id, 3)
    with pytest.raises(ServiceError) as caught:
        client.edit_map("yard", edit, only_new=True)
    assert (caught.value.status, caught.value.ids) == (409, (3, 4))
    assert decode(client.get_map_file("yard")).ids.tolist() == [0, 1, 2, 3, 4]
    assert client.reserve_ids("yard", 10).tolist() == [*range(5, 15)]
    free = client.reset_ids("yard")
    assert free.start == 5
    assert free.stop > 1 << 31
