import json
import weakref
from collections.abc import Iterator
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import encode

from placecell.core.types import Int8
from placecell.descriptors.manifest import Manifest
from service.api.body.body import render
from service.api.body.msgpack_codec import Items
from tests.service.service_builders import (
    STEP,
    assert_problem,
    cloud,
    map_of,
    random_codes,
    request_of,
)


def put(service: Any, name: str, codes: Int8, manifest: Manifest, **changes: Any) -> None:
    data = encode(map_of(codes, manifest.model_id, **changes))
    assert service.put(f"/maps/{name}", content=data).status_code == 201


def by_codes(codes: Int8, manifest: Manifest, **more: Any) -> dict[str, Any]:
    return {"model_id": manifest.model_id, "codes": codes.tolist()} | more


def brute_force(maps: dict[str, Int8], query: Int8, k: int) -> list[tuple[float, str, int]]:
    """Distance, map and id of the nearest segments, compared in whole numbers."""
    found = []
    for name, codes in maps.items():
        squared = ((codes.astype(np.int64) - query.astype(np.int64)) ** 2).sum(axis=1)
        found += [(int(value), name, 100 + row) for row, value in enumerate(squared)]
    return [(STEP * value**0.5, name, row) for value, name, row in sorted(found)[:k]]


# Few different codes: many ties, within a map and between maps.
MAPS = {
    "b": random_codes(400, 1),
    "a": random_codes(300, 2) // 64,
    "c": random_codes(5, 3) // 64,
}


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    for name, codes in MAPS.items():
        put(service, name, codes, manifest)
    return service


@pytest.mark.parametrize("names", [None, ["a"], ["c", "b"], ["a", "a"]])
@pytest.mark.parametrize("k", [1, 10, 100])
def test_candidates_equal_those_of_brute_force(
    stocked: Any, manifest: Manifest, names: list[str] | None, k: int
) -> None:
    queries = np.concatenate([random_codes(20, 4), random_codes(20, 5) // 64])
    body = by_codes(queries, manifest, k=k)
    if names is not None:
        body["maps"] = names
    response = stocked.post("/match", json=body).json()
    searched = sorted(set(names or MAPS))
    assert response["searched"] == searched
    assert response["model_id"] == manifest.model_id
    for query, item in zip(queries, response["queries"], strict=True):
        got = [(each["distance"], each["map"], each["id"]) for each in item["candidates"]]
        expected = brute_force({name: MAPS[name] for name in searched}, query, k)
        assert [each[1:] for each in got] == [each[1:] for each in expected]
        assert [each[0] for each in got] == pytest.approx([each[0] for each in expected])


def test_candidate_has_map_frame_and_centroid(service: Any, manifest: Manifest) -> None:
    codes = random_codes(4)
    put(service, "yard", codes, manifest, first_id=40, robot="zoe", frame="hall")
    response = service.post("/match", json=by_codes(codes[2:3], manifest, k=1)).json()
    assert response["queries"] == [
        {
            "candidates": [
                {
                    "map": "yard",
                    "id": 42,
                    "robot": "zoe",
                    "distance": 0.0,
                    "probability": None,
                    "support": None,
                    "centroid": [2.0, -2.0, 1.5],
                    "frame": "hall",
                    "model_id": manifest.model_id,
                }
            ]
        }
    ]


def test_segments_and_their_codes_give_the_same_candidates(
    stocked: Any, manifest: Manifest
) -> None:
    clouds = [cloud(0), cloud(1)[:3], cloud(2)]
    described = stocked.post("/describe", json=request_of(clouds)).json()["descriptors"]
    codes = np.array([described[0]["codes"], described[2]["codes"]], np.int8)
    put(stocked, "own", codes, manifest)
    matched = stocked.post("/match", json=request_of(clouds) | {"k": 3}).json()["queries"]
    centroids = [described[0]["centroid"], described[2]["centroid"]]
    body = by_codes(codes, manifest, k=3, centroids=centroids)
    expected = stocked.post("/match", json=body).json()["queries"]
    assert [matched[0], matched[2]] == expected
    assert matched[1] == described[1]
    # Rounded before the search, as the map's were: the distance to itself is zero.
    assert matched[0]["candidates"][0]["distance"] == 0


def test_match_without_maps_has_no_candidates(service: Any, manifest: Manifest) -> None:
    response = service.post("/match", json=by_codes(random_codes(2), manifest)).json()
    assert response["queries"] == [{"candidates": []}, {"candidates": []}]
    put(service, "empty", random_codes(0), manifest)
    response = service.post("/match", json=by_codes(random_codes(2), manifest)).json()
    assert response["searched"] == ["empty"]
    assert response["queries"] == [{"candidates": []}, {"candidates": []}]


def test_k_defaults_to_ten(stocked: Any, manifest: Manifest) -> None:
    response = stocked.post("/match", json=by_codes(random_codes(1), manifest)).json()
    assert len(response["queries"][0]["candidates"]) == 10


@pytest.mark.parametrize(
    ("changes", "status", "kind", "detail"),
    [
        ({"k": -1}, 422, "invalid-request", "/k"),
        ({"k": 0}, 422, "invalid-request", "/k"),
        ({"k": 101}, 422, "invalid-request", "the limit is 100"),
        ({"k": "5"}, 422, "invalid-request", "/k"),
        ({"k": 1.5}, 422, "invalid-request", "/k"),
        ({"maps": ["a", "nowhere"]}, 404, "unknown-map", "'nowhere'"),
        ({"maps": ["../a"]}, 404, "unknown-map", "../a"),
        ({"maps": []}, 422, "invalid-request", "/maps"),
        ({"maps": "a"}, 422, "invalid-request", "/maps"),
        ({"codes": []}, 422, "invalid-request", "/codes"),
        ({"codes": [[1] * 7, [1] * 6]}, 422, "invalid-request", "/codes/1"),
        ({"codes": [[128] * 7]}, 422, "invalid-request", "/codes/0/0"),
        ({"codes": [["1"] * 7]}, 422, "invalid-request", "/codes/0/0"),
        ({"codes": [[0.5] * 7]}, 422, "invalid-request", "/codes/0/0"),
        ({"codes": [[1] * 7] * 1001}, 413, "too-many-segments", "1001"),
        ({"model_id": "other-1"}, 409, "other-model", "other-1"),
        ({"model_id": None}, 422, "invalid-request", "either"),
        (request_of([cloud(0)]), 422, "invalid-request", "either"),
    ],
)
def test_bad_query_is_refused_with_the_reason(
    stocked: Any,
    manifest: Manifest,
    changes: dict[str, Any],
    status: int,
    kind: str,
    detail: str,
) -> None:
    body = by_codes(random_codes(2), manifest)
    assert_problem(stocked.post("/match", json=body | changes), status, kind, detail)
    assert stocked.post("/match", json=body).status_code == 200


def test_maps_of_another_model_are_never_compared(
    start: Any, manifest: Manifest, other_manifest: Manifest
) -> None:
    codes = random_codes(3)
    with start(model="other") as service:
        put(service, "old", codes, other_manifest)
    with start(model="tiny") as service:
        put(service, "new", codes, manifest)
        response = service.post("/match", json=by_codes(codes, manifest)).json()
        assert response["searched"] == ["new"]
        assert response["skipped"] == [{"map": "old", "model_id": other_manifest.model_id}]
        assert {each["map"] for each in response["queries"][0]["candidates"]} == {"new"}
        named = by_codes(codes, manifest, maps=["new", "old"])
        assert_problem(
            service.post("/match", json=named), 409, "other-model", other_manifest.model_id
        )
        assert {each["name"] for each in service.get("/maps").json()["maps"]} == {"new", "old"}
        assert service.get("/maps/old").status_code == 200
    with start(model="other") as service:
        response = service.post("/match", json=by_codes(codes, other_manifest, k=1)).json()
        assert response["searched"] == ["old"]


def test_many_maps_give_the_nearest_of_all(service: Any, manifest: Manifest) -> None:
    codes = random_codes(60, seed=3)
    for number in range(6):
        part = codes[10 * number : 10 * number + 10]
        put(service, f"map-{number}", part, manifest, first_id=10 * number)
    query = random_codes(4, seed=4)
    found = service.post("/match", json=by_codes(query, manifest, k=7)).json()["queries"]
    apart = ((query[:, None].astype(int) - codes[None].astype(int)) ** 2).sum(axis=2)
    for row, answer in enumerate(found):
        wanted = np.argsort(apart[row], kind="stable")[:7]
        assert [each["id"] for each in answer["candidates"]] == wanted.tolist()


@pytest.mark.parametrize("media_type", ["application/json", "application/msgpack"])
def test_A7_items_of_an_answer_are_made_one_at_a_time(media_type: str) -> None:
    class Item(dict[str, int]):
        """Dictionary that a weak reference can watch."""

    made: list[weakref.ref[Item]] = []

    def items() -> Iterator[Item]:
        for number in range(5):
            assert sum(each() is not None for each in made) <= 1
            item = Item(number=number)
            made.append(weakref.ref(item))
            yield item
            del item

    content = render({"queries": Items(5, items()), "none": []}, media_type)
    read = json.loads if media_type == "application/json" else msgpack.unpackb
    assert read(content) == {"queries": [{"number": number} for number in range(5)], "none": []}
