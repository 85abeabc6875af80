"""Training loop of every method: stochastic gradient descent over the batches of each epoch."""

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
import torch
from torch import Tensor, nn

from training.methods.run import Figures, Run

Batch = TypeVar("Batch")

BatchLoss = tuple[Tensor, Figures]
"""Loss of a batch, and further figures of it, to be averaged over the epoch."""


@dataclass(frozen=True, slots=True)
class Sgd:
    """SGD with Nesterov momentum on a one-cycle schedule.

    The learning rate rises for a third of the steps and then falls; momentum goes the other way,
    from 0.95 to 0.85 and back.

    Attributes:
        learning_rate: the highest one.
        batch: samples of a step.
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
    sgd: Sgd,
    epochs: int,
    steps: int,
    draw: Callable[[int, np.random.Generator], Iterator[Batch]],
    loss_of: Callable[[Batch], BatchLoss],
    validate: Callable[[], Figures],
) -> None:
    """Train a model in place; the run keeps checkpoints and notes figures of each epoch.

    Args:
        model: the module whose parameters are learned.
        run: seed, checkpoints and history.
        sgd: settings of the gradient descent.
        epochs: epochs in all, those before a stop included.
        steps: batches of an epoch.
        draw: called with the epoch and its random generator, before the model is put into
            training mode; gives the epoch's `steps` batches.
        loss_of: the loss of a batch, and further figures of it.
        validate: figures of the model after an epoch.
    """
    optimizer, schedule = sgd.start(model, epochs, steps)
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
