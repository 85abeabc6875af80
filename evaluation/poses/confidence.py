"""Fit of the pose probability: `placecell fit-confidence`.

In each town, two robots drive the same streets in opposite directions. Each capture of one robot is
localized in the other's map, with all segments and with a few, and in a joined map of all towns.
It is also localized where no answer is right: in the map of another town, and in the other's map
without the segments near the robot, where at best a similar street is found.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client.maps.edit import take
from scipy.optimize import minimize

from evaluation.machine import machine
from evaluation.poses.queries import Pair, PoseQuery, joined, localize_query, random_frame
from evaluation.poses.report import RIGHT, reliability_of
from placecell.core.types import Bool, Float64, Int64
from placecell.localization import Confidence, LocalizationParameters, Pose
from placecell.localization.confidence import FEATURES
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine

FEW = (6, 8, 12, 20)
"""Numbers of segments drawn from a capture."""

APART = 3_000.0
"""Distance between the towns of the joined map, meters."""

NEAR = 80.0
"""Radius around the robot that is removed from a map without a right answer, meters."""

K = 25
"""Candidates per segment."""

QUERIES = 150
"""Queries of each robot in each town, spread evenly: more towns teach more than more captures."""

PENALTY = 1.0
"""Factor of the squared weights in the loss."""

SIGNS = {name: -1.0 if name == "residual" else 1.0 for name in FEATURES}
"""Sign of each weight: more agreement and a smaller residual never lower the probability. Without
this, correlated features could get weights of opposite signs, which do not generalize."""


@dataclass(frozen=True, slots=True, eq=False)
class Cases:
    """Best hypotheses of queries.

    Attributes:
        features: float64 (n, features), features of the hypotheses.
        right: bool (n,), whether the hypothesis is right.
        towns: int64 (n,), town of the query.
    """

    features: Float64
    right: Bool
    towns: Int64


def fit(
    pairs: Sequence[Pair], model: Path, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Fit the logistic model; return the content of `confidence.json`.

    The held-out figures are of towns that the model was not fitted on, each left out in turn.

    Args:
        pairs: the robots of two or more towns.
        model: folder of the model.
        seed: random seed.
        progress: wraps the loop.
    """
    with Engine.temporary(model) as engine:
        cases = ask(pairs, engine, seed, progress)
        model_id = engine.model.id
    held_out = np.zeros(len(cases.right))
    for town in np.unique(cases.towns):
        rest, here = cases.towns != town, cases.towns == town
        held_out[here] = logistic(cases.features[rest], cases.right[rest], 1.0).probabilities(
            cases.features[here]
        )
    # Laplace's rule of succession limits the highest probability by the wrong sure cases.
    sure = held_out >= 0.99
    highest = 1 - (float((~cases.right[sure]).sum()) + 1) / (float(sure.sum()) + 2)
    fitted = logistic(cases.features, cases.right, highest)
    return {
        "features": list(FEATURES),
        "model": asdict(fitted),
        "fitted_on": {
            "towns": len(pairs),
            "scans": [len(pair.mapper.drive) for pair in pairs],
            "model_id": model_id,
            "cases": len(cases.right),
            "right": int(cases.right.sum()),
            "queries": QUERIES,
            "k": K,
            "seed": seed,
            "machine": machine(),
        },
        "held_out": {
            "reliability": reliability_of(np.minimum(held_out, highest), cases.right),
            "brier": round(float(np.mean((held_out - cases.right) ** 2)), 5),
        },
    }


def logistic(features: Float64, right: Bool, highest: float) -> Confidence:
    """Fit a logistic regression with a small ridge penalty.

    See Hastie et al., *The Elements of Statistical Learning*, section 4.4.

    Args:
        features: float64 (n, features).
        right: bool (n,).
        highest: highest probability that the model states.
    """
    means, deviations = features.mean(axis=0), features.std(axis=0)
    standard = np.column_stack([(features - means) / deviations, np.ones(len(features))])
    signs = np.where(right, 1.0, -1.0)

    def loss(weights: Float64) -> tuple[float, Float64]:
        margins = signs * (standard @ weights)
        ridge = PENALTY * np.append(weights[:-1], 0.0)
        pull = -signs / (1 + np.exp(np.clip(margins, -500, 500)))
        value = np.logaddexp(0.0, -margins).sum() + 0.5 * ridge @ weights
        return float(value), np.asarray(standard.T @ pull + ridge)

    bounds = [(0.0, None) if SIGNS[name] > 0 else (None, 0.0) for name in FEATURES]
    start = np.zeros(standard.shape[1])
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=[*bounds, (None, None)]).x
    return Confidence(
        tuple(means.tolist()),
        tuple(deviations.tolist()),
        tuple(found[:-1].tolist()),
        float(found[-1]),
        highest,
    )


def ask(pairs: Sequence[Pair], engine: Engine, seed: int, progress: Progress) -> Cases:
    """Localize each robot of each pair in the map of the other, and in other maps."""
    random = np.random.default_rng(seed)
    frame = random_frame(seed)
    both = [*pairs, *(pair.swapped() for pair in pairs)]
    maps = [pair.mapper.build_map(engine, "town") for pair in both]
    shifts = [np.array([APART * index, 0.0, 0.0]) for index in range(len(pairs))]
    names = [f"map-{index}" for index in range(len(both))]
    for name, compact in zip(names, maps, strict=True):
        engine.put_map(name, compact)
    # A joined map holds one map per town, because a robot would find its own map.
    for way in range(2):
        half = maps[way * len(pairs) : (way + 1) * len(pairs)]
        engine.put_map(f"joined-{way}", joined(half, shifts))
    features, right, towns = [], [], []
    for index in progress(range(len(both)), len(both), "localizing"):
        town, way = index % len(pairs), index // len(pairs)
        elsewhere = names[way * len(pairs) + (town + 1) % len(pairs)]
        for query in both[index].queries(engine, frame, QUERIES):
            there = Pose(np.eye(3), shifts[town]).after(query.truth)
            place = query.truth.apply(query.sensor)
            far = np.linalg.norm(maps[index].centroids - place, axis=1) > NEAR
            if engine.maps.find("without") is not None:
                engine.delete_map("without")
            engine.put_map("without", take(maps[index], far))
            asked = [
                (query, names[index], query.truth),
                (query, elsewhere, None),
                *((each, "without", None) for each in (query, *parts(query, random, (20,)))),
                *((each, names[index], query.truth) for each in parts(query, random)),
                *((each, f"joined-{way}", there) for each in (query, *parts(query, random, (12,)))),
            ]
            for each, name, truth in asked:
                found, _ = localize_query(engine, each, name, K, LocalizationParameters())
                if found.best is not None and found.features is not None:
                    features.append(found.features)
                    right.append(truth is not None and near(found.best.pose, truth, query.sensor))
                    towns.append(town)
    return Cases(np.array(features), np.array(right), np.array(towns))


def parts(
    query: PoseQuery, random: np.random.Generator, sizes: Sequence[int] = FEW
) -> Iterator[PoseQuery]:
    """Yield the query with some of its segments, for each size."""
    for size in sizes:
        if size < len(query.codes):
            yield query.some(np.sort(random.choice(len(query.codes), size, replace=False)))


def near(pose: Pose, truth: Pose, sensor: Float64) -> bool:
    """Return whether a pose is right."""
    meters, angle = pose.difference(truth, sensor)
    return meters <= RIGHT[0] and bool(np.degrees(angle) <= RIGHT[1])
