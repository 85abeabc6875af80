"""Extractor networks and their export."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import onnxruntime
import pytest
import torch

from placecell.core.parameters import PROTOCOL_V1
from placecell.descriptors.voxels import voxelize
from training.data.training_set import TrainingSet
from training.export.onnx_graph import Exported, export_onnx, principal_axes
from training.methods.networks import (
    NETWORKS,
    SMALLEST_DEVIATION,
    DescriptorNetwork,
    Normalization,
    describe,
    normalization_statistics,
)


def test_normalization_is_per_voxel_and_bounded() -> None:
    mean = np.array([[[0.5, 0.0]]], dtype=np.float32)
    deviation = np.array([[[0.5, 0.0]]], dtype=np.float32)
    layer = Normalization(mean, deviation)
    occupied = layer(torch.ones((1, 1, 1, 2), dtype=torch.uint8)).numpy().ravel()
    empty = layer(torch.zeros((1, 1, 1, 2), dtype=torch.uint8)).numpy().ravel()
    assert occupied.tolist() == pytest.approx([1.0, 1.0 / SMALLEST_DEVIATION])
    assert empty.tolist() == pytest.approx([-1.0, 0.0])


def test_statistics_match_the_training_set(shapes: TrainingSet) -> None:
    mean, deviation = normalization_statistics(shapes)
    occupancy, _ = voxelize(shapes.segments, shapes.parameters)
    assert mean == pytest.approx(occupancy.mean(axis=0), abs=1e-6)
    assert deviation == pytest.approx(occupancy.std(axis=0), abs=1e-6)


def test_statistics_of_halved_voxels_match_the_training_set(shapes: TrainingSet) -> None:
    halved = replace(shapes, parameters=replace(shapes.parameters, voxel_parts=2))
    mean, deviation = normalization_statistics(halved)
    occupancy, _ = voxelize(halved.segments, halved.parameters)
    assert occupancy.max() > 1
    assert mean == pytest.approx(occupancy.mean(axis=0), abs=1e-6)
    assert deviation == pytest.approx(occupancy.std(axis=0), abs=1e-5)


def a_network(name: str, shapes: TrainingSet) -> DescriptorNetwork:
    torch.manual_seed(4)
    network = DescriptorNetwork(name, *normalization_statistics(shapes), dropout=0.3)
    # Running statistics that differ from those of a new network make the comparison strict.
    network.train()
    with torch.no_grad():
        occupancy, extents = voxelize(shapes.segments, shapes.parameters)
        network(torch.from_numpy(occupancy), torch.from_numpy(extents))
    return network.eval()


@pytest.mark.parametrize("name", NETWORKS)
def test_onnx_equals_torch_for_any_batch(name: str, shapes: TrainingSet, tmp_path: Path) -> None:
    network = a_network(name, shapes)
    learned = describe(network, shapes)
    mean, axes = principal_axes(learned, 32)
    exported = Exported(network, mean, axes)
    export_onnx(exported, PROTOCOL_V1.grid, tmp_path / "model.onnx")
    session = onnxruntime.InferenceSession(tmp_path / "model.onnx")
    occupancy, extents = voxelize(shapes.segments, shapes.parameters)
    for count in (1, 3, len(shapes)):
        inputs = {"occupancy": occupancy[:count], "extents": extents[:count]}
        (through_onnx,) = session.run(["descriptor"], inputs)
        with torch.no_grad():
            through_torch = exported(
                torch.from_numpy(occupancy[:count]), torch.from_numpy(extents[:count])
            )
        assert through_onnx == pytest.approx(through_torch.numpy(), abs=1e-4)
        assert through_onnx == pytest.approx((learned[:count] - mean) @ axes, abs=1e-4)
    # Paths of the exporting machine would become part of the model's id.
    assert (
        str(Path(__file__).resolve().parents[2]).encode()
        not in (tmp_path / "model.onnx").read_bytes()
    )
    types = {given.name: given.type for given in session.get_inputs()}
    assert types == {"occupancy": "tensor(uint8)", "extents": "tensor(float)"}


def test_descriptors_have_length_one(shapes: TrainingSet) -> None:
    learned = describe(a_network("fast", shapes), shapes)
    assert np.linalg.norm(learned, axis=1) == pytest.approx(1.0, abs=1e-5)


def test_principal_axes_keep_distances_within_their_span() -> None:
    random = np.random.default_rng(0)
    flat = random.normal(size=(50, 3)) @ random.normal(size=(3, 64))
    mean, axes = principal_axes(flat.astype(np.float32), 3)
    projected = (flat - mean) @ axes
    assert axes.T @ axes == pytest.approx(np.eye(3), abs=1e-5)
    assert np.linalg.norm(projected[0] - projected[1]) == pytest.approx(
        np.linalg.norm(flat[0] - flat[1]), rel=1e-4
    )
