"""Filters by class in `/match` and `/localize`: the k best among the allowed, exactly."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, encode, encode_delta
from placecell_client.maps.edit import take

from placecell.core.segment_classes import CLASSES, ClassFilter, encoded
from placecell.core.types import UInt8
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer
from service.maps.index import index_of
from tests.service.search.test_localize import (
    TRUTH,
    assert_found,
    by_codes,
    packed,
    seen_in,
    street_map,
)
from tests.service.service_builders import (
    STEP,
    assert_problem,
    map_of,
    post_packed,
    random_codes,
)

FILTERS: list[dict[str, Any]] = [
    {"ignore": "movable"},
    {"ignore": ["movable", "sign"]},
    {"classes": ["pole"]},
    {"classes": ["pole", "vehicle"], "ignore": ["vehicle"]},
    {"classes": "person"},
    {"ignore": []},
]


def random_classes(count: int, seed: int = 0) -> UInt8:
    random = np.random.default_rng(seed)
    return encoded(random.integers(-1, 8, count), random.uniform(0, 1, count))


def kept_by(asked: dict[str, Any], classes: UInt8) -> list[int]:
    """Return the rows that a filter keeps, by the names."""
    names = [None if code == 0 else CLASSES[(int(code) - 1) // 31] for code in classes]
    listed = {key: [value] if isinstance(value, str) else value for key, value in asked.items()}
    ignored = {*listed.get("ignore", ())}
    ignored |= {"vehicle", "person"} if "movable" in ignored else set()
    wanted = listed.get("classes")
    return [
        row
        for row, name in enumerate(names)
        if name not in ignored and (wanted is None or name in wanted)
    ]


@pytest.mark.parametrize("per_byte", [1, 2, 4])
@pytest.mark.parametrize("kept", [0, 1, 40, 3000])
def test_filtered_index_is_exact(per_byte: int, kept: int) -> None:
    random = np.random.default_rng(kept)
    # Few different codes, so that there are many ties.
    codes = random.integers(-128, 128, (3000, 4)).astype(np.int8) // 32
    classes = np.full(3000, 94, np.uint8)
    classes[random.permutation(3000)[:kept]] = 1
    gone = random.uniform(size=3000) < 0.2
    quantizer = Quantizer(STEP, per_byte)
    wanted = ClassFilter.of(["building"])
    assert wanted is not None
    index = index_of(codes, quantizer)
    asked = codes[:20]
    distances, rows = index.filtered(classes, wanted).search(asked, 10, gone)
    allowed = np.flatnonzero((classes == 1) & ~gone)
    levels = quantizer.levels(codes).astype(np.int64)
    squared = ((levels[:20, None] - levels[allowed]) ** 2).sum(axis=2)
    order = np.argsort(squared, axis=1, kind="stable")[:, :10]
    np.testing.assert_array_equal(rows, allowed[order])
    np.testing.assert_allclose(distances**2, np.take_along_axis(squared, order, axis=1))
    assert index.filtered(classes, wanted) is index.filtered(classes, wanted)


@pytest.fixture(scope="module")
def contents(request: pytest.FixtureRequest) -> dict[str, UInt8]:
    return {"a": random_classes(300, 1), "b": random_classes(400, 2)}


@pytest.fixture
def stocked(service: Any, manifest: Manifest, contents: dict[str, UInt8]) -> Any:
    for name, classes in contents.items():
        stored = map_of(random_codes(len(classes), len(name)), manifest.model_id)
        assert (
            service.put(
                f"/maps/{name}", content=encode(replace(stored, classes=classes))
            ).status_code
            == 201
        )
    # A map without the column has unknown classes only.
    bare = map_of(random_codes(50, 9), manifest.model_id)
    assert service.put("/maps/c", content=encode(bare)).status_code == 201
    return service


def test_candidates_are_the_k_best_among_the_allowed(
    stocked: Any, manifest: Manifest, contents: dict[str, UInt8]
) -> None:
    every = contents | {"c": np.zeros(50, np.uint8)}
    seeds = {"a": 1, "b": 1, "c": 9}
    query = random_codes(5, 77)
    for asked in FILTERS:
        rows = []
        for name, classes in every.items():
            kept = kept_by(asked, classes)
            codes = random_codes(len(classes), seeds[name])[kept].astype(np.int64)
            for number, one in enumerate(query.astype(np.int64)):
                squared = ((codes - one) ** 2).sum(axis=1).tolist()
                rows += [
                    (number, value, name, 100 + row)
                    for value, row in zip(squared, kept, strict=True)
                ]
        body = {"model_id": manifest.model_id, "codes": query.tolist(), "k": 30} | asked
        told = stocked.post("/match", json=body)
        assert told.status_code == 200, told.text
        for number, item in enumerate(told.json()["queries"]):
            expected = sorted(row[1:] for row in rows if row[0] == number)[:30]
            found = [(each["map"], each["id"]) for each in item["candidates"]]
            assert found == [(name, id_) for _, name, id_ in expected], asked


def test_filter_follows_edits(stocked: Any, manifest: Manifest, contents: dict[str, UInt8]) -> None:
    codes = random_codes(1, 5)
    body = {
        "model_id": manifest.model_id,
        "codes": codes.tolist(),
        "k": 1,
        "maps": ["a"],
        "classes": ["vehicle"],
    }
    before = stocked.post("/match", json=body).json()["queries"][0]["candidates"]
    added = replace(map_of(codes, manifest.model_id, 5000), classes=encoded([3], [1.0]))
    edit = encode_delta(Delta(added, np.zeros(0, np.uint32)))
    assert stocked.post("/maps/a/segments", content=edit).status_code == 200
    (nearest,) = stocked.post("/match", json=body).json()["queries"][0]["candidates"]
    assert (nearest["id"], nearest["distance"]) == (5000, 0)
    removed = np.array([5000], np.uint32)
    gone = encode_delta(Delta(take(added, slice(0)), removed))
    assert stocked.post("/maps/a/segments?robot=ann", content=gone).status_code == 200
    assert stocked.post("/match", json=body).json()["queries"][0]["candidates"] == before


def test_queries_of_a_left_out_class_have_an_error(stocked: Any, manifest: Manifest) -> None:
    given = [{"name": "vehicle", "probability": 0.7}, None, {"name": "pole", "probability": 1}]
    body = {
        "model_id": manifest.model_id,
        "codes": random_codes(3, 5).tolist(),
        "query_classes": given,
        "ignore": "movable",
        "k": 2,
    }
    first, *others = stocked.post("/match", json=body).json()["queries"]
    assert first["error"]["type"] == "urn:placecell:problem:ignored-class"
    assert "vehicle" in first["error"]["detail"]
    assert [len(each["candidates"]) for each in others] == [2, 2]
    # Without a filter the classes change nothing.
    whole = stocked.post("/match", json={k: v for k, v in body.items() if k != "ignore"}).json()
    assert all("candidates" in each for each in whole["queries"])
    blob = packed({**body, "centroids": np.zeros((3, 3))})
    del blob["centroids"]
    blob["query_classes"] = encoded([3, -1, 2], [0.7, 0, 1]).tobytes()
    told = post_packed(stocked, "/match", blob, "application/json").json()
    assert told["queries"] == [first, *others]


def test_all_queries_may_be_left_out(stocked: Any, manifest: Manifest) -> None:
    body = by_codes(manifest, random_codes(3, 5), np.zeros((3, 3))) | {
        "query_classes": [{"name": "person", "probability": 1}] * 3,
        "ignore": ["person"],
    }
    told = stocked.post("/match", json=body).json()
    assert all("error" in each for each in told["queries"])
    found = stocked.post("/localize", json=body).json()
    assert [each["query"] for each in found["unusable"]] == [0, 1, 2]
    assert {each["reason"] for each in found["localizations"]} == {"too-few-segments"}


@pytest.mark.parametrize(
    ("change", "pointer", "detail"),
    [
        ({"classes": ["car"]}, "/classes/0", "'building', 'vegetation', 'pole'"),
        ({"classes": ["movable"]}, "/classes/0", "'building'"),
        ({"classes": []}, "/classes", "at least 1"),
        ({"ignore": "cars"}, "/ignore/0", "'movable'"),
        ({"ignore": ["vehicle", 3]}, "/ignore/1", "'movable'"),
        ({"query_classes": [None]}, "/query_classes", "1 classes for 2 codes"),
        ({"query_classes": [{"name": "car", "probability": 1}, None]}, "/query_classes/0/name", ""),
        (
            {"query_classes": [{"name": "sign", "probability": 2}, None]},
            "/query_classes/0/probability",
            "",
        ),
    ],
)
@pytest.mark.parametrize("path", ["/match", "/localize"])
def test_wrong_filter_is_refused(
    service: Any, manifest: Manifest, path: str, change: dict[str, Any], pointer: str, detail: str
) -> None:
    body = by_codes(manifest, random_codes(2, 5), np.zeros((2, 3))) | change
    response = service.post(path, json=body)
    assert_problem(response, 422, "invalid-request", detail)
    assert response.json()["errors"][0]["pointer"] == pointer


def test_wrong_class_blobs_are_refused(service: Any, manifest: Manifest) -> None:
    body = packed(by_codes(manifest, random_codes(2, 5), np.zeros((2, 3))))
    for blob, detail in ((b"\x00\xff", "found the byte 255"), (b"", "at least one class")):
        told = post_packed(service, "/match", body | {"query_classes": blob})
        assert_problem(told, 422, "invalid-request", detail)


def test_segments_with_query_classes_are_refused(service: Any) -> None:
    segment = {"points": [[1.0, 2.0, 3.0]] * 20, "sensor": [0.0, 0.0, 0.0]}
    body = {"segments": [segment], "query_classes": [None]}
    assert_problem(
        service.post("/match", json=body), 422, "invalid-request", "needs no query_classes"
    )


def with_cars(content: CompactMap) -> CompactMap:
    """Return a map where each of the first 40 segments has ten vehicles of the same look."""
    cars = [
        replace(
            take(content, np.arange(40)),
            ids=np.arange(1000 + 40 * copy, 1040 + 40 * copy, dtype=np.uint32),
            centroids=np.random.default_rng(copy)
            .uniform((-200, -15, 0), (200, 15, 4), (40, 3))
            .round(2),
            classes=np.full(40, 121, np.uint8),
        )
        for copy in range(30)
    ]
    still = replace(content, classes=np.ones(len(content), np.uint8))
    joined: dict[str, Any] = {
        name: np.concatenate([getattr(each, name) for each in (still, *cars)])
        for name in ("codes", "centroids", "ids", "robot", "frame_index", "classes")
    }
    return replace(still, **joined)


def test_localization_without_movable_segments_finds_the_place(
    service: Any, manifest: Manifest
) -> None:
    content = with_cars(street_map(manifest))
    assert service.put("/maps/street", content=encode(content)).status_code == 201
    codes, centroids = seen_in(street_map(manifest))
    body = by_codes(manifest, codes, centroids) | {"ignore": "movable", "k": 5}
    (told,) = service.post("/localize", json=body).json()["localizations"]
    assert_found(told)
    assert {each["id"] for each in told["inliers"]} == set(range(100, 140))
    # Hints search the segments around a place by themselves, and leave out the same ones.
    x, y, _ = TRUTH.translation.tolist()
    hinted = body | {"hints": {"near": {"position": [x, y], "radius": 5.0}}}
    (told,) = service.post("/localize", json=hinted).json()["localizations"]
    assert {each["id"] for each in told["inliers"]} == set(range(100, 140))
    only = service.post("/localize", json=body | {"classes": ["vehicle"], "ignore": []}).json()
    assert all(each["id"] >= 1000 for each in only["localizations"][0]["inliers"])


def test_many_small_maps_are_filtered_in_their_shared_index(
    service: Any, manifest: Manifest
) -> None:
    for number in range(20):
        content = street_map(manifest, number)
        classes = np.full(len(content), 121 if number % 2 else 1, np.uint8)
        data = encode(replace(content, classes=classes))
        assert service.put(f"/maps/street-{number:02}", content=data).status_code == 201
    codes, centroids = seen_in(street_map(manifest, 4))
    body = by_codes(manifest, codes, centroids) | {"ignore": "movable"}
    told = service.post("/localize", json=body).json()["localizations"]
    assert told[0]["map"] == "street-04"
    assert_found(told[0])
    searched = service.post("/match", json=body | {"k": 50}).json()
    found = {each["map"] for item in searched["queries"] for each in item["candidates"]}
    assert found <= {f"street-{number:02}" for number in range(0, 20, 2)}
    codes, centroids = seen_in(street_map(manifest, 5))
    told = service.post(
        "/localize", json=by_codes(manifest, codes, centroids) | {"ignore": "movable"}
    ).json()["localizations"]
    assert not any(each["localized"] for each in told)
