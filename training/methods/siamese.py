"""Siamese network (paper III-D).

Two branches share the extractor's weights. A third network takes both descriptors and returns the
match probability. The training uses binary cross-entropy, SGD, and random pairs without duplicates,
with as many matches as non-matches.

    placecell train siamese DRIVE@0:299 --seed 0
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import torch
from torch import Tensor, nn

from evaluation.recognition.retrieval import top1
from placecell.core.types import Float32, Int64, UInt8
from training.data.augmentation import Augmentation
from training.data.training_set import TrainingSet
from training.methods.fit import BatchLoss, Sgd, fit
from training.methods.networks import (
    DIMENSION,
    DescriptorNetwork,
    describe,
    normalization_statistics,
)
from training.methods.run import Figures, Run

PairBatch = tuple[UInt8, Float32, Float32]
"""Batch of pairs: occupancy and extents of both sides, and 1 for matches."""


@dataclass(frozen=True, slots=True)
class SiameseRecipe:
    """Recipe of the Siamese training; the defaults are those of the shipped model."""

    epochs: int = 40
    pairs: int = 8192
    """Number of pairs per epoch; half of them are matches."""
    sgd: Sgd = field(default_factory=lambda: Sgd(learning_rate=0.05, batch=128))
    dropout: float = 0.2
    augmentation: Augmentation = field(default_factory=Augmentation)


class MatchNetwork(nn.Module):
    """Third network: match probability of two descriptors.

    Its input does not depend on their order: distance and product in each dimension.
    """

    def __init__(self, hidden: int = 64) -> None:
        super().__init__()
        self.layers = nn.Sequential(
            nn.Linear(2 * DIMENSION, hidden), nn.ReLU(), nn.Linear(hidden, 1)
        )

    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        """Return the logits of the match probability, (n,), of descriptors, (n, 64) each."""
        features = torch.cat([(a - b).abs(), a * b], dim=1) * DIMENSION**0.5
        logits: Tensor = self.layers(features)
        return logits.squeeze(1)


class Siamese(nn.Module):
    """Siamese network: two branches with shared weights, and the third network."""

    def __init__(self, extractor: DescriptorNetwork) -> None:
        super().__init__()
        self.extractor = extractor
        self.match = MatchNetwork()

    def forward(self, occupancy: Tensor, extents: Tensor) -> Tensor:
        """Return the logits (n,) of n pairs; rows i and n + i of the inputs form a pair."""
        descriptors = self.extractor(occupancy, extents)
        half = len(descriptors) // 2
        logits: Tensor = self.match(descriptors[:half], descriptors[half:])
        return logits


def sample_pairs(groups: Int64, count: int, random: np.random.Generator) -> tuple[Int64, Float32]:
    """Draw random pairs, one half of them matches.

    No pair occurs twice in either order, and no segment is paired with itself. If fewer than
    count / 2 pairs of one kind exist, there are as many of each kind as of the rarer kind.

    Returns:
        Indices (count, 2), and 1 for matches and 0 for non-matches (count,).

    Raises:
        ValueError: no two segments match, or all of them match.
    """
    order = np.argsort(groups, kind="stable")
    sizes = np.bincount(groups)
    starts = np.cumsum(sizes) - sizes
    matches = np.concatenate(
        [
            order[start + np.stack(np.triu_indices(size, k=1), axis=1)]
            for start, size in zip(starts, sizes, strict=True)
        ]
    )
    apart = (len(groups) ** 2 - int((sizes**2).sum())) // 2
    half = min(count // 2, len(matches), apart)
    if not half:
        raise ValueError("No pairs to train on. The training set needs matches and non-matches.")
    matches = random.permutation(matches)[:half]
    others: set[tuple[int, int]] = set()
    while len(others) < half:
        drawn = random.integers(0, len(groups), (half, 2))
        drawn = np.sort(drawn[groups[drawn[:, 0]] != groups[drawn[:, 1]]], axis=1)
        others.update(map(tuple, drawn[: half - len(others)].tolist()))
    pairs = np.concatenate([matches, np.array(sorted(others), dtype=np.int64).reshape(-1, 2)])
    labels = np.repeat(np.array([1, 0], dtype=np.float32), half)
    shuffled = random.permutation(len(pairs))
    return pairs[shuffled], labels[shuffled]


def train(
    training: TrainingSet,
    validation: TrainingSet,
    run: Run,
    network: str = "fast",
    recipe: SiameseRecipe | None = None,
) -> Siamese:
    """Train extractor and third network together.

    The history holds the loss, the accuracy on training pairs, the accuracy on fixed random pairs
    of the validation groups, and the top-1 of the validation groups.
    """
    recipe = recipe or SiameseRecipe()
    torch.manual_seed(run.seed)
    mean, deviation = normalization_statistics(training)
    model = Siamese(DescriptorNetwork(network, mean, deviation, recipe.dropout))
    pairs_an_epoch = len(sample_pairs(training.groups, recipe.pairs, np.random.default_rng(0))[0])
    steps = pairs_an_epoch // recipe.sgd.batch
    held_out = sample_pairs(validation.groups, 4000, np.random.default_rng(run.seed))
    cross_entropy = nn.BCEWithLogitsLoss()

    def draw(_epoch: int, random: np.random.Generator) -> Iterator[PairBatch]:
        pairs, labels = sample_pairs(training.groups, recipe.pairs, random)
        for step in range(steps):
            rows = slice(step * recipe.sgd.batch, (step + 1) * recipe.sgd.batch)
            occupancy, extents = recipe.augmentation.copies(
                training.segments.take(pairs[rows].T.reshape(-1)), training.parameters, random
            )
            yield occupancy, extents, labels[rows]

    def loss_of(batch: PairBatch) -> BatchLoss:
        occupancy, extents, truth = map(torch.from_numpy, batch)
        logits = model(occupancy, extents)
        right = int(((logits > 0) == (truth > 0.5)).sum())
        return cross_entropy(logits, truth), {"accuracy": right / len(truth)}

    def validate() -> Figures:
        descriptors = describe(model.extractor, validation)
        return {
            "validation_accuracy": pair_accuracy(model.match, descriptors, *held_out),
            "validation_top1": top1(descriptors, validation.groups),
        }

    fit(model, run, recipe.sgd, recipe.epochs, steps, draw, loss_of, validate)
    return model


@torch.no_grad()
def pair_accuracy(
    match: MatchNetwork, descriptors: Float32, pairs: Int64, labels: Float32
) -> float:
    """Return the share of pairs that the third network classifies right."""
    match.eval()
    a, b = (torch.from_numpy(descriptors[side]) for side in pairs.T)
    return float(((match(a, b) > 0).numpy() == (labels > 0.5)).mean())
