import json
import pickle

import httpx
import numpy as np
import pytest
from placecell_client import Client, Description, ItemError, ServiceError, decode, encode

from tests.client import client_fakes
from tests.client.client_fakes import CANDIDATE, SUMMARY, Handler
from tests.client.map_builders import random_map

CLOUD = np.arange(12, dtype=np.float32).reshape(4, 3)
ERROR = {"type": "urn:x", "title": "Too few points", "detail": "4 points"}


def client_of(answer: Handler) -> Client:
    # These tests read the bodies, so they use JSON; test_encoding covers both encodings.
    return client_fakes.client_of(answer, encoding="json")


def test_describe_sends_points_and_returns_arrays() -> None:
    sent = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append((request.method, request.url.path, json.loads(request.content)))
        item = {"codes": [1, -2], "descriptor": [0.5, -1.0], "centroid": [1, 2, 3]}
        body = {"model_id": "m", "dimension": 2, "descriptors": [{"error": ERROR}, item]}
        return httpx.Response(200, json=body)

    with client_of(answer) as client:
        described = client.describe([CLOUD[:1], CLOUD], [1.0, 2.0, 3.0])
    method, path, body = sent[0]
    assert (method, path) == ("POST", "/describe")
    assert body["segments"][1] == {"points": CLOUD.tolist(), "sensor": [1.0, 2.0, 3.0]}
    assert described.model_id == "m"
    assert described.codes.dtype == np.int8
    assert described.codes.tolist() == [[0, 0], [1, -2]]
    assert described.descriptors.dtype == np.float32
    assert np.isnan(described.descriptors[0]).all()
    assert described.descriptors[1].tolist() == [0.5, -1.0]
    assert described.centroids[1].tolist() == [1, 2, 3]
    assert described.errors == {0: ItemError("urn:x", "Too few points", "4 points")}


def test_match_skips_segments_without_descriptor() -> None:
    asked: list[list[list[float]] | None] = []

    def answer(request: httpx.Request) -> httpx.Response:
        body = json.loads(request.content)
        asked.append(body.pop("centroids", None))
        assert body == {"k": 2, "maps": ["a"], "model_id": "m", "codes": [[3, 4]]}
        skipped = [{"map": "b", "model_id": "n"}]
        queries = [{"candidates": [CANDIDATE]}]
        return httpx.Response(
            200,
            json={"model_id": "m", "queries": queries, "searched": ["a"], "skipped": skipped},
        )

    described = Description(
        "m",
        np.array([[0, 0], [3, 4]], np.int8),
        np.zeros((2, 2), np.float32),
        np.zeros((2, 3)),
        {0: ItemError("urn:x", "Too few points", "4 points")},
    )
    with client_of(answer) as client:
        matches = client.match(described, maps=["a"], k=2)
        client.match(described, maps=["a"], k=2, rerank=False)
    assert asked == [[[0.0, 0.0, 0.0]], None]
    assert matches.queries[0] == ()
    assert matches.queries[1][0].id == 9
    assert matches.queries[1][0].probability is None
    assert matches.queries[1][0].support is None  # the answer of an older service
    assert set(matches.errors) == {0}
    assert matches.skipped[0].model_id == "n"


@pytest.mark.parametrize("rerank", [True, False])
def test_match_leaves_out_fields_that_an_older_service_refuses(rerank: bool) -> None:
    asked: list[set[str]] = []

    def answer(request: httpx.Request) -> httpx.Response:
        asked.append(set(json.loads(request.content)))
        for unknown in ("centroids", "rerank"):
            if unknown in asked[-1]:
                detail = f"/{unknown}: Extra inputs are not permitted."
                return httpx.Response(422, json={"title": "Invalid request", "detail": detail})
        return httpx.Response(
            200,
            json={"model_id": "m", "queries": [{"candidates": []}], "searched": [], "skipped": []},
        )

    described = Description(
        "m", np.zeros((1, 32), np.int8), np.zeros((1, 32), np.float32), np.zeros((1, 3)), {}
    )
    with client_of(answer) as client:
        client.match(described, rerank=rerank)
        client.match(segments=[CLOUD], sensors=np.zeros(3), rerank=rerank)
    assert len(asked) == 3  # one of the two calls has such a field
    assert {"centroids", "rerank"}.isdisjoint(asked[-1] | (asked[1] if rerank else asked[0]))


def test_match_tells_other_invalid_fields_at_once() -> None:
    asked = []

    def answer(request: httpx.Request) -> httpx.Response:
        asked.append(request)
        return httpx.Response(422, json={"detail": "/k: Input should be greater than 0."})

    described = Description(
        "m", np.zeros((1, 32), np.int8), np.zeros((1, 32), np.float32), np.zeros((1, 3)), {}
    )
    with client_of(answer) as client, pytest.raises(ServiceError, match="/k"):
        client.match(described)
    assert len(asked) == 1


def test_match_refuses_both_or_no_kinds_of_query() -> None:
    with client_of(lambda _: httpx.Response(500)) as client:
        with pytest.raises(ValueError, match="either"):
            client.match()
        with pytest.raises(ValueError, match="either"):
            client.match(segments=[CLOUD])


@pytest.mark.parametrize("name", ["yard", "../etc", "a/b", "..", "a b", "ü"])
def test_names_stay_one_part_of_the_path(name: str) -> None:
    seen = []

    def answer(request: httpx.Request) -> httpx.Response:
        seen.append(request.url)
        return httpx.Response(204)

    with client_of(answer) as client:
        client.delete_map(name)
    assert seen[0].path == f"/maps/{name}"
    assert seen[0].raw_path.count(b"/") == 2


def test_maps_are_sent_as_files() -> None:
    stored: dict[str, bytes] = {}

    def answer(request: httpx.Request) -> httpx.Response:
        if request.method == "PUT":
            stored[request.url.path] = request.content
            return httpx.Response(201, json=SUMMARY)
        headers = {"Content-Type": "application/vnd.placecell.map"}
        return httpx.Response(200, content=stored[request.url.path], headers=headers)

    given = random_map()
    with client_of(answer) as client:
        summary = client.put_map("yard", given)
        assert summary.time_span == (0, 1)
        assert summary.sources == {}  # the answer of an older service
        assert client.get_map_file("yard") == encode(given)
        assert encode(client.get_map("yard")) == encode(decode(encode(given)))


def test_problem_becomes_a_service_error() -> None:
    problem = {"type": "urn:p", "title": "Unknown map", "status": 404, "detail": "No map 'x'."}
    with (
        client_of(lambda _: httpx.Response(404, json=problem)) as client,
        pytest.raises(ServiceError) as raised,
    ):
        client.get_map("x")
    error = raised.value
    assert (error.status, error.title, error.detail, error.type) == (
        404,
        "Unknown map",
        "No map 'x'.",
        "urn:p",
    )
    assert error.retry_after is None
    assert str(error) == f"404 Unknown map: No map 'x'. (request {error.request_id})"
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_arrays_are_checked_before_they_are_sent() -> None:
    with client_of(lambda _: httpx.Response(500)) as client:
        with pytest.raises(ValueError, match="sensors"):
            client.describe([CLOUD, CLOUD], np.zeros((3, 3)))
        with pytest.raises(ValueError, match="not finite"):
            client.describe([CLOUD], np.full(3, np.nan))
