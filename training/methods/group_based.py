"""Group-based classification (paper III-C).

Each group of the training set is a class. The network learns to classify groups by categorical
cross-entropy with SGD, and the layer before the classifier is the descriptor. Groups with too few
segments are left out.

    placecell train group DRIVE@0:299 --seed 0
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

LabeledBatch = tuple[UInt8, Float32, Int64]
"""Occupancy, extents and groups of a batch."""


@dataclass(frozen=True, slots=True)
class GroupBasedRecipe:
    """Recipe of the group-based training; the defaults are those of the shipped model."""

    epochs: int = 60
    sgd: Sgd = field(default_factory=lambda: Sgd(learning_rate=0.2))
    dropout: float = 0.2
    fewest_segments: int = 2
    held_out: float = 0.05
    """Share of segments, in groups of four or more, that are held out to measure accuracy."""
    augmentation: Augmentation = field(default_factory=Augmentation)


class GroupClassifier(nn.Module):
    """Classification layer: scaled cosines between the descriptor and one vector per group."""

    def __init__(self, network: DescriptorNetwork, groups: int) -> None:
        super().__init__()
        self.network = network
        self.groups = nn.Parameter(torch.randn(groups, DIMENSION) / DIMENSION**0.5)
        self.log_scale = nn.Parameter(torch.tensor(16.0).log())

    def forward(self, occupancy: Tensor, extents: Tensor) -> Tensor:
        """Return the logits of segments, float32 (n, groups)."""
        return self.classify(self.network(occupancy, extents))

    def classify(self, descriptors: Tensor) -> Tensor:
        """Return the logits, float32 (n, groups), of descriptors (n, 64)."""
        cosines = descriptors @ nn.functional.normalize(self.groups, dim=1).T
        logits: Tensor = cosines * self.log_scale.exp()
        return logits


def train(
    training: TrainingSet,
    validation: TrainingSet,
    run: Run,
    network: str = "fast",
    recipe: GroupBasedRecipe | None = None,
) -> DescriptorNetwork:
    """Train a descriptor network as a classifier of groups.

    The history holds the loss of each epoch, the classification accuracy on the training copies and
    on held-out segments of the same groups (figure 3 a), and the top-1 of the validation groups.
    """
    recipe = recipe or GroupBasedRecipe()
    torch.manual_seed(run.seed)
    classes = training.without_small_groups(recipe.fewest_segments)
    mean, deviation = normalization_statistics(classes)
    extractor = DescriptorNetwork(network, mean, deviation, recipe.dropout)
    model = GroupClassifier(extractor, len(classes.group_sizes()))
    held_out = held_out_segments(classes, recipe.held_out, np.random.default_rng(run.seed))
    learned = np.setdiff1d(np.arange(len(classes)), held_out)
    steps = len(learned) // recipe.sgd.batch
    cross_entropy = nn.CrossEntropyLoss()

    def draw(_epoch: int, random: np.random.Generator) -> Iterator[LabeledBatch]:
        order = random.permutation(learned)
        for step in range(steps):
            chosen = order[step * recipe.sgd.batch : (step + 1) * recipe.sgd.batch]
            occupancy, extents = recipe.augmentation.copies(
                classes.segments.take(chosen), classes.parameters, random
            )
            yield occupancy, extents, classes.groups[chosen]

    def loss_of(batch: LabeledBatch) -> BatchLoss:
        occupancy, extents, labels = map(torch.from_numpy, batch)
        logits = model(occupancy, extents)
        right = int((logits.argmax(dim=1) == labels).sum())
        return cross_entropy(logits, labels), {"accuracy": right / len(labels)}

    def validate() -> Figures:
        found = top1(describe(extractor, validation), validation.groups)
        held = classification_accuracy(model, classes, held_out)
        return held | {"validation_top1": found}

    fit(model, run, recipe.sgd, recipe.epochs, steps, draw, loss_of, validate)
    return extractor


def held_out_segments(classes: TrainingSet, share: float, random: np.random.Generator) -> Int64:
    """Draw a share of the segments whose groups keep at least three others for training."""
    held_out: list[int] = []
    left = classes.group_sizes()
    for segment in random.permutation(len(classes)):
        if len(held_out) >= share * len(classes):
            break
        group = classes.groups[segment]
        if left[group] > 3:
            left[group] -= 1
            held_out.append(int(segment))
    return np.array(sorted(held_out), dtype=np.int64)


@torch.no_grad()
def classification_accuracy(
    model: GroupClassifier, classes: TrainingSet, held_out: Int64
) -> dict[str, float]:
    """Return the share of held-out segments that are classified right; empty without any."""
    if not len(held_out):
        return {}
    descriptors = torch.from_numpy(describe(model.network, classes.take(held_out)))
    told = model.classify(descriptors).argmax(dim=1).numpy()
    return {"validation_accuracy": float((told == classes.groups[held_out]).mean())}
