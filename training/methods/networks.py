"""The feature extraction network (paper III-B): one trunk for all methods, by name.

Input: occupancy, uint8 (n, 38, 38, 18), and extents in metres, float32 (n, 3). Output: the
descriptor, float32 (n, 64), of length one. Normalisation is the first layer, so that nobody can
get it wrong.
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
"""Of the descriptor, as in SegMap."""

SMALLEST_DEVIATION = 0.1
"""A voxel that hardly ever varies in training must not blow up when it does."""


class Normalization(nn.Module):
    """Per-voxel: minus the training set's mean, over its standard deviation (paper III-A)."""

    mean: Tensor
    scale: Tensor

    def __init__(self, mean: Float32, deviation: Float32) -> None:
        super().__init__()
        self.register_buffer("mean", torch.from_numpy(mean))
        scale = 1 / np.maximum(deviation, SMALLEST_DEVIATION)
        self.register_buffer("scale", torch.from_numpy(scale.astype(np.float32)))

    def forward(self, occupancy: Tensor) -> Tensor:
        """uint8 (n, x, y, z) -> float32 of that shape."""
        normalized: Tensor = (occupancy.float() - self.mean) * self.scale
        return normalized


class Fast(nn.Module):
    """2D convolutions over x and y, z as input channels: a tenth of the 3D network's cost."""

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
        """float32 (n, x, y, z) -> (n, features)."""
        features: Tensor = self.layers(grids.permute(0, 3, 1, 2))
        return features.flatten(1)


class Paper(nn.Module):
    """3D convolutions; the paper's figure is lost, so this is its authors' next one, SegMap's."""

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
        """float32 (n, x, y, z) -> (n, 512)."""
        features: Tensor = self.layers(grids.unsqueeze(1))
        return features


class PaperReduced(nn.Module):
    """The paper's way to speed: the same kind of network, thirty times smaller (paper IV-B)."""

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
        """float32 (n, x, y, z) -> (n, 128)."""
        features: Tensor = self.layers(grids.unsqueeze(1))
        return features


WIDE = (32, 64, 128, 192)
"""Channels of `wide`: the deeper layers, whose maps are small, cost little."""

NETWORKS: dict[str, Callable[[tuple[int, int, int]], "Fast | Paper | PaperReduced"]] = {
    "fast": Fast,
    "wide": partial(Fast, widths=WIDE),
    "paper": Paper,
    "paper-reduced": PaperReduced,
}


class DescriptorNetwork(nn.Module):
    """Normalisation, trunk, dropout, and the descriptor's layer."""

    def __init__(
        self, network: str, mean: Float32, deviation: Float32, dropout: float = 0.0
    ) -> None:
        super().__init__()
        if network not in NETWORKS:
            raise ValueError(f"no network {network!r}; there are {', '.join(NETWORKS)}")
        self.normalization = Normalization(mean, deviation)
        self.trunk = NETWORKS[network]((mean.shape[0], mean.shape[1], mean.shape[2]))
        self.dropout = nn.Dropout(dropout)
        self.descriptor = nn.Sequential(
            nn.Linear(self.trunk.features + 3, DIMENSION, bias=False),
            # Keeps descriptors spread over the sphere: where all lie close together the contrastive
            # loss has no gradient to push them apart.
            nn.BatchNorm1d(DIMENSION, affine=False),
        )

    def forward(self, occupancy: Tensor, extents: Tensor) -> Tensor:
        """Descriptors of length one, float32 (n, 64)."""
        # bfloat16 halves a training's time where the processor has it; what is exported is float32.
        mixed = self.training and has_bfloat16()
        with torch.autocast("cpu", torch.bfloat16, enabled=mixed):
            features = self.trunk(self.normalization(occupancy)).float()
        # The extents give back the size of what the grid cut off; log1p keeps walls in scale.
        features = torch.cat([self.dropout(features), torch.log1p(extents)], dim=1)
        return nn.functional.normalize(self.descriptor(features), dim=1)


def normalization_statistics(data: TrainingSet) -> tuple[Float32, Float32]:
    """Mean and standard deviation of each voxel over a training set, float32 (x, y, z) each."""
    total = np.zeros(data.parameters.grid)
    for batch in batches(data):
        total += voxelize(batch.segments, data.parameters)[0].sum(axis=0, dtype=np.int64)
    mean = total / len(data)
    # Of values 0 and 1 the mean says all.
    return mean.astype(np.float32), np.sqrt(mean * (1 - mean)).astype(np.float32)


@torch.no_grad()
def describe(network: nn.Module, data: TrainingSet) -> Float32:
    """Descriptors of a training set's segments as they are, float32 (segments, dimension)."""
    network.eval()
    parts = []
    for batch in batches(data):
        occupancy, extents = voxelize(batch.segments, data.parameters)
        parts.append(network(torch.from_numpy(occupancy), torch.from_numpy(extents)).numpy())
    return np.concatenate(parts)


def batches(data: TrainingSet, size: int = 256) -> Iterator[TrainingSet]:
    """The set in parts, in order."""
    for first in range(0, len(data), size):
        yield data.take(np.arange(first, min(first + size, len(data))))
