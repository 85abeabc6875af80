import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.core.segments import Segments
from placecell.descriptors.extractor import Inputs, load_extractor
from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import assert_problem, cloud, request_of

SENSOR = (9.0, -3.0, 1.7)
POINT = [1.0, 2.0, 3.0]


def column(response: Any, name: str) -> Any:
    assert response.status_code == 200, response.text
    return np.array([item[name] for item in response.json()["descriptors"]])


@pytest.mark.parametrize("model", ["tiny", "onnx"])
def test_descriptors_equal_those_of_the_library(start: Any, models_dir: Path, model: str) -> None:
    clouds = [cloud(seed) for seed in range(70)]
    extractor = load_extractor(models_dir / model)
    sensors = np.tile(SENSOR, (70, 1))
    # As the service does: about the sensor, in float64, before the cast.
    near = [(points - SENSOR).astype(np.float32) for points in clouds]
    expected = extractor.describe(Segments.of(near, sensors - SENSOR))
    with start(model=model) as service:
        response = service.post("/describe", json=request_of(clouds))
    np.testing.assert_allclose(column(response, "descriptor"), expected, atol=1e-5)
    codes = extractor.manifest.quantizer.encode(expected)
    np.testing.assert_array_equal(column(response, "codes"), codes)
    means = np.array([points.mean(axis=0) for points in clouds])
    np.testing.assert_allclose(column(response, "centroid"), means, atol=1e-5)
    assert response.json()["model_id"] == extractor.manifest.model_id
    assert response.json()["dimension"] == extractor.manifest.dimension


def test_coordinates_of_hundreds_of_kilometers_keep_their_precision(service: Any) -> None:
    clouds = [cloud(seed) for seed in range(20)]
    shift = np.array([5e5, 5.4e6, 300.0])
    here = service.post("/describe", json=request_of(clouds))
    far = [points + shift for points in clouds]
    there = service.post("/describe", json=request_of(far, tuple(SENSOR + shift)))
    np.testing.assert_allclose(column(there, "descriptor"), column(here, "descriptor"), atol=1e-3)
    np.testing.assert_allclose(
        column(there, "centroid"), column(here, "centroid") + shift, atol=1e-5
    )


def test_descriptor_does_not_depend_on_other_segments(service: Any) -> None:
    clouds = [cloud(seed) for seed in range(9)]
    together = column(service.post("/describe", json=request_of(clouds)), "descriptor")
    for points, expected in zip(clouds, together, strict=True):
        alone = column(service.post("/describe", json=request_of([points])), "descriptor")
        np.testing.assert_allclose(alone[0], expected, atol=1e-5)


def test_unusable_segment_has_an_error_in_its_place(start: Any) -> None:
    body = request_of([cloud(0), cloud(1)[:2], cloud(2), cloud(3)[:0], cloud(4), cloud(5)])
    body["segments"][4]["sensor"] = [0, 0, 2000]
    far = cloud(5) + 50_000
    body["segments"][5] = {"points": far.tolist(), "sensor": far[0].tolist()}
    with start(limits={"max_points": 200, "min_points": 10}) as service:
        alone = service.post("/describe", json=request_of([cloud(0), cloud(2)]))
        body["segments"].append(request_of([cloud(6, 201)])["segments"][0])
        items = service.post("/describe", json=body).json()["descriptors"]
    assert [items[0], items[2]] == alone.json()["descriptors"]
    kinds = {index: item["error"]["type"] for index, item in enumerate(items) if "error" in item}
    assert kinds == {
        1: "urn:placecell:problem:too-few-points",
        3: "urn:placecell:problem:too-few-points",
        4: "urn:placecell:problem:out-of-reach",
        5: "urn:placecell:problem:out-of-reach",
        6: "urn:placecell:problem:too-many-points",
    }
    assert "2 points" in items[1]["error"]["detail"]


def test_segment_of_equal_points_is_described(service: Any) -> None:
    response = service.post("/describe", json=request_of([np.ones((20, 3))]))
    assert np.isfinite(column(response, "descriptor")).all()


def segment(points: str, sensor: str = "[0, 0, 1]") -> bytes:
    return f'{{"segments": [{{"points": {points}, "sensor": {sensor}}}]}}'.encode()


MANY = json.dumps([POINT] * 20)[:-1]

BAD = {
    "nothing": (b"", 400, "not-json", "not JSON"),
    "not JSON": (b"points, please", 400, "not-json", "line 1"),
    "not text": (b"\xff\xfe\x00", 400, "not-json", "not JSON"),
    "cut short": (segment(MANY + "]")[:-5], 400, "not-json", "EOF"),
    "deep": (b"[" * 100_000, 400, "not-json", "recursion"),
    "a list": (b"[]", 422, "invalid-request", "object"),
    "no segments": (b'{"segments": []}', 422, "invalid-request", "/segments"),
    "no field": (b"{}", 422, "invalid-request", "/segments: Field required"),
    "a field too many": (b'{"segments": [], "up": "y"}', 422, "invalid-request", ""),
    "an empty segment": (segment("[]"), 422, "no-usable-segment", "0 points"),
    "two points": (segment("[[1,2,3],[4,5,6]]"), 422, "no-usable-segment", "2 points"),
    "NaN": (segment(MANY + ", [1, NaN, 3]]"), 422, "invalid-request", "/segments/0/points/20/1"),
    "infinity": (segment(MANY + ", [Infinity, 2, 3]]"), 422, "invalid-request", "points/20/0"),
    "minus infinity": (segment(MANY + ", [1,2,-Infinity]]"), 422, "invalid-request", "finite"),
    "overflow": (segment(MANY + ", [1e999, 2, 3]]"), 422, "invalid-request", "points/20/0"),
    "NaN sensor": (segment(MANY + "]", "[0, NaN, 0]"), 422, "invalid-request", "/sensor/1"),
    "too far": (segment(MANY + ", [1, 2, 1.1e8]]"), 422, "invalid-request", "points/20/2"),
    "strings": (segment(MANY + ', ["1", 2, 3]]'), 422, "invalid-request", "points/20/0"),
    "booleans": (segment(MANY + ", [1, true, 3]]"), 422, "invalid-request", "points/20/1"),
    "null": (segment(MANY + ", [1, 2, null]]"), 422, "invalid-request", "points/20/2"),
    "two coordinates": (segment(MANY + ", [1, 2]]"), 422, "invalid-request", "points/20/2"),
    "four coordinates": (segment(MANY + ", [1, 2, 3, 4]]"), 422, "invalid-request", "points/20"),
    "no list": (segment('"points"'), 422, "invalid-request", "/segments/0/points"),
}


@pytest.mark.parametrize("case", BAD)
@pytest.mark.parametrize("path", ["/describe", "/match"])
def test_bad_request_is_refused_with_the_reason(service: Any, case: str, path: str) -> None:
    body, status, kind, detail = BAD[case]
    if path == "/match" and case == "no field":
        detail = "segments"
    response = service.post(path, content=body)
    assert_problem(response, status, kind, detail)
    assert len(response.content) < 5_000
    assert service.post("/describe", json=request_of([cloud(0)])).status_code == 200


def test_too_large_request_is_refused(start: Any) -> None:
    with start(limits={"segments": 3, "points": 500}) as service:
        clouds = [cloud(seed, 125) for seed in range(4)]
        assert service.post("/describe", json=request_of(clouds[:3])).status_code == 200
        response = service.post("/describe", json=request_of(clouds))
        assert_problem(response, 413, "too-many-segments", "the limit is 3")
        response = service.post("/describe", json=request_of([cloud(0, 501)]))
        assert_problem(response, 413, "too-many-points", "the limit is 500")
        response = service.post("/describe", json=request_of([cloud(0, 2_000)]))
        assert_problem(
            response, 413, "too-many-points", "2000 points in a request; the limit is 500"
        )


def test_descriptor_that_is_not_finite_is_an_error(
    service: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(_: object, inputs: Inputs) -> Any:
        rows = np.arange(len(inputs["features"]))[:, None]
        return np.where(rows == 1, np.nan, np.zeros((1, 7), np.float32))

    monkeypatch.setattr("placecell.descriptors.extractor.EigenvalueExtractor.infer", broken)
    items = service.post("/describe", json=request_of([cloud(0), cloud(1), cloud(2)])).json()
    assert ["error" in item for item in items["descriptors"]] == [False, True, False]
    assert items["descriptors"][2]["centroid"] == pytest.approx(cloud(2).mean(axis=0), abs=1e-5)


def test_response_names_the_model(service: Any, manifest: Manifest) -> None:
    body = service.post("/describe", json=request_of([cloud(0)])).json()
    assert body["model_id"] == manifest.model_id
