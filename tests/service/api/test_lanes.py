"""Lanes: reads, writes and recognition do not wait for each other; clients share fairly."""

import asyncio
import gzip
import struct
import threading
import time
from collections.abc import AsyncIterator, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
import zstandard
from placecell_client import encode

from placecell.core.cancellation import Cancelled, current
from placecell.descriptors.extractor import EigenvalueExtractor
from placecell.descriptors.manifest import Manifest
from service.api.state import State, open_state
from service.app import create_app
from service.core.auth import new_key
from service.core.settings import Settings
from tests.service.service_builders import (
    ask_app,
    assert_problem,
    cloud,
    edit_of,
    map_of,
    random_codes,
    request_of,
)

pytestmark = pytest.mark.slow  # by their sum

SCAN = request_of([cloud(0)])


@pytest.fixture
def keys(tmp_path: Path) -> tuple[Path, dict[str, dict[str, str]]]:
    """Return a file of API keys and the headers of each key."""
    file, headers, lines = tmp_path / "keys.toml", {}, []
    for name in ("ann", "bob", "cid"):
        key, digest = new_key()
        lines.append(f'[{name}]\nsha256 = "{digest}"\nwrite = true\n')
        headers[name] = {"Authorization": f"Bearer {key}"}
    file.write_text("".join(lines))
    return file, headers


@contextmanager
def held(monkeypatch: pytest.MonkeyPatch, place: str) -> Iterator[threading.Semaphore]:
    """Block and count all calls of a function, until they are cancelled or the block ends."""
    begun, released = threading.Semaphore(0), threading.Event()

    def slow(*_: object, **__: object) -> Any:
        begun.release()
        token = current()
        while not released.wait(0.01):
            token.check()
        raise RuntimeError

    monkeypatch.setattr(place, slow)
    try:
        yield begun
    finally:
        released.set()


PREPARE = "placecell.descriptors.extractor.EigenvalueExtractor.prepare"
VERSION = "service.api.routes.maps.version_file"


def put(service: Any, name: str, manifest: Manifest, headers: Any = None) -> Any:
    data = encode(map_of(random_codes(5), manifest.model_id))
    return service.put(f"/maps/{name}", content=data, headers=headers)


def test_A5_reads_have_a_lane_that_does_not_block_writes(
    start: Any, manifest: Manifest, keys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, headers = keys
    limits = {"reads": 4}
    with (
        start(keys_file=file, limits=limits) as service,
        ThreadPoolExecutor(4) as pool,
    ):
        assert put(service, "yard", manifest, headers["ann"]).status_code == 201
        with held(monkeypatch, VERSION) as begun:
            path = "/maps/yard?version=1"
            pending = [pool.submit(service.get, path, headers=headers["ann"]) for _ in range(4)]
            assert begun.acquire(timeout=60)
            while len(service.app.state.placecell.lanes.reads._inside) == 0 or (
                service.app.state.placecell.lanes.reads._inside.total() < 4
            ):
                time.sleep(0.01)
            for refused in (path, "/maps", "/maps/yard/versions", "/maps/yard/changes"):
                answer = service.get(refused, headers=headers["ann"])
                assert_problem(answer, 429, "busy", "Try again")
                assert int(answer.headers["retry-after"]) >= 1
            # Another key can read. Writes have their own threads. Health is never refused.
            assert service.get("/maps", headers=headers["bob"]).status_code == 200
            assert put(service, "hall", manifest, headers["ann"]).status_code == 201
            answer = service.post("/maps/hall/ids?count=5", headers=headers["ann"])
            assert answer.status_code == 200
            for path in ("/livez", "/readyz", "/metrics"):
                assert service.get(path).status_code == 200
        assert [each.result(60).status_code for each in pending] == [500] * 4
        monkeypatch.undo()
        assert service.get("/maps/yard", headers=headers["ann"]).status_code == 200


@pytest.mark.parametrize(
    ("place", "method", "path"),
    [
        (VERSION, "GET", "/maps/yard"),
        ("service.api.routes.maps.summary_of", "GET", "/maps"),
        ("service.api.routes.versions.commits_of", "GET", "/maps/yard/versions"),
        ("service.api.routes.segments._page", "GET", "/maps/yard/changes"),
        ("service.maps.writes.writer.MapWriter.restore", "POST", "/maps/yard/versions/1/restore"),
        ("service.maps.writes.writer.MapWriter.compact", "POST", "/maps/yard/compact"),
        ("service.maps.writes.writer.MapWriter.prune", "POST", "/maps/yard/age?unseen_since=0"),
        ("service.maps.writes.writer.MapWriter.reserve", "POST", "/maps/yard/ids?count=1"),
        ("service.maps.writes.writer.MapWriter.delete", "DELETE", "/maps/yard"),
    ],
)
def test_A5_every_path_answers_504_at_its_deadline(
    service: Any,
    manifest: Manifest,
    monkeypatch: pytest.MonkeyPatch,
    place: str,
    method: str,
    path: str,
) -> None:
    put(service, "yard", manifest)
    with held(monkeypatch, place):
        answer = service.request(method, path, headers={"Placecell-Timeout": "0.1"})
        assert_problem(answer, 504, "deadline-exceeded", "0.1 s")


def test_write_that_waits_for_a_lock_answers_504_at_its_deadline(
    service: Any, manifest: Manifest
) -> None:
    put(service, "yard", manifest)
    maps = service.app.state.placecell.engine.maps
    edit = edit_of(random_codes(1), manifest.model_id)
    with maps.writing("yard"):
        answer = service.post(
            "/maps/yard/segments", content=edit, headers={"Placecell-Timeout": "0.1"}
        )
        assert_problem(answer, 504, "deadline-exceeded", "0.1 s")
    assert service.post("/maps/yard/segments", content=edit).status_code == 200


def test_work_of_late_request_is_cancelled(service: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[type[BaseException]] = []

    def slow(*_: object, **__: object) -> Any:
        token = current()
        try:
            while True:
                time.sleep(0.005)
                token.check()
        except Cancelled:
            seen.append(Cancelled)
            raise

    monkeypatch.setattr(EigenvalueExtractor, "prepare", slow)
    answer = service.post("/describe", json=SCAN, headers={"Placecell-Timeout": "0.1"})
    assert_problem(answer, 504, "deadline-exceeded", "0.1 s")
    assert seen == [Cancelled]


def test_work_of_disconnected_client_is_cancelled(
    models_dir: Path, data_dir: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def main() -> None:
        async with opened(models_dir, data_dir) as (app, state):
            with held(monkeypatch, PREPARE) as begun:
                sent = await ask_app(app, SCAN, leave_after=0.1)
                assert begun.acquire(blocking=False)
                assert sent[0]["status"] == 400
                assert not state.lanes.recognition._inside
                assert not state.lanes.recognition.threads._started

    asyncio.run(main())


@asynccontextmanager
async def opened(
    models_dir: Path, data_dir: Path, **settings: Any
) -> AsyncIterator[tuple[Any, State]]:
    values = {"models_dir": models_dir, "data_dir": data_dir, "model": "tiny"} | settings
    made = Settings.model_validate(values)
    with open_state(made) as state:
        app = create_app(made, state)
        async with app.router.lifespan_context(app), asyncio.timeout(60):
            yield app, state


def client_of(app: Any) -> httpx.AsyncClient:
    return httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://x")


def test_A6_slow_bodies_take_no_place_in_a_lane(
    models_dir: Path, data_dir: Path, keys: Any, manifest: Manifest
) -> None:
    """40 slow connections of one key neither cause a 429 of another key nor delay its writes."""
    file, headers = keys

    async def main() -> None:
        limits = {"bodies": 40, "requests": 2, "uploads": 1, "edits": 1}
        async with (
            opened(models_dir, data_dir, keys_file=file, limits=limits) as (app, state),
            client_of(app) as client,
        ):
            stop = asyncio.Event()

            async def trickle() -> AsyncIterator[bytes]:
                yield b"{"
                await stop.wait()

            trickles = [
                asyncio.create_task(
                    client.request(method, path, content=trickle(), headers=headers["ann"])
                )
                for method, path, count in (
                    ("POST", "/describe", 14),
                    ("PUT", "/maps/a", 13),
                    ("POST", "/maps/a/segments", 13),
                )
                for _ in range(count)
            ]
            receiver = state.lanes.edits._receiver
            while receiver._receiving["key ann"] < 40:
                await asyncio.sleep(0.01)
            data = encode(map_of(random_codes(5), manifest.model_id))
            answer = await client.post("/describe", json=SCAN, headers=headers["bob"])
            assert answer.status_code == 200
            answer = await client.put("/maps/b", content=data, headers=headers["bob"])
            assert answer.status_code == 201
            edit = edit_of(random_codes(1), manifest.model_id, first_id=900)
            answer = await client.post("/maps/b/segments", content=edit, headers=headers["bob"])
            assert answer.status_code == 200
            # The key itself has a limit on its bodies.
            answer = await client.post("/describe", json=SCAN, headers=headers["ann"])
            assert_problem(answer, 429, "busy", "40 bodies")
            stop.set()
            assert {(await each).status_code for each in trickles} <= {400, 409, 422, 429}
            assert not receiver._receiving
            assert not receiver._budget.bytes

    asyncio.run(main())


def test_A6_bytes_of_bodies_are_bounded_for_each_key(
    models_dir: Path, data_dir: Path, keys: Any
) -> None:
    file, headers = keys

    async def main() -> None:
        limits = dict.fromkeys(("body_bytes", "json_bytes", "map_bytes", "scan_bytes"), 2_000)
        limits["held_bytes"] = 4_000
        async with (
            opened(models_dir, data_dir, keys_file=file, limits=limits) as (app, state),
            client_of(app) as client,
        ):
            stop = asyncio.Event()

            async def half() -> AsyncIterator[bytes]:
                yield b" " * 1_500
                await stop.wait()

            held = asyncio.create_task(
                client.post("/describe", content=half(), headers=headers["ann"])
            )
            budget = state.lanes.edits._receiver._budget
            while budget.bytes < 1_500:
                await asyncio.sleep(0.01)
            body = b" " * 1_500
            answer = await client.post("/describe", content=body, headers=headers["ann"])
            assert_problem(answer, 429, "busy", "bytes of bodies")
            answer = await client.post("/describe", content=body, headers=headers["bob"])
            assert_problem(answer, 400, "not-json")
            stop.set()
            await held
            assert budget.bytes == 0

    asyncio.run(main())


def test_A6_full_lane_has_a_place_for_another_key(
    start: Any, keys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One key's slow requests fill the lane and the threads, and another key is answered."""
    file, headers = keys
    original = EigenvalueExtractor.prepare
    begun, released = threading.Semaphore(0), threading.Event()

    def slow(self: EigenvalueExtractor, segments: Any, **options: Any) -> Any:
        if len(segments) == 2:
            begun.release()
            assert released.wait(60)
        return original(self, segments, **options)

    monkeypatch.setattr(EigenvalueExtractor, "prepare", slow)
    large = request_of([cloud(0), cloud(1)])
    with (
        start(keys_file=file, limits={"requests": 4}, workers=2) as service,
        ThreadPoolExecutor(4) as pool,
    ):
        try:
            pending = [
                pool.submit(service.post, "/describe", json=large, headers=headers["ann"])
                for _ in range(4)
            ]
            for _ in range(2):
                assert begun.acquire(timeout=60)
            inside = service.app.state.placecell.lanes.recognition._inside
            while inside.total() < 4:
                time.sleep(0.01)
            for name in ("bob", "cid", "bob"):
                answer = service.post("/describe", json=SCAN, headers=headers[name])
                assert answer.status_code == 200
            answer = service.post("/describe", json=SCAN, headers=headers["ann"])
            assert_problem(answer, 429, "busy")
        finally:
            released.set()
        assert [each.result(60).status_code for each in pending] == [200] * 4


def test_slow_steady_upload_is_accepted(
    models_dir: Path, data_dir: Path, manifest: Manifest
) -> None:
    """The time limit of a body restarts with each byte, while the body makes progress."""
    data = encode(map_of(random_codes(400), manifest.model_id))

    async def steady() -> AsyncIterator[bytes]:
        for at in range(0, len(data), len(data) // 8):
            yield data[at : at + len(data) // 8]
            await asyncio.sleep(0.06)

    async def main() -> None:
        limits = {"upload_seconds": 5.0, "stall_seconds": 0.3, "body_seconds": 0.2}
        async with (
            opened(models_dir, data_dir, limits=limits) as (app, _),
            client_of(app) as client,
        ):
            assert (await client.put("/maps/yard", content=steady())).status_code == 201
            limits_answer = await client.post("/describe", content=steady())
            assert_problem(limits_answer, 408, "slow-body", "0.2 s")

    asyncio.run(main())


@pytest.mark.parametrize(
    ("coding", "member"),
    [
        ("gzip", gzip.compress(b"")),
        ("gzip", gzip.compress(b"") + b"\0" * 5),
        ("zstd", zstandard.compress(b"")),
        ("zstd", struct.pack("<II", 0x184D2A50, 0)),  # a skippable frame
    ],
    # gzip contains the time, so its bytes would give the test another name in each worker.
    ids=["gzip", "gzip-padded", "zstd", "zstd-skipped"],
)
def test_A14_many_empty_members_are_refused(service: Any, coding: str, member: bytes) -> None:
    body = member * (1_000_000 // len(member))
    answer = service.post("/describe", content=body, headers={"Content-Encoding": coding})
    assert_problem(answer, 413, "too-many-members", "4096")


@pytest.mark.parametrize("coding", ["gzip", "zstd"])
def test_A14_several_members_form_one_body(service: Any, coding: str) -> None:
    import json

    compress = gzip.compress if coding == "gzip" else zstandard.compress
    text = json.dumps(SCAN).encode()
    parts = [text[at : at + 100] for at in range(0, len(text), 100)]
    body = b"".join(compress(part) for part in parts)
    answer = service.post("/describe", content=body, headers={"Content-Encoding": coding})
    assert answer.json() == service.post("/describe", json=SCAN).json()


def test_A14_decompression_stops_when_cancelled() -> None:
    from placecell.core.cancellation import CancelToken, cancelled_by
    from service.api.body.compression import decompress

    token = CancelToken()
    token.cancel()
    for coding, compress in (("gzip", gzip.compress), ("zstd", zstandard.compress)):
        with cancelled_by(token), pytest.raises(Cancelled):
            decompress(compress(b"a"), coding, 100)


def test_A14_too_many_map_names_answer_422(service: Any) -> None:
    most = service.get("/info").json()["limits"]["named_maps"]
    codes = {"model_id": service.get("/info").json()["model"]["model_id"], "codes": [[0] * 7]}
    for path, body in (
        ("/match", codes),
        ("/localize", codes | {"centroids": [[0.0, 0.0, 0.0]]}),
        ("/maps/site/merge", {}),
    ):
        names = [f"m{n}" for n in range(most + 1)]
        answer = service.post(path, json=body | {"maps": names})
        assert answer.status_code == 422, answer.text
        assert str(most) in answer.json()["detail"]
        many = service.post(path, json=body | {"maps": ["m"] * 300_000})
        assert many.status_code in {413, 422}
    unknown = service.post("/match", json=codes | {"maps": [f"m{n}" for n in range(most)]})
    assert unknown.status_code == 404


def test_A14_setting_lowers_the_limit_of_map_names(start: Any) -> None:
    with start(limits={"named_maps": 2}) as service:
        model_id = service.get("/info").json()["model"]["model_id"]
        body = {"model_id": model_id, "codes": [[0] * 7], "maps": ["a", "b", "c"]}
        assert_problem(service.post("/match", json=body), 422, "invalid-request", "limit is 2")
