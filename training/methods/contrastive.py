"""Descriptor extraction using contrastive loss (paper III-E).

    L(y, a, b) = y |a - b|^2 + (1 - y) max(0, m - |a - b|^2)

on hard pairs: matches far apart and non-matches close together. The pairs are drawn again at the
end of each epoch, by the current descriptors, and sub-sampled so that the few hardest pairs do not
dominate.

    placecell train contrastive DRIVE@0:299 --seed 0
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import torch
from torch import Tensor

from evaluation.recognition.retrieval import distance_rows, top1
from placecell.core.types import Float32, Int64, UInt8
from training.data.augmentation import Augmentation
from training.data.training_set import TrainingSet
from training.methods.fit import BatchLoss, Sgd, fit
from training.methods.networks import DescriptorNetwork, describe, normalization_statistics
from training.methods.run import Figures, Run

PairBatch = tuple[UInt8, Float32, Float32]
"""Batch of pairs: occupancy and extents of both sides, and 1 for matches."""


@dataclass(frozen=True, slots=True)
class ContrastiveRecipe:
    """Recipe of the contrastive training; the defaults are those of the shipped model."""

    epochs: int = 25
    margin: float = 1.0
    """Margin m of the squared distance, at most 4 for descriptors of length one."""
    hardest: int = 200
    """Number of nearest non-matches that a segment's hard non-match is drawn from."""
    matches_share: float = 0.25
    """Number of matches per non-match.

    Near the minimum of the loss, a match pulls harder than a close non-match pushes. Equal numbers
    would pull all descriptors together.
    """
    hard: bool = True
    """True for hard pairs, False for random pairs."""
    sgd: Sgd = field(default_factory=lambda: Sgd(learning_rate=0.1, batch=128))
    dropout: float = 0.0
    augmentation: Augmentation = field(default_factory=Augmentation)


def contrastive_loss(matches: Tensor, squared_distances: Tensor, margin: float) -> Tensor:
    """Return the paper's loss (III-E), averaged over pairs.

    Args:
        matches: 1 for matches and 0 for non-matches, (n,).
        squared_distances: squared distances of the descriptors, (n,).
        margin: margin m of the squared distance.
    """
    apart = (margin - squared_distances).clamp(min=0)
    loss: Tensor = (matches * squared_distances + (1 - matches) * apart).mean()
    return loss


def hard_pairs(
    descriptors: Float32, groups: Int64, hardest: int, random: np.random.Generator
) -> tuple[Int64, Int64]:
    """Draw a hard match and a hard non-match for each segment.

    The match is drawn from the segment's group with a probability that grows with the rank of the
    distance: with probability 3/4 it belongs to the farther half. The non-match is drawn from the
    `hardest` nearest segments of other groups.

    Returns:
        Matches, int64 (m, 2), of segments with a mate, and non-matches, int64 (segments, 2).
    """
    matches, others = [], []
    for rows, distances in distance_rows(descriptors):
        same = groups[rows, None] == groups[None]
        foreign = np.where(same, np.inf, distances)
        several = min(hardest, int((~same).sum(axis=1).min()))
        nearest = np.argpartition(foreign, several - 1, axis=1)[:, :several]
        chosen = nearest[np.arange(len(rows)), random.integers(0, several, len(rows))]
        others.append(np.stack([rows, chosen], axis=1))
        for row, segment in enumerate(rows):
            mates = np.flatnonzero(same[row])
            mates = mates[mates != segment]
            if len(mates):
                by_distance = mates[np.argsort(distances[row, mates])]
                # The square root of a uniform number prefers far mates.
                pick = int(len(mates) * np.sqrt(random.random()))
                matches.append((int(segment), int(by_distance[pick])))
    return np.array(matches, dtype=np.int64).reshape(-1, 2), np.concatenate(others)


def random_pairs(groups: Int64, random: np.random.Generator) -> tuple[Int64, Int64]:
    """Draw a random match and a random non-match for each segment, as a baseline."""
    matches, others = [], []
    for segment, group in enumerate(groups):
        same = groups == group
        others.append((segment, int(random.choice(np.flatnonzero(~same)))))
        same[segment] = False
        if same.any():
            matches.append((segment, int(random.choice(np.flatnonzero(same)))))
    return np.array(matches, dtype=np.int64).reshape(-1, 2), np.array(others, dtype=np.int64)


def train(
    training: TrainingSet,
    validation: TrainingSet,
    run: Run,
    network: str = "fast",
    recipe: ContrastiveRecipe | None = None,
) -> DescriptorNetwork:
    """Train a descriptor network with the contrastive loss.

    The history holds the loss and the top-1 of the training set and of the validation groups.
    """
    recipe = recipe or ContrastiveRecipe()
    torch.manual_seed(run.seed)
    mean, deviation = normalization_statistics(training)
    model = DescriptorNetwork(network, mean, deviation, recipe.dropout)
    steps = len(training) // recipe.sgd.batch
    described: list[Float32] = []  # descriptors of the training set after the last epoch

    def draw(epoch: int, random: np.random.Generator) -> Iterator[PairBatch]:
        if recipe.hard and epoch:
            if not described:  # the run was stopped and resumes
                described.append(describe(model, training))
            matches, others = hard_pairs(described.pop(), training.groups, recipe.hardest, random)
        else:
            matches, others = random_pairs(training.groups, random)
        others = random.permutation(others)
        matches = random.permutation(matches)[: int(len(others) * recipe.matches_share)]
        return batches(matches, others, random)

    def batches(matches: Int64, others: Int64, random: np.random.Generator) -> Iterator[PairBatch]:
        share, batch = len(matches) / len(others), recipe.sgd.batch
        for step in range(steps):
            some_matches = matches[int(step * batch * share) : int((step + 1) * batch * share)]
            pairs = np.concatenate([some_matches, others[step * batch : (step + 1) * batch]])
            is_match = np.zeros(len(pairs), dtype=np.float32)
            is_match[: len(some_matches)] = 1
            occupancy, extents = recipe.augmentation.copies(
                training.segments.take(pairs.T.reshape(-1)), training.parameters, random
            )
            yield occupancy, extents, is_match

    def loss_of(batch: PairBatch) -> BatchLoss:
        occupancy, extents, is_match = map(torch.from_numpy, batch)
        a, b = model(occupancy, extents).chunk(2)
        return contrastive_loss(is_match, (a - b).square().sum(dim=1), recipe.margin), {}

    def validate() -> Figures:
        described[:] = [describe(model, training)]
        return {
            "top1": top1(described[0], training.groups),
            "validation_top1": top1(describe(model, validation), validation.groups),
        }

    fit(model, run, recipe.sgd, recipe.epochs, steps, draw, loss_of, validate)
    return model
