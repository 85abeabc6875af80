"""Which trainings the experiments consist of (paper, section IV)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from training.methods.registry import METHODS
from training.methods.siamese import SiameseRecipe

EPOCHS_3D = {"group": 12, "siamese": 8, "contrastive": 6}
"""Of the `paper` network, an epoch of which costs ten times as much: what half an hour allows."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is trained.

    Attributes:
        networks: by name; the first is the one that ablations use.
        seeds: trainings of each method on the first network; the others are trained once.
        dropouts: of the Siamese, to show what regularisation does to its over-fitting.
        epochs: of every training; None: each recipe's own.
        epochs_3d: the same of the `paper` network, by method.
    """

    networks: tuple[str, ...] = ("fast", "paper-reduced", "paper")
    seeds: int = 3
    dropouts: tuple[float, ...] = (0.0, 0.2, 0.5)
    epochs: int | None = None
    epochs_3d: Mapping[str, int] = field(default_factory=lambda: EPOCHS_3D)

    def trainings(self) -> "Iterator[Training]":
        """All trainings, cheapest first."""
        first = self.networks[0]
        for seed in range(self.seeds):
            for method in METHODS:
                yield Training(method, first, seed, self._changes(method, first))
        for dropout in self.dropouts:
            if dropout == SiameseRecipe().dropout:
                continue  # that is the training of seed 0
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
    """One training of the plan.

    Attributes:
        method: by name.
        network: by name.
        seed: of the training; the split into training and validation set is always the same.
        changes: to the method's recipe.
        ablation: what is special about it; empty for those that are compared with the paper.
    """

    method: str
    network: str
    seed: int
    changes: dict[str, Any] = field(default_factory=dict)
    ablation: str = ""

    @property
    def name(self) -> str:
        """Of its run and its model."""
        if not self.network:
            return self.method
        parts = [self.method, self.network, str(self.seed), self.ablation]
        return "-".join(part for part in parts if part)

    def options(self) -> list[object]:
        """Of `placecell train`, where they are not its defaults."""
        options: list[object] = []
        if self.network not in ("", "fast"):
            options += ["--network", self.network]
        if self.changes.get("epochs"):
            options += ["--epochs", self.changes["epochs"]]
        return options
