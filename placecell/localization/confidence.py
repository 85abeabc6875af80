"""Confidence: the probability that a pose is right, a logistic model fitted on drives.

`confidence.json` holds the constants of the logistic model, the drives that they were fitted on,
and how reliable the probabilities are. `placecell fit-confidence` makes the file. Each model has
its own file in its folder, since scores of two models differ; a model without one uses the default
model's.
"""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Self

import numpy as np

from placecell.core.types import Float64
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from placecell.localization.hypothesis import Hypothesis

NAME = "confidence.json"

PACKAGED = Path(__file__).with_name(NAME)
"""Copy of the default model's constants in an installed package, which has no models beside it."""

SHIPPED = PACKAGED if PACKAGED.is_file() else MODELS_FOLDER / DEFAULT_MODEL / NAME
"""Constants of the default model."""

FEATURES = ("score", "margin", "inliers", "share", "residual", "spread")


def features_of(best: Hypothesis, score: float, rival: float, usable: int) -> Float64:
    """What the probability follows from, float64 (6,), in the order of `FEATURES`.

    Args:
        score: of the best hypothesis, with the support of earlier requests.
        rival: share of that score that the best one at another place has; 0 if there is none.
        usable: queries that had candidates.
    """
    plan = best.source[:, :2] - best.source[:, :2].mean(axis=0)
    # The narrower of the two horizontal extents: segments in a row fix less than ones all around.
    spread = np.sqrt(max(np.linalg.eigvalsh(plan.T @ plan / len(best))[0], 0.0))
    return np.array(
        [
            np.log(max(score, 1e-9)),
            1 - rival,
            np.log(len(best)),
            len(best) / usable,
            np.sqrt(np.mean(best.residuals**2)),
            np.log1p(spread),
        ]
    )


@dataclass(frozen=True, slots=True)
class Confidence:
    """Constants of the logistic model.

    Attributes:
        means: of the features where it was fitted.
        deviations: of the features there.
        weights: of the standardized features.
        bias: added to their sum.
        highest: probability that is never exceeded: no more than the cases that were seen allow.
    """

    means: tuple[float, ...]
    deviations: tuple[float, ...]
    weights: tuple[float, ...]
    bias: float
    highest: float

    def probability(self, features: Float64) -> float:
        """That a pose with these features is right."""
        return float(self.probabilities(features[None])[0])

    def probabilities(self, features: Float64) -> Float64:
        """Of many poses: features (n, 6), probabilities float64 (n,)."""
        standard = (features - np.array(self.means)) / np.array(self.deviations)
        logits = np.clip(standard @ np.array(self.weights) + self.bias, -500.0, 500.0)
        return np.asarray(np.minimum(1 / (1 + np.exp(-logits)), self.highest))

    @classmethod
    def load(cls, file: Path = SHIPPED, model_id: str | None = None) -> Self:
        """From a file of `placecell fit-confidence`.

        Args:
            model_id: that it has to be fitted for, if any.

        Raises:
            ValueError: it is of other features than this program's, or for another model.
        """
        content = json.loads(file.read_text())
        if tuple(content["features"]) != FEATURES:
            raise ValueError(f"{file}: of the features {content['features']}, not {FEATURES}")
        fitted_for = content["fitted_on"]["model_id"]
        if model_id not in {None, fitted_for}:
            raise ValueError(f"{file}: for model {fitted_for}, not {model_id}")
        model = content["model"]
        return cls(
            tuple(model["means"]),
            tuple(model["deviations"]),
            tuple(model["weights"]),
            model["bias"],
            model["highest"],
        )


@cache
def shipped() -> Confidence:
    """Return the constants of the default model."""
    return Confidence.load()
