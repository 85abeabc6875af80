"""Benchmark of descriptor compression, and synthetic maps."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from placecell_client import decode, encode
from typer.testing import CliRunner

from benchmarks.storage import ladder as ladders
from benchmarks.storage.ladder import draw_compression, measure_compression, storage_formats
from benchmarks.synthetic_maps.descriptor_sampler import VIEWS, DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map
from cli import app
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.shipped_models import BASELINE, DEFAULT_MODEL, MODELS_FOLDER
from placecell.segmentation.recording import Recording
from tests.training_sets import make_shapes

pytestmark = pytest.mark.slow

EIGENVALUE = load_extractor(MODELS_FOLDER / BASELINE)


def recorded(views: int = 200) -> Recording:
    """Return a recording of eight boxes, seen in turn; in its second half, of eight others."""
    shapes = make_shapes(views, seed=3)
    frames = np.tile(np.arange(views), 8)
    return Recording(
        name="boxes",
        parameters=PROTOCOL_V1,
        segments=shapes.segments,
        captures=frames,
        groups=shapes.groups + 8 * (frames >= views // 2),
        distinct=np.ones(len(frames), dtype=bool),
        scans=views,
        scan_hashes=tuple(str(scan) for scan in range(views)),
        path_length=10.0,
    )


def recorded_from_two_places() -> Recording:
    """Return the same recording, seen from two viewpoints 7 m apart in turn."""
    boxes = recorded()
    sensors = boxes.segments.sensors + np.outer(boxes.captures % 2, [0, 7, 0]).astype(np.float32)
    return replace(boxes, segments=replace(boxes.segments, sensors=sensors))


def clouds(count: int, dimension: int = 8, seed: int = 0) -> Float32:
    return np.random.default_rng(seed).normal(size=(count, dimension)).astype(np.float32)


def test_each_storage_format_has_its_stated_size() -> None:
    found = clouds(600)
    asked = np.arange(600) < 100
    steps = {
        name: (size, back)
        for name, size, back in storage_formats(found, asked, ~asked, Quantizer(0.05))
    }
    assert {name: size for name, (size, _) in steps.items()} == {
        "float32": 32, "float16": 16, "255 levels": 8, "15 levels": 4, "4 levels": 2,
        "as shipped": 8, "product, 8 parts": 8,
    }  # fmt: skip
    errors = {name: float(np.abs(back - found[:100]).mean()) for name, (_, back) in steps.items()}
    assert errors["float32"] == 0
    assert 0 < errors["float16"] < errors["255 levels"] < errors["15 levels"] < errors["4 levels"]


def test_report_has_a_row_for_each_storage_format(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ladders, "PRODUCT_BYTES", (7,))
    report = measure_compression(EIGENVALUE, recorded(300), (150, 299))
    assert report["segments"] == 8 * 150
    assert report["fitted_to"] == 8 * 150
    rows = {row["storage"]: row for row in report["rows"]}
    assert rows["as shipped"]["bytes"] == 7
    assert rows["product, 7 parts"]["top1"] == pytest.approx(rows["float32"]["top1"], abs=0.3)
    draw_compression(report, tmp_path / "ladder.png")
    assert (tmp_path / "ladder.png").read_bytes().startswith(b"\x89PNG")


def test_too_few_segments_are_refused() -> None:
    with pytest.raises(ValueError, match="1,000 are needed"):
        measure_compression(EIGENVALUE, recorded(20), (10, 19))


def test_command_prints_and_writes_the_report(tmp_path: Path) -> None:
    recorded(300).save(tmp_path / "boxes.safetensors")
    words = ["bench", "ladder", tmp_path / "boxes.safetensors", "--scans", "150:299",
             "--model", BASELINE, "--json", tmp_path / "ladder.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    assert json.loads((tmp_path / "ladder.json").read_text())["rows"][0]["storage"] == "float32"


def test_sampled_views_differ_like_those_of_one_group() -> None:
    views = DescriptorSampler.from_recording(EIGENVALUE, recorded_from_two_places(), seed=0)
    assert len(views.descriptors) == 16
    assert 700 < len(views.differences) < 900  # half of the pairs
    content = views.sample_map(1000, 50, seed=1)
    assert np.bincount(content.objects).tolist() == [VIEWS] * 250
    assert len(np.unique(content.query_objects)) == 50
    # There are more objects than groups, and no two views are equal.
    assert len(np.unique(content.codes, axis=0)) > 900
    np.testing.assert_array_equal(content.codes, views.sample_map(1000, 50, seed=1).codes)
    with pytest.raises(ValueError, match="5 m apart"):
        DescriptorSampler.from_recording(EIGENVALUE, recorded(), seed=0)


def test_road_map_is_small_and_valid() -> None:
    manifest = load_extractor(MODELS_FOLDER / DEFAULT_MODEL).manifest
    codes = np.zeros((10_000, manifest.code_bytes), np.int8)
    file = encode(road_map(codes, manifest, "ann"))
    assert len(file) / 10_000 < 48
    assert len(decode(file)) == 10_000
