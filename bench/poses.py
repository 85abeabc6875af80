"""How well robots find their place: `placecell evaluate-poses`, DESIGN's protocol.

A pose is right within 1 m and 3 degrees of the truth, where the robot is. It is wrong but sure if
its probability is 0.9 or more and it is off by more than 3 m or 10 degrees.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from bench.local import Local
from bench.pose_queries import MAPPED_METRES, Pair, PoseQuery, random_frame
from segments.extraction import Progress, silent
from segments.localisation import Localisation, LocalisationParameters
from segments.localisation.covariance import at_point
from segments.localisation.evidence import History
from segments.types import Bool, Float64
from training.evaluation import machine
from training.figure import figure

RIGHT = (1.0, 3.0)
OFF = (3.0, 10.0)
"""Metres and degrees."""

SURE = 0.9
MAP = "map"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a query.

    Attributes:
        reason: why it was not localised; empty if it was.
        probability: of the best hypothesis, localised or not.
        metres, degrees: that its pose is off at the sensor; infinite without one.
        normalised: squared error of position and yaw by the stated covariance, a chi-square of
            four degrees of freedom were it exact; NaN if it was not localised.
        milliseconds: from descriptors to the pose.
        driven: metres on the way so far.
        mapped: whether the mapping robot was near by.
    """

    reason: str
    probability: float
    metres: float
    degrees: float
    normalised: float
    milliseconds: float
    driven: float
    mapped: bool

    @property
    def localised(self) -> bool:
        """Whether a pose was told."""
        return not self.reason

    @property
    def right(self) -> bool:
        """Whether the best hypothesis is right, told or not."""
        return self.metres <= RIGHT[0] and self.degrees <= RIGHT[1]

    @property
    def wrong_but_sure(self) -> bool:
        """Whether the robot was misled."""
        off = self.metres > OFF[0] or self.degrees > OFF[1]
        return self.localised and off and self.probability >= SURE


def evaluate(
    pair: Pair,
    model: Path,
    k: int = 25,
    parameters: LocalisationParameters | None = None,
    session: bool = False,
    seed: int = 0,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Ask for every frame of a drive; the report as `placecell evaluate-poses` writes it.

    Args:
        model: its folder.
        k: candidates a segment.
        session: whether the requests are of one session, at the times of their scans.
        seed: of the robot's own frame.

    Raises:
        ValueError: the drives give no segments.
    """
    parameters = parameters or LocalisationParameters()
    with Local.open(model) as local:
        compact = pair.mapper.build_map(local, pair.mapper.name)
        size = local.put_map(MAP, compact)
        queries = [each for each in pair.queries(local, random_frame(seed)) if len(each.codes)]
        if not queries or not len(compact):
            raise ValueError(f"{pair.mapper.drive.folder}: the drives give no segments")
        model_id = local.model.id
        # What compiles at its first use does so now.
        local.localise(queries[0].codes, queries[0].centroids, MAP, k, parameters)
        history = History(parameters)
        outcomes = []
        for number in progress(range(len(queries)), len(queries), "localising"):
            query = queries[number]
            evidence = history.at(query.time) if session else None
            found, milliseconds = local.localise(
                query.codes, query.centroids, MAP, k, parameters, evidence
            )
            history.add(query.time, found.hypotheses)
            outcomes.append(outcome_of(found, query, milliseconds))
    first = pair.asker.recordings[0].parameters
    return {
        "map_drive": pair.mapper.drive.folder.name,
        "query_drive": pair.asker.drive.folder.name,
        "blocks": pair.blocks,
        "protocol": first.protocol,
        "every": first.frame_step,
        "accumulated_scans": first.accumulated_scans,
        "model_id": model_id,
        "motion": parameters.model,
        "session": session,
        "k": k,
        "seed": seed,
        "machine": machine(),
        "map_segments": len(compact),
        "map_bytes": size,
        "query_segments_mean": round(float(np.mean([len(each.codes) for each in queries])), 1),
        "mapped_metres": None if pair.blocks else MAPPED_METRES,
    } | report(outcomes)


def outcome_of(found: Localisation, query: PoseQuery, milliseconds: float) -> Outcome:
    """Compare with the truth."""
    metres = degrees = np.inf
    normalised = np.nan
    if found.best is not None:
        pose = found.best.pose
        metres, angle = pose.difference(query.truth, query.sensor)
        degrees = float(np.degrees(angle))
        if found.pose is not None:
            covariance = at_point(found.best.covariance, pose, query.sensor)[:4, :4]
            turn = query.truth.rotation @ pose.rotation.T
            error = np.append(
                query.truth.apply(query.sensor) - pose.apply(query.sensor),
                np.arctan2(turn[1, 0], turn[0, 0]),
            )
            normalised = float(error @ np.linalg.solve(covariance, error))
    return Outcome(
        found.reason or "",
        found.probability,
        metres,
        degrees,
        normalised,
        milliseconds,
        query.metres,
        query.mapped,
    )


def report(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """All figures. Shares are of the queries within the map; those beyond it stand apart."""
    within = [each for each in outcomes if each.mapped]
    beyond = [each for each in outcomes if not each.mapped]
    told = [each for each in within if each.localised]
    milliseconds = [each.milliseconds for each in outcomes]
    normalised = [each.normalised for each in told if each.right]
    p50, p99 = (round(float(np.percentile(milliseconds, at)), 2) for at in (50, 99))
    return {
        **shares(within),
        "reasons": reasons(within),
        "median_position_error_m": median([each.metres for each in told]),
        "median_yaw_error_deg": median([each.degrees for each in told]),
        "p50_ms": p50,
        "p99_ms": p99,
        "beyond_the_map": shares(beyond) | {"reasons": reasons(beyond)},
        "precision_recall": precision_recall(within),
        "reliability": reliability(outcomes),
        "covariance_ratio": median(normalised, stats.chi2.median(4)),
        "metres_until_localised": until_localised(within),
    }


def shares(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """How many were right, wrong and unknown, with 95% bounds (Clopper and Pearson)."""
    counts = {
        "localised_right": sum(each.localised and each.right for each in outcomes),
        "wrong_but_sure": sum(each.wrong_but_sure for each in outcomes),
        "not_localised": sum(not each.localised for each in outcomes),
    }
    n = len(outcomes)
    return {
        "queries": n,
        **{name: round(count / n, 5) if n else None for name, count in counts.items()},
        "counts": counts,
        "bounds_95": {name: bounds(count, n) for name, count in counts.items()},
    }


def bounds(count: int, n: int) -> list[float]:
    """95% bounds of a share, exact."""
    low = stats.beta.ppf(0.025, count, n - count + 1) if count else 0.0
    high = stats.beta.ppf(0.975, count + 1, n - count) if count < n else 1.0
    return [round(float(low), 5), round(float(high), 5)]


def reasons(outcomes: Sequence[Outcome]) -> dict[str, int]:
    """How often each reason was told."""
    told = sorted(each.reason for each in outcomes if each.reason)
    return {reason: told.count(reason) for reason in dict.fromkeys(told)}


def precision_recall(outcomes: Sequence[Outcome]) -> list[dict[str, float]]:
    """Of those told with a probability or more: how many are right, and of all, how many so."""
    rows = []
    for at in (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995):
        told = [each for each in outcomes if each.localised and each.probability >= at]
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
    """Stated against true probability of the best hypothesis, told or not."""
    stated = np.array([each.probability for each in outcomes])
    right = np.array([each.right for each in outcomes], dtype=bool)
    return reliability_of(stated, right)


def reliability_of(stated: Float64, right: Bool) -> list[dict[str, float]]:
    """By tenths, the last of them finer."""
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


def until_localised(outcomes: Sequence[Outcome]) -> dict[str, float | None]:
    """Metres driven until a pose is right and sure, switched on at each query in turn."""
    good = [each.localised and each.right and each.probability >= SURE for each in outcomes]
    metres = []
    for start, first in enumerate(outcomes):
        later = next((i for i in range(start, len(good)) if good[i]), None)
        if later is not None:
            metres.append(outcomes[later].driven - first.driven)
    return {
        "median": median(metres),
        "p95": round(float(np.percentile(metres, 95)), 2) if metres else None,
        "never": len(outcomes) - len(metres),
    }


def median(values: Sequence[float], by: float = 1.0) -> float | None:
    """Rounded; None of nothing."""
    return round(float(np.median(values)) / by, 4) if len(values) else None


def draw(report: dict[str, Any], file: Path) -> None:
    """Precision and recall over the stated probability, and how true it is, as a PNG."""
    with figure(file, 2) as (curve, diagram):
        rows = report["precision_recall"]
        recall, precision = ([row[name] for row in rows] for name in ("recall", "precision"))
        curve.plot(recall, precision, marker="o", markersize=3)
        curve.set(xlabel="recall", ylabel="precision", xlim=(0, 1.02), title=report["query_drive"])
        bins = report["reliability"]
        diagram.plot([0, 1], [0, 1], color="0.7", linestyle=":")
        diagram.scatter(
            [each["stated"] for each in bins],
            [each["right"] for each in bins],
            [4 + 100 * each["count"] / sum(one["count"] for one in bins) for each in bins],
        )
        diagram.set(xlabel="stated probability", ylabel="right", title="reliability")
        for axes in (curve, diagram):
            axes.grid(alpha=0.3)
