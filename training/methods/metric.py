"""Metric learning: losses on the distances within a batch, beside the group-based loss.

A batch holds several segments of each of its groups, so that it has matches. The losses come from
pytorch-metric-learning and have the names of their papers.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import torch
from torch import nn

from evaluation.recognition.retrieval import top1
from placecell.core.types import Bool, Int64
from training.data.augmentation import Augmentation
from training.data.training_set import TrainingSet
from training.methods.fit import BatchLoss, Sgd, fit
from training.methods.group_based import LabeledBatch
from training.methods.networks import (
    DIMENSION,
    DescriptorNetwork,
    describe,
    normalization_statistics,
)
from training.methods.run import Figures, Run

GROUPS, VIEWS = 32, 4
"""Number of groups in a batch, and number of segments of each group."""


class HardTriplets(nn.Module):
    """Triplet loss on the farthest match and the nearest non-match of each segment in a batch."""

    def __init__(self) -> None:
        super().__init__()
        from pytorch_metric_learning.losses import TripletMarginLoss
        from pytorch_metric_learning.miners import BatchHardMiner

        self.loss, self.miner = TripletMarginLoss(margin=0.2), BatchHardMiner()

    def forward(self, descriptors: torch.Tensor, labels: torch.Tensor) -> torch.Tensor:
        """Return the mean loss over the batch."""
        loss: torch.Tensor = self.loss(descriptors, labels, self.miner(descriptors, labels))
        return loss


def losses(groups: int) -> dict[str, Callable[[], nn.Module]]:
    """Return functions that create the losses, by name.

    Args:
        groups: number of groups in the training set, for losses with one vector per group.
    """
    from pytorch_metric_learning import losses as library

    return {
        "cosine-margin": lambda: library.CosFaceLoss(groups, DIMENSION, margin=0.1, scale=16),
        "supervised-contrastive": lambda: library.SupConLoss(temperature=0.1),
        "multi-similarity": library.MultiSimilarityLoss,
        "hard-triplets": HardTriplets,
        "smooth-ap": lambda: library.SmoothAPLoss(temperature=0.01),
    }


LOSSES = tuple(losses(1))


@dataclass(frozen=True, slots=True)
class MetricRecipe:
    """Recipe of the metric training."""

    loss: str
    """Name of the loss, one of `LOSSES`."""
    epochs: int = 30
    sgd: Sgd = field(default_factory=lambda: Sgd(learning_rate=0.2))
    dropout: float = 0.2
    recorded_share: float = 0.5
    """Share of a batch's groups that are of recorded drives, if the drives are of both kinds."""
    augmentation: Augmentation = field(default_factory=Augmentation)


def train(
    training: TrainingSet,
    validation: TrainingSet,
    run: Run,
    network: str,
    recipe: MetricRecipe,
) -> DescriptorNetwork:
    """Train a descriptor network by the distances within each batch.

    The history holds the loss and the top-1 of the validation groups for each epoch.
    """
    torch.manual_seed(run.seed)
    # Indices of the segments that have a match: a copy of these segments could take a gigabyte.
    usable = np.flatnonzero(training.group_sizes()[training.groups] >= 2)
    groups = np.unique(training.groups[usable], return_inverse=True)[1]
    synthetic = None if training.synthetic is None else training.synthetic[usable]
    extractor = DescriptorNetwork(network, *normalization_statistics(training), recipe.dropout)
    loss_of = losses(int(groups.max()) + 1)[recipe.loss]()
    model = nn.ModuleList([extractor, loss_of])
    steps = len(usable) // (GROUPS * VIEWS)

    def draw(_epoch: int, random: np.random.Generator) -> Iterator[LabeledBatch]:
        for _ in range(steps):
            chosen = draw_batch(groups, random, synthetic, recipe.recorded_share)
            occupancy, extents = recipe.augmentation.copies(
                training.segments.take(usable[chosen]), training.parameters, random
            )
            yield occupancy, extents, groups[chosen]

    def loss_in(batch: LabeledBatch) -> BatchLoss:
        occupancy, extents, labels = map(torch.from_numpy, batch)
        return loss_of(extractor(occupancy, extents), labels), {}

    def validate() -> Figures:
        return {"validation_top1": top1(describe(extractor, validation), validation.groups)}

    fit(model, run, recipe.sgd, recipe.epochs, steps, draw, loss_in, validate)
    return extractor


def draw_batch(
    groups: Int64,
    random: np.random.Generator,
    synthetic: Bool | None = None,
    recorded_share: float = 0.5,
) -> Int64:
    """Draw a batch with the same number of segments per group, int64 (batch,).

    Segments of a small group occur several times.

    Args:
        groups: int64 (segments,), group of each segment, from 0.
        random: random generator.
        synthetic: bool (segments,), True for segments of synthetic towns; None if unknown.
        recorded_share: share of the groups that are of recorded drives, if both kinds occur.
    """
    order = np.argsort(groups, kind="stable")
    sizes = np.bincount(groups)
    starts = np.cumsum(sizes) - sizes
    count = min(GROUPS, len(sizes))
    if synthetic is None or synthetic.all() or not synthetic.any():
        drawn = random.choice(len(sizes), count, replace=False)
    else:
        made_up = synthetic[order[starts]]
        kinds = np.flatnonzero(~made_up), np.flatnonzero(made_up)
        wanted = min(round(recorded_share * count), len(kinds[0]))
        wanted = max(wanted, count - len(kinds[1]))
        shares = zip(kinds, (wanted, count - wanted), strict=True)
        drawn = np.concatenate([random.choice(kind, few, replace=False) for kind, few in shares])
    places = [random.choice(sizes[group], VIEWS, replace=sizes[group] < VIEWS) for group in drawn]
    return np.asarray(order[starts[drawn][:, None] + np.array(places)].ravel())
