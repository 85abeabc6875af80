"""Chance: how surprising a pose's support is if the pose is wrong (an a-contrario test).

The background model puts the map's candidates anywhere. A query's candidate of rank r at a distance
d from the predicted position then has the p-value

    p = r pi d^2 / area

the probability that one of the query's r best candidates lies so near. If k of n queries have a
p-value of t or less, the number of false alarms is the expected number of wrong poses with as much
support, over all poses that can be told apart:

    NFA = poses thresholds P(binomial(n, t) >= k)

The threshold t with the smallest NFA counts. The probability is bounded by Hoeffding's inequality.
Ranks and counts do not depend on the sensor's density. Source: Moisan, Stival: *A probabilistic
criterion to detect rigid point matches between two images*. IJCV, 2004.
"""

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.localization.candidates import Candidates
from placecell.localization.guided_matching import first_of_each
from placecell.localization.pose import Pose

THRESHOLDS = np.array([0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.0003])
"""Thresholds of the p-value: 0.3 to 0.0003."""

GATE = 1.5
"""Largest distance of a candidate that counts, horizontal and vertical, meters."""

NEAREST = 0.5
"""Smallest distance of the p-value, meters: centroids are no more exact than this."""

CELL = 8.0
"""Cell size by which the area of the map near the candidates is measured, meters."""

YAWS = 72
"""Number of yaws that can be told apart: 5 degrees each."""


def surprise(pose: Pose, candidates: Candidates) -> float:
    """Return -log(NFA) of a pose; more than 0 if fewer than one wrong pose is expected."""
    beliefs = candidates.beliefs
    usable = int(np.count_nonzero(beliefs.any(axis=1)))
    if not usable:
        return 0.0
    area = area_of(candidates)
    values = p_values(pose, candidates, area)
    return -log_false_alarms(values, usable, YAWS * area)


def area_of(candidates: Candidates) -> float:
    """Return the area of the cells that hold candidates, square meters."""
    places = candidates.places[candidates.beliefs > 0][:, :2]
    cells = np.floor((places - places.min(axis=0)) / CELL).astype(np.int64)
    return CELL**2 * len(np.unique(cells[:, 0] * (cells[:, 1].max() + 1) + cells[:, 1]))


def p_values(pose: Pose, candidates: Candidates, area: float) -> Float64:
    """Return the p-value of each query with a candidate in the gate, float64 (m,).

    Each map segment counts for one query only, the one with the smallest p-value.
    """
    beliefs = candidates.beliefs
    apart = candidates.places - pose.apply(candidates.centroids)[:, None]
    squared = (apart[..., :2] ** 2).sum(axis=2)
    with np.errstate(invalid="ignore"):  # NaN is not in the gate
        near = (squared < GATE**2) & (np.abs(apart[..., 2]) < GATE) & (beliefs > 0)
    queries, columns = np.nonzero(near)
    ranks = (beliefs[queries] >= beliefs[queries, columns][:, None]).sum(axis=1)
    values = ranks * np.pi * np.maximum(squared[queries, columns], NEAREST**2) / area
    return _one_to_one(values, queries, candidates.rows[queries, columns])


def _one_to_one(values: Float64, queries: Int64, rows: Int64) -> Float64:
    """Return the smallest value of each query, then of each row."""
    best = np.lexsort((rows, queries, values))
    for owners in (queries, rows):
        best = best[first_of_each(owners[best])]
    return values[best]


def log_false_alarms(values: Float64, queries: int, poses: float) -> float:
    """Return log(NFA) of p-values.

    Args:
        values: float64 (m,), p-values of the queries with a candidate in the gate.
        queries: number of queries that have candidates, m or more.
        poses: number of poses that can be told apart.
    """
    share = (values[:, None] <= THRESHOLDS).sum(axis=0) / queries
    tails = -queries * np.where(share > THRESHOLDS, _divergence(share, THRESHOLDS), 0.0)
    return float(np.log(poses * len(THRESHOLDS)) + tails.min())


def _divergence(share: Float64, chance: Float64) -> Float64:
    """Return the Kullback-Leibler divergence of two Bernoulli distributions."""
    rest = 1 - share
    with np.errstate(divide="ignore", invalid="ignore"):
        own = np.where(share > 0, share * np.log(share / chance), 0.0)
        other = np.where(rest > 0, rest * np.log(rest / (1 - chance)), 0.0)
    return np.asarray(own + other)
