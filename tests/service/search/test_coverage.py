"""`/coverage`: the share of a robot's segments that each map knows; tags select maps."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, encode

from placecell.descriptors.manifest import Manifest
from tests.service.search.test_localize import by_codes, packed, seen_in, street_map
from tests.service.service_builders import (
    MSGPACK,
    assert_problem,
    cloud,
    post_packed,
    random_codes,
    request_of,
)


@pytest.fixture
def content(manifest: Manifest) -> CompactMap:
    return street_map(manifest)


@pytest.fixture
def stocked(service: Any, manifest: Manifest, content: CompactMap) -> Any:
    service.put("/maps/street", content=encode(content))
    service.put("/maps/hall", content=encode(street_map(manifest, seed=9)))
    service.put("/maps/street/tags", json={"tags": ["outdoor", "north"]})
    service.put("/maps/hall/tags", json={"tags": ["indoor", "north"]})
    return service


@pytest.fixture
def body(manifest: Manifest, content: CompactMap) -> dict[str, Any]:
    return by_codes(manifest, *seen_in(content))


def test_known_area_has_a_large_share(stocked: Any, body: Any) -> None:
    told = stocked.post("/coverage", json=body).json()
    assert told["segments"] == 40
    assert [each["map"] for each in told["maps"]] == ["street", "hall"]
    street, hall = told["maps"]
    assert (street["share"], street["known"], street["frame"]) == (1.0, 40, "town")
    assert street["probability"] > 0.9
    assert hall["share"] < 0.5
    assert hall["known"] == round(40 * hall["share"])


def test_half_known_area_and_unknown_segments(
    stocked: Any, body: Any, manifest: Manifest, content: CompactMap
) -> None:
    codes, centroids = seen_in(content)
    codes = codes.copy()
    codes[20:] = random_codes(20, 77)
    half = by_codes(manifest, codes, centroids)
    share = stocked.post("/coverage", json=half | {"maps": ["street"]}).json()["maps"][0]["share"]
    assert 0.5 <= share < 0.8


def test_both_encodings_agree_and_segments_work(stocked: Any, body: Any) -> None:
    first = stocked.post("/coverage", json=body).json()
    assert post_packed(stocked, "/coverage", packed(body), "application/json").json() == first
    answer = post_packed(stocked, "/coverage", packed(body))
    assert answer.headers["content-type"] == MSGPACK
    scan = stocked.post("/coverage", json=request_of([cloud(n) for n in range(5)])).json()
    assert scan["segments"] == 5
    assert_problem(stocked.post("/coverage", json={}), 422, "invalid-request")


@pytest.mark.parametrize("path", ["/match", "/localize", "/coverage"])
def test_tags_select_the_maps(stocked: Any, body: Any, path: str) -> None:
    def searched(**more: Any) -> set[str]:
        answer = stocked.post(path, json=body | more)
        assert answer.status_code == 200, answer.text
        told = answer.json()
        if path == "/match":
            return set(told["searched"])
        return {each["map"] for each in told["maps" if path == "/coverage" else "localizations"]}

    assert searched(tags=["north"]) == {"street", "hall"}
    assert searched(tags=["north", "indoor"]) == {"hall"}
    assert searched(tags=["unknown"]) == set()
    assert searched(tags=["indoor"], maps=["street"]) == set()
    wrong = stocked.post(path, json=body | {"tags": []})
    assert_problem(wrong, 422, "invalid-request")


def test_map_without_probabilities_and_no_map(service: Any, body: Any) -> None:
    told = service.post("/coverage", json=body).json()
    assert (told["segments"], told["maps"]) == (40, [])


def test_dense_map_that_resembles_nothing_is_not_known(
    service: Any, manifest: Manifest, content: CompactMap
) -> None:
    far = replace(content, codes=np.full_like(content.codes, 127))
    service.put("/maps/far", content=encode(far))
    codes, centroids = seen_in(content)
    low = by_codes(manifest, np.full_like(codes, -127), centroids)
    assert service.post("/coverage", json=low).json()["maps"][0]["share"] == 0.0
