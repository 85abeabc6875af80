"""`placecell calibrate` on recordings and map files."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from placecell_client import encode
from typer.testing import CliRunner, Result

from cli import app
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.descriptors.manifest import Manifest, ModelError
from placecell.descriptors.site_calibration import SiteConstants
from placecell.segmentation.recording import Recording
from tests.service.service_builders import map_of, random_codes, write_eigenvalue_model


def run(*words: object, status: int = 0) -> Result:
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == status, result.output
    return result


OBJECTS, VIEWS = 70, 3
SITE = SiteConstants(slope=2.0, offset=-3.0, mean=1.0, deviation=0.2)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    write_eigenvalue_model(tmp_path, pair_threshold=0.5)
    manifest = Manifest.load(tmp_path / "tiny")
    pair = {"kind": "distance", "threshold": 0.5, "site": SITE.as_dict()}
    replace(manifest, pair=pair).save(tmp_path / "tiny")
    return tmp_path / "tiny"


@pytest.fixture
def drive(tmp_path: Path) -> Path:
    """Recording in which each capture sees each object, with a little noise."""
    random = np.random.default_rng(0)
    shapes = [random.normal(size=(120, 3)) * random.uniform(0.1, 2.0, 3) for _ in range(OBJECTS)]
    clouds, groups, captures = [], [], []
    for view in range(VIEWS):
        for number, shape in enumerate(shapes):
            noise = random.normal(size=shape.shape) * 0.03
            clouds.append((shape + noise + [4.0 * number, 0.0, 0.0]).astype(np.float32))
            groups.append(number)
            captures.append(view)
    sensors = np.array(captures)[:, None] * [1.0, 0.0, 0.0] + [0.0, 5.0, 0.0]
    recording = Recording(
        name="lane",
        parameters=PROTOCOL_V1,
        segments=Segments.of(clouds, sensors),
        captures=np.array(captures),
        groups=np.array(groups),
        distinct=np.ones(len(groups), dtype=bool),
        scans=VIEWS,
        scan_hashes=("a", "b", "c"),
        path_length=2.0,
    )
    recording.save(tmp_path / "lane.safetensors")
    return tmp_path / "lane.safetensors"


def test_calibration_of_a_drive_becomes_that_of_the_model(
    model: Path, drive: Path, tmp_path: Path
) -> None:
    file = model / "calibration.json"
    result = run("calibrate", drive, "--model", model, "-o", file, "--json", tmp_path / "told.json")
    assert "calibrated" in result.output
    content = json.loads(file.read_text())
    assert content == json.loads((tmp_path / "told.json").read_text())
    (site,) = content["sites"]
    assert site["calibration"]["state"] == "calibrated"
    assert set(site["reliability"]) == {"before", "after"}
    assert content["site"]["slope"] == pytest.approx(2.0 * site["calibration"]["scale"])
    assert Manifest.load(model).pair["site"] == content["site"]
    file.write_text(json.dumps(content | {"model_id": "other-0"}))
    with pytest.raises(ModelError, match="made for model other-0"):
        Manifest.load(model)
    file.write_text("{}")
    with pytest.raises(ModelError, match="not a calibration file"):
        Manifest.load(model)


def test_calibration_of_a_map_file_has_no_labels(model: Path, tmp_path: Path) -> None:
    manifest = Manifest.load(model)
    content = map_of(random_codes(30), manifest.model_id)
    (tmp_path / "yard.map").write_bytes(encode(content))
    run("calibrate", tmp_path / "yard.map", "--model", model, "--json", tmp_path / "told.json")
    told = json.loads((tmp_path / "told.json").read_text())
    (site,) = told["sites"]
    assert (site["name"], site["reliability"]) == ("yard", None)
    assert site["calibration"]["state"] == "collecting"
    # One capture saw all segments: nothing but the normalization is the site's own.
    assert (told["site"]["slope"], told["site"]["offset"]) == (SITE.slope, SITE.offset)
    other = encode(map_of(random_codes(30), "other-0"))
    (tmp_path / "yard.map").write_bytes(other)
    result = run("calibrate", tmp_path / "yard.map", "--model", model, status=1)
    assert "was made by model other-0" in result.output


def test_fit_writes_the_constants_of_the_manifest(model: Path, drive: Path) -> None:
    before = Manifest.load(model)
    run("calibrate", drive, "--model", model, "--fit")
    after = Manifest.load(model)
    assert after.pair["site"] != before.pair["site"]
    assert after.pair["site"]["slope"] > 0
    assert after.model_id == before.model_id


def test_model_without_constants_says_how_to_add_them(model: Path, drive: Path) -> None:
    replace(Manifest.load(model), pair={}).save(model)
    result = run("calibrate", drive, "--model", model, status=1)
    assert "--fit" in result.output
    refused = run("calibrate", drive, "--model", model, "--fit", status=1)
    assert "Site constants replace" in refused.output
