"""Requests for shared maps, and updates of a local copy."""

from collections.abc import Callable, Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import (
    ChangesPage,
    CompactMap,
    Delta,
    MapCopy,
    MapFileError,
    ServiceError,
    encode,
    encode_delta,
)
from placecell_client.maps.edit import delta_between, difference, take
from placecell_client.replica import RESTARTS

from tests.client.client_fakes import SUMMARY, WRITTEN, Blocking, client_of
from tests.client.map_builders import random_map

NONE = np.zeros(0, np.uint32)
OLD, NEW = random_map(seed=1), random_map(seed=2)


@pytest.fixture(params=[client_of, Blocking], ids=["sync", "async"])
def make(request: pytest.FixtureRequest) -> Callable[..., Any]:
    maker: Callable[..., Any] = request.param
    return maker


def test_conditions_and_queries_are_sent_as_asked(make: Callable[..., Any]) -> None:
    seen: list[tuple[str, str, str | None, str | None]] = []

    def answer(request: httpx.Request) -> httpx.Response:
        headers = request.headers
        tags = headers.get("If-Match"), headers.get("If-None-Match")
        seen.append((request.method, request.url.raw_path.decode(), *tags))
        if request.method == "DELETE":
            return httpx.Response(204)
        return httpx.Response(200, json=SUMMARY if request.method == "PUT" else WRITTEN)

    client = make(answer)
    client.put_map("a.b", OLD, if_match="e-3")
    client.put_map("a", OLD, create_only=True)
    client.put_map("a", OLD, if_match="*")
    client.edit_map("a", Delta(OLD, NONE), robot="ann & zoe", create=True, if_match="e-3")
    client.edit_map("a", Delta(OLD, NONE))
    client.restore_map("a", 7)
    client.prune_map("a", 1e-7, dry_run=True)
    client.prune_map("a", 2, if_match="e-3")
    client.delete_map("a", if_match="e-3")
    assert seen == [
        ("PUT", "/maps/a%2Eb", '"e-3"', None),
        ("PUT", "/maps/a", None, "*"),
        ("PUT", "/maps/a", "*", None),
        ("POST", "/maps/a/segments?robot=ann+%26+zoe&create=true", '"e-3"', None),
        ("POST", "/maps/a/segments", None, None),
        ("POST", "/maps/a/versions/7/restore", None, None),
        ("POST", "/maps/a/age?unseen_since=1e-07&dry_run=true", None, None),
        ("POST", "/maps/a/age?unseen_since=2.0", '"e-3"', None),
        ("DELETE", "/maps/a", '"e-3"', None),
    ]


def test_error_lists_the_refused_ids(make: Callable[..., Any]) -> None:
    problem: dict[str, Any] = {
        "type": "urn:p",
        "title": "Id taken",
        "detail": "2 ids",
        "ids": [3, 9, "x"],
    }
    with pytest.raises(ServiceError) as raised:
        make(lambda _: httpx.Response(409, json=problem)).edit_map("a", Delta(OLD, NONE))
    assert raised.value.ids == (3, 9)
    problem["ids"] = 7
    with pytest.raises(ServiceError) as raised:
        make(lambda _: httpx.Response(409, json=problem)).edit_map("a", Delta(OLD, NONE))
    assert raised.value.ids == ()


def parts_of(delta: Delta, count: int) -> Iterator[Delta]:
    """Split a delta into parts."""
    for part in range(count):
        changed = take(delta.changed, np.arange(part, len(delta.changed), count))
        removed = delta.removed[part::count]
        yield Delta(changed, removed, delta.since, delta.until)


class Sharing:
    """Fake service that knows versions 1 and 2 and sends changes in three pages."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.fails: list[int] = []
        self.knows = {"0", "e-1"}

    def __call__(self, request: httpx.Request) -> httpx.Response:
        self.asked.append(request.url.query.decode().partition("&limit")[0])
        if self.fails:
            status = self.fails.pop(0)
            if status:
                return httpx.Response(status, json={})
        given = dict(request.url.params)
        since, _, part = given.get("cursor", f"{given['since']}.0").rpartition(".")
        if since not in self.knows:
            return httpx.Response(410, json={})
        whole = Delta(NEW, NONE, 0, 2)
        delta = whole if since == "0" else delta_between(OLD, NEW, 1, 2)
        headers = {"Content-Type": "application/vnd.placecell.delta", "ETag": 'W/"e-2"'}
        if part != "2":
            headers["Placecell-Next"] = f"{since}.{int(part) + 1}"
        content = encode_delta(list(parts_of(delta, 3))[int(part)])
        return httpx.Response(200, content=content, headers=headers)


def test_pull_creates_and_updates_a_copy(make: Callable[..., Any]) -> None:
    service = Sharing()
    copy = make(service).pull("yard")
    assert (copy.name, copy.etag, copy.sequence) == ("yard", "e-2", 2)
    assert encode(copy.content) == encode(NEW)
    assert service.asked == ["since=0", "since=0&cursor=0.1", "since=0&cursor=0.2"]
    service.asked.clear()
    copy = make(service).pull(MapCopy("yard", OLD, "e-1"))
    assert encode(copy.content) == encode(NEW)
    assert service.asked[0] == "since=e-1"


def test_pull_continues_with_the_missing_page(make: Callable[..., Any]) -> None:
    service, copy = Sharing(), MapCopy("yard", OLD, "e-1")
    service.fails = [0, 403]
    with pytest.raises(ServiceError):
        make(service).pull(copy)
    # The copy keeps its whole version.
    assert (copy.content, copy.etag) == (OLD, "e-1")
    service.asked.clear()
    assert make(service).pull(copy) is copy
    assert encode(copy.content) == encode(NEW)
    assert service.asked == ["since=e-1&cursor=e-1.1", "since=e-1&cursor=e-1.2"]


def test_pull_restarts_when_the_service_dropped_the_version(make: Callable[..., Any]) -> None:
    service, copy = Sharing(), MapCopy("yard", OLD, "e-1")
    service.fails = [0, 410, 410]
    make(service).pull(copy)
    assert copy.content is not None
    assert encode(copy.content) == encode(NEW)
    assert service.asked == [
        *("since=e-1", "since=e-1&cursor=e-1.1", "since=e-1"),
        *("since=0", "since=0&cursor=0.1", "since=0&cursor=0.2"),
    ]
    service.knows = set()
    with pytest.raises(ServiceError) as raised:
        make(service).pull("yard")
    assert raised.value.status == 410
    # A service that always refuses its own cursors ends the pull, too.
    service.knows = {"0"}
    service.fails = [0, 410] * 20
    with pytest.raises(ServiceError):
        make(service).pull("yard")


def test_copy_is_usable_after_too_many_restarts() -> None:
    """The service drops versions during a pull over a link that breaks."""
    part, *_ = parts_of(Delta(NEW, NONE, 0, 2), 3)
    copy = MapCopy("yard", OLD, "e-1")
    for _ in range(3):
        losses = 0
        while copy.restart():
            losses += 1
            assert not copy.take(ChangesPage(part, "e-2", "cursor"))
        assert losses == RESTARTS


def test_pull_gets_the_whole_map_when_changes_are_unavailable(make: Callable[..., Any]) -> None:
    service, copy = Sharing(), MapCopy("yard", OLD, "e-1")
    service.fails = [410, 0, 410]
    make(service).pull(copy)
    assert service.asked == [
        *("since=e-1", "since=0", "since=0&cursor=0.1"),
        *("since=0", "since=0&cursor=0.1", "since=0&cursor=0.2"),
    ]


def test_copy_refuses_pages_it_did_not_request() -> None:
    changed, removed = difference(OLD, NEW)
    copy = MapCopy("yard", OLD, "e-1")
    with pytest.raises(MapFileError, match="starts at version 7"):
        copy.take(ChangesPage(Delta(changed, removed, 7, 9), "e-9", None))
    assert not copy.take(ChangesPage(Delta(changed, NONE, 1, 2), "e-2", "c"))
    with pytest.raises(MapFileError, match="different deltas"):
        copy.take(ChangesPage(Delta(changed, removed, 1, 3), "e-3", None))
    assert (copy.content, copy.etag) == (OLD, "e-1")
    with pytest.raises(ValueError, match="both"):
        MapCopy("yard", OLD)


@pytest.mark.parametrize("tag", [None, "", '"x"', '"e-"', '"-3"', '"e-3x"'])
def test_foreign_etag_is_refused(make: Callable[..., Any], tag: str | None) -> None:
    headers = {"Content-Type": "application/vnd.placecell.delta"}
    headers |= {"ETag": tag} if tag is not None else {}
    content = encode_delta(Delta(NEW, NONE, 0, 2))
    client = make(lambda _: httpx.Response(200, content=content, headers=headers))
    with pytest.raises(ServiceError, match=r"ETag|etag"):
        client.pull("yard")


def test_copy_of_a_recreated_map_is_replaced() -> None:
    other: CompactMap = random_map(seed=3, dimension=9)
    copy = MapCopy("yard", OLD, "e-1")
    assert copy.take(ChangesPage(Delta(other, NONE, 0, 4), "f-4", None))
    assert copy.content is not None
    assert encode(copy.content) == encode(other)
