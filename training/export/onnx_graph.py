"""Export to ONNX: normalization, network and projection in one graph."""

import warnings
from pathlib import Path

import numpy as np
import onnx
import torch
from torch import Tensor, nn

from placecell.core.types import Float32
from training.methods.context import Projection
from training.methods.networks import DescriptorNetwork

OPSET = 20


class Exported(nn.Module):
    """Graph of the descriptor network and the projection to the stored dimensions."""

    mean: Tensor
    axes: Tensor

    def __init__(self, network: DescriptorNetwork, mean: Float32, axes: Float32) -> None:
        super().__init__()
        self.network = network
        self.register_buffer("mean", torch.from_numpy(mean))
        self.register_buffer("axes", torch.from_numpy(axes))

    def forward(self, occupancy: Tensor, extents: Tensor) -> Tensor:
        """float32 (n, stored dimension)."""
        projected: Tensor = (self.network(occupancy, extents) - self.mean) @ self.axes
        return projected


class ExportedContext(nn.Module):
    """Graph of the context model: projects descriptor and neighborhood, joins and rotates them."""

    mean: Tensor
    axes: Tensor
    center: Tensor
    rotation: Tensor

    def __init__(self, segment: Exported, projection: Projection, rotation: Float32) -> None:
        super().__init__()
        self.segment = segment
        self.register_buffer("mean", torch.from_numpy(projection.mean))
        self.register_buffer("axes", torch.from_numpy(projection.axes))
        self.register_buffer("center", torch.from_numpy(projection.center))
        self.register_buffer("rotation", torch.from_numpy(rotation))
        self.weight = projection.weight

    def forward(self, occupancy: Tensor, extents: Tensor, surroundings: Tensor) -> Tensor:
        """float32 (n, stored dimension)."""
        projected = nn.functional.normalize((surroundings - self.mean) @ self.axes, dim=1)
        projected = projected - self.center
        # Without a neighborhood the segment's own part fills the descriptor. So all descriptors
        # have the same length and lose equally little by quantization.
        seen = (surroundings.sum(dim=1, keepdim=True) > 0).float()
        own = self.segment(occupancy, extents) * (seen + (1 - seen) * (1 + self.weight**2) ** 0.5)
        side_by_side = torch.cat([own, projected * self.weight * seen], dim=1)
        descriptors: Tensor = side_by_side @ self.rotation
        return descriptors


def principal_axes(descriptors: Float32, dimension: int) -> tuple[Float32, Float32]:
    """Return the mean (d,) and the principal axes (d, dimension) of training descriptors."""
    mean = descriptors.mean(axis=0)
    _, _, axes = np.linalg.svd(descriptors - mean, full_matrices=False)
    # The sign of an axis is arbitrary, so its largest entry is made positive.
    signs = np.sign(axes[np.arange(len(axes)), np.abs(axes).argmax(axis=1)])
    chosen = (axes * signs[:, None])[:dimension].T
    return mean.astype(np.float32), np.ascontiguousarray(chosen, dtype=np.float32)


def export_onnx(
    network: Exported | ExportedContext, grid: tuple[int, int, int], file: Path
) -> None:
    """Write a network as ONNX with any batch size.

    The inputs are `occupancy` (uint8), `extents` (float32) and, for the context model,
    `surroundings` (float32).
    """
    example: tuple[Tensor, ...] = (torch.zeros((2, *grid), dtype=torch.uint8), torch.ones((2, 3)))
    inputs = ["occupancy", "extents"]
    if isinstance(network, ExportedContext):
        example += (torch.ones((2, len(network.mean))),)
        inputs.append("surroundings")
    to_onnx(network, example, inputs, ["descriptor"], file)


def to_onnx(
    network: nn.Module,
    example: tuple[Tensor, ...],
    inputs: list[str],
    outputs: list[str],
    file: Path,
) -> None:
    """Write a module as ONNX; the first dimension of every input is the batch, of any size."""
    network.eval()
    batch = torch.export.Dim("batch")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # deprecations inside the exporter
        program = torch.onnx.export(
            network,
            example,
            input_names=inputs,
            output_names=outputs,
            dynamic_shapes=tuple({0: batch} for _ in example),
            opset_version=OPSET,
            dynamo=True,
            external_data=False,
            verbose=False,
        )
    assert program is not None
    model = program.model_proto
    forget_sources(model)
    onnx.save(model, file)


def forget_sources(model: onnx.ModelProto) -> None:
    """Remove the source positions of all nodes, because their paths would change the model's id.

    The rest depends only on the network and its weights.
    """
    for message in (model, model.graph, *model.functions):
        message.ClearField("metadata_props")
        message.ClearField("doc_string")
    parts = [model.graph.node, model.graph.input, model.graph.output, model.graph.value_info]
    for part in (*parts, model.graph.initializer, *(body.node for body in model.functions)):
        for item in part:
            item.ClearField("metadata_props")
            item.ClearField("doc_string")
