"""Plan of the experiments: the trainings that are run and compared (paper, section IV)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from training.methods.registry import METHODS
from training.methods.siamese import SiameseRecipe

EPOCHS_3D = {"group": 12, "siamese": 8, "contrastive": 6}
"""Epochs of the `paper` network by method: as many as half an hour allows.

One epoch of this network takes ten times as long as one of the others.
"""


@dataclass(frozen=True, slots=True)
class ExperimentPlan:
    """Plan of the experiments' trainings.

    Attributes:
        networks: names of the networks; ablations use the first.
        seeds: number of trainings of each method on the first network; other networks are trained
            once.
        dropouts: dropout rates of the Siamese network, to show their effect on over-fitting.
        epochs: number of epochs of every training; None for the epochs of each recipe.
        epochs_3d: number of epochs of the `paper` network, by method.
    """

    networks: tuple[str, ...] = ("fast", "paper-reduced", "paper")
    seeds: int = 3
    dropouts: tuple[float, ...] = (0.0, 0.2, 0.5)
    epochs: int | None = None
    epochs_3d: Mapping[str, int] = field(default_factory=lambda: EPOCHS_3D)

    def trainings(self) -> "Iterator[Training]":
        """Yield all trainings, cheapest first."""
        first = self.networks[0]
        for seed in range(self.seeds):
            for method in METHODS:
                yield Training(method, first, seed, self._changes(method, first))
        for dropout in self.dropouts:
            if dropout == SiameseRecipe().dropout:
                continue  # already trained with seed 0
            changes = self._changes("siamese", first) | {"dropout": dropout}
            yield Training("siamese", first, 0, changes, f"dropout-{dropout}")
        random_pairs = self._changes("contrastive", first) | {"hard": False}
        yield Training("contrastive", first, 0, random_pairs, "random-pairs")
        for network in self.networks[1:]:
            for method in METHODS:
                yield Training(method, network, 0, self._changes(method, network))

    def _changes(self, method: str, network: str) -> dict[str, Any]:
        if self.epochs is None and network == "paper":
            return {"epochs": self.epochs_3d[method]}
        return {"epochs": self.epochs}


@dataclass(frozen=True, slots=True)
class Training:
    """Training of the plan.

    Attributes:
        method: name of the method.
        network: name of the network.
        seed: random seed; the split into training and validation set does not depend on it.
        changes: changed settings of the method's recipe.
        ablation: name of the changed setting; empty for trainings compared with the paper.
    """

    method: str
    network: str
    seed: int
    changes: dict[str, Any] = field(default_factory=dict)
    ablation: str = ""

    @property
    def name(self) -> str:
        """Return the name of the training's run and model."""
        if not self.network:
            return self.method
        parts = [self.method, self.network, str(self.seed), self.ablation]
        return "-".join(part for part in parts if part)

    def options(self) -> list[object]:
        """Return the options of `placecell train` that differ from its defaults."""
        options: list[object] = []
        if self.network not in ("", "fast"):
            options += ["--network", self.network]
        if self.changes.get("epochs"):
            options += ["--epochs", self.changes["epochs"]]
        return options
