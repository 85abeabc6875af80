"""Networks to measure: those of the shipped models, and the network of the SegMap paper."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from placecell.core.parameters import Parameters
from placecell.descriptors.extractor import MODEL_FILE
from placecell.descriptors.manifest import Manifest

PAPER = "paper"


@dataclass(frozen=True, slots=True)
class MeasuredNetwork:
    """An ONNX file to measure.

    Attributes:
        model: name of the model.
        precision: `fp32` or `int8`.
        file: path of the ONNX file.
        served: whether the service runs this file of the model.
        top1: top-1 accuracy on the model's validation groups, from the manifest; None if unknown.
    """

    model: str
    precision: str
    file: Path
    served: bool
    top1: float | None


def networks_of_model(folder: Path) -> Iterator[MeasuredNetwork]:
    """Yield the extractor's networks of a model: `model.onnx`, and variants such as int8."""
    manifest = Manifest.load(folder)
    for name in sorted(manifest.files):
        if name.startswith("model") and name.endswith(".onnx"):
            served = name == MODEL_FILE
            # The manifest states the figures of the served file only.
            top1 = manifest.figures.get("validation", {}).get("top1") if served else None
            yield MeasuredNetwork(
                manifest.name, precision_of(folder / name), folder / name, served, top1
            )


def precision_of(file: Path) -> str:
    """Return `int8` if a network has quantized layers (by the names of its nodes), else `fp32`."""
    return "int8" if b"QuantizeLinear" in file.read_bytes() else "fp32"


def paper_network(
    folder: Path, parameters: Parameters, dimension: int, seed: int
) -> list[MeasuredNetwork]:
    """Export the paper's network with random weights; return an empty list without torch.

    Random weights are as fast as trained weights.

    Args:
        folder: keeps the exported file for later runs.
        parameters: voxel grid of the network's input.
        dimension: dimension of the descriptor.
        seed: random seed of the weights.
    """
    file = folder / f"paper-{dimension}.onnx"
    if not file.exists():
        try:
            import torch
        except ImportError:
            return []
        from training.export.onnx_graph import Exported, export_onnx
        from training.methods.networks import DIMENSION, DescriptorNetwork

        torch.manual_seed(seed)
        mean = np.zeros(parameters.grid, np.float32)
        network = DescriptorNetwork(PAPER, mean, np.ones_like(mean))
        axes = np.eye(DIMENSION, dimension, dtype=np.float32)
        folder.mkdir(parents=True, exist_ok=True)
        unfinished = file.with_suffix(".unfinished")
        exported = Exported(network, np.zeros(DIMENSION, np.float32), axes)
        export_onnx(exported, parameters.grid, unfinished)
        unfinished.replace(file)
    return [MeasuredNetwork(PAPER, "fp32", file, served=True, top1=None)]
