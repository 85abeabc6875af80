"""Training loop of every method: stochastic gradient descent over the batches of each epoch."""

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
import torch
from torch import Tensor, nn

from training.methods.run import Figures, Run

Batch = TypeVar("Batch")

BatchLoss = tuple[Tensor, Figures]
"""Loss and further figures of a batch, which are averaged over the epoch."""


class Descent(Protocol):
    """Settings of an optimizer and of its learning rates."""

    def start(
        self, model: nn.Module, epochs: int, steps: int
    ) -> tuple[torch.optim.Optimizer, torch.optim.lr_scheduler.LRScheduler]:
        """Return optimizer and schedule for a number of epochs of `steps` steps each."""


@dataclass(frozen=True, slots=True)
class Sgd:
    """SGD with Nesterov momentum on a one-cycle schedule.

    The learning rate rises for a third of the steps and then falls. The momentum falls from 0.95 to
    0.85 and then rises.

    Attributes:
        learning_rate: highest learning rate.
        batch: number of samples per step.
        weight_decay: L2 penalty of the weights.
    """

    learning_rate: float = 0.1
    batch: int = 128
    weight_decay: float = 5e-4

    def start(
        self, model: nn.Module, epochs: int, steps: int
    ) -> tuple[torch.optim.SGD, torch.optim.lr_scheduler.OneCycleLR]:
        """Return optimizer and schedule for a number of epochs of `steps` steps each."""
        optimizer = torch.optim.SGD(
            model.parameters(),
            lr=self.learning_rate,
            momentum=0.9,
            weight_decay=self.weight_decay,
            nesterov=True,
        )
        schedule = torch.optim.lr_scheduler.OneCycleLR(
            optimizer, max_lr=self.learning_rate, epochs=epochs, steps_per_epoch=steps
        )
        return optimizer, schedule


def fit(
    model: nn.Module,
    run: Run,
    descent: Descent,
    epochs: int,
    steps: int,
    draw: Callable[[int, np.random.Generator], Iterator[Batch]],
    loss_of: Callable[[Batch], BatchLoss],
    validate: Callable[[], Figures],
) -> None:
    """Train a model in place; the run stores checkpoints and the figures of each epoch.

    Args:
        model: module whose parameters are learned.
        run: seed, checkpoints and history of the training.
        descent: settings of the gradient descent.
        epochs: total number of epochs, including those before a stop.
        steps: number of batches per epoch.
        draw: function that yields the `steps` batches of an epoch, from its number and its random
            generator. It is called before the model enters training mode.
        loss_of: function that returns the loss and further figures of a batch.
        validate: function that returns figures of the model after an epoch.
    """
    optimizer, schedule = descent.start(model, epochs, steps)
    for epoch in run.epochs(epochs, model, optimizer, schedule):
        batches = draw(epoch, run.random(epoch))
        values = defaultdict[str, list[float]](list)
        model.train()
        for batch in batches:
            loss, figures = loss_of(batch)
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            schedule.step()
            for name, value in ({"loss": loss.item()} | figures).items():
                values[name].append(value)
        means = {name: float(np.mean(of_steps)) for name, of_steps in values.items()}
        run.note(**means, **validate())
