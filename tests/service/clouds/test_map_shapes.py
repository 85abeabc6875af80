"""The shape of a stored segment over HTTP, and a whole map as a cloud."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from placecell_client import Client, CompactMap, encode
from starlette.testclient import TestClient
from typer.testing import CliRunner

from benchmarks.synthetic_maps.road_map import road_map
from cli import app
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.app import create_app
from service.core.settings import Settings
from tests.placecell.shapes.shape_builders import map_of, walls
from tests.placecell.sources.clouds.writers import read

pytestmark = pytest.mark.slow

JSON = {"Accept": "application/json"}


@pytest.fixture(scope="module")
def yard() -> CompactMap:
    return map_of(walls())


@pytest.fixture(scope="module")
def plain() -> CompactMap:
    manifest = Manifest.load(MODELS_FOLDER / "eigenvalue")
    codes = np.random.default_rng(1).integers(-128, 128, (5, manifest.code_bytes), np.int8)
    return road_map(codes, manifest, "bench")


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


def test_shapes_of_several_segments_are_those_of_each(service: TestClient) -> None:
    answer = service.get("/maps/yard/shapes?id=12&id=10&id=99&id=12")
    assert answer.status_code == 200, answer.text
    told = answer.json()
    assert told["missing"] == [99]
    assert [each["id"] for each in told["shapes"]] == [10, 12]
    alone = [service.get(f"/maps/yard/segments/{one}/shape").json() for one in (10, 12)]
    assert told["shapes"] == alone
    assert alone[0]["points"] != alone[1]["points"]
    assert service.get("/maps/yard/shapes?id=99").json() == {
        "map": "yard",
        "shapes": [],
        "missing": [99],
    }


def test_client_reads_several_shapes(service: TestClient) -> None:
    client = Client("http://127.0.0.1", transport=service._transport)
    shapes = client.segment_shapes("yard", [13, 99, 11])
    assert [each.id for each in shapes] == [11, 13]
    np.testing.assert_array_equal(shapes[0].points, client.segment_shape("yard", 11).points)


@pytest.mark.parametrize(
    "query", ["", "id=x", "id=-1", "id=4294967296", "&".join(f"id={one}" for one in range(101))]
)
def test_no_ids_bad_ids_and_too_many_are_refused(service: TestClient, query: str) -> None:
    assert service.get(f"/maps/yard/shapes?{query}").status_code == 422


def test_map_says_whether_its_shapes_can_be_decoded(service: TestClient, plain: CompactMap) -> None:
    assert service.get("/maps/yard", headers=JSON).json()["shapes"] is True
    assert service.put("/maps/plain", content=encode(plain)).is_success
    assert service.get("/maps/plain", headers=JSON).json()["shapes"] is False
    refused = service.get("/maps/plain/shapes?id=1")
    assert refused.status_code == 409
    assert refused.json()["type"].endswith("no-shapes")


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
