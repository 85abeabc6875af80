"""Figures of localization: shares of right poses, and reliability of their probabilities.

A pose is right within 1 m and 3 degrees of the truth, where the robot is. It is wrong but sure if
its probability is 0.9 or more and it is off by more than 3 m or 10 degrees.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from evaluation.calibration import calibration_figures
from placecell.core.types import Bool, Float64

RIGHT = (1.0, 3.0)
OFF = (3.0, 10.0)
"""Tolerances of a right pose, and of one that is not misleading: meters and degrees."""

WIDE = (2.0, 5.0)
"""Tolerances of a success in the literature on global registration: meters and degrees."""

SURE = 0.9
"""Probability from which a pose counts as sure."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """Outcome of a query.

    Attributes:
        reason: reason for "not localized"; empty if localized.
        probability: probability of the best hypothesis, localized or not.
        meters, degrees: pose error of the best hypothesis at the sensor; infinite without one.
        normalized: squared error of position and yaw over the stated covariance. It follows a
            chi-square distribution with four degrees of freedom if the covariance is exact. NaN if
            not localized.
        milliseconds: time from descriptors to the pose.
        driven: distance driven so far, meters.
        mapped: whether the query is in the mapped area.
    """

    reason: str
    probability: float
    meters: float
    degrees: float
    normalized: float
    milliseconds: float
    driven: float
    mapped: bool

    @property
    def localized(self) -> bool:
        """Return whether the answer has a pose."""
        return not self.reason

    @property
    def right(self) -> bool:
        """Return whether the best hypothesis is right, localized or not."""
        return self.meters <= RIGHT[0] and self.degrees <= RIGHT[1]

    @property
    def within_2m_5deg(self) -> bool:
        """Return whether the best hypothesis is within 2 m and 5 degrees, localized or not."""
        return self.meters <= WIDE[0] and self.degrees <= WIDE[1]

    @property
    def wrong_but_sure(self) -> bool:
        """Return whether the pose is misleading: sure, but far off."""
        off = self.meters > OFF[0] or self.degrees > OFF[1]
        return self.localized and off and self.probability >= SURE


def report(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return all figures; shares are of queries in the mapped area, others are counted apart."""
    within = [each for each in outcomes if each.mapped]
    beyond = [each for each in outcomes if not each.mapped]
    told = [each for each in within if each.localized]
    milliseconds = [each.milliseconds for each in outcomes]
    normalized = [each.normalized for each in told if each.right]
    p50, p99 = (round(float(np.percentile(milliseconds, at)), 2) for at in (50, 99))
    return {
        **shares(within),
        **best_pose_shares(within),
        **calibration(outcomes),
        "reasons": reasons(within),
        "median_position_error_m": median([each.meters for each in told]),
        "median_yaw_error_deg": median([each.degrees for each in told]),
        "p50_ms": p50,
        "p99_ms": p99,
        "beyond_the_map": shares(beyond) | {"reasons": reasons(beyond)},
        "precision_recall": precision_recall(within),
        "reliability": reliability(outcomes),
        "covariance_ratio": median(normalized, stats.chi2.median(4)),
        "metres_until_localised": until_localized(within),
    }


def shares(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return the shares of right, wrong and missing poses, with 95% Clopper-Pearson bounds."""
    counts = {
        "localised_right": sum(each.localized and each.right for each in outcomes),
        "wrong_but_sure": sum(each.wrong_but_sure for each in outcomes),
        "not_localised": sum(not each.localized for each in outcomes),
    }
    n = len(outcomes)
    return {
        "queries": n,
        **{name: share(count, n) for name, count in counts.items()},
        "counts": counts,
        "bounds_95": {name: bounds(count, n) for name, count in counts.items()},
    }


def best_pose_shares(outcomes: Sequence[Outcome]) -> dict[str, float | None]:
    """Return how many best hypotheses are right, and what share of these is told.

    `success_...` counts the poses that are told, `best_pose_...` the best hypotheses.
    """
    n = len(outcomes)
    right = [each for each in outcomes if each.right]
    near = [each for each in outcomes if each.within_2m_5deg]
    told = sum(each.localized for each in right)
    return {
        "best_pose_right": share(len(right), n),
        "told_share_of_right": share(told, len(right)),
        "success_1m_3deg": share(told, n),
        "success_2m_5deg": share(sum(each.localized for each in near), n),
        "best_pose_2m_5deg": share(len(near), n),
    }


def calibration(outcomes: Sequence[Outcome]) -> dict[str, float | None]:
    """Return the calibration of the stated probabilities of the best hypotheses, told or not.

    A query without any hypothesis states no probability, so it does not count.
    """
    stated = [each for each in outcomes if np.isfinite(each.meters)]
    return calibration_figures(
        np.array([each.probability for each in stated]),
        np.array([each.right for each in stated], dtype=bool),
    )


def share(count: int, n: int) -> float | None:
    """Return a rounded share; None of nothing."""
    return round(count / n, 5) if n else None


def bounds(count: int, n: int) -> list[float]:
    """Return the exact 95% bounds of a share."""
    low = stats.beta.ppf(0.025, count, n - count + 1) if count else 0.0
    high = stats.beta.ppf(0.975, count + 1, n - count) if count < n else 1.0
    return [round(float(low), 5), round(float(high), 5)]


def reasons(outcomes: Sequence[Outcome]) -> dict[str, int]:
    """Count each reason for "not localized"."""
    told = sorted(each.reason for each in outcomes if each.reason)
    return {reason: told.count(reason) for reason in dict.fromkeys(told)}


def precision_recall(outcomes: Sequence[Outcome]) -> list[dict[str, float]]:
    """Return precision and recall of the poses above each probability."""
    rows = []
    for at in (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995):
        told = [each for each in outcomes if each.localized and each.probability >= at]
        right = sum(each.right for each in told)
        if told:
            rows.append(
                {
                    "probability": at,
                    "precision": round(right / len(told), 5),
                    "recall": round(right / len(outcomes), 5),
                }
            )
    return rows


def reliability(outcomes: Sequence[Outcome]) -> list[dict[str, float]]:
    """Return the stated and the true probability of the best hypotheses, localized or not."""
    stated = np.array([each.probability for each in outcomes])
    right = np.array([each.right for each in outcomes], dtype=bool)
    return reliability_of(stated, right)


def reliability_of(stated: Float64, right: Bool) -> list[dict[str, float]]:
    """Return mean stated probability, share of right poses, and count, per bin of probability."""
    edges = np.array([*np.arange(0, 1, 0.1), 0.95, 0.99])
    place = np.searchsorted(edges, stated, side="right") - 1
    return [
        {
            "stated": round(float(stated[place == bin_].mean()), 4),
            "right": round(float(right[place == bin_].mean()), 4),
            "count": int((place == bin_).sum()),
        }
        for bin_ in np.unique(place)
    ]


def until_localized(outcomes: Sequence[Outcome]) -> dict[str, float | None]:
    """Return the distance from a start until a right and sure pose, over all queries as starts."""
    good = [each.localized and each.right and each.probability >= SURE for each in outcomes]
    meters = []
    for start, first in enumerate(outcomes):
        later = next((i for i in range(start, len(good)) if good[i]), None)
        if later is not None:
            meters.append(outcomes[later].driven - first.driven)
    return {
        "median": median(meters),
        "p95": round(float(np.percentile(meters, 95)), 2) if meters else None,
        "never": len(outcomes) - len(meters),
    }


def median(values: Sequence[float], by: float = 1.0) -> float | None:
    """Return the rounded median of values divided by `by`; None if there are none."""
    return round(float(np.median(values)) / by, 4) if len(values) else None
