"""Feature extraction networks (paper III-B), by name; all methods share them.

Input: occupancy, uint8 (n, 38, 38, 18; see `voxelize`), and extents in meters, float32 (n, 3).
Output: descriptor of length one, float32 (n, 64). The first layer normalizes the
input, so that callers cannot forget it.
"""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import torch
from torch import Tensor, nn

from placecell.core.types import Float32
from placecell.descriptors.voxels import voxelize
from training.data.training_set import TrainingSet
from training.methods.processor import has_bfloat16

DIMENSION = 64
"""Number of dimensions of the descriptor, as in SegMap."""

SMALLEST_DEVIATION = 0.1
"""Lower bound of a voxel's standard deviation, so that rare voxels do not get huge values."""


class Normalization(nn.Module):
    """Normalization of each voxel by the training set's mean and deviation (paper III-A)."""

    mean: Tensor
    scale: Tensor

    def __init__(self, mean: Float32, deviation: Float32) -> None:
        super().__init__()
        self.register_buffer("mean", torch.from_numpy(mean))
        scale = 1 / np.maximum(deviation, SMALLEST_DEVIATION)
        self.register_buffer("scale", torch.from_numpy(scale.astype(np.float32)))

    def forward(self, occupancy: Tensor) -> Tensor:
        """Normalize occupancy, uint8 (n, x, y, z), to float32 of the same shape."""
        normalized: Tensor = (occupancy.float() - self.mean) * self.scale
        return normalized


class Fast(nn.Module):
    """Network of 2D convolutions over x and y, with z as channels; a tenth of the 3D cost."""

    def __init__(self, grid: tuple[int, int, int], widths: tuple[int, ...] = (32, 48, 64, 96)):
        super().__init__()
        layers: list[nn.Module] = []
        channels = grid[2]
        for index, width in enumerate(widths):
            layers += [
                nn.Conv2d(channels, width, 3, padding=1, bias=False),
                nn.BatchNorm2d(width),
                nn.ReLU(inplace=True),
            ]
            if index < 3:
                layers.append(nn.MaxPool2d(2))
            channels = width
        self.layers = nn.Sequential(*layers)
        self.features = channels * (grid[0] // 8) * (grid[1] // 8)

    def forward(self, grids: Tensor) -> Tensor:
        """Return the features, (n, features), of grids, float32 (n, x, y, z)."""
        features: Tensor = self.layers(grids.permute(0, 3, 1, 2))
        return features.flatten(1)


class Paper(nn.Module):
    """Network of 3D convolutions, as in SegMap.

    The paper's figure is not available, so this is the network of its authors' next paper.
    """

    def __init__(
        self, grid: tuple[int, int, int], widths: tuple[int, int, int] = (32, 64, 64)
    ) -> None:
        super().__init__()
        first, second, third = widths
        self.layers = nn.Sequential(
            nn.Conv3d(1, first, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool3d(2),
            nn.Conv3d(first, second, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool3d(2),
            nn.Conv3d(second, third, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.Flatten(),
            nn.Linear(third * (grid[0] // 4) * (grid[1] // 4) * (grid[2] // 4), 512, bias=False),
            nn.BatchNorm1d(512),
            nn.ReLU(inplace=True),
        ).to(memory_format=torch.channels_last_3d)  # type: ignore[call-overload]  # trains faster
        self.features = 512

    def forward(self, grids: Tensor) -> Tensor:
        """Return the features, (n, 512), of grids, float32 (n, x, y, z)."""
        features: Tensor = self.layers(grids.unsqueeze(1))
        return features


class PaperReduced(nn.Module):
    """Reduced network: the same kind of network, thirty times smaller (paper IV-B)."""

    def __init__(self, grid: tuple[int, int, int]) -> None:
        super().__init__()
        self.layers = nn.Sequential(
            nn.MaxPool3d(2),
            nn.Conv3d(1, 8, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.MaxPool3d(2),
            nn.Conv3d(8, 16, 3, padding=1),
            nn.ReLU(inplace=True),
            nn.Flatten(),
            nn.Linear(16 * (grid[0] // 4) * (grid[1] // 4) * (grid[2] // 4), 128, bias=False),
            nn.BatchNorm1d(128),
            nn.ReLU(inplace=True),
        )
        self.features = 128

    def forward(self, grids: Tensor) -> Tensor:
        """Return the features, (n, 128), of grids, float32 (n, x, y, z)."""
        features: Tensor = self.layers(grids.unsqueeze(1))
        return features


WIDE = (32, 64, 128, 192)
"""Channels of the network `wide`. Deeper layers have small maps and cost little."""

NETWORKS: dict[str, Callable[[tuple[int, int, int]], "Fast | Paper | PaperReduced"]] = {
    "fast": Fast,
    "wide": partial(Fast, widths=WIDE),
    "paper": Paper,
    "paper-reduced": PaperReduced,
}


class DescriptorNetwork(nn.Module):
    """Descriptor network: normalization, trunk, dropout and the descriptor's layer."""

    def __init__(
        self, network: str, mean: Float32, deviation: Float32, dropout: float = 0.0
    ) -> None:
        super().__init__()
        if network not in NETWORKS:
            raise ValueError(f"Unknown network {network!r}: expected one of {', '.join(NETWORKS)}.")
        self.normalization = Normalization(mean, deviation)
        self.trunk = NETWORKS[network]((mean.shape[0], mean.shape[1], mean.shape[2]))
        self.dropout = nn.Dropout(dropout)
        self.descriptor = nn.Sequential(
            nn.Linear(self.trunk.features + 3, DIMENSION, bias=False),
            # Keeps descriptors spread over the sphere. If all are close together, the contrastive
            # loss has no gradient that separates them.
            nn.BatchNorm1d(DIMENSION, affine=False),
        )

    def forward(self, occupancy: Tensor, extents: Tensor) -> Tensor:
        """Return descriptors of length one, float32 (n, 64)."""
        # bfloat16 halves the training time on processors with support. Exports are float32.
        mixed = self.training and has_bfloat16()
        with torch.autocast("cpu", torch.bfloat16, enabled=mixed):
            features = self.trunk(self.normalization(occupancy)).float()
        # The extents give the size of segments that the grid cuts; log1p limits that of walls.
        features = torch.cat([self.dropout(features), torch.log1p(extents)], dim=1)
        return nn.functional.normalize(self.descriptor(features), dim=1)


def normalization_statistics(data: TrainingSet) -> tuple[Float32, Float32]:
    """Return mean and standard deviation of each voxel over a training set, float32 (x, y, z)."""
    total, squares = np.zeros(data.parameters.grid), np.zeros(data.parameters.grid)
    for batch in batches(data):
        occupancy = voxelize(batch.segments, data.parameters)[0]
        total += occupancy.sum(axis=0, dtype=np.int64)
        squares += np.square(occupancy).sum(axis=0, dtype=np.int64)
    mean = total / len(data)
    variance = np.maximum(squares / len(data) - np.square(mean), 0)
    return mean.astype(np.float32), np.sqrt(variance).astype(np.float32)


@torch.no_grad()
def describe(network: nn.Module, data: TrainingSet) -> Float32:
    """Describe the unaltered segments of a training set, float32 (segments, dimension)."""
    network.eval()
    parts = []
    for batch in batches(data):
        occupancy, extents = voxelize(batch.segments, data.parameters)
        parts.append(network(torch.from_numpy(occupancy), torch.from_numpy(extents)).numpy())
    return np.concatenate(parts)


def batches(data: TrainingSet, size: int = 256) -> Iterator[TrainingSet]:
    """Yield the training set in parts, in order."""
    for first in range(0, len(data), size):
        yield data.take(np.arange(first, min(first + size, len(data))))
