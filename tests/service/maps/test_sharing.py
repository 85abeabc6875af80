"""Robots that share a map over broken links end with the same map."""

import random
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, Delta, MapCopy, Maps, Retries, ServiceError, encode

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import map_of, random_codes

NONE = np.zeros(0, np.uint32)


class Cut(httpx.BaseTransport):
    """Transport that breaks at times, before the request or before the answer arrives."""

    def __init__(self, link: httpx.BaseTransport, seed: int) -> None:
        self._link = link
        self._random = random.Random(seed)

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        chance = self._random.random()
        if chance < 0.15:
            raise httpx.ConnectError("cut before the request")
        response = self._link.handle_request(request)
        if chance < 0.3:
            response.read()
            raise httpx.ReadError("cut before the answer")
        return response

    def close(self) -> None:
        """Leave the shared transport open."""


def robot_at(service: Any, seed: int) -> Client:
    return Client(
        "http://testserver",
        transport=Cut(service._transport, seed),
        retries=Retries(attempts=50, first_wait=0.0),
        sleep=lambda _: None,
    )


@pytest.mark.slow
def test_concurrent_robots_end_with_the_same_map(service: Any, manifest: Manifest) -> None:
    def drive(number: int) -> MapCopy:
        name, chance = f"robot-{number}", np.random.default_rng(number)
        own: list[int] = []
        with robot_at(service, number) as client:
            copy = MapCopy("site")
            for step in range(6):
                ids = client.reserve_ids("site", 3)
                made = map_of(random_codes(3, step), manifest.model_id, int(ids[0]), name)
                own += ids.tolist()
                removed = NONE
                if len(own) > 6:
                    removed = np.array([own.pop(int(chance.integers(len(own) - 3)))], np.uint32)
                client.edit_map("site", Delta(made, removed))
                client.pull(copy, limit=4)
            return copy

    with robot_at(service, 99) as owner:
        nothing = map_of(random_codes(1), manifest.model_id, 0, "owner")
        owner.edit_map("site", Delta(nothing, NONE), create=True)
        with ThreadPoolExecutor(5) as pool:
            copies = list(pool.map(drive, range(5)))
        expected = service.get("/maps/site").content
        for copy in copies:
            owner.pull(copy, limit=7)
            assert copy.content is not None
            assert encode(copy.content) == expected
        (summary,) = owner.maps()
        assert summary.robots == {"owner": 1} | {f"robot-{n}": 18 - 4 for n in range(5)}
        # No write happened twice after a lost answer.
        assert summary.sequence == 1 + 5 * 6


def test_client_reports_a_deleted_map(service: Any, manifest: Manifest) -> None:
    with robot_at(service, 1) as client:
        first = client.put_map("yard", map_of(random_codes(4), manifest.model_id), create_only=True)
        other = map_of(random_codes(5, 1), manifest.model_id)
        with pytest.raises(ServiceError) as raised:
            client.put_map("yard", other)
        assert raised.value.status == 428
        second = client.put_map("yard", other, if_match=first.etag)
        assert second.sequence == 2
        zoe = map_of(random_codes(1), manifest.model_id, 104, "zoe")
        with pytest.raises(ServiceError) as raised:
            client.edit_map("yard", Delta(zoe, NONE))
        assert raised.value.ids == (104,)
        assert client.edit_map("yard", Delta(zoe, NONE), if_match=second.etag).sequence == 3
        assert client.restore_map("yard", 1).sequence == 4
        assert client.get_map_file("yard") == client.get_map_file("yard", version=1)
        assert [one.operation for one in client.versions("yard")] == [
            *("restore", "edit", "put", "put"),
        ]
        assert client.prune_map("yard", 2e9, dry_run=True).removed == 4
        assert client.compact_map("yard", keep=2) == 3
        assert len(client.versions("yard")) == 2
        client.delete_map("yard")
        assert client.maps() == Maps(())
