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
from placecell.localization.acceptance import Acceptance, check_risk
from placecell.localization.candidates import Candidates
from placecell.localization.chance import surprise
from placecell.localization.hypothesis import Hypothesis
from placecell.localization.overlap import ExplainedShares, SegmentsInMap

NAME = "confidence.json"

PACKAGED = Path(__file__).with_name(NAME)
"""Copy of the default model's constants in an installed package, which has no models beside it."""

SHIPPED = PACKAGED if PACKAGED.is_file() else MODELS_FOLDER / DEFAULT_MODEL / NAME
"""Constants of the default model."""

DEFAULT_RISK = 0.001
"""Default of `max_false_acceptance`."""

FEATURES = (
    "score",
    "margin",
    "inliers",
    "share",
    "residual",
    "spread",
    "surprise",
    "majority",
    "explained",
    "explained_in_plan",
    "surprise_in_map",
    "explained_in_map",
)
"""Names of all features. A file names those that its model uses: earlier versions used the first
six, five of the first eight, `explained`, whose distances are in space, or `surprise` and
`explained_in_plan`, which count the segments beyond the edge of the map too."""


MAJORITY = 0.5
"""Share of inliers from which a larger one says nothing about the pose: no other place can have
more. It depends on the sensor, and on what has changed since the map was made."""

FEW = 8
"""Number of segments with which an explained share counts half: few segments of similar streets
are all explained now and then."""


def features_of(
    best: Hypothesis,
    score: float,
    rival: float,
    usable: int,
    candidates: Candidates,
    explained: ExplainedShares,
    in_map: SegmentsInMap,
) -> Float64:
    """Return all features of a hypothesis, float64 (features,), in the order of `FEATURES`.

    Args:
        best: best hypothesis.
        score: its score, with the support of earlier requests.
        rival: score of the best hypothesis at another place, divided by `score`; 0 without one.
        usable: number of queries that have candidates.
        candidates: candidates of all queries.
        explained: shares of the robot's segments that the map explains (`overlap`).
        in_map: the robot's segments where the map has been.
    """
    plan = best.source[:, :2] - best.source[:, :2].mean(axis=0)
    # The smaller horizontal extent: segments in a row determine less than segments all around.
    spread = np.sqrt(max(np.linalg.eigvalsh(plan.T @ plan / len(best))[0], 0.0))
    return np.array(
        [
            np.log(max(score, 1e-9)),
            1 - rival,
            np.log(len(best)),
            len(best) / usable,
            np.sqrt(np.mean(best.residuals**2)),
            np.log1p(spread),
            np.arcsinh(surprise(best.pose, candidates)),
            min(len(best) / usable, MAJORITY),
            explained.in_space * usable / (usable + FEW),
            explained.in_plan * usable / (usable + FEW),
            np.arcsinh(surprise(best.pose, in_map.candidates)),
            in_map.explained.in_plan * in_map.usable / (in_map.usable + FEW),
        ]
    )


def with_rival(features: Float64, rival: float) -> Float64:
    """Return the features with another rival's score, divided by that of the hypothesis."""
    changed = features.copy()
    changed[FEATURES.index("margin")] = 1 - rival
    return changed


@dataclass(frozen=True, slots=True)
class SegmentNeeds:
    """Segments that a robot needs, and how fast it sees more of them as it starts to drive.

    Attributes:
        segments: number of segments with candidates with which robots are usually localized.
        per_meter: segments that are added per meter in the first meters of a drive.
    """

    segments: int = 15
    per_meter: float = 1.0


@dataclass(frozen=True, slots=True)
class Confidence:
    """Constants of the logistic model.

    Attributes:
        means: mean of each feature in the fitting data.
        deviations: standard deviation of each feature in the fitting data.
        weights: weight of each standardized feature.
        bias: value added to the weighted sum.
        highest: largest probability that the number of fitting cases justifies.
        features: names of the features, of `FEATURES`.
        acceptance: calibration of the threshold; None in a file of an earlier version.
        needs: segments that a robot needs; assumed values in a file of an earlier version.
    """

    means: tuple[float, ...]
    deviations: tuple[float, ...]
    weights: tuple[float, ...]
    bias: float
    highest: float
    features: tuple[str, ...] = FEATURES
    acceptance: Acceptance | None = None
    needs: SegmentNeeds = SegmentNeeds()

    def probability(self, features: Float64) -> float:
        """Return the probability that a pose with these features is right."""
        return float(self.probabilities(features[None])[0])

    def probabilities(self, features: Float64) -> Float64:
        """Return the probability of each pose, float64 (n,).

        Args:
            features: float64 (n, features), in the order of `FEATURES`.
        """
        own = features[:, [FEATURES.index(name) for name in self.features]]
        standard = (own - np.array(self.means)) / np.array(self.deviations)
        logits = np.clip(standard @ np.array(self.weights) + self.bias, -500.0, 500.0)
        return np.asarray(self.highest / (1 + np.exp(-logits)))

    def threshold(self, risk: float | None, without: float) -> tuple[float, float | None]:
        """Return the probability that a pose must exceed, and the risk that it stands for.

        Args:
            risk: `max_false_acceptance`; None for the default.
            without: threshold of a model without calibration.

        Raises:
            ValueError: The risk is out of range, or the model's calibration does not support it.
        """
        if risk is not None:
            check_risk(risk)
        if self.acceptance is None:
            if risk is not None:
                raise ValueError(
                    "The model has no calibration for max_false_acceptance. Fit one with "
                    "'placecell fit-confidence --model NAME'."
                )
            return without, None
        if risk is None:
            risk = max(DEFAULT_RISK, self.acceptance.smallest_risk)
        return self.acceptance.threshold(risk), risk

    @classmethod
    def load(cls, file: Path = SHIPPED, model_id: str | None = None) -> Self:
        """Load a file of `placecell fit-confidence`.

        Args:
            model_id: model that the file must be fitted for; None for any.

        Raises:
            ValueError: The file has unknown features, or was fitted for another model.
        """
        content = json.loads(file.read_text())
        unknown = sorted(set(content["features"]) - set(FEATURES))
        if unknown:
            raise ValueError(
                f"{file}: unknown features {', '.join(unknown)}; expected some of "
                f"{', '.join(FEATURES)}. Fit the file again with 'placecell fit-confidence'."
            )
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
            tuple(content["features"]),
            Acceptance.of_json(content["acceptance"]) if "acceptance" in content else None,
            SegmentNeeds(**content["needs"]) if "needs" in content else SegmentNeeds(),
        )


@cache
def shipped() -> Confidence:
    """Return the constants of the default model."""
    return Confidence.load()
