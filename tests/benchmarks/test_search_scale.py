"""Benchmark of the search by all cores, run on small maps."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks.storage import search_scale
from benchmarks.storage.cold_maps import ColdMapsPlan, measure_cold_maps
from benchmarks.storage.search_scale import SearchScalePlan, on_one_core
from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from cli import app
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.core.metrics import Metrics
from service.core.settings import Settings
from service.inference.model_registry import Models
from service.maps import index
from service.search import parallel
from tests.benchmarks.test_ladder import recorded_from_two_places


@pytest.mark.slow
def test_command_measures_one_map_and_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tiny = SearchScalePlan(map_segments=(0, 500), queries=(1, 8), repeats=1)
    monkeypatch.setattr(
        search_scale, "SearchScalePlan", lambda sizes, repeats: replace(tiny, sizes=sizes)
    )
    monkeypatch.setattr(parallel, "PARALLEL", 1)
    recorded_from_two_places().save(tmp_path / "boxes.safetensors")
    words = ["bench", "search", "--segments", tmp_path / "boxes.safetensors", "--size", 2000,
             "--repeats", 1, "--json", tmp_path / "search.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "search.json").read_text())
    one, many = report["rows"]
    assert (one["maps"], many["maps"]) == (1, 4)
    for row in (one, many):
        assert row["segments"] == 2000
        assert row["equal_1_queries"]
        assert row["equal_8_queries"]
        assert row["ms_8_queries"] > 0
    assert report["code_bytes"] == 32


@pytest.mark.integration
@pytest.mark.slow
def test_cold_maps_are_measured_beside_a_service_that_holds_all() -> None:
    model = Models(Settings.model_validate({}), Metrics()).default
    sampler = DescriptorSampler.from_recording(
        load_extractor(MODELS_FOLDER / DEFAULT_MODEL), recorded_from_two_places(), seed=1
    )
    plan = ColdMapsPlan(sizes=(1000,), maps=2, rounds=1, queries=3)
    (row,) = measure_cold_maps(sampler, model.manifest, plan)["rows"]
    assert (row["segments"], row["maps"]) == (1000, 2)
    assert 0 < row["later_ms"] <= row["first_max_ms"]
    assert min(row["without_maps_mb"], row["all_loaded_mb"], row["one_loaded_mb"]) > 50


def test_one_core_is_for_a_block_only() -> None:
    before = index.CORES, parallel.PARALLEL
    with on_one_core():
        assert index.CORES == 1
        assert not parallel.is_large(1 << 60)
    assert before == (index.CORES, parallel.PARALLEL)
