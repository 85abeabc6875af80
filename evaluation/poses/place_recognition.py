"""Place recognition as in the literature: one retrieved map frame for each query.

A query retrieves the map frame that is nearest to the position of its best hypothesis, localized or
not. Its score is the stated probability. docs/results/localization.md defines the figures.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from evaluation.poses.queries import PoseQuery
from evaluation.poses.report import share
from placecell.core.types import Bool, Float64
from placecell.localization import Localization

RADII_M = (3.0, 5.0, 10.0, 20.0, 25.0)
"""Radii of `recall_at_1_within_m`, meters."""


@dataclass(frozen=True, slots=True)
class PlaceProtocol:
    """Rules of a published evaluation.

    Attributes:
        name: name of the protocol.
        revisit_m: largest distance of a right map frame, meters.
        apart_m: distance beyond which a map frame is wrong, meters; between both it does not count.
        skip_seconds: on one drive, the map holds what is at least as old as this, seconds.
        flat: whether distances are horizontal.
    """

    name: str
    revisit_m: float
    apart_m: float
    skip_seconds: float
    flat: bool = False


PROTOCOLS = {
    each.name: each
    for each in (
        # LoGG3D-Net (Vidanapathirana et al. 2022), the configuration of its authors.
        PlaceProtocol("kitti-loops", 3.0, 20.0, 30.0),
        PlaceProtocol("mulran", 3.0, 20.0, 90.0),
        # ImLPR (Jung et al. 2025), the evaluation of the data set's authors.
        PlaceProtocol("helipr", 10.0, 10.0, 60.0, flat=True),
    )
}


@dataclass(frozen=True, slots=True)
class PlaceAnswer:
    """Map frame that a query retrieved.

    Attributes:
        score: stated probability; 0 without an answer.
        retrieved_m: distance from the true position to the retrieved frame, meters; infinite
            without an answer.
        nearest_m: distance from the true position to the nearest map frame, meters; infinite if the
            map has no frame.
    """

    score: float
    retrieved_m: float
    nearest_m: float


def place_answer(
    found: Localization | None, query: PoseQuery, frames: Float64, *, flat: bool = False
) -> PlaceAnswer:
    """Return the map frame that a query retrieves.

    Args:
        found: result of the localization; None if the map has no segment.
        query: the query.
        frames: float64 (n, 3), positions of the map frames, in the map's coordinates.
        flat: whether distances are horizontal.
    """
    if not len(frames):
        return PlaceAnswer(0.0, np.inf, np.inf)
    axes = 2 if flat else 3
    away = np.linalg.norm((frames - query.truth.apply(query.sensor))[:, :axes], axis=1)
    nearest = float(away.min())
    if found is None or found.best is None:
        return PlaceAnswer(0.0, np.inf, nearest)
    place = found.best.pose.apply(query.sensor)
    retrieved = int(np.linalg.norm((frames - place)[:, :axes], axis=1).argmin())
    return PlaceAnswer(found.probability, float(away[retrieved]), nearest)


def place_figures(answers: Sequence[PlaceAnswer], protocol: PlaceProtocol) -> dict[str, Any]:
    """Return the figures of a protocol.

    A revisit is a query with a map frame within `revisit_m`. For `f1_max`, a query is positive if
    its score reaches a threshold. It is then a true positive if the retrieved frame is within
    `revisit_m`, and a false positive if it is beyond `apart_m`. A revisit that is not positive is a
    false negative. The threshold is the one with the highest F1.
    """
    score = np.array([each.score for each in answers])
    retrieved = np.array([each.retrieved_m for each in answers])
    nearest = np.array([each.nearest_m for each in answers])
    revisit = nearest <= protocol.revisit_m
    right = retrieved <= protocol.revisit_m
    return {
        "queries": len(answers),
        "revisits": int(revisit.sum()),
        "recall_at_1": share(int((right & revisit).sum()), int(revisit.sum())),
        **best_f1(score, retrieved, revisit, protocol),
        "recall_at_1_within_m": {
            f"{radius:g}": share(
                int((retrieved[nearest <= radius] <= radius).sum()), int((nearest <= radius).sum())
            )
            for radius in RADII_M
        },
        "revisit_m": protocol.revisit_m,
        "apart_m": protocol.apart_m,
    }


def best_f1(
    score: Float64, retrieved: Float64, revisit: Bool, protocol: PlaceProtocol
) -> dict[str, float | None]:
    """Return the highest F1 over all thresholds of the score, with its precision and recall."""
    answered = np.isfinite(retrieved)
    right, wrong = retrieved <= protocol.revisit_m, answered & (retrieved > protocol.apart_m)
    found = (0.0, 0.0, 0.0)
    for threshold in np.unique(score[answered]):
        positive = answered & (score >= threshold)
        true, false = int((positive & right).sum()), int((positive & wrong).sum())
        missed = int((~positive & revisit).sum())
        if true:
            precision, recall = true / (true + false), true / (true + missed)
            found = max(found, (2 * precision * recall / (precision + recall), precision, recall))
    names = ("f1_max", "f1_max_precision", "f1_max_recall")
    return {
        name: round(value, 5) if revisit.any() else None
        for name, value in zip(names, found, strict=True)
    }
