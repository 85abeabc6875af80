"""Ground level: the height of a pose by the ground on which the segments stand.

Two sensors see an object up to different heights: the view of an HDL-64E ends two degrees above the
horizon, and few beams of an OS0 hit the foot of a house. So their centroids of one object differ in
height, all in the same direction, and the residuals do not show it. The segments' boxes do: the
lowest ones around a place stand on the ground, whichever sensor sees them. Boxes of one sensor are
alike, so that the centroids keep their say (docs/results/sensors.md, Heights across sensors).
"""

from dataclasses import replace

import numpy as np

from placecell.core.nearest import nearest_within
from placecell.core.spatial import evenly
from placecell.core.types import Float64
from placecell.localization.candidates import Candidates
from placecell.localization.guided_matching import MapBoxes
from placecell.localization.hypothesis import Hypothesis
from placecell.localization.overlap import PLAN
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose

UNLIKE = 1.2
"""Constant of the centroids' common height error, meters: boxes whose heights differ by d on
average have centroids that are off by d^2 / UNLIKE (standard deviation). Boxes that differ by 0.2,
0.5, 0.8 and 1.1 m have errors of 0.03, 0.1, 0.5 and 0.6 to 1.2 m."""

ALIKE = 0.3
"""Mean difference of the heights of boxes below which the centroids alone give the height, m."""

UNCERTAINTY = 0.3
"""Standard deviation of the difference of two ground levels that are alike everywhere, meters."""

BOTH = 3.0
"""Distance of centroids within which robot and map have both seen a place, meters."""

AROUND = 20.0
"""Horizontal distance of the segments among which the lowest ones give the ground level, meters."""

LOWEST = 0.05
"""Share of segments below the ground level: a few boxes reach into holes and reflections."""

FARTHEST = 2.5
"""Largest correction, meters: a level farther away is that of another floor or of a bridge."""

FEWEST = 4
"""Smallest number of segments that give a ground level."""

CENTERS, MOST_ROWS = 16, 600
"""Largest number of places where levels are compared, and of map segments that are used."""


def at_ground_level(
    hypothesis: Hypothesis,
    candidates: Candidates,
    there: MapBoxes,
    parameters: LocalizationParameters,
) -> Hypothesis:
    """Return a hypothesis at the height that the ground and the centroids give together.

    Both are weighted by their variances. Without a ground level, the height stays and its variance
    grows by what the boxes show. Only the pose, its covariance and the residuals change.

    Args:
        hypothesis: hypothesis of these candidates.
        candidates: the robot's segments; without the heights of their boxes, the hypothesis stays.
        there: segments of the map; without the heights of their boxes, the hypothesis stays.
        parameters: model; the hypothesis stays if gravity is not known.
    """
    if candidates.heights is None or parameters.model != "yaw":
        return hypothesis
    unlike = np.abs(there.heights(hypothesis.rows) - candidates.heights[hypothesis.queries])
    unlike = unlike[np.isfinite(unlike)]
    if len(unlike) < FEWEST or unlike.mean() < ALIKE:
        return hypothesis
    common = float(unlike.mean()) ** 2 / UNLIKE
    variance = hypothesis.covariance[2, 2] + common**2
    level, deviation = ground_offset(hypothesis.pose, candidates, there)
    if abs(level) <= FARTHEST:  # not if it is NaN
        trust = variance / (variance + deviation**2)
    else:
        trust, level = 0.0, 0.0
    covariance = hypothesis.covariance.copy()
    covariance[2, 2] = (1 - trust) * variance
    return replace(_raised(hypothesis, trust * level, candidates), covariance=covariance)


def _raised(hypothesis: Hypothesis, rise: float, candidates: Candidates) -> Hypothesis:
    """Return a hypothesis at another height, with its residuals there."""
    old = hypothesis.pose
    pose = Pose(old.rotation, old.translation + np.array([0.0, 0.0, rise]))
    inliers = np.arange(len(hypothesis))
    matched = candidates.rows[hypothesis.queries] == hypothesis.rows[:, None]
    targets = candidates.places[hypothesis.queries][inliers, matched.argmax(axis=1), 2]
    off = old.apply(hypothesis.source)[:, 2] - targets
    squared = hypothesis.residuals**2 + rise * (2 * off + rise)
    return replace(hypothesis, pose=pose, residuals=np.sqrt(squared.clip(0.0)))


def ground_offset(pose: Pose, candidates: Candidates, there: MapBoxes) -> tuple[float, float]:
    """Return how much higher the map's ground level is than the robot's at a pose.

    Only segments where robot and map have both seen something count.

    Args:
        pose: transform from the robot's frame to the map's.
        candidates: the robot's segments, with the heights of their boxes.
        there: segments of the map.

    Returns:
        Median over several places, and its standard deviation, which includes the spread over these
        places, meters; NaN if there are too few segments.
    """
    assert candidates.heights is not None
    known = np.isfinite(candidates.centroids).all(axis=1) & np.isfinite(candidates.heights)
    places = pose.apply(candidates.centroids[known])
    if len(places) < FEWEST:
        return float("nan"), float("nan")
    rows, points = there.near(places, BOTH)
    both, _, _ = nearest_within(points, places, BOTH, 1)
    both = evenly(both, MOST_ROWS)
    heights = there.heights(rows[both])
    boxed = np.isfinite(heights)
    points, heights = points[both][boxed], heights[boxed]
    seen, _, _ = nearest_within(places, points, BOTH, 1)
    centers = places[evenly(seen, CENTERS)]
    own, other = (
        _levels(centers, around, box)
        for around, box in ((places[seen], candidates.heights[known][seen]), (points, heights))
    )
    apart = (other - own)[np.isfinite(other - own)]
    if not len(apart):
        return float("nan"), float("nan")
    return float(np.median(apart)), float(np.hypot(UNCERTAINTY, apart.std()))


def _levels(centers: Float64, places: Float64, heights: Float64) -> Float64:
    """Return the ground level around each center, float64 (c,); NaN among too few segments.

    Args:
        centers: float64 (c, 3), meters.
        places: float64 (n, 3), meters, centroids.
        heights: float64 (n,), meters, heights of their boxes.
    """
    if len(places) < FEWEST or not len(centers):
        return np.full(len(centers), np.nan)
    apart = (centers * PLAN)[:, None, :2] - places[:, :2]
    near = np.einsum("cni,cni->cn", apart, apart) < AROUND**2
    counts = near.sum(axis=1)
    feet = np.sort(np.where(near, places[:, 2] - heights / 2, np.inf), axis=1)
    lowest = feet[np.arange(len(centers)), (LOWEST * (counts - 1)).astype(np.int64).clip(0)]
    return np.where(counts >= FEWEST, lowest, np.nan)
