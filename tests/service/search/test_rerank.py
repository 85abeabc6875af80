"""`/match` orders the candidates of a scan's segments by the neighbors that support them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from placecell_client import encode

from placecell.core.types import Float64, Int8
from placecell.descriptors.manifest import Manifest
from service.search.matching import merged
from tests.service.service_builders import (
    assert_problem,
    cloud,
    map_of,
    packed,
    post_packed,
    random_codes,
    request_of,
)

SCENE = np.array([[0.0, 0.0, 0.0], [6.0, 0.0, 1.0], [0.0, 9.0, -1.0], [-4.0, -5.0, 0.5]])
CODES = random_codes(4, seed=1) // 2
AWAY = np.array([30.0, -20.0, 4.0])
RIGHT, ALIKE = [204, 205, 206, 207], [200, 201, 202, 203]


def put(service: Any, name: str, codes: Int8, places: Float64, manifest: Manifest) -> None:
    content = replace(map_of(codes, manifest.model_id, first_id=200), centroids=places)
    assert service.put(f"/maps/{name}", content=encode(content)).status_code == 201


def put_scene(service: Any, manifest: Manifest, name: str = "yard") -> None:
    """Store the scene, turned by a quarter, behind look-alikes that are nearer to the queries."""
    turned = SCENE @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]) + AWAY
    alike = np.array([[100.0, 0, 0], [100, 50, 0], [150, 0, 0], [150, 60, 0]])
    codes = np.concatenate([CODES + 10, CODES - 12]).astype(np.int8)
    put(service, name, codes, np.concatenate([alike, turned]), manifest)


def query(manifest: Manifest, **more: Any) -> dict[str, Any]:
    codes = {"model_id": manifest.model_id, "codes": CODES.tolist()}
    return codes | {"centroids": SCENE.tolist()} | more


def firsts(answer: Any, key: str = "id") -> list[Any]:
    assert answer.status_code == 200, answer.text
    return [each["candidates"][0][key] for each in answer.json()["queries"]]


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    put_scene(service, manifest)
    return service


@pytest.mark.parametrize("k", [1, 2, 10])
def test_first_candidate_is_the_one_with_support(stocked: Any, manifest: Manifest, k: int) -> None:
    answer = stocked.post("/match", json=query(manifest, k=k))
    assert firsts(answer) == RIGHT
    assert firsts(answer, "support") == [3, 3, 3, 3]
    found = answer.json()["queries"]
    assert [len(each["candidates"]) for each in found] == [min(k, 8)] * 4
    plain = stocked.post("/match", json=query(manifest, rerank=False)).json()["queries"]
    for one, other in zip(found, plain, strict=True):
        stated = {each["id"]: each for each in other["candidates"]}
        for candidate in one["candidates"]:
            assert candidate["distance"] == stated[candidate["id"]]["distance"]
            assert candidate["probability"] == stated[candidate["id"]]["probability"]


@pytest.mark.parametrize("changes", [{"rerank": False}, {"centroids": None}])
def test_without_reranking_the_nearest_come_first(
    stocked: Any, manifest: Manifest, changes: dict[str, Any]
) -> None:
    answer = stocked.post("/match", json=query(manifest) | changes)
    assert firsts(answer) == ALIKE
    assert firsts(answer, "support") == [None] * 4


def test_single_segment_is_answered_as_before(stocked: Any, manifest: Manifest) -> None:
    one = {"codes": CODES[:1].tolist(), "centroids": SCENE[:1].tolist()}
    told = stocked.post("/match", json=query(manifest) | one)
    assert firsts(told) == ALIKE[:1]
    assert firsts(told, "support") == [0]
    plain = stocked.post("/match", json=query(manifest, rerank=False) | one)
    ids = [
        [each["id"] for each in answer.json()["queries"][0]["candidates"]]
        for answer in (told, plain)
    ]
    assert ids[0] == ids[1]


def test_candidates_of_other_maps_do_not_support(service: Any, manifest: Manifest) -> None:
    for number in range(4):
        places = SCENE[number : number + 1] + AWAY
        put(service, f"part-{number}", CODES[number : number + 1], places, manifest)
    assert firsts(service.post("/match", json=query(manifest)), "support") == [0] * 4
    put_scene(service, manifest, "whole")
    answer = service.post("/match", json=query(manifest, maps=["whole", "part-0"]))
    assert firsts(answer, "map") == ["part-0", "whole", "whole", "whole"]
    assert firsts(answer, "support") == [0, 3, 3, 3]


def test_answers_in_both_encodings_are_equal(stocked: Any, manifest: Manifest) -> None:
    for more in ({}, {"rerank": False}, {"k": 3}):
        body = query(manifest, **more)
        listed = stocked.post("/match", json=body).json()
        told = post_packed(stocked, "/match", packed(body), accept="application/json")
        assert told.json() == listed


def test_segments_are_reranked_without_those_that_have_no_descriptor(
    stocked: Any, manifest: Manifest
) -> None:
    clouds = [cloud(seed) + 4 * seed for seed in range(6)]
    described = stocked.post("/describe", json=request_of(clouds)).json()["descriptors"]
    codes = np.array([each["codes"] for each in described], np.int8)
    places = np.array([each["centroid"] for each in described]) + AWAY
    put(stocked, "own", codes, places, manifest)
    clouds.insert(2, clouds[0][:3])
    answer = stocked.post("/match", json=request_of(clouds) | {"maps": ["own"]}).json()["queries"]
    assert "error" in answer[2]
    first = [each["candidates"][0] for each in answer if "error" not in each]
    assert [each["id"] for each in first] == [200, 201, 202, 203, 204, 205]
    assert min(each["support"] for each in first) > 2


def test_empty_map_and_many_queries_are_answered(service: Any, manifest: Manifest) -> None:
    random = np.random.default_rng(0)
    many = {"codes": random_codes(300).tolist(), "centroids": random.normal(size=(300, 3)).tolist()}
    told = service.post("/match", json=query(manifest) | many).json()["queries"]
    assert told == [{"candidates": []}] * 300
    put_scene(service, manifest)
    assert len(firsts(service.post("/match", json=query(manifest, k=100) | many))) == 300


@pytest.mark.parametrize(
    ("changes", "detail"),
    [
        ({"rerank": "yes"}, "/rerank"),
        ({"rerank": None}, "/rerank"),
        ({"rerank": 1}, "/rerank"),
        ({"centroids": []}, "/centroids"),
        ({"centroids": [[0, 0, 0]]}, "/centroids"),
        ({"centroids": [[0, 0]] * 4}, "/centroids/0"),
        ({"centroids": [[0, 0, 1e300]] * 4}, "/centroids/0/2"),
        (request_of([cloud(0)]) | {"codes": None, "model_id": None}, "no centroids"),
    ],
)
def test_bad_option_is_refused_with_the_reason(
    stocked: Any, manifest: Manifest, changes: dict[str, Any], detail: str
) -> None:
    response = stocked.post("/match", json=query(manifest) | changes)
    assert_problem(response, 422, "invalid-request", detail)


def test_support_orders_candidates_of_several_models() -> None:
    def candidate(number: int, probability: float | None, support: int | None) -> dict[str, Any]:
        return {"map": "a", "id": number, "probability": probability, "support": support}

    one = [candidate(1, 0.5, 0), candidate(2, 0.4, 0), candidate(3, None, 9)]
    other = [candidate(4, 0.3, 3), candidate(5, 0.6, None), candidate(6, 1.0, 2)]
    assert [each["id"] for each in merged([one, other], 5)] == [6, 4, 5, 1, 2]


def test_cost_of_reranking_is_limited(start: Callable[..., Any], manifest: Manifest) -> None:
    with start(limits={"cost_seconds": 7e-4}) as service:
        put_scene(service, manifest)
        random = np.random.default_rng(0)
        many = {
            "codes": random_codes(60).tolist(),
            "centroids": random.normal(size=(60, 3)).tolist(),
        }
        assert service.post("/match", json=query(manifest, rerank=False) | many).status_code == 200
        refused = service.post("/match", json=query(manifest) | many)
        assert_problem(refused, 413, "too-much-work", "candidates")
