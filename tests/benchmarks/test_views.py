"""Benchmark of stored views, on boxes that are seen from all sides."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.storage.views import measure_views
from cli import app
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.shipped_models import BASELINE, MODELS_FOLDER
from placecell.segmentation.recording import Recording
from tests.benchmarks.test_ladder import recorded

EIGENVALUE = load_extractor(MODELS_FOLDER / BASELINE)


def driven_past(views: int) -> Recording:
    """Recording of the boxes, from viewpoints 3 m apart."""
    recording = recorded(views)
    sensors = (
        recording.segments.sensors + np.array([3, 0, 0], np.float32) * recording.captures[:, None]
    )
    segments = replace(recording.segments, sensors=sensors.astype(np.float32))
    return replace(recording, segments=segments)


def test_more_views_have_more_segments_and_no_less_recall() -> None:
    report = measure_views(EIGENVALUE, driven_past(40), (0, 39), seed=0)
    every, *rest = report["rows"]
    assert every["segments"] == 320
    differing = [row for row in rest if row["kept"] == "views that differ"]
    sizes = [row["segments"] for row in differing]
    assert sizes == sorted(sizes)
    # A box of each half of the drive stands in the same place.
    assert sizes[0] < 320
    for one, drawn in zip(differing, rest[1::2], strict=True):
        assert (drawn["segments"], drawn["views"]) == (one["segments"], one["views"])
        assert 0 <= one["cross_view_top1"] <= one["cross_view_recall_at_25"] <= 1
    assert differing[-1]["cross_view_recall_at_25"] >= differing[0]["cross_view_recall_at_25"]


def test_recording_without_distant_mates_is_refused() -> None:
    with pytest.raises(ValueError, match="no segment has a mate"):
        measure_views(EIGENVALUE, recorded(2), (0, 0), seed=0)


def test_command_prints_and_writes_the_report(tmp_path: Path) -> None:
    driven_past(40).save(tmp_path / "boxes.safetensors")
    words = ["bench", "views", tmp_path / "boxes.safetensors", "--scans", "0:39",
             "--model", BASELINE, "--json", tmp_path / "views.json"]  # fmt: skip
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "views.json").read_text())
    assert np.isin([1, 8], [row["views"] for row in report["rows"]]).all()
