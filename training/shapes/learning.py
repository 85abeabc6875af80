"""Learning of the shape decoder: batches with random map frames and missing columns.

A segment's voxels lie in its box, which is small for most segments. So a batch holds segments with
boxes of similar size, and nearly all voxels that it reads lie in these boxes.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.descriptors.quantizer import Quantizer
from training.methods.fit import fit
from training.methods.processor import has_bfloat16
from training.methods.run import Figures, Run
from training.shapes.data import ShapeData
from training.shapes.network import ENTROPY, ShapeNetwork, shape_loss

THRESHOLDS = np.linspace(-2.5, 2.5, 21)
"""Logits that are tried as threshold of an occupied voxel."""

BLOCK = 16
"""Number of batches whose segments are sorted by the size of their boxes, and divided again."""

CENTER_WEIGHT = 0.3
"""Weight of the error of the grid's center, in meters, beside the loss of the occupancy."""


@dataclass(frozen=True, slots=True)
class AdamW:
    """AdamW on a one-cycle schedule."""

    learning_rate: float = 2e-3
    batch: int = 128
    weight_decay: float = 1e-2

    def start(
        self, model: nn.Module, epochs: int, steps: int
    ) -> tuple[torch.optim.AdamW, torch.optim.lr_scheduler.OneCycleLR]:
        """Return optimizer and schedule for a number of epochs of `steps` steps each."""
        optimizer = torch.optim.AdamW(
            model.parameters(),
            lr=self.learning_rate,
            weight_decay=self.weight_decay,
            fused=True,
        )
        schedule = torch.optim.lr_scheduler.OneCycleLR(
            optimizer, self.learning_rate, epochs=epochs, steps_per_epoch=steps, pct_start=0.15
        )
        return optimizer, schedule


@dataclass(frozen=True, slots=True)
class ShapeRecipe:
    """Recipe of the shape decoder's training; the defaults are those of the shipped decoders."""

    epochs: int = 3
    descent: AdamW = AdamW()
    inside: int = 3000
    """Largest number of voxels of each step in the boxes of its segments, drawn at random."""
    outside: int = 400
    """Largest number of voxels of each step outside of these boxes."""
    without_extents: float = 0.1
    """Share of segments without extents, so that maps without the column can be decoded."""
    without_counts: float = 0.3
    """Share of segments without number of points."""
    entropy_weight: float = ENTROPY
    """Weight of the cross entropy beside the soft intersection over union."""


@dataclass(frozen=True, slots=True)
class ShapeBatch:
    """Inputs of the network, grids and centers of some segments.

    Attributes:
        inputs: arguments of `ShapeNetwork.forward`.
        grids: occupancy of all voxels, 0 or 1, uint8 (n, grid voxels).
        occupied: occupancy of some voxels, 0 or 1, float32 (n, voxels).
        center: vector from the centroid to the grid's center, float32 (n, 3), meters.
        voxels: indices of the voxels, int64 (voxels,); None: all.
        weights: number of voxels of the grid that each of them stands for, float32 (voxels,);
            None: one.
    """

    inputs: tuple[Tensor, ...]
    grids: Tensor
    occupied: Tensor
    center: Tensor
    voxels: Tensor | None
    weights: Tensor | None


def learn_shapes(
    network: ShapeNetwork,
    quantizer: Quantizer,
    training: ShapeData,
    validation: ShapeData,
    run: Run,
    recipe: ShapeRecipe,
) -> None:
    """Train the network in place."""
    steps = max(1, len(training) // recipe.descent.batch)
    count = network.basis.out_features
    reach = training.reach(network.voxel)

    def draw(_: int, random: np.random.Generator) -> Iterator[ShapeBatch]:
        for rows in alike(reach, steps, random):
            voxels = drawn_voxels(reach[rows].max(axis=0), network.grid, recipe, random)
            frames = random.integers(0, training.bearings.shape[1], len(rows))
            hidden = random.random((2, len(rows)))
            missing = hidden[0] < recipe.without_extents, hidden[1] < recipe.without_counts
            yield batch_of(training, quantizer, rows, count, frames, missing, voxels)

    def loss_of(batch: ShapeBatch) -> tuple[Tensor, Figures]:
        with torch.autocast("cpu", torch.bfloat16, enabled=has_bfloat16()):
            logits, center = network.at(batch.voxels, *batch.inputs, occupied=batch.grids)
        loss, overlap = shape_loss(logits, batch.occupied, recipe.entropy_weight, batch.weights)
        away = functional.smooth_l1_loss(center.float(), batch.center, beta=0.1)
        return loss + CENTER_WEIGHT * away, {"overlap": overlap.item()}

    def validate() -> Figures:
        overlaps = overlaps_by_threshold(network, quantizer, validation).mean(axis=0)
        return {"validation_iou": float(overlaps.max())}

    fit(network, run, recipe.descent, recipe.epochs, steps, draw, loss_of, validate)


def alike(reach: Int64, batches: int, random: np.random.Generator) -> Iterator[Int64]:
    """Yield the segments of each batch of an epoch; the boxes of a batch have similar sizes.

    Args:
        reach: voxels from the grid's center to the sides of each box, int64 (n, 3).
        batches: number of batches.
        random: draws the order of the segments and of the batches.
    """
    size = reach[:, :2].max(axis=1) + reach[:, 2] / (reach[:, 2].max() + 1)
    parts = np.array_split(random.permutation(len(reach)), batches)
    for first in range(0, batches, BLOCK):
        block = parts[first : first + BLOCK]
        rows = np.concatenate(block)
        divided = np.array_split(rows[np.argsort(size[rows], kind="stable")], len(block))
        for number in random.permutation(len(block)):
            yield divided[number]


def drawn_voxels(
    reach: Int64, grid: tuple[int, int, int], recipe: ShapeRecipe, random: np.random.Generator
) -> tuple[Int64, Float32]:
    """Return voxels of a step, int64 (voxels,), and how many each stands for, float32 (voxels,).

    Args:
        reach: voxels from the grid's center to the sides of the largest box, int64 (3,).
        grid: number of voxels along x, y, z.
        recipe: numbers of voxels inside and outside of the boxes.
        random: draws the voxels.
    """
    # Distance from the center of the grid to the near side of each voxel.
    x, y, z = (
        np.abs(np.arange(size) - (size - 1) / 2) - 0.5 < steps
        for steps, size in zip(reach, grid, strict=True)
    )
    box = (x[:, None, None] & y[:, None] & z).ravel()
    parts = (np.flatnonzero(box), recipe.inside), (np.flatnonzero(~box), recipe.outside)
    voxels, weights = [], []
    for every, most in parts:
        some = np.sort(random.permutation(every)[:most])
        voxels.append(some)
        weights.append(np.full(len(some), len(every) / max(len(some), 1), np.float32))
    return np.concatenate(voxels), np.concatenate(weights)


def batch_of(
    data: ShapeData,
    quantizer: Quantizer,
    rows: Int64,
    count: int,
    frames: Int64 | None = None,
    missing: tuple[Bool, Bool] | None = None,
    voxels: tuple[Int64, Float32] | None = None,
) -> ShapeBatch:
    """Return the batch of some segments.

    Args:
        data: the segments.
        quantizer: decodes the codes.
        rows: indices of segments, int64 (n,).
        count: number of voxels of a grid.
        frames: map frame of each segment, int64 (n,); None: the first of all.
        missing: segments without extents, and without number of points, bool (n,) each; None: none.
        voxels: voxels and their weights (see `drawn_voxels`); None: all.
    """
    drawn = np.zeros(len(rows), np.int64) if frames is None else frames
    extents = data.extents[rows, drawn].astype(np.float32) / np.float32(10)
    points = data.counts[rows].astype(np.float32)
    if missing is not None:
        extents[missing[0]] = 0
        points[missing[1]] = 0
    occupied = data.occupied(rows, count)
    inputs: tuple[Float32, ...] = (
        quantizer.decode(data.codes[rows]),
        data.offsets[rows],
        data.bearings[rows, drawn],
        extents,
        points,
    )
    chosen, weights = (None, None) if voxels is None else map(torch.from_numpy, voxels)
    every = torch.from_numpy(occupied)
    return ShapeBatch(
        tuple(torch.from_numpy(each) for each in inputs),
        every,
        (every if chosen is None else every[:, chosen]).float(),
        torch.from_numpy(data.centers[rows]),
        chosen,
        weights,
    )


@torch.no_grad()
def overlaps_by_threshold(network: ShapeNetwork, quantizer: Quantizer, data: ShapeData) -> Float64:
    """Return the intersection over union by segment and threshold, float64 (n, thresholds)."""
    network.eval()
    parts = []
    for first in range(0, len(data), 64):
        rows = np.arange(first, min(first + 64, len(data)))
        batch = batch_of(data, quantizer, rows, network.basis.out_features)
        logits = network.at(None, *batch.inputs, occupied=batch.grids)[0].flatten(1).numpy()
        occupied = batch.occupied.numpy() > 0
        columns = []
        for threshold in THRESHOLDS:
            likely = logits >= threshold
            common = (likely & occupied).sum(axis=1)
            columns.append(common / np.maximum((likely | occupied).sum(axis=1), 1))
        parts.append(np.stack(columns, axis=1))
    return np.concatenate(parts)
