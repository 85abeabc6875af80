"""Range requests on map files: parts of the same bytes, and their headers."""

import asyncio
import gc
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.api.admission import streaming
from service.api.admission.byte_range import range_of
from service.api.admission.streaming import Answers
from service.core.problems import Problem
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

SIZES = {"small": 50, "large": 6_000}
"""Segments of a map that is answered from memory, and of one that is answered from disk."""


@pytest.fixture(params=sorted(SIZES))
def stored(service: Any, manifest: Manifest, request: Any) -> tuple[Any, bytes]:
    """The service with a map in two versions, and the newest file of the map."""
    rows = SIZES[request.param]
    first = encode(map_of(random_codes(rows), manifest.model_id))
    assert service.put("/maps/yard", content=first).status_code == 201
    edit = edit_of(random_codes(3, 1), manifest.model_id, first_id=100 + rows)
    assert service.post("/maps/yard/segments", content=edit).status_code == 200
    file = service.get("/maps/yard").content
    assert (len(file) > streaming.SMALL_BYTES) == (request.param == "large")
    return service, file


@pytest.mark.parametrize(
    ("asked", "first", "last"),
    [
        ("bytes=0-0", 0, 0),
        ("bytes=10-99", 10, 99),
        ("bytes=100-", 100, None),
        ("bytes=-7", -7, None),
        ("BYTES = 3 - 4", 3, 4),
        ("bytes=5-999999999999", 5, None),
        ("bytes=-999999999999", 0, None),
    ],
)
def test_single_range_is_that_part_of_the_file(
    stored: tuple[Any, bytes], asked: str, first: int, last: int | None
) -> None:
    service, file = stored
    first %= len(file)
    last = len(file) - 1 if last is None else last
    answer = service.get("/maps/yard", headers={"Range": asked})
    assert answer.status_code == 206
    assert answer.content == file[first : last + 1]
    assert answer.headers["content-range"] == f"bytes {first}-{last}/{len(file)}"
    assert answer.headers["content-length"] == str(last + 1 - first)
    assert answer.headers["etag"] == service.get("/maps/yard").headers["etag"]
    assert answer.headers["accept-ranges"] == "bytes"


@pytest.mark.parametrize(
    "asked",
    ["bytes=0-1,5-6", "bytes=5-4", "bytes=-", "bytes=a-b", "lines=1-2", "bytes 1-2", "", "bytes=1"],
)
def test_other_ranges_give_the_whole_file(stored: tuple[Any, bytes], asked: str) -> None:
    service, file = stored
    answer = service.get("/maps/yard", headers={"Range": asked})
    assert (answer.status_code, answer.content) == (200, file)
    assert "content-range" not in answer.headers
    assert answer.headers["accept-ranges"] == "bytes"


@pytest.mark.parametrize(
    "beyond", ["bytes=-0", "bytes={0}-", "bytes={0}-{0}", "bytes=99999999999-"]
)
def test_range_beyond_the_file_is_refused(stored: tuple[Any, bytes], beyond: str) -> None:
    service, file = stored
    answer = service.get("/maps/yard", headers={"Range": beyond.format(len(file))})
    assert_problem(answer, 416, "range-not-satisfiable", f"{len(file)} bytes")
    assert answer.headers["content-range"] == f"bytes */{len(file)}"
    assert service.get("/maps/yard").content == file


def test_if_range_of_another_version_gives_the_whole_file(stored: tuple[Any, bytes]) -> None:
    service, file = stored
    tag = service.get("/maps/yard").headers["etag"]
    old = service.get("/maps/yard?version=1").headers["etag"]
    for since, status in (
        (tag, 206), (old, 200), (f"W/{tag}", 200), ("Wed, 21 Oct 2026 07:28:00 GMT", 200)
    ):  # fmt: skip
        answer = service.get("/maps/yard", headers={"Range": "bytes=2-5", "If-Range": since})
        assert answer.status_code == status, since
        assert answer.content == (file[2:6] if status == 206 else file)


def test_broken_download_of_an_old_version_continues(stored: tuple[Any, bytes]) -> None:
    service, newest = stored
    whole = service.get("/maps/yard?version=1")
    assert whole.content != newest
    half = len(whole.content) // 2
    rest = service.get(
        "/maps/yard?version=1",
        headers={"Range": f"bytes={half}-", "If-Range": whole.headers["etag"]},
    )
    assert (rest.status_code, whole.content[:half] + rest.content) == (206, whole.content)
    known = service.get(
        "/maps/yard?version=1",
        headers={"Range": "bytes=0-9", "If-None-Match": whole.headers["etag"]},
    )
    assert (known.status_code, known.content) == (304, b"")


def test_head_tells_the_size_and_ignores_ranges(stored: tuple[Any, bytes]) -> None:
    service, file = stored
    answer = service.head("/maps/yard", headers={"Range": "bytes=0-9"})
    assert (answer.status_code, answer.content) == (200, b"")
    assert answer.headers["content-length"] == str(len(file))
    assert answer.headers["accept-ranges"] == "bytes"


def test_single_column_is_read_by_its_offsets(stored: tuple[Any, bytes]) -> None:
    service, _ = stored

    def part(first: int, last: int) -> bytes:
        answer = service.get("/maps/yard", headers={"Range": f"bytes={first}-{last}"})
        assert answer.status_code == 206
        return bytes(answer.content)

    (head,) = struct.unpack("<Q", part(0, 7))
    columns = json.loads(part(8, 7 + head))
    first, last = columns["ids"]["data_offsets"]
    ids = np.frombuffer(part(8 + head + first, 7 + head + last), "<u4")
    rows = columns["codes"]["shape"][0]
    assert ids.tolist() == list(range(100, 100 + rows))


def test_web_pages_of_other_origins_may_read_the_headers(start: Any, manifest: Manifest) -> None:
    origin = "https://map.example"
    with start(cors_origins=[origin]) as service:
        service.put("/maps/yard", content=encode(map_of(random_codes(9), manifest.model_id)))
        answer = service.get("/maps/yard", headers={"Origin": origin, "Range": "bytes=0-9"})
        exposed = answer.headers["access-control-expose-headers"]
        assert {"Accept-Ranges", "Content-Range", "ETag"} <= {*exposed.split(", ")}
        asked = service.options(
            "/maps/yard",
            headers={
                "Origin": origin,
                "Access-Control-Request-Method": "GET",
                "Access-Control-Request-Headers": "range,if-range",
            },
        )
        assert asked.status_code == 200
        assert "range" in asked.headers["access-control-allow-headers"]


@given(asked=st.text("bytes=-0123456789, ", max_size=30), total=st.integers(0, 1000))
def test_any_range_header_gives_a_part_or_nothing(asked: str, total: int) -> None:
    try:
        part = range_of(asked, total)
    except Problem:
        part = None  # beyond the file
    if part is not None:
        assert 0 <= part.first < part.first + part.size <= total


def used(tmp_path: Path, check: Callable[[Answers, Callable[..., Any]], Any]) -> None:
    """Run a check with a sender of answers, and a function that asks it for a shared file."""

    async def main() -> None:
        answers = Answers(tmp_path, 1 << 20, 60.0)
        made: list[str] = []

        async def run(work: Callable[[], bytes]) -> bytes:
            return work()

        async def ask(name: str, asked: str | None = None) -> int:
            def make() -> bytes:
                made.append(name)
                return bytes(400_000)

            sent = 0

            async def send(message: Any) -> None:
                nonlocal sent
                sent += len(message.get("body", b""))

            async def receive() -> Any:
                await asyncio.sleep(60)

            answer = await answers.respond_shared(name, make, run, "ann", "a/b", None, asked)
            await answer({"type": "http", "state": {}}, receive, send)
            return sent

        await check(answers, ask)
        answers.close()
        assert answers.under_way == 0
        check.__dict__["made"] = made

    asyncio.run(main())
    gc.collect()


def test_file_read_in_parts_is_made_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streaming, "LINGER_SECONDS", 0.05)

    async def check(answers: Answers, ask: Callable[..., Any]) -> None:
        for first in range(0, 400_000, 100_000):
            assert await ask("one", f"bytes={first}-{first + 99_999}") == 100_000
            assert answers.under_way == 400_000
        await asyncio.sleep(0.1)
        assert answers.under_way == 0
        assert await ask("one") == 400_000
        assert answers.under_way == 0

    used(tmp_path, check)
    assert check.__dict__["made"] == ["one", "one"]


def test_waiting_files_make_room_for_other_answers(tmp_path: Path) -> None:
    async def check(answers: Answers, ask: Callable[..., Any]) -> None:
        for name in ("one", "two", "three", "four"):
            assert await ask(name, "bytes=0-9") == 10
        assert answers.under_way == 800_000
        with pytest.raises(Problem) as raised:
            await ask("four", "bytes=400000-")
        assert raised.value.status == 416

    used(tmp_path, check)
    assert check.__dict__["made"] == ["one", "two", "three", "four"]
