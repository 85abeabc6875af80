import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.descriptors.manifest import (
    PAIR_FILE,
    Manifest,
    ModelError,
    file_hash,
    preprocessing_of,
)
from placecell.descriptors.quantizer import Quantizer

MANIFEST = Manifest(
    name="toy",
    method="group",
    network="narrow",
    dimension=4,
    quantizer=Quantizer(step=0.01),
    preprocessing=preprocessing_of(PROTOCOL_V1),
    pair_threshold=0.7,
    training={"drives": ["a"], "seed": 3},
    figures={"top1": 0.5},
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "model.onnx").write_bytes(b"a network")
    MANIFEST.with_files(tmp_path, ["model.onnx"]).save(tmp_path)
    return tmp_path


def alter(folder: Path, **changes: object) -> None:
    file = folder / "manifest.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | changes))


def test_round_trip(folder: Path) -> None:
    loaded = Manifest.load(folder)
    assert loaded == MANIFEST.with_files(folder, ["model.onnx"])
    assert loaded.files == {
        # sha256sum of "a network"
        "model.onnx": file_hash(folder / "model.onnx")
    }
    assert json.loads((folder / "manifest.json").read_text())["model_id"] == loaded.model_id


def test_file_hash_is_sha_256(tmp_path: Path) -> None:
    (tmp_path / "abc").write_bytes(b"abc")
    published = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert file_hash(tmp_path / "abc") == published


def test_id_begins_with_the_name() -> None:
    name, _, digits = MANIFEST.model_id.rpartition("-")
    assert name == "toy"
    assert len(digits) == 16
    assert int(digits, 16) >= 0


@pytest.mark.parametrize(
    "change",
    [
        {"name": "other"},
        {"method": "siamese"},
        {"dimension": 5},
        {"quantizer": Quantizer(step=0.02)},
        {"preprocessing": preprocessing_of(Parameters(grid_voxel=0.25))},
        {"preprocessing": preprocessing_of(Parameters(grid=(38, 38, 20)))},
        {"preprocessing": preprocessing_of(PROTOCOL_V1) | {"version": "2"}},
        {"preprocessing": preprocessing_of(Parameters(voxel_parts=2))},
        {"files": {"model.onnx": "0" * 64}},
        {"standardization": {"mean": [1.0], "deviation": [2.0]}},
    ],
)
def test_id_changes_with_everything_that_determines_descriptors(change: dict[str, Any]) -> None:
    assert replace(MANIFEST, **change).model_id != MANIFEST.model_id


@pytest.mark.parametrize(
    "change",
    [
        {"figures": {"top1": 0.9}},
        {"training": {"seed": 4}},
        {"pair_threshold": 0.8},
        {"files": {PAIR_FILE: "0" * 64}},
    ],
)
def test_id_ignores_measured_figures(change: dict[str, Any]) -> None:
    assert replace(MANIFEST, **change).model_id == MANIFEST.model_id


def test_id_does_not_depend_on_the_order_of_files() -> None:
    one = replace(MANIFEST, files={"a": "1", "b": "2"})
    other = replace(MANIFEST, files={"b": "2", "a": "1"})
    assert one.model_id == other.model_id


def test_id_survives_the_file(folder: Path) -> None:
    # A float that JSON wrote otherwise would make another id.
    awkward = replace(MANIFEST, quantizer=Quantizer(step=0.1 + 0.2), files={})
    awkward.save(folder)
    assert Manifest.load(folder).model_id == awkward.model_id


def test_altered_file_is_refused(folder: Path) -> None:
    (folder / "model.onnx").write_bytes(b"another network")
    with pytest.raises(ModelError, match=r"model\.onnx: its SHA-256"):
        Manifest.load(folder)


def test_missing_file_is_refused(folder: Path) -> None:
    (folder / "model.onnx").unlink()
    with pytest.raises(ModelError, match=r"model\.onnx: missing"):
        Manifest.load(folder)


def test_file_outside_the_folder_is_refused(folder: Path) -> None:
    outside = folder.parent / "outside.onnx"
    outside.write_bytes(b"x")
    alter(folder, files={"../outside.onnx": file_hash(outside)})
    with pytest.raises(ModelError, match=r"outside\.onnx: missing"):
        Manifest.load(folder)


def test_altered_manifest_is_refused(folder: Path) -> None:
    alter(folder, dimension=8)
    with pytest.raises(ModelError, match=r"manifest\.json: states the id toy-"):
        Manifest.load(folder)


def test_halved_voxels_survive_the_file(folder: Path) -> None:
    halved = Parameters(voxel_parts=2)
    replace(MANIFEST, preprocessing=preprocessing_of(halved), files={}).save(folder)
    loaded = Manifest.load(folder)
    assert loaded.parameters.voxel_parts == 2
    # Earlier versions of Placecell refuse the model, because they would compute other inputs.
    assert loaded.preprocessing["version"] == "2"


@pytest.mark.parametrize("parts", [3, None, "2"])
def test_unknown_parts_of_a_voxel_are_refused(folder: Path, parts: object) -> None:
    unknown = preprocessing_of(PROTOCOL_V1) | {"voxel_parts": parts}
    replace(MANIFEST, preprocessing=unknown, files={}).save(folder)
    with pytest.raises(ModelError, match="preprocessing version"):
        Manifest.load(folder)


def test_other_preprocessing_version_is_refused(folder: Path) -> None:
    old = replace(MANIFEST, preprocessing=preprocessing_of(PROTOCOL_V1) | {"version": "0"})
    old.save(folder)
    with pytest.raises(ModelError, match=r"manifest\.json: made for preprocessing version 0"):
        Manifest.load(folder)


def test_folder_without_manifest(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"manifest\.json: missing"):
        Manifest.load(tmp_path)


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", '"text"', "3", "{}", '{"model_id": "x"}', "\x00"]
)
def test_other_json_as_manifest_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(ModelError, match=r"manifest\.json: not a model's manifest"):
        Manifest.load(tmp_path)


def test_manifest_with_an_unknown_field(folder: Path) -> None:
    alter(folder, color="red")
    with pytest.raises(ModelError, match=r"manifest\.json: not a model's manifest .*color"):
        Manifest.load(folder)


def test_parameters_are_protocol_v1_with_the_models_grid() -> None:
    smaller = replace(MANIFEST, preprocessing=preprocessing_of(Parameters(grid=(20, 20, 10))))
    assert smaller.parameters == Parameters(grid=(20, 20, 10))
