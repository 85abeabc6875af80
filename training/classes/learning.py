"""Learning of the head: a small network, calibrated on groups that it did not see.

Unlabeled drives take part by self-training: the network states the class of their segments, all
views of a group agree on the most probable one, and the network learns from those it is sure of.
So it learns from a car that it saw well how the same car looks from afar.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn

from placecell.core.segment_classes import CLASSES
from placecell.core.types import Float32, Float64, UInt8
from placecell.datasets.labels import NO_CLASS
from training.classes.examples import Examples

WIDTHS = (256, 96)
"""Widths of the hidden layers."""

HELD_OUT = 0.1
"""Share of the groups that calibrate the probabilities."""

ROUNDS = 2
"""Number of rounds of self-training."""

SURE = 0.6
"""Smallest probability of a group's class in self-training."""


@dataclass(frozen=True, slots=True)
class ClassRecipe:
    """Recipe of the training.

    Attributes:
        epochs: passes over the examples.
        batch: examples per step.
        learning_rate: highest learning rate (one cycle).
        weight_decay: L2 penalty of the weights.
        dropout: share of the hidden values that are dropped.
        noise: standard deviation of the noise of the standardized inputs.
        smoothing: share of the probability that is spread over all classes.
        recorded: weight of all examples of recorded drives over that of the simulated ones.
        unlabeled: weight of all unlabeled examples over that of the simulated ones.
        cast: weight of a thing that was cast over that of another simulated example.
    """

    epochs: int = 8
    batch: int = 256
    learning_rate: float = 4e-3
    weight_decay: float = 1e-3
    dropout: float = 0.3
    noise: float = 0.25
    smoothing: float = 0.05
    recorded: float = 0.7
    unlabeled: float = 1.0
    cast: float = 3.0


class HeadNetwork(nn.Module):
    """Head: standardized inputs, two hidden layers, and the logits over a temperature."""

    mean: Tensor
    scale: Tensor
    temperature: Tensor

    def __init__(self, mean: Float32, deviation: Float32, dropout: float) -> None:
        super().__init__()
        self.register_buffer("mean", torch.from_numpy(mean))
        self.register_buffer("scale", torch.from_numpy(1 / deviation))
        self.register_buffer("temperature", torch.ones(()))
        layers: list[nn.Module] = []
        size = len(mean)
        for width in WIDTHS:
            layers += [nn.Linear(size, width), nn.GELU(), nn.Dropout(dropout)]
            size = width
        self.layers = nn.Sequential(*layers, nn.Linear(size, len(CLASSES)))

    def standardized(self, inputs: Tensor) -> Tensor:
        """Return the inputs with mean 0 and deviation 1."""
        return (inputs - self.mean) * self.scale

    def forward(self, inputs: Tensor) -> Tensor:
        """Return the logits, float32 (n, classes)."""
        logits: Tensor = self.layers(self.standardized(inputs)) / self.temperature
        return logits


@dataclass(frozen=True, slots=True)
class TrainedHead:
    """Trained head.

    Attributes:
        network: calibrated network.
        held_out: labeled examples that only calibrated it.
    """

    network: HeadNetwork
    held_out: Examples


def learn(
    labeled: Examples,
    unlabeled: Examples | None,
    seed: int,
    recipe: ClassRecipe | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> TrainedHead:
    """Train and calibrate a head.

    Args:
        labeled: labeled examples.
        unlabeled: examples of unlabeled drives for self-training; None without.
        seed: seed of the weights, the batches and the held-out groups.
        recipe: recipe; None for the default one.
        tell: receives the progress.

    Raises:
        ValueError: The labeled examples have fewer than two classes.
    """
    recipe = recipe or ClassRecipe()
    labeled = labeled.labeled_as(labeled.classes)
    if len(np.unique(labeled.classes)) < 2:
        raise ValueError(
            f"Found {len(np.unique(labeled.classes))} classes in {len(labeled)} labeled segments, "
            "expected 2 or more. Add drives with labels, such as town:800."
        )
    groups = np.unique(labeled.groups)
    chosen = np.random.default_rng(seed).permutation(groups)[: max(1, int(HELD_OUT * len(groups)))]
    apart = np.isin(labeled.groups, chosen)
    learned = labeled.take(np.flatnonzero(~apart))
    held_out = labeled.take(np.flatnonzero(apart & (labeled.is_copy == 0)))
    weights = weights_of(learned, recipe)
    network = fit(learned, weights, seed, recipe)
    for number in range(ROUNDS if unlabeled is not None else 0):
        assert unlabeled is not None
        found = unlabeled.labeled_as(agreed(network, unlabeled))
        tell(f"Round {number + 1}: {len(found)} of {len(unlabeled)} unlabeled examples are sure.")
        if not len(found):
            break
        more = np.full(len(found), recipe.unlabeled * weights.sum() / len(unlabeled))
        everything = Examples.joined([learned, found])
        network = fit(everything, np.concatenate([weights, more]), seed + number + 1, recipe)
    calibrate(network, held_out)
    return TrainedHead(network, held_out)


def weights_of(examples: Examples, recipe: ClassRecipe) -> Float64:
    """Return the weight of each example: see `recorded` and `cast` of the recipe."""
    simulated = examples.simulated > 0
    weights = np.where(examples.is_cast > 0, recipe.cast, 1.0)
    if simulated.any() and not simulated.all():
        weights[~simulated] = recipe.recorded * weights[simulated].sum() / (~simulated).sum()
    return weights


def fit(examples: Examples, weights: Float64, seed: int, recipe: ClassRecipe) -> HeadNetwork:
    """Train a network. Rare classes weigh more: with the root of their rarity."""
    torch.manual_seed(seed)
    inputs, classes = examples.inputs, torch.from_numpy(examples.classes.astype(np.int64))
    counts = np.bincount(examples.classes, weights, len(CLASSES)).clip(min=1.0)
    weights = weights * np.sqrt(counts.sum() / counts)[examples.classes]
    weight = torch.from_numpy((weights / weights.mean()).astype(np.float32))
    network = HeadNetwork(inputs.mean(axis=0), inputs.std(axis=0) + 1e-3, recipe.dropout)
    standardized = network.standardized(torch.from_numpy(inputs))
    optimizer = torch.optim.AdamW(
        network.parameters(), recipe.learning_rate, weight_decay=recipe.weight_decay
    )
    steps = -(-len(inputs) // recipe.batch)
    schedule = torch.optim.lr_scheduler.OneCycleLR(
        optimizer, recipe.learning_rate, total_steps=recipe.epochs * steps
    )
    loss_of = nn.CrossEntropyLoss(reduction="none", label_smoothing=recipe.smoothing)
    for _ in range(recipe.epochs):
        order = torch.randperm(len(inputs))
        for rows in order.split(recipe.batch):
            noisy = standardized[rows]
            noisy = noisy + recipe.noise * torch.randn(noisy.shape)
            loss = (loss_of(network.layers(noisy), classes[rows]) * weight[rows]).mean()
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            schedule.step()
    return network.eval()


def logits_of(network: HeadNetwork, examples: Examples) -> Float64:
    """Return the logits of examples, float64 (n, classes)."""
    with torch.no_grad():
        logits = [network(part) for part in torch.from_numpy(examples.inputs).split(4096)]
    return torch.cat(logits).double().numpy()


def agreed(network: HeadNetwork, examples: Examples) -> UInt8:
    """Return the class that all views of a group agree on; `NO_CLASS` if it is not sure."""
    logits = torch.from_numpy(logits_of(network, examples)).log_softmax(1).numpy().clip(min=-7.0)
    _, which = np.unique(examples.groups, return_inverse=True)
    views = np.bincount(which)
    mean = np.stack([np.bincount(which, column) / views for column in logits.T], axis=1)
    likely = np.exp(mean)
    likely /= likely.sum(axis=1, keepdims=True)
    classes = np.where(likely.max(axis=1) >= SURE, likely.argmax(axis=1), NO_CLASS)
    return classes[which].astype(np.uint8)


def calibrate(network: HeadNetwork, held_out: Examples) -> None:
    """Set the temperature that makes held-out classes most probable (Guo et al. 2017)."""
    logits = torch.from_numpy(logits_of(network, held_out))
    classes = torch.from_numpy(held_out.classes.astype(np.int64))
    tried = np.geomspace(0.25, 4.0, 81)
    loss = [float(nn.functional.cross_entropy(logits / each, classes)) for each in tried]
    network.temperature.fill_(float(tried[int(np.argmin(loss))]))
