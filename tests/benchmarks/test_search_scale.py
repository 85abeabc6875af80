"""Benchmark of the search by all cores, run on small maps."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks.storage import search_scale
from benchmarks.storage.search_scale import SearchScalePlan, on_one_core
from cli import app
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


def test_one_core_is_for_a_block_only() -> None:
    before = index.CORES, parallel.PARALLEL
    with on_one_core():
        assert index.CORES == 1
        assert not parallel.is_large(1 << 60)
    assert before == (index.CORES, parallel.PARALLEL)
