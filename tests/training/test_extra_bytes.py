"""Study of further bytes of a segment: the encoder, and a short training."""

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from typer.testing import CliRunner

from cli import app
from evaluation.segments.shapes import overlap
from placecell.descriptors.extractor import load_extractor
from tests.placecell.segment_builders import one_scan_recording
from tests.placecell.shapes.shape_builders import FOLDER, walls
from training.shapes.extra_bytes import (
    MeasuredDrive,
    decoded,
    drive_figures,
)
from training.shapes.network import ExtraEncoder, ShapeNetwork
from training.shapes.publishing import own_part

GRID = (6, 5, 3)


def random_grids(count: int) -> torch.Tensor:
    return torch.randint(0, 2, (count, 90), dtype=torch.uint8)


def test_encoder_stores_each_value_in_four_bits() -> None:
    torch.manual_seed(0)
    values = ExtraEncoder(8, GRID, 4)(random_grids(50), torch.zeros(50, 4))
    assert values.shape == (50, 16)
    numbers = (values.detach().numpy() + 1) * 7.5
    np.testing.assert_allclose(numbers, np.round(numbers), atol=1e-5)
    assert numbers.min() >= 0
    assert numbers.max() <= 15
    assert len(np.unique(np.round(numbers))) > 1


def test_gradient_passes_the_rounding_to_all_layers() -> None:
    torch.manual_seed(0)
    encoder = ExtraEncoder(1, GRID, 4)
    encoder(random_grids(20), torch.ones(20, 4)).square().sum().backward()
    for name, parameter in encoder.named_parameters():
        assert parameter.grad is not None, name
        assert parameter.grad.abs().sum() > 0, name


def test_every_voxel_reaches_the_further_bytes() -> None:
    torch.manual_seed(0)
    occupied = random_grids(20).float().requires_grad_()
    ExtraEncoder(1, GRID, 1)(occupied, torch.zeros(20, 1)).square().sum().backward()
    assert occupied.grad is not None
    assert (occupied.grad.abs().sum(dim=0) > 0).all()


def test_network_without_an_encoder_ignores_the_true_grid() -> None:
    extractor = load_extractor(FOLDER)
    parameters = extractor.manifest.parameters
    drive = MeasuredDrive.drawn(one_scan_recording(walls(), "walls"), extractor, 0)
    torch.manual_seed(0)
    network = ShapeNetwork(
        own_part(FOLDER, extractor.manifest), parameters.grid, parameters.grid_voxel
    )
    grids, centers = decoded(network, drive.data, extractor, -10.0)
    assert grids.shape == drive.known.grids.shape
    assert centers.shape == (4, 3)
    figures = drive_figures(network, drive, extractor, -10.0)
    assert figures["iou"] == pytest.approx(overlap(grids, drive.known.grids).mean(), abs=1e-4)
    assert figures["chamfer_m"] > 0


@pytest.mark.slow
def test_command_reports_each_number_of_bytes_on_each_drive(tmp_path: Path) -> None:
    files = [tmp_path / "known.safetensors", tmp_path / "other.safetensors"]
    for count, file in zip((12, 5), files, strict=True):
        one_scan_recording(walls(count, seed=count), file.stem).save(file)
    report = tmp_path / "report.json"
    called = ["bench", "shape-bytes", str(files[0]), "--measure", str(files[1])]
    called += ["--extra-bytes", "0", "--extra-bytes", "8", "--epochs", "1", "--json", str(report)]
    result = CliRunner().invoke(app, called)
    assert result.exit_code == 0, result.output
    content = json.loads(report.read_text())
    assert [row["extra_bytes"] for row in content["rows"]] == [0, 8]
    assert content["segments"] == 12
    assert content["baseline"]["other"]["segments"] == 5
    for row in content["rows"]:
        assert row["drives"]["other"]["segments"] == 5
        assert 0 <= row["drives"]["other"]["iou"] <= 1
