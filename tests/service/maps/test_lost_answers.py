"""Lost answers: a repeated write does not undo writes of other clients."""

from collections.abc import Callable
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, CompactMap, Delta, Retries, ServiceError

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import map_of, random_codes

NONE = np.zeros(0, np.uint32)
Ask = Callable[[Client, str | None], object]
"""Write to the map `yard`, under this ETag or under none."""


class Losing(httpx.BaseTransport):
    """Transport that loses the first answer; other clients write before the timeout."""

    def __init__(self, link: httpx.BaseTransport, meanwhile: Callable[[], object]) -> None:
        self._link = link
        self._meanwhile = meanwhile
        self.requests = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        self.requests += 1
        response = self._link.handle_request(request)
        if self.requests > 1:
            return response
        response.read()
        self._meanwhile()
        raise httpx.ReadError("lost")

    def close(self) -> None:
        """Leave the shared transport open."""


class Yard:
    """Map of two versions, to which zoe writes too, over a working link."""

    def __init__(self, service: Any, manifest: Manifest) -> None:
        self._link = service._transport
        self._model_id = manifest.model_id
        self.zoe = client_at(self._link)
        self.zoe.put_map("yard", self.map_of("ann", 100))
        self.etag = self.zoe.edit_map("yard", Delta(self.map_of("ann", 50), NONE)).etag

    def map_of(self, robot: str, first_id: int) -> CompactMap:
        return map_of(random_codes(8, first_id), self._model_id, first_id, robot)

    def write(self) -> None:
        """Write as zoe: ids from 7 on, where ann may have written too."""
        tags = [one.etag for one in self.zoe.maps()]
        delta = Delta(self.map_of("zoe", 7), NONE)
        self.zoe.edit_map("yard", delta, create=True, if_match=tags[0] if tags else None)

    def zoes(self) -> int:
        """Return the number of zoe's segments."""
        return sum(one.robots.get("zoe", 0) for one in self.zoe.maps())

    def lossy(self, meanwhile: Callable[[], object]) -> Losing:
        return Losing(self._link, meanwhile)


def client_at(link: httpx.BaseTransport) -> Client:
    retries = Retries(first_wait=0.0)
    return Client("http://testserver", transport=link, retries=retries, sleep=lambda _: None)


@pytest.fixture
def yard(service: Any, manifest: Manifest) -> Yard:
    return Yard(service, manifest)


@pytest.fixture(params=["restore", "put", "edit", "age", "delete"])
def ask(request: pytest.FixtureRequest, yard: Yard) -> Ask:
    other, one = yard.map_of("ann", 3), Delta(yard.map_of("ann", 7), NONE)
    asks: dict[str, Ask] = {
        "restore": lambda ann, etag: ann.restore_map("yard", 1, etag),
        "put": lambda ann, etag: ann.put_map("yard", other, if_match=etag or "*"),
        "edit": lambda ann, etag: ann.edit_map("yard", one, if_match=etag or "*"),
        "age": lambda ann, etag: ann.prune_map("yard", 2e9, if_match=etag),
        "delete": lambda ann, etag: ann.delete_map("yard", etag),
    }
    return asks[request.param]


def test_client_does_not_retry_write_without_etag(yard: Yard, ask: Ask) -> None:
    link = yard.lossy(yard.write)
    with client_at(link) as ann, pytest.raises(httpx.ReadError):
        ask(ann, None)
    assert link.requests == 1
    assert yard.zoes() == 8


def test_retry_under_etag_fails_after_other_writes(yard: Yard, ask: Ask) -> None:
    link = yard.lossy(yard.write)
    with client_at(link) as ann, pytest.raises(ServiceError) as raised:
        ask(ann, yard.etag)
    assert raised.value.status == 412
    assert link.requests == 2
    assert yard.zoes() == 8


def test_retry_under_etag_is_done_once(yard: Yard, ask: Ask) -> None:
    link = yard.lossy(lambda: None)
    with client_at(link) as ann:
        ask(ann, yard.etag)
    assert link.requests == 2
    assert [one.sequence for one in yard.zoe.maps()] in ([3], [])


def test_compaction_is_done_once(yard: Yard) -> None:
    link = yard.lossy(yard.write)
    with client_at(link) as ann, pytest.raises(httpx.ReadError):
        ann.compact_map("yard", keep=2)
    assert [one.sequence for one in yard.zoe.versions("yard")] == [3, 2, 1]
