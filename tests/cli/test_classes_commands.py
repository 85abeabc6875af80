"""Tests of evaluate-segments and train-classes on a short labeled drive."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cli import app
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import MODELS_FOLDER
from town import HDL_64E, Route, Town, write_drive


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    town = Town.build(seed=5, streets=(2, 2))
    route = Route.through(town.plan, town.terrain, [(0, 0), (1, 0), (1, 1)]).cut(40.0, 30.0)
    folder = tmp_path_factory.mktemp("labeled") / "drive"
    lidar = replace(HDL_64E, columns=500)
    return write_drive(folder, town, route, traffic_seed=1, scans=4, lidar=lidar, labels=True)


@pytest.mark.slow
def test_evaluate_segments_of_a_labeled_drive(drive: Path, tmp_path: Path) -> None:
    words = ["evaluate-segments", drive, "--model", "context-town", "--json", tmp_path / "f.json"]
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    figures = json.loads((tmp_path / "f.json").read_text())
    assert figures["accuracy"] > 0.5
    assert "building" in figures["classes_present"]
    assert figures["bytes"]["classes"] == 1


@pytest.mark.slow
def test_labels_of_unknown_classes_are_told(drive: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    shutil.copytree(drive, other)
    for file in (other / "labels").iterdir():
        np.full(file.stat().st_size // 4, 60_000, "<u4").tofile(file)
    words = ["evaluate-segments", str(other), "--training", "none"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert "none of a known class" in result.stderr


@pytest.mark.slow
def test_train_classes_adds_a_head_and_keeps_the_id(drive: Path, tmp_path: Path) -> None:
    folder = tmp_path / "context-town"
    shutil.copytree(MODELS_FOLDER / "context-town", folder)
    words = ["train-classes", folder, drive, "--unlabeled", drive]
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    manifest = Manifest.load(folder)
    assert manifest.model_id == Manifest.load(MODELS_FOLDER / "context-town").model_id
    assert manifest.classes["command"].endswith("--seed 0")
    assert str(drive) not in manifest.classes["command"]


def test_scans_need_a_simulated_drive(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["evaluate-segments", str(tmp_path), "--scans", "3"])
    assert result.exit_code != 0
    assert "needs a simulated drive" in result.output + str(result.stderr)
