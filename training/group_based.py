"""Group-based classification (paper III-C).

Each group of the training set is a class; the network learns to tell them apart by categorical
cross-entropy with SGD, and the layer before the classifier is the descriptor. Groups with too few
segments are left out.

    placecell train group DRIVE@0:299 --seed 0
"""

from dataclasses import dataclass, field

import numpy as np
import torch
from torch import Tensor, nn

from training.augmentation import Augmentation
from training.networks import DIMENSION, DescriptorNetwork, describe, normalisation_statistics
from training.recognition import top1
from training.run import Run
from training.sgd import Sgd
from training.training_set import TrainingSet


@dataclass(frozen=True, slots=True)
class GroupBasedRecipe:
    """Settings of the training; the defaults made the model that ships."""

    epochs: int = 60
    sgd: Sgd = field(default_factory=lambda: Sgd(learning_rate=0.2))
    dropout: float = 0.2
    fewest_segments: int = 2
    label_smoothing: float = 0.0
    augmentation: Augmentation = field(default_factory=Augmentation)


class GroupClassifier(nn.Module):
    """The classification layer: scaled cosines of the descriptor with a vector for each group."""

    def __init__(self, network: DescriptorNetwork, groups: int) -> None:
        super().__init__()
        self.network = network
        self.groups = nn.Parameter(torch.randn(groups, DIMENSION) / DIMENSION**0.5)
        self.log_scale = nn.Parameter(torch.tensor(16.0).log())

    def forward(self, occupancy: Tensor, extents: Tensor) -> Tensor:
        """Logits, float32 (n, groups)."""
        descriptors = self.network(occupancy, extents)
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

    The history holds, for each epoch, the loss, the classification accuracy on the altered copies
    trained on, and the validation groups' top-1 (nearest descriptor of the same group).
    """
    recipe = recipe or GroupBasedRecipe()
    torch.manual_seed(run.seed)
    classes = training.without_small_groups(recipe.fewest_segments)
    mean, deviation = normalisation_statistics(classes)
    extractor = DescriptorNetwork(network, mean, deviation, recipe.dropout)
    model = GroupClassifier(extractor, len(classes.group_sizes()))
    steps = len(classes) // recipe.sgd.batch
    optimiser, schedule = recipe.sgd.start(model, recipe.epochs, steps)
    cross_entropy = nn.CrossEntropyLoss(label_smoothing=recipe.label_smoothing)
    for epoch in run.epochs(recipe.epochs, model, optimiser, schedule):
        random = run.random(epoch)
        order = random.permutation(len(classes))
        losses, right = [], 0
        model.train()
        for step in range(steps):
            chosen = order[step * recipe.sgd.batch : (step + 1) * recipe.sgd.batch]
            occupancy, extents = recipe.augmentation.copies(
                classes.segments.take(chosen), classes.parameters, random
            )
            labels = torch.from_numpy(classes.groups[chosen])
            logits = model(torch.from_numpy(occupancy), torch.from_numpy(extents))
            loss = cross_entropy(logits, labels)
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            schedule.step()
            losses.append(loss.item())
            right += int((logits.argmax(dim=1) == labels).sum())
        run.note(
            loss=np.mean(losses),
            accuracy=right / (steps * recipe.sgd.batch),
            validation_top1=top1(describe(extractor, validation), validation.groups),
        )
    return extractor
