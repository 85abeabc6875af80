"""Both encodings give equal results, and match the bytes in the documentation of msgpack."""

from dataclasses import replace
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, ServiceError, encode
from placecell_client.http.encoding import MEDIA_TYPES

from placecell.descriptors.manifest import Manifest
from service.api.body.body import MSGPACK, Body, parse, render
from service.api.query_parsing import read_scan
from service.api.schemas.msgpack import (
    PackedDescribeRequest,
    PackedDescribeResponse,
    PackedDescriptor,
)
from service.api.schemas.recognition import DescribeRequest, Failed, ItemErrorOut
from service.core.settings import Limits
from tests.client.test_msgpack_document import CLOUD, ORIGIN, example
from tests.service.service_builders import cloud, map_of, random_codes

FAR = np.array([5e5, 5.4e6, 300.0])
SENSORS = np.array([9.0, -3.0, 1.7]) + np.linspace(0, 5, 8)[:, None]
CLOUDS = [cloud(seed) for seed in range(7)] + [cloud(7)[:2]]


@pytest.fixture
def clients(service: Any, manifest: Manifest) -> list[Client]:
    """Return a client with msgpack and a client with JSON, for a service with a map."""

    def forward(request: httpx.Request) -> httpx.Response:
        told = service.request(
            request.method, request.url.path, content=request.content, headers=request.headers
        )
        if request.method == "POST" and told.is_success:
            assert told.headers["content-type"] == request.headers["content-type"]
        return httpx.Response(told.status_code, content=told.content, headers=told.headers)

    stored = map_of(random_codes(300), manifest.model_id)
    assert service.put("/maps/yard", content=encode(stored)).status_code == 201
    return [
        Client("http://127.0.0.1", transport=httpx.MockTransport(forward), encoding=encoding)
        for encoding in MEDIA_TYPES
    ]


@pytest.mark.parametrize("shift", [np.zeros(3), FAR])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_both_encodings_give_equal_descriptors_and_matches(
    clients: list[Client], shift: Any, dtype: type
) -> None:
    clouds = [(points + shift).astype(dtype) for points in CLOUDS]
    packed, listed = (client.describe(clouds, SENSORS + shift) for client in clients)
    np.testing.assert_array_equal(packed.codes, listed.codes)
    np.testing.assert_allclose(packed.descriptors, listed.descriptors, rtol=0, atol=1e-6)
    np.testing.assert_allclose(packed.centroids, listed.centroids, rtol=0, atol=1e-6)
    assert packed.errors == listed.errors
    assert set(packed.errors) == {7}
    by_codes = [client.match(packed) for client in clients]
    assert by_codes[0] == by_codes[1]
    by_segments = [client.match(segments=clouds, sensors=SENSORS + shift) for client in clients]
    assert by_segments[0] == by_segments[1]
    assert by_segments[0].queries == by_codes[0].queries


@pytest.mark.parametrize("shift", [np.zeros(3), FAR])
def test_both_encodings_give_the_same_pose(clients: list[Client], shift: Any) -> None:
    clouds = [cloud(seed) for seed in range(30)] + [cloud(30)[:2]]
    described = clients[0].describe(clouds, np.zeros(3))
    good = [row for row in range(31) if row not in described.errors]
    stored = map_of(described.codes[good], described.model_id, first_id=500)
    clients[0].put_map("own", replace(stored, centroids=described.centroids[good].round(2)))
    moved = [points + shift for points in clouds]
    here = [client.describe(moved, shift) for client in clients]
    answers = [
        *(client.localize(each) for client, each in zip(clients, here, strict=True)),
        *(client.localize(segments=moved, sensors=shift, maps=["own"]) for client in clients),
    ]
    for answer in answers:
        assert set(answer.errors) == {30}
        assert answer.best is not None
        assert answer.best.map == "own"
        assert answer.best.pose is not None
        at = answer.best.pose.apply(shift)
        np.testing.assert_allclose(at, np.zeros(3), atol=0.02)
        np.testing.assert_array_equal(answer.best.inliers.ids - 500, answer.best.inliers.queries)
        deviation = np.sqrt(np.diag(answer.best.covariance_at(shift)))
        assert (deviation < 0.2).all()


pytestmark = pytest.mark.filterwarnings("ignore::placecell_client.PrecisionWarning")


def test_map_coordinates_keep_their_accuracy(clients: list[Client]) -> None:
    for client in clients:
        here = client.describe(CLOUDS, SENSORS)
        there = client.describe([points + FAR for points in CLOUDS], SENSORS + FAR)
        np.testing.assert_allclose(there.descriptors, here.descriptors, rtol=0, atol=1e-3)
        np.testing.assert_allclose(there.centroids, here.centroids + FAR, rtol=0, atol=1e-5)


def test_both_encodings_give_the_same_errors(clients: list[Client]) -> None:
    beyond = [CLOUDS[0], np.full((20, 3), 1e9)]
    told = []
    for client in clients:
        with pytest.raises(ServiceError) as raised:
            client.describe(beyond, np.zeros(3))
        told.append((raised.value.status, raised.value.type, raised.value.detail))
    assert told[0] == told[1]
    with pytest.raises(ValueError, match="segment 0: point 0 is too far for float32"):
        clients[0].describe([np.full((20, 3), 1e300)], np.zeros(3))


def test_documented_msgpack_request_is_parsed() -> None:
    body = Body(MSGPACK, example("request"))
    request = parse(DescribeRequest, PackedDescribeRequest, body, Limits())
    scan = read_scan(request.segments, request.origin)
    np.testing.assert_array_equal(scan.points, CLOUD + ORIGIN)
    assert scan.counts.tolist() == [len(CLOUD)]
    np.testing.assert_array_equal(scan.sensors, np.add([[0.0, 0.0, 1.5]], ORIGIN))


def test_documented_msgpack_answer_is_rendered() -> None:
    described = PackedDescriptor(
        codes=np.array([3, -7], np.int8).tobytes(),
        descriptor=np.array([0.0625, -0.125], "<f4").tobytes(),
        centroid=(500004.125, 5400002.0, 300.625),
    )
    failed = ItemErrorOut(
        type="urn:placecell:problem:too-few-points", title="Too few points", detail="2 points."
    )
    response = PackedDescribeResponse(
        model_id="tiny-1",
        dimension=2,
        descriptors=[described, Failed(error=failed)],
        dropped_points=0,
    )
    told = response.model_dump(exclude={"classes"})  # the model has no semantic head
    assert render(told, MSGPACK) == example("answer")
