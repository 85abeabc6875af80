"""A training run: its seed, its folder, its checkpoints, its history; stopped, it resumes."""

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
    """What a checkpoint can hold."""

    def state_dict(self) -> dict[str, Any]: ...
    def load_state_dict(self, state_dict: Any, /) -> object: ...


@dataclass
class Run:
    """Where a training keeps its state.

    Every epoch draws from a generator seeded by the seed and the epoch's number, so a run that was
    stopped and resumed ends as one that was not.

    Attributes:
        folder: of checkpoint.pt and history.json.
        seed: of everything random.
        identity: of data and recipe: a checkpoint of another is refused, not gone on with.
        progress: where the bar is shown; None: nowhere.
        history: figures of each epoch done.
    """

    folder: Path
    seed: int
    identity: str = ""
    progress: Progress | None = None
    history: list[Figures] = field(default_factory=list)

    def random(self, epoch: int) -> np.random.Generator:
        """The generator of an epoch; torch's own is seeded alike."""
        torch.manual_seed(self.seed * 100_003 + epoch)
        return np.random.default_rng([self.seed, epoch])

    def epochs(
        self,
        count: int,
        model: nn.Module,
        optimizer: torch.optim.Optimizer,
        schedule: torch.optim.lr_scheduler.LRScheduler,
    ) -> Iterator[int]:
        """The epochs still to do; what the loop's body changed is saved after each.

        Raises:
            ValueError: the checkpoint is of another data set or recipe.
        """
        keep_freed_memory()
        self.folder.mkdir(parents=True, exist_ok=True)
        checkpoint = self.folder / "checkpoint.pt"
        parts: dict[str, Stateful] = {"model": model, "optimiser": optimizer, "schedule": schedule}
        if checkpoint.exists():
            state = torch.load(checkpoint, weights_only=True)
            if state.get("identity", "") != self.identity:
                raise ValueError(
                    f"{checkpoint}: of a training on other drives or with other settings; "
                    "begin anew (without --resume), or name another folder for runs"
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
        """Seconds of all epochs, those before a stop included: by the clock and of all cores."""
        return {
            key: round(sum(epoch[key] for epoch in self.history), 1)
            for key in ("seconds", "cpu_seconds")
        }

    def note(self, **figures: float) -> None:
        """Add an epoch's figures to the history."""
        self.history.append({name: float(value) for name, value in figures.items()})
