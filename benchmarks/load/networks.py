"""Networks whose speed is measured: those of the shipped models, and the paper's."""

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
    """An ONNX file that is measured.

    Attributes:
        model: its name.
        precision: `fp32` or `int8`.
        file: where it lies.
        served: whether the service would run this file, rather than another of the model's.
        top1: of the model on its validation groups, as its manifest has it.
    """

    model: str
    precision: str
    file: Path
    served: bool
    top1: float | None


def networks_of_model(folder: Path) -> Iterator[MeasuredNetwork]:
    """The extractor's networks in a model's folder: `model.onnx` and others, such as in int8."""
    manifest = Manifest.load(folder)
    for name in sorted(manifest.files):
        if name.startswith("model") and name.endswith(".onnx"):
            served = name == MODEL_FILE
            # The manifest's figures are those of the file that is served.
            top1 = manifest.figures.get("validation", {}).get("top1") if served else None
            yield MeasuredNetwork(
                manifest.name, precision_of(folder / name), folder / name, served, top1
            )


def precision_of(file: Path) -> str:
    """`int8` for a network with quantised layers, told by its nodes' names, otherwise `fp32`."""
    return "int8" if b"QuantizeLinear" in file.read_bytes() else "fp32"


def paper_network(
    folder: Path, parameters: Parameters, dimension: int, seed: int
) -> list[MeasuredNetwork]:
    """The paper's network with random weights: as fast as a trained one. Empty without torch."""
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
