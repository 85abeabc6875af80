"""Stochastic gradient descent, as all three trainings use it."""

from dataclasses import dataclass

import torch
from torch import nn


@dataclass(frozen=True, slots=True)
class Sgd:
    """SGD with momentum on a one-cycle schedule.

    The learning rate rises for a third of the steps and then falls; momentum goes the other way,
    from 0.95 to 0.85 and back.
    """

    learning_rate: float = 0.1
    batch: int = 128
    weight_decay: float = 5e-4

    def start(
        self, model: nn.Module, epochs: int, steps: int
    ) -> tuple[torch.optim.SGD, torch.optim.lr_scheduler.OneCycleLR]:
        """Optimiser and schedule of so many epochs of so many steps each."""
        optimiser = torch.optim.SGD(
            model.parameters(),
            lr=self.learning_rate,
            momentum=0.9,
            weight_decay=self.weight_decay,
            nesterov=True,
        )
        schedule = torch.optim.lr_scheduler.OneCycleLR(
            optimiser, max_lr=self.learning_rate, epochs=epochs, steps_per_epoch=steps
        )
        return optimiser, schedule
