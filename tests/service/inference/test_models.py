"""Several loaded models, and a reload that drops no request."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from placecell.localization.confidence import NAME, SHIPPED, shipped
from tests.service.service_builders import (
    assert_problem,
    cloud,
    map_of,
    random_codes,
    request_of,
    write_eigenvalue_model,
)


@pytest.fixture
def own_models(models_dir: Path, tmp_path: Path) -> Path:
    """Folder of models that a test may change."""
    return Path(shutil.copytree(models_dir, tmp_path / "models"))


def test_each_map_is_searched_with_the_model_that_made_it(
    start: Any, manifest: Manifest, other_manifest: Manifest
) -> None:
    clouds = [cloud(0), cloud(1)]
    with start(also=["other"]) as service:
        info = service.get("/info").json()
        assert [each["name"] for each in info["models"]] == ["tiny", "other"]
        for name, model in (("yard", manifest), ("hall", other_manifest)):
            described = service.post(
                "/describe", json=request_of(clouds) | {"model": model.name}
            ).json()
            assert described["model_id"] == model.model_id
            codes = [each["codes"] for each in described["descriptors"]]
            data = encode(map_of(np.array(codes, np.int8), model.model_id))
            assert service.put(f"/maps/{name}", content=data).status_code == 201
            found = service.post(
                "/match", json={"model_id": model.model_id, "codes": codes, "k": 1}
            ).json()
            assert found["model_id"] == model.model_id
            assert found["searched"] == [name]
        both = service.post("/match", json=request_of(clouds) | {"k": 4}).json()
    assert both["searched"] == ["hall", "yard"]
    for place, query in enumerate(both["queries"]):
        best = [one for one in query["candidates"] if one["distance"] == 0]
        assert {one["map"] for one in best} == {"hall", "yard"}
        assert {one["id"] for one in best} == {100 + place}


def test_map_of_a_model_on_disk_loads_this_model(
    start: Any, own_models: Path, manifest: Manifest, other_manifest: Manifest
) -> None:
    data = encode(map_of(random_codes(4), manifest.model_id))
    with start(models_dir=own_models) as service:
        assert service.put("/maps/yard", content=data).status_code == 201
    # A new default does not strand it.
    with start(models_dir=own_models, model="other") as service:
        query = {"model_id": manifest.model_id, "codes": random_codes(1).tolist()}
        found = service.post("/match", json=query | {"maps": ["yard"]})
        assert found.status_code == 200
        assert found.json()["searched"] == ["yard"]
        assert service.get("/info").json()["model"]["model_id"] == other_manifest.model_id
    # Without the model's folder it is kept, and told.
    shutil.rmtree(own_models / "tiny")
    with start(models_dir=own_models, model="other") as service:
        assert_problem(service.post("/match", json=query), 409, "other-model")
        found = service.post("/match", json=request_of([cloud(0)])).json()
        assert [each["map"] for each in found["skipped"]] == ["yard"]
        assert service.get("/maps/yard").content == data


def test_model_that_is_not_loaded_is_refused(service: Any) -> None:
    response = service.post("/describe", json=request_of([cloud(0)]) | {"model": "best"})
    assert_problem(response, 409, "other-model", "tiny-")


def test_reload_loads_changed_models(start: Any, own_models: Path, manifest: Manifest) -> None:
    data = encode(map_of(random_codes(4), manifest.model_id))
    with start(models_dir=own_models) as service:
        assert service.put("/maps/yard", content=data).status_code == 201
        shutil.rmtree(own_models / "tiny")
        newer = write_eigenvalue_model(own_models, "tiny", step=0.05)
        response = service.post("/models/reload")
        assert response.json() == {
            "model_id": newer.model_id,
            "models": [newer.model_id, manifest.model_id],
        }
        described = service.post("/describe", json=request_of([cloud(0)])).json()
        assert described["model_id"] == newer.model_id
        # The old map is searched with the old model.
        query = {"model_id": manifest.model_id, "codes": random_codes(1).tolist()}
        assert service.post("/match", json=query).json()["searched"] == ["yard"]
        # And again: nothing changes.
        assert service.post("/models/reload").json() == response.json()


def test_broken_model_is_refused_and_the_old_one_stays_in_use(
    start: Any, own_models: Path, manifest: Manifest
) -> None:
    with start(models_dir=own_models) as service:
        (own_models / "tiny" / "manifest.json").write_text("{")
        response = service.post("/models/reload")
        assert_problem(response, 409, "broken-model", "not a model's manifest")
        assert service.post("/describe", json=request_of([cloud(0)])).json()["model_id"] == (
            manifest.model_id
        )
    onnx = own_models / "onnx"
    with start(models_dir=own_models, model="onnx") as service:
        (onnx / "model.onnx").write_bytes((onnx / "model.onnx").read_bytes()[:-7])
        assert_problem(service.post("/models/reload"), 409, "broken-model", "SHA-256")
        assert service.post("/describe", json=request_of([cloud(0)])).status_code == 200


def test_answer_names_the_model_that_made_it(start: Any, other_manifest: Manifest) -> None:
    with start(also=["other"]) as service:
        response = service.post("/describe", json=request_of([cloud(0)]) | {"model": "other"})
        assert response.headers["placecell-model"] == other_manifest.model_id
        assert response.json()["model_id"] == other_manifest.model_id


def test_map_names_its_model_by_id(service: Any, manifest: Manifest) -> None:
    data = encode(map_of(random_codes(3), manifest.name))
    assert_problem(service.put("/maps/yard", content=data), 409, "other-model")
    assert service.get("/maps/yard").status_code == 404


def test_model_has_its_own_probability_of_a_pose(
    start: Any, own_models: Path, manifest: Manifest, caplog: pytest.LogCaptureFixture
) -> None:
    content = json.loads(SHIPPED.read_text())
    content["model"]["highest"] = 0.75
    file = own_models / manifest.name / NAME
    with start(models_dir=own_models) as service:
        assert service.app.state.placecell.engine.models.default.confidence == shipped()
    content["fitted_on"]["model_id"] = manifest.model_id
    file.write_text(json.dumps(content))
    with start(models_dir=own_models) as service:
        assert service.app.state.placecell.engine.models.default.confidence.highest == 0.75
    assert not caplog.records
    # Of a model that was trained again the old constants say nothing.
    content["fitted_on"]["model_id"] = "tiny-0"
    for text in (json.dumps(content), "[]", "{"):
        file.write_text(text)
        with start(models_dir=own_models) as service:
            assert service.app.state.placecell.engine.models.default.confidence == shipped()
        assert "default model's constants" in caplog.text
        caplog.clear()
