"""Training run: seed, folder, checkpoint and history; a stopped run can be resumed."""

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import torch
from rich.progress import Progress
from torch import nn

from training.methods.processor import keep_freed_memory

Figures = dict[str, float]


class Stateful(Protocol):
    """Object whose state a checkpoint can hold."""

    def state_dict(self) -> dict[str, Any]: ...
    def load_state_dict(self, state_dict: Any, /) -> object: ...


@dataclass
class Run:
    """Training run and its state.

    Every epoch has a random generator seeded by the run's seed and the number of the epoch. So a
    resumed run has the same result as a run without a stop.

    Attributes:
        folder: folder of checkpoint.pt and history.json.
        seed: random seed.
        identity: hash of data and recipe; only a checkpoint with the same identity is resumed.
        progress: display of the progress bar; None for no bar.
        history: figures of each finished epoch.
    """

    folder: Path
    seed: int
    identity: str = ""
    progress: Progress | None = None
    history: list[Figures] = field(default_factory=list)

    def random(self, epoch: int) -> np.random.Generator:
        """Return the random generator of an epoch; seed torch's generator as well."""
        torch.manual_seed(self.seed * 100_003 + epoch)
        return np.random.default_rng([self.seed, epoch])

    def epochs(
        self,
        count: int,
        model: nn.Module,
        optimizer: torch.optim.Optimizer,
        schedule: torch.optim.lr_scheduler.LRScheduler,
    ) -> Iterator[int]:
        """Yield the remaining epochs; save a checkpoint after each.

        Args:
            count: total number of epochs.
            model: module that is trained.
            optimizer: optimizer of the training.
            schedule: learning rate schedule of the training.

        Raises:
            ValueError: the checkpoint belongs to other data, another recipe or an earlier version.
        """
        keep_freed_memory()
        self.folder.mkdir(parents=True, exist_ok=True)
        checkpoint = self.folder / "checkpoint.pt"
        parts: dict[str, Stateful] = {"model": model, "optimizer": optimizer, "schedule": schedule}
        if checkpoint.exists():
            state = torch.load(checkpoint, weights_only=True)
            if state.get("identity", "") != self.identity:
                raise ValueError(
                    f"{checkpoint} belongs to a training on other drives or with other settings. "
                    "Begin anew (without --resume), or choose another folder for runs."
                )
            if missing := [name for name in parts if name not in state]:
                raise ValueError(
                    f"{checkpoint} has no state of the {missing[0]}: an earlier version wrote it. "
                    "Begin anew (without --resume), or choose another folder for runs."
                )
            for name, part in parts.items():
                part.load_state_dict(state[name])
            self.history = state["history"]
        task = None
        if self.progress is not None:
            task = self.progress.add_task("training", total=count, completed=len(self.history))
        for epoch in range(len(self.history), count):
            started, computed = time.monotonic(), time.process_time()
            yield epoch
            self.history[-1]["seconds"] = round(time.monotonic() - started, 2)
            self.history[-1]["cpu_seconds"] = round(time.process_time() - computed, 2)
            unfinished = checkpoint.with_suffix(".unfinished")
            state = {name: part.state_dict() for name, part in parts.items()}
            torch.save(state | {"history": self.history, "identity": self.identity}, unfinished)
            unfinished.replace(checkpoint)
            (self.folder / "history.json").write_text(json.dumps(self.history, indent=1) + "\n")
            if self.progress is not None and task is not None:
                shown = ", ".join(f"{name} {value:.3f}" for name, value in self.history[-1].items())
                self.progress.update(task, advance=1, description=f"epoch {epoch + 1}: {shown}")

    def cost(self) -> Figures:
        """Return the time of all epochs, seconds: elapsed time, and the sum over all cores."""
        return {
            key: round(sum(epoch[key] for epoch in self.history), 1)
            for key in ("seconds", "cpu_seconds")
        }

    def note(self, **figures: float) -> None:
        """Add an epoch's figures to the history."""
        self.history.append({name: float(value) for name, value in figures.items()})
