"""Benchmark of large maps, run on a small map."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks.storage import map_writers
from benchmarks.storage.map_writers import MapsPlan
from cli import app
from tests.benchmarks.test_ladder import recorded_from_two_places

pytestmark = [pytest.mark.integration, pytest.mark.slow]

ROW = {
    "segments", "disk_bytes_per_segment", "memory_mb", "match_50_p50_ms", "match_50_p99_ms",
    "recall_at_25_of_exact", "start_cache_s", "start_rebuild_s",
}  # fmt: skip


@pytest.mark.integration
def test_command_writes_a_report_and_a_plot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tiny = MapsPlan(
        (2000,), asked=100, rate=5, upserts=100, upload=500, upload_seconds=0.5, starts=1
    )
    monkeypatch.setattr(map_writers, "MapsPlan", lambda seconds: replace(tiny, seconds=seconds))
    recorded_from_two_places().save(tmp_path / "boxes.safetensors")
    words = ["bench", "maps", "--segments", tmp_path / "boxes.safetensors", "--seconds", 1,
             "--json", tmp_path / "maps.json", "--plot", tmp_path / "maps.png"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "maps.json").read_text())
    assert report["file_bytes_per_segment"] < 48
    (row,) = report["rows"]
    assert row.keys() >= ROW
    assert row["segments"] == 2000
    # The index is exact.
    assert row["recall_at_25_of_exact"] == 1.0
    assert row["upserted_segments_a_second"] > 0
    assert row["uploads_a_second"] > 0
    assert row["peak_mb"] > row["memory_mb_after_writes"]
    assert (tmp_path / "maps.png").read_bytes().startswith(b"\x89PNG")
