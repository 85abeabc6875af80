"""The calibration of a stored map: its state in the API, and what it depends on."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, encode, encode_delta

from placecell.descriptors.manifest import Manifest
from placecell.descriptors.site_calibration import SiteConstants, calibrate
from service.maps.layers import MapLayers
from tests.service.service_builders import map_of, write_eigenvalue_model

SITE = SiteConstants(slope=2.0, offset=-3.0, mean=1.0, deviation=0.2)
JSON = {"Accept": "application/json"}


@pytest.fixture
def sited(tmp_path: Path) -> Manifest:
    """Model `sited`, with site constants, and `tiny`, an old one, in `tmp_path / models`."""
    folder = tmp_path / "models"
    write_eigenvalue_model(folder)
    manifest = write_eigenvalue_model(folder, "sited")
    manifest = replace(manifest, pair={"threshold": 0.5, "site": SITE.as_dict()})
    manifest.save(folder / "sited")
    return manifest


@pytest.fixture
def serve(start: Any, tmp_path: Path) -> Any:
    return lambda model: start(models_dir=tmp_path / "models", model=model)


def seen_map(manifest: Manifest, objects: int, views: int, first_id: int = 100) -> CompactMap:
    """A map in which each capture sees each object; objects are 4 m apart."""
    random = np.random.default_rng(first_id)
    rows = np.tile(np.arange(objects), views)
    looks = random.normal(size=(objects, 7)) * 60
    codes = (looks[rows] + random.normal(size=(len(rows), 7)) * 8).round().clip(-127, 127)
    plain = map_of(codes.astype(np.int8), manifest.model_id, first_id)
    centroids = np.zeros((len(rows), 3))
    centroids[:, 0] = 4.0 * rows - 150
    return replace(
        plain,
        centroids=centroids,
        frame_index=np.repeat(np.arange(views), objects).astype(np.uint32),
        frame_times=np.arange(views, dtype=np.float64) + 1.7e9,
        frame_positions=np.arange(views)[:, None] * [1.0, 0.0, 0.0],
        frame_orientations=np.tile(np.array([[0, 0, 0, 1]], np.float32), (views, 1)),
    )


def state_of(client: Any, name: str = "yard") -> Any:
    response = client.get(f"/maps/{name}", headers=JSON)
    assert response.status_code == 200, response.text
    assert response.headers["vary"] == "Accept"
    return response.json()["calibration"]


def put(client: Any, content: CompactMap, **headers: str) -> None:
    response = client.put("/maps/yard", content=encode(content), headers=headers)
    assert response.status_code in {200, 201}, response.text


def test_state_advances_as_a_map_fills(serve: Any, sited: Manifest) -> None:
    with serve("sited") as client:
        put(client, seen_map(sited, 1, 1))
        assert state_of(client)["state"] == "default"
        put(client, seen_map(sited, 20, 1), **{"If-Match": "*"})
        collecting = state_of(client)
        assert collecting["state"] == "collecting"
        assert (collecting["cohort"], collecting["negatives"]) == (20, 20 * 19)
        assert (collecting["shift"], collecting["scale"]) == (0.0, 1.0)
        put(client, seen_map(sited, 80, 4), **{"If-Match": "*"})
        calibrated = state_of(client)
        assert calibrated["state"] == "calibrated"
        assert 2.0 < calibrated["views"] <= 3.0
        text = client.get("/metrics").text
        assert 'placecell_maps_by_calibration{state="calibrated"} 1.0' in text
        assert 'placecell_maps_by_calibration{state="default"} 0.0' in text
        listed = client.get("/maps").json()["maps"][0]
        detail = client.get("/maps/yard", headers=JSON).json()
        alone = {"calibration", "anchor", "mirror", "shapes"}
        assert listed == {key: value for key, value in detail.items() if key not in alone}


def test_map_is_a_file_unless_json_is_preferred(serve: Any, sited: Manifest) -> None:
    content = encode(seen_map(sited, 3, 1))
    with serve("sited") as client:
        client.put("/maps/yard", content=content)
        for accept in ("*/*", "application/json, */*", "application/octet-stream", "text/html"):
            assert client.get("/maps/yard", headers={"Accept": accept}).content == content
        assert client.get("/maps/yard?version=1", headers=JSON).content == content


def test_old_model_states_no_calibration_and_the_same_probabilities(
    serve: Any, sited: Manifest, tmp_path: Path
) -> None:
    tiny = Manifest.load(tmp_path / "models" / "tiny")
    content = seen_map(tiny, 20, 2)
    with serve("tiny") as client:
        put(client, content)
        assert state_of(client) is None
        body = {"model_id": tiny.model_id, "codes": content.codes[:3].tolist()}
        for result in client.post("/match", json=body).json()["queries"]:
            assert {each["probability"] for each in result["candidates"]} == {None}


def test_probabilities_depend_on_the_version_only(serve: Any, sited: Manifest) -> None:
    base, more = seen_map(sited, 80, 3), seen_map(sited, 10, 2, first_id=900)
    whole = sited_union(base, more)
    body = {"model_id": sited.model_id, "codes": whole.codes[::7].tolist(), "k": 5}

    def told(client: Any) -> Any:
        return client.post("/match", json=body).json()["queries"]

    with serve("sited") as client:
        put(client, base)
        before = told(client)
        assert all(
            0 < each["probability"] < 1 for result in before for each in result["candidates"]
        )
        delta = encode_delta(Delta(more, np.zeros(0, np.uint32)))
        assert client.post("/maps/yard/segments", content=delta).status_code == 200
        after, state = told(client), state_of(client)
        assert after != before
    with serve("sited") as client:  # nothing is remembered but the map
        assert told(client) == after
        assert state_of(client) == state
        # The same content as one layer.
        client.delete("/maps/yard")
        stored = client.put("/maps/yard", content=encode(whole))
        assert stored.status_code == 201
        assert told(client) == after


def test_request_that_reaches_many_maps_calibrates_the_first_ones_only(
    serve: Any, sited: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    contents = {name: seen_map(sited, 40, 2, first_id=100 + ord(name)) for name in "abc"}
    # Most candidates come from map b.
    codes = np.concatenate([contents["b"].codes[:30], contents["a"].codes[:5]])
    body = {"model_id": sited.model_id, "codes": codes.tolist(), "k": 1}
    with serve("sited") as client:
        for name, content in contents.items():
            client.put(f"/maps/{name}", content=encode(content))
        full = client.post("/match", json=body).json()["queries"]
        monkeypatch.setattr("service.search.matching.CALIBRATED", 1)
        some = client.post("/match", json=body).json()["queries"]
    for of_all, of_some in zip(full, some, strict=True):
        (one,), (other,) = of_all["candidates"], of_some["candidates"]
        assert (one["map"], one["id"], one["distance"]) == (
            other["map"],
            other["id"],
            other["distance"],
        )
        assert (one["probability"] == other["probability"]) == (one["map"] == "b")
        assert 0 < other["probability"] < 1


def sited_union(base: CompactMap, more: CompactMap) -> CompactMap:
    return MapLayers.of(base).after(Delta(more, np.zeros(0, np.uint32))).content()


def test_sample_does_not_depend_on_layers(sited: Manifest) -> None:
    base, low, high = (seen_map(sited, 30, 2, first_id=first) for first in (1000, 100, 5000))
    layers = MapLayers.of(base)
    removed = base.ids[5:9]
    for delta in (
        Delta(low, removed),
        Delta(high, np.zeros(0, np.uint32)),
        Delta(replace(low, ids=base.ids[:60]), np.zeros(0, np.uint32)),
    ):
        layers = layers.after(delta)
        assert (
            layers.site_sample().digest() == MapLayers.of(layers.content()).site_sample().digest()
        )


def test_single_writes_keep_the_calibration_and_count_its_segments(sited: Manifest) -> None:
    layers = MapLayers.of(seen_map(sited, 80, 3))
    before = layers.sites.of(layers, sited)
    assert before is not None
    assert layers.sites.of(layers, sited) is before
    more = MapLayers.after(layers, Delta(seen_map(sited, 1, 1, 900), np.zeros(0, np.uint32)))
    after = more.sites.of(more, sited)
    assert after is not None
    assert (after.read, after.segments) == (before.read, before.segments + 1)
    assert after.cohort is before.cohort
    # A change among the segments that were read makes a new one.
    less = layers.after(Delta(seen_map(sited, 0, 1), layers.base.ids[:40]))
    fewer = less.sites.of(less, sited)
    assert fewer is not None
    assert fewer.cohort is not before.cohort
    content = less.content()
    sample = less.site_sample()
    fresh = calibrate(
        sample.codes, sample.centroids, sample.captures, sited.quantizer, SITE, len(content)
    )
    assert fewer.as_dict() == fresh.as_dict()
