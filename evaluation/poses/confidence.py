"""Fit of the pose probability: `placecell fit-confidence`.

The probability is a logistic model of the best hypothesis' features, fitted on the cases of several
sensors and places (`cases`). Each sensor is left out of the fit once: the probabilities of its
cases then calibrate the acceptance of poses, and show how well the model carries over. A case whose
map and query are of two sensors has the probability of a fit without both.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from evaluation.calibration import calibration_figures
from evaluation.machine import machine
from evaluation.poses.cases import Cases, FitPair, K, ask
from evaluation.poses.report import SURE, reliability_of
from placecell.core.types import Bool, Float64
from placecell.localization import Confidence
from placecell.localization.acceptance import Acceptance
from placecell.localization.confidence import DEFAULT_RISK, FEATURES, SegmentNeeds
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine

FITTED = ("score", "margin", "spread", "surprise_in_map", "explained_in_map")
"""Features of the model. `share`, `majority` and `residual` depend on the sensor: unmatched
segments and centroid noise are more frequent on real sensors than in the town.
`explained_in_map` tells a street from a similar one."""

PENALTY = 1.0
"""Factor of the squared weights in the loss."""

SIGNS = {name: -1.0 if name == "residual" else 1.0 for name in FEATURES}
"""Sign of each weight: more agreement and a smaller residual never lower the probability. Without
this, correlated features could get weights of opposite signs, which do not generalize."""

LOCALIZED = 0.95
"""Share of the queries in the mapped area that get a right pose, from the number of segments that a
robot needs."""

MOST_NEEDED = 60
"""Largest number of segments that a robot is said to need."""


def fit(
    pairs: Sequence[FitPair],
    model: Path,
    most: int,
    seed: int = 0,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Fit the logistic model; return the content of `confidence.json`.

    Args:
        pairs: the robots of two or more towns.
        model: folder of the model.
        most: largest number of captures of each robot, spread evenly.
        seed: random seed.
        progress: wraps the loop.
    """
    with Engine.temporary(model) as engine:
        cases = ask(pairs, engine, most, seed, progress)
        model_id = engine.model.id
    content = fit_cases(cases)
    content["fitted_on"] = {
        "towns": [pair.town for pair in pairs],
        "sensors": ["+".join(dict.fromkeys(pair.sensors)) for pair in pairs],
        "places": [pair.place for pair in pairs],
        "look_alikes": [pair.look_alikes for pair in pairs],
        "scans": [len(pair.pair.mapper.drive) for pair in pairs],
        "model_id": model_id,
        "cases": len(cases),
        "right": int(cases.right.sum()),
        "queries": most,
        "k": K,
        "seed": seed,
        "machine": machine(),
    }
    return content


def fit_cases(cases: Cases) -> dict[str, Any]:
    """Fit the logistic model to cases; return the content of `confidence.json` about it.

    The calibration of the acceptance uses probabilities of models that were fitted without the
    sensors of a case, or without its town if no case would be left.
    """
    towns = cases.towns[:, None]
    by_sensor = all(rest.any() for _, rest in _left_out(cases.sensors))
    held_out = _held_out(cases, cases.sensors if by_sensor else towns)
    # Laplace's rule of succession limits the highest probability by the wrong sure cases.
    sure = held_out >= 0.99
    highest = 1 - (float((~cases.right[sure]).sum()) + 1) / (float(sure.sum()) + 2)
    stated = np.minimum(highest * held_out, cases.limits)
    false = cases.false & ~cases.rejected
    acceptance = Acceptance.by_group(stated, false, cases.sensors, cases.places)
    fitted = logistic(cases.features, cases.right, highest)
    threshold = acceptance.threshold(max(DEFAULT_RISK, acceptance.smallest_risk))
    told = (stated > threshold) & ~cases.rejected
    by_town = np.minimum(highest * _held_out(cases, towns), cases.limits)
    is_cross = cases.sensors[:, 0] != cases.sensors[:, 1]
    return {
        "features": list(FITTED),
        "model": {
            name: value
            for name, value in asdict(fitted).items()
            if name in {"means", "deviations", "weights", "bias", "highest"}
        },
        "acceptance": acceptance.as_json(),
        "needs": asdict(needs_of(cases, told)),
        "held_out": {
            "reliability": reliability_of(stated, cases.right),
            "brier": calibration_figures(stated, cases.right)["brier"],
            "threshold": threshold,
            "all": figures(cases, stated, threshold, np.ones(len(cases), dtype=bool)),
            "same_sensor": figures(cases, stated, threshold, ~is_cross),
            "cross_sensor": figures(cases, stated, threshold, is_cross),
            "sensors": {
                name: figures(cases, stated, threshold, (cases.sensors == name).any(axis=1))
                for name in np.unique(cases.sensors).tolist()
            },
            "places": {
                name: figures(cases, stated, threshold, cases.places == name)
                for name in np.unique(cases.places).tolist()
            },
            "by_town": figures(cases, by_town, threshold, np.ones(len(cases), dtype=bool)),
        },
    }


def _left_out(groups: NDArray[Any]) -> Iterator[tuple[Bool, Bool]]:
    """Yield the cases of the same groups, bool (n,), and the cases that share no group with them.

    Args:
        groups: (n, m), groups of each case.
    """
    ordered = np.sort(groups, axis=1)
    for own in np.unique(ordered, axis=0):
        alike, shared = (ordered == own).all(axis=1), np.isin(groups, own).any(axis=1)
        yield np.asarray(alike), ~np.asarray(shared)


def _held_out(cases: Cases, groups: NDArray[Any]) -> Float64:
    """Return each case's probability by a model that was fitted without the case's groups."""
    found = np.isfinite(cases.features).all(axis=1)
    held_out = np.zeros(len(cases))
    for here, rest in _left_out(groups):
        if (here & found).any():
            model = logistic(cases.features[rest], cases.right[rest], 1.0)
            held_out[here & found] = model.probabilities(cases.features[here & found])
    return held_out


def figures(cases: Cases, stated: Float64, threshold: float, chosen: Bool) -> dict[str, Any]:
    """Return how reliable the stated probabilities of the chosen cases are.

    Args:
        cases: all cases.
        stated: float64 (n,), their probabilities.
        threshold: probability that a returned pose exceeds.
        chosen: bool (n,), the cases that count.
    """
    told = (stated > threshold) & ~cases.rejected & chosen
    right = cases.right & chosen
    whole = right & cases.answerable & cases.whole
    return {
        "cases": int(chosen.sum()),
        "best_pose_right": int(right.sum()),
        "told_share_of_right": _share(told & right, right),
        "told_share_of_right_captures": _share(told & whole, whole),
        "false_acceptance": _share(told & cases.false, chosen),
        "wrong_but_sure": _share(told & cases.false & (stated >= SURE), chosen),
        **{
            name: None if value is None else round(value, 5)
            for name, value in calibration_figures(stated[chosen], cases.right[chosen]).items()
        },
    }


def _share(part: Bool, whole: Bool) -> float | None:
    return round(float(part.sum()) / float(whole.sum()), 5) if whole.any() else None


def needs_of(cases: Cases, told: Bool) -> SegmentNeeds:
    """Return the number of segments with which robots are usually localized, and its growth.

    The number is the median over the sensors: some see too little of a place from the opposite
    direction, however many segments it is. Only cases of one sensor count, if there are any: in the
    map of another sensor, the two fields of view matter more than the number.
    """
    localized = told & cases.right
    counted = cases.sensors[:, 0] == cases.sensors[:, 1]
    if not counted.any():
        counted[:] = True
    counts = []
    for sensor in np.unique(cases.sensors[counted, 1]):
        own = counted & cases.answerable & (cases.sensors[:, 1] == sensor)
        for count in range(4, MOST_NEEDED):
            near = own & (cases.usable >= count) & (cases.usable < 1.5 * count)
            if near.any() and localized[near].mean() >= LOCALIZED:
                break
        counts.append(count)
    growth = cases.growth[np.isfinite(cases.growth)]
    per_meter = float(np.median(growth)) if len(growth) else SegmentNeeds().per_meter
    return SegmentNeeds(int(np.median(counts)), round(max(per_meter, 0.1), 2))


def logistic(features: Float64, right: Bool, highest: float) -> Confidence:
    """Fit a logistic regression with a small ridge penalty.

    See Hastie et al., *The Elements of Statistical Learning*, section 4.4.

    Args:
        features: float64 (n, features), in the order of `FEATURES`; rows with NaN are left out.
        right: bool (n,).
        highest: highest probability that the model states.
    """
    found = np.isfinite(features).all(axis=1)
    own = features[found][:, [FEATURES.index(name) for name in FITTED]]
    means, deviations = own.mean(axis=0), own.std(axis=0)
    standard = np.column_stack([(own - means) / np.maximum(deviations, 1e-9), np.ones(len(own))])
    signs = np.where(right[found], 1.0, -1.0)

    def loss(weights: Float64) -> tuple[float, Float64]:
        margins = signs * (standard @ weights)
        ridge = PENALTY * np.append(weights[:-1], 0.0)
        pull = -signs / (1 + np.exp(np.clip(margins, -500, 500)))
        value = np.logaddexp(0.0, -margins).sum() + 0.5 * ridge @ weights
        return float(value), np.asarray(standard.T @ pull + ridge)

    bounds = [(0.0, None) if SIGNS[name] > 0 else (None, 0.0) for name in FITTED]
    start = np.zeros(standard.shape[1])
    weights = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=[*bounds, (None, None)]).x
    return Confidence(
        tuple(means.tolist()),
        tuple(np.maximum(deviations, 1e-9).tolist()),
        tuple(weights[:-1].tolist()),
        float(weights[-1]),
        highest,
        FITTED,
    )
