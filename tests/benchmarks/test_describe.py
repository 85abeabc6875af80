import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from benchmarks.load.describe import (
    DescribePlan,
    draw_accuracy_speed,
    measure_inference,
    rate_ratio,
)
from benchmarks.load.networks import networks_of_model, paper_network, precision_of
from benchmarks.scans import draw_scans
from cli import app
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER, shipped_models
from tests.placecell.segment_builders import many_segments

pytestmark = pytest.mark.slow

TINY = DescribePlan(batches=(1, 2), threads=(1, 2), repeats=1, seconds=0.0, segments=6, latencies=3)
SOME = [many_segments([20, 300, 80]), many_segments([50])]


@pytest.fixture(scope="module")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("bench")


@pytest.fixture(scope="module")
def report(workbench: Path) -> dict[str, Any]:
    return measure_inference(SOME, workbench, TINY, seed=3)


def test_report_has_the_documented_keys(report: dict[str, Any]) -> None:
    assert set(report) >= {
        *("rows", "points_in_descriptors_out_segments_per_second", "default_over_paper"),
        *("preprocessing_segments_per_second", "single_segment_ms", "machine", "seed", "sizes"),
    }
    assert report["seed"] == 3
    assert report["sizes"]["segments"] >= 6
    assert set(report["preprocessing_segments_per_second"]) == {"1", "2"}
    json.dumps(report)


def test_every_network_has_a_row_for_every_batch_and_number_of_threads(
    report: dict[str, Any],
) -> None:
    rows = report["rows"]
    keys = [(row["model"], row["precision"], row["batch"], row["threads"]) for row in rows]
    assert len(keys) == len(set(keys))
    assert {"paper", DEFAULT_MODEL} <= {row["model"] for row in rows}
    for model in {row["model"] for row in rows}:
        assert {key[2:] for key in keys if key[0] == model} == {(1, 1), (1, 2), (2, 1), (2, 2)}


def test_all_figures_are_positive(report: dict[str, Any]) -> None:
    figures = [
        *(row["segments_per_second"] for row in report["rows"]),
        report["points_in_descriptors_out_segments_per_second"],
        *report["preprocessing_segments_per_second"].values(),
        *report["single_segment_ms"].values(),
        report["default_over_paper"],
    ]
    assert all(figure > 0 and math.isfinite(figure) for figure in figures)
    assert report["single_segment_ms"]["p50"] <= report["single_segment_ms"]["p99"]


def test_every_shipped_pair_classifier_is_measured(report: dict[str, Any]) -> None:
    assert {pair["model"] for pair in report["pairs"]} == set(shipped_models())
    for pair in report["pairs"]:
        assert pair["p50_ms"] > 0
        assert pair["bytes"] <= 3_000_000


def test_ratio_is_computed_from_the_rows(report: dict[str, Any]) -> None:
    rates = {
        row["model"]: row["segments_per_second"]
        for row in report["rows"]
        if (row["batch"], row["threads"], row["served"]) == (2, 2, True)
    }
    by_hand = rates[DEFAULT_MODEL] / rates["paper"]
    assert report["default_over_paper"] == pytest.approx(by_hand, abs=0.01)


def test_accuracy_comes_from_the_manifest(report: dict[str, Any]) -> None:
    top1 = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL).figures["validation"]["top1"]
    shown = {row["model"]: row["top1"] for row in report["rows"] if row["served"]}
    assert shown[DEFAULT_MODEL] == top1


def test_without_torch_there_is_no_ratio(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "torch", None)
    assert paper_network(tmp_path, PROTOCOL_V1, 32, seed=0) == []
    row = {"model": "group", "served": True, "batch": 1, "threads": 1, "segments_per_second": 9.0}
    assert rate_ratio([row], "group", 1, 1) is None


def test_exported_network_of_the_paper_needs_no_torch(
    report: dict[str, Any], workbench: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "torch", None)
    dimension = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL).dimension
    (network,) = paper_network(workbench, PROTOCOL_V1, dimension, seed=3)
    # The first dense layer of SegMap has 10.6 of its 10.8 million weights.
    assert network.file.stat().st_size > 4 * 10_600_000


def test_quantized_network_beside_the_served_one_is_not_served(tmp_path: Path) -> None:
    served = (MODELS_FOLDER / "group" / "model.onnx").read_bytes()
    (tmp_path / "model.onnx").write_bytes(served)
    (tmp_path / "model-int8.onnx").write_bytes(b"...QuantizeLinear...")
    manifest = Manifest.load(MODELS_FOLDER / "group")
    manifest.with_files(tmp_path, ["model.onnx", "model-int8.onnx"]).save(tmp_path)

    found = {network.file.name: network for network in networks_of_model(tmp_path)}

    assert precision_of(tmp_path / "model.onnx") == "fp32"
    assert found["model.onnx"].served
    assert found["model-int8.onnx"].precision == "int8"
    assert not found["model-int8.onnx"].served
    assert found["model-int8.onnx"].top1 is None


def test_plot_is_a_png(report: dict[str, Any], tmp_path: Path) -> None:
    draw_accuracy_speed(report, tmp_path / "new" / "speed.png")
    assert (tmp_path / "new" / "speed.png").read_bytes().startswith(b"\x89PNG")


def test_scans_without_segments_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no segment"):
        measure_inference([Segments.of([], np.zeros((0, 3)))], tmp_path, TINY)


def test_whole_scans_are_drawn_and_repeated_if_too_few() -> None:
    drawn = draw_scans(SOME, 9, seed=0)
    assert sum(map(len, drawn[:-1])) < 9 <= sum(map(len, drawn))
    assert {len(scan) for scan in drawn} == {1, 3}


def test_command_takes_segments_from_the_town(
    workbench: Path, report: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchmarks import scans
    from benchmarks.load import describe

    shorter = scans.town_recording
    monkeypatch.setattr(
        scans, "town_recording", lambda folder, seed, show, _: shorter(folder, seed, show, 3)
    )
    monkeypatch.setattr(describe, "DescribePlan", lambda repeats, seconds: TINY)
    file = workbench / "figures.json"
    words = ["bench", "describe", "--json", file, "--output", workbench, "--seconds", 0]
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    assert "times as fast as the paper's network" in result.output
    assert json.loads(file.read_text())["source"] == "synthetic town"


def test_command_names_a_missing_file_of_segments() -> None:
    result = CliRunner().invoke(app, ["bench", "describe", "--segments", "nowhere"])
    assert result.exit_code == 1
    assert "nowhere" in result.output


def test_help_names_the_options() -> None:
    result = CliRunner().invoke(app, ["bench", "describe", "--help"])
    assert result.exit_code == 0
    assert "--segments" in result.output
