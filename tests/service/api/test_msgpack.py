"""Requests and answers in msgpack are equal to those in JSON."""

from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import (
    MSGPACK,
    assert_problem,
    cloud,
    map_of,
    packed,
    post_packed,
    random_codes,
    request_of,
)

JSON = "application/json"
CLOUDS = [cloud(seed).astype(np.float32).astype(float) for seed in range(6)]
FAR = [5e5, 5.4e6, 300.0]


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    stored = map_of(random_codes(300), manifest.model_id)
    assert service.put("/maps/yard", content=encode(stored)).status_code == 201
    return service


def content_of(response: Any) -> Any:
    """Return an answer's body with lists in place of blobs."""
    assert response.status_code == 200, response.text
    if response.headers["content-type"] == JSON:
        return response.json()
    assert response.headers["content-type"] == MSGPACK
    content = msgpack.unpackb(response.content)
    for item in content.get("descriptors", ()):
        if "error" not in item:
            item["codes"] = np.frombuffer(item["codes"], np.int8).tolist()
            item["descriptor"] = np.frombuffer(item["descriptor"], "<f4").tolist()
    return content


def answers(service: Any, path: str, body: dict[str, Any]) -> list[Any]:
    """Return the answers to a request for each pair of request and answer encodings."""
    told = []
    for accept in (JSON, MSGPACK):
        told.append(service.post(path, json=body, headers={"Accept": accept}))
        told.append(post_packed(service, path, packed(body), accept))
    return [content_of(response) for response in told]


@pytest.mark.parametrize("origin", [None, FAR])
def test_describe_gives_equal_descriptors_and_errors_in_both_encodings(
    service: Any, origin: Any
) -> None:
    body = request_of([*CLOUDS[:3], CLOUDS[3][:2], CLOUDS[4]]) | {"origin": origin}
    first, *others = answers(service, "/describe", body)
    assert "error" in first["descriptors"][3]
    assert all(other == first for other in others)


@pytest.mark.parametrize("origin", [None, FAR])
def test_match_of_segments_gives_equal_results_in_both_encodings(stocked: Any, origin: Any) -> None:
    body = request_of([*CLOUDS, CLOUDS[0][:2]]) | {"k": 4, "maps": ["yard"], "origin": origin}
    first, *others = answers(stocked, "/match", body)
    assert [len(item.get("candidates", ())) for item in first["queries"]] == [4] * 6 + [0]
    assert all(other == first for other in others)


def test_match_of_codes_gives_equal_results_in_both_encodings(
    stocked: Any, manifest: Manifest
) -> None:
    codes = random_codes(9, seed=5)
    body = {"model_id": manifest.model_id, "codes": codes.tolist(), "maps": None}
    first, *others = answers(stocked, "/match", body)
    assert [len(item["candidates"]) for item in first["queries"]] == [10] * 9
    assert all(other == first for other in others)


@pytest.mark.parametrize("kind", ["json", "msgpack"])
def test_origin_at_map_coordinates_keeps_accuracy(stocked: Any, kind: str) -> None:
    def ask(path: str, body: dict[str, Any]) -> Any:
        if kind == "json":
            return content_of(stocked.post(path, json=body))
        return content_of(post_packed(stocked, path, packed(body)))

    body = request_of(CLOUDS)
    here, there = (ask("/describe", body | more) for more in ({}, {"origin": FAR}))
    for near, far in zip(here["descriptors"], there["descriptors"], strict=True):
        assert far["descriptor"] == pytest.approx(near["descriptor"], abs=1e-3)
        shifted = (np.array(near["centroid"]) + FAR).tolist()
        assert far["centroid"] == pytest.approx(shifted, abs=1e-5)
    here, there = (ask("/match", body | more) for more in ({}, {"origin": FAR}))
    assert [
        [candidate["distance"] for candidate in item["candidates"]] for item in there["queries"]
    ] == [
        pytest.approx([candidate["distance"] for candidate in item["candidates"]], abs=1e-3)
        for item in here["queries"]
    ]


def test_origin_without_segments_answers_422(service: Any, manifest: Manifest) -> None:
    body = {"model_id": manifest.model_id, "codes": [[1] * 7], "origin": [0, 0, 0]}
    assert_problem(service.post("/match", json=body), 422, "invalid-request", "either")
    response = post_packed(service, "/match", packed(body))
    assert_problem(response, 422, "invalid-request", "either")


@pytest.mark.parametrize(
    ("accept", "expected"),
    [
        ("", JSON),
        ("*/*", JSON),
        ("application/*", JSON),
        ("application/msgpack", MSGPACK),
        ("Application/MsgPack; q=0.1", MSGPACK),
        ("application/json, application/msgpack", JSON),
        ("application/msgpack;q=0.9, application/json;q=0.8", MSGPACK),
        ("application/json;q=0, */*", MSGPACK),
        ("application/json;q=0.5, */*;q=0.6", MSGPACK),
        ("application/msgpack;q=0.5, */*;q=0.6", JSON),
        ("application/*;q=0.2, application/json;q=0.1, text/html", MSGPACK),
        ("text/html", None),
        ("application/problem+json", None),
        ("*/*;q=0", None),
        ("application/json;q=nan", None),
        ("application/json;q=nan, application/msgpack;q=0.01", MSGPACK),
    ],
)
def test_accept_header_selects_the_encoding(
    service: Any, accept: str, expected: str | None
) -> None:
    body = request_of(CLOUDS[:1])
    for response in (
        service.post("/describe", json=body, headers={"Accept": accept}),
        post_packed(service, "/describe", packed(body), accept),
    ):
        if expected is None:
            assert_problem(response, 406, "not-acceptable", "application/json or application/msg")
        else:
            assert response.status_code == 200
            assert response.headers["content-type"] == expected


def test_openapi_describes_both_encodings(service: Any) -> None:
    document = service.get("/openapi.json").json()
    for path in ("/describe", "/match"):
        operation = document["paths"][path]["post"]
        for content in (operation["requestBody"]["content"], operation["responses"]["200"]):
            assert {JSON, MSGPACK} <= set(content.get("content", content))
    segment = document["components"]["schemas"]["PackedSegment"]["properties"]
    assert segment["points"]["format"] == "binary"
