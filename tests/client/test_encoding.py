"""Requests and responses in both encodings."""

import json
from typing import Any

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import Client, Description, ServiceError
from placecell_client.http.encoding import Encoding, segments_of

MEDIA_TYPE = "application/msgpack"
FAR = np.array([5e5, 5.4e6, 300.0])
CLOUD = np.random.default_rng(0).uniform(-30, 30, (50, 3))


def points_of(segment: dict[str, Any]) -> Any:
    return np.frombuffer(segment["points"], "<f4").reshape(-1, 3)


def test_float32_is_sent_unchanged() -> None:
    cloud = CLOUD.astype(np.float32)
    for given in (cloud, np.asfortranarray(cloud), np.repeat(cloud, 2, axis=0)[::2]):
        body, _ = segments_of([given], FAR, "msgpack")
        assert set(body) == {"segments"}
        assert body["segments"][0]["points"] == cloud.tobytes()
        assert body["segments"][0]["sensor"] == FAR.tolist()


@pytest.mark.parametrize("sensors", [FAR, np.stack([FAR + 3, FAR, FAR - 1.25])])
def test_float64_is_sent_relative_to_a_sensor(sensors: Any) -> None:
    clouds = [CLOUD + FAR, (CLOUD[:7] + FAR).tolist(), np.zeros((0, 3), np.float32)]
    body, _ = segments_of(clouds, sensors, "msgpack")
    assert body["origin"] == FAR.tolist()
    for cloud, sensor, segment in zip(
        clouds, np.broadcast_to(sensors, (3, 3)), body["segments"], strict=True
    ):
        arrived = points_of(segment).astype(np.float64) + body["origin"]
        np.testing.assert_allclose(arrived, np.reshape(cloud, (-1, 3)), rtol=0, atol=2e-6)
        np.testing.assert_allclose(np.add(segment["sensor"], body["origin"]), sensor, atol=1e-9)


def test_json_holds_the_same_numbers() -> None:
    body, _ = segments_of([CLOUD + FAR], FAR, "json")
    assert body == {"segments": [{"points": (CLOUD + FAR).tolist(), "sensor": FAR.tolist()}]}


def test_integers_and_lists_are_accepted() -> None:
    body, _ = segments_of([[[1, 2, 3]]], [0, 0, 1], "msgpack")
    assert points_of(body["segments"][0]).tolist() == [[1, 2, 2]]
    assert body["segments"][0]["sensor"] == [0, 0, 0]
    assert body["origin"] == [0, 0, 1]
    nothing, clouds = segments_of([], [0, 0, 1], "msgpack")
    assert (nothing, clouds.dropped) == ({"segments": []}, 0)


@pytest.mark.parametrize("encoding", ["msgpack", "json"])
def test_arrays_are_checked_before_they_are_sent(encoding: Encoding) -> None:
    with Client("http://service", encoding=encoding) as client:
        with pytest.raises(ValueError, match="sensors"):
            client.describe([CLOUD, CLOUD], np.zeros((3, 3)))
        with pytest.raises(ValueError, match="not finite"):
            client.describe([CLOUD], [0.0, np.inf, 0.0])


def test_unknown_encoding_is_refused() -> None:
    with pytest.raises(ValueError, match="Invalid encoding 'cbor': expected one of msgpack, json"):
        Client("http://service", encoding="cbor")  # type: ignore[arg-type]


@pytest.mark.parametrize("is_known", [True, False])
def test_msgpack_request_sends_codes_and_known_centroids_as_bytes(is_known: bool) -> None:
    places = np.array([[1.0, -2.0, 0.5]]) if is_known else np.full((1, 3), np.nan)
    expected = {"k": 10, "model_id": "m", "codes": b"\x03\xff"}
    if is_known:
        expected["centroids"] = places.astype("<f8").tobytes()

    def answer(request: httpx.Request) -> httpx.Response:
        assert request.headers["content-type"] == request.headers["accept"] == MEDIA_TYPE
        assert msgpack.unpackb(request.content) == expected
        content = {"model_id": "m", "queries": [{"candidates": []}], "searched": [], "skipped": []}
        return httpx.Response(
            200, content=msgpack.packb(content), headers={"Content-Type": MEDIA_TYPE}
        )

    description = Description(
        "m", np.array([[3, -1]], np.int8), np.zeros((1, 2), np.float32), places, {}
    )
    with Client("http://service", transport=httpx.MockTransport(answer)) as client:
        assert client.match(description).queries == ((),)


def test_problems_are_json_in_both_encodings() -> None:
    problem = {"type": "urn:p", "title": "Not msgpack", "status": 400, "detail": "Cut short."}
    headers = {"Content-Type": "application/problem+json"}
    transport = httpx.MockTransport(
        lambda _: httpx.Response(400, content=json.dumps(problem), headers=headers)
    )
    with (
        Client("http://service", transport=transport) as client,
        pytest.raises(ServiceError, match="Cut short"),
    ):
        client.describe([CLOUD], FAR)
