import shutil
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.descriptors.extractor import Inputs
from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import assert_problem, cloud, request_of


@pytest.mark.sqlite
def test_health(service: Any, data_dir: Path) -> None:
    assert service.get("/livez").json() == {"status": "alive"}
    assert service.get("/readyz").json() == {"status": "ready"}
    shutil.rmtree(data_dir)
    assert_problem(service.get("/readyz"), 503, "not-ready")
    assert service.get("/livez").status_code == 200


def test_info(start: Any, manifest: Manifest) -> None:
    with start(limits={"k": 7}) as service:
        info = service.get("/info").json()
    assert info["model"]["model_id"] == manifest.model_id
    assert info["model"]["dimension"] == 7
    assert info["limits"]["k"] == 7
    assert info["limits"]["min_points"] == 10
    assert info["map_file"] == {
        "format": "placecell-map",
        "version": 1,
        "media_type": "application/vnd.placecell.map",
    }


def test_service_answers_during_inference(service: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    entered, released = threading.Event(), threading.Event()

    def slow(_: object, inputs: Inputs) -> Any:
        entered.set()
        assert released.wait(60)
        return np.zeros((len(inputs["features"]), 7), np.float32)

    monkeypatch.setattr("placecell.descriptors.extractor.EigenvalueExtractor.infer", slow)
    with ThreadPoolExecutor(1) as pool:
        pending = pool.submit(service.post, "/describe", json=request_of([cloud(0)]))
        assert entered.wait(60)
        assert service.get("/livez").status_code == 200
        assert service.get("/maps").status_code == 200
        assert not pending.done()
        released.set()
        assert pending.result(60).status_code == 200


def test_unknown_paths_and_methods_answer_with_problems(service: Any) -> None:
    assert_problem(service.get("/nowhere"), 404, "not-found", "/nowhere")
    response = service.put("/maps")
    assert_problem(response, 405, "method-not-allowed", "PUT")
    assert "GET" in response.headers["allow"]


def test_unexpected_error_reveals_no_internals(
    service: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(*_: object) -> Any:
        raise RuntimeError("a secret of the inside")

    monkeypatch.setattr("placecell.descriptors.extractor.EigenvalueExtractor.infer", failing)
    response = service.post("/describe", json=request_of([cloud(0)]))
    assert_problem(response, 500, "internal-error")
    assert "secret" not in response.text
    assert "Traceback" not in response.text
    assert service.get("/livez").status_code == 200


def test_body_of_another_media_type_answers_415(service: Any) -> None:
    headers = {"Content-Type": "text/csv"}
    response = service.post("/describe", content=b"1,2,3", headers=headers)
    assert_problem(response, 415, "unsupported-media-type", "application/json")
    headers = {"Content-Type": "application/json; charset=utf-8"}
    assert service.post("/describe", content=b"{}", headers=headers).status_code == 422


def test_large_body_answers_413_with_and_without_content_length(start: Any) -> None:
    with start(limits={"body_bytes": 1000, "json_bytes": 1000}) as service:
        response = service.post("/describe", content=b" " * 1001)
        assert_problem(response, 413, "body-too-large", "1000 bytes")
        taken = []

        def stream() -> Any:
            for _ in range(100):
                taken.append(1)
                yield b" " * 100

        response = service.post("/describe", content=stream())
        assert_problem(response, 413, "body-too-large", "1000 bytes")
        assert service.post("/describe", content=b" " * 1000).status_code == 400


def test_openapi_lists_every_route(service: Any) -> None:
    document = service.get("/openapi.json").json()
    schemas = document["components"]["schemas"]
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            assert operation["summary"], (path, method)
            for status, response in operation["responses"].items():
                if status >= "400":
                    assert list(response["content"]) == ["application/problem+json"]
    text = str(document)
    for name in {part.split("'")[0] for part in text.split("#/components/schemas/")[1:]}:
        assert name in schemas
    assert "DescribeRequest" in schemas
    assert "HTTPValidationError" not in schemas
    assert service.get("/docs").status_code == 200


@pytest.mark.slow
def test_examples_of_openapi_are_accepted(service: Any) -> None:
    document = service.get("/openapi.json").json()
    for path in ("/describe", "/match", "/localize"):
        content = document["paths"][path]["post"]["requestBody"]["content"]["application/json"]
        schema = document["components"]["schemas"][content["schema"]["$ref"].rpartition("/")[2]]
        for example in schema["examples"]:
            response = service.post(path, json=example)
            assert response.status_code == 200, response.text
            answer = response.json()
            assert path == "/localize" or answer.get("descriptors", answer.get("queries"))
