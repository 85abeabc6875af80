"""The shape of a stored segment over HTTP, and a whole map as a cloud."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from placecell_client import Client, CompactMap, encode
from starlette.testclient import TestClient
from typer.testing import CliRunner

from cli import app
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.app import create_app
from service.core.settings import Settings
from tests.placecell.shapes.shape_builders import map_of, walls
from tests.placecell.sources.clouds.writers import read

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def yard() -> CompactMap:
    return map_of(walls())


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory, yard: CompactMap) -> Iterator[TestClient]:
    settings = Settings(
        data_dir=tmp_path_factory.mktemp("maps"),
        models_dir=MODELS_FOLDER,
        model=DEFAULT_MODEL,
        also=("eigenvalue",),
    )
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
        assert client.put("/maps/yard", content=encode(yard)).is_success
        yield client


def test_shape_lies_at_its_segment(service: TestClient, yard: CompactMap) -> None:
    answer = service.get("/maps/yard/segments/11/shape")
    assert answer.status_code == 200, answer.text
    told = answer.json()
    assert told["id"] == 11
    assert told["bytes"] == 32 + 6 + 3
    assert told["class"] == {"name": "building", "probability": 0.0}
    points = np.array(told["points"])
    assert np.abs(points.mean(axis=0) - yard.centroids[1]).max() < 1.0
    assert answer.headers["ETag"]


def test_client_reads_the_shape(service: TestClient, yard: CompactMap) -> None:
    client = Client("http://127.0.0.1", transport=service._transport)
    shape = client.segment_shape("yard", 10)
    assert shape.points.shape[1] == 3
    assert shape.voxel_m == pytest.approx(0.2)
    assert shape.class_name == "building"
    assert shape.model_id == yard.model_id


def test_unknown_segment_and_model_without_a_decoder_are_told(
    service: TestClient, yard: CompactMap
) -> None:
    missing = service.get("/maps/yard/segments/99/shape")
    assert missing.status_code == 404
    assert missing.json()["type"].endswith("unknown-segment")
    assert service.get("/maps/hall/segments/1/shape").status_code == 404
    assert service.get("/maps/yard/segments/x/shape").status_code == 422


@pytest.mark.parametrize("suffix", ["ply", "png"])
def test_whole_map_is_rendered(tmp_path: Path, yard: CompactMap, suffix: str) -> None:
    source, file = tmp_path / "yard.map", tmp_path / f"yard.{suffix}"
    source.write_bytes(encode(yard))
    result = CliRunner().invoke(app, ["maps", "render", str(source), "-o", str(file)])
    assert result.exit_code == 0, result.output
    assert "4 segments" in result.output
    if suffix == "ply":
        assert len(read(file).points) > 20
    else:
        assert file.read_bytes().startswith(b"\x89PNG")


def test_render_refuses_what_it_cannot_write_or_decode(tmp_path: Path, yard: CompactMap) -> None:
    source = tmp_path / "yard.map"
    source.write_bytes(encode(yard))
    result = CliRunner().invoke(app, ["maps", "render", str(source), "-o", "yard.txt"])
    assert result.exit_code == 1
    assert "unknown format" in result.output
    words = ["maps", "render", str(source), "-o", str(tmp_path / "a.ply"), "--model", "eigenvalue"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 1
    assert "was made by the model" in result.output
