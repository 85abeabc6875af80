"""Pose height: the height of a pose by the boxes of the segments.

Two sensors see an object up to different heights: the view of an HDL-64E ends two degrees above the
horizon, and few beams of an OS0 hit the foot of a house. So their centroids of one object differ in
height, all in the same direction, and the residuals do not show it. The boxes say more:

- If boxes are unlike, the centroids are uncertain. Boxes of one sensor are alike.
- Tops or feet of one object are at one height, where both sensors see them.
- The lowest boxes around a place stand on the ground, or a little above it if beams are few.

The three are combined as likelihoods of the height (docs/results/sensors.md, Heights across
sensors).
"""

from dataclasses import replace

import numpy as np

from placecell.core.jit import compiled
from placecell.core.nearest import nearest_within
from placecell.core.spatial import evenly
from placecell.core.types import Float64, Int64
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

FARTHEST, STEP = 2.5, 0.05
"""Largest change of the height, and its resolution, meters: a ground farther away is that of
another floor or of a bridge."""

SAME_PLAN, VIEWS = 0.7, 32
"""Horizontal distance of centroids of one object, meters, and the most map segments compared."""

EDGE, REACH = 0.25, 1.0
"""Scale of the kernel of a top or a foot, and the distance where it ends, meters."""

WORTH, ALIKE_SEGMENTS = 3.0, 3.0
"""Likelihood ratio of a segment whose top or foot fits, less 1; and how many segments are as one
piece of evidence: rows of equal houses fit at several heights."""

UNCERTAINTY = 0.5
"""Standard deviation of the difference of two ground levels that are alike everywhere, meters."""

UNLIKELY = 4.0
"""Standard deviations from which a ground level is no farther from the truth: it is an outlier."""

LEAST_DEVIATION = 0.1
"""Smallest standard deviation of the height by centroids, meters."""

LEFT = 0.2
"""Standard deviation of what the boxes leave open, meters: their feet and tops are computed from
the centroids and the heights."""

BOTH = 3.0
"""Distance of centroids within which robot and map have both seen a place, meters."""

AROUND = 20.0
"""Horizontal distance of the segments among which the lowest ones give the ground level, meters."""

LOWEST = 0.05
"""Share of segments below the ground level: a few boxes reach into holes and reflections."""

FEWEST = 4
"""Smallest number of segments that give a ground level."""

CENTERS, MOST_ROWS = 16, 600
"""Largest number of places where levels are compared, and of map segments that are used there."""

RISES = np.arange(-round(FARTHEST / STEP), round(FARTHEST / STEP) + 1) * STEP
"""Changes of the height that are compared, float64 (r,), meters."""


def at_height_of_boxes(
    hypothesis: Hypothesis,
    candidates: Candidates,
    there: MapBoxes,
    parameters: LocalizationParameters,
) -> Hypothesis:
    """Return a hypothesis at the height that centroids, tops, feet and the ground give together.

    Only the pose, its covariance and the residuals change.

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
    own = max(hypothesis.covariance[2, 2], LEAST_DEVIATION**2)
    variance = own + (float(unlike.mean()) ** 2 / UNLIKE) ** 2
    seen = _boxes_seen_by_both(hypothesis.pose, candidates, there)
    level, deviation = ground_offset(*seen)
    likelihood = edge_likelihood(*seen) - RISES**2 / (2 * variance)
    if abs(level) <= FARTHEST:  # not if it is NaN
        likelihood -= np.minimum(((RISES - level) / deviation) ** 2, UNLIKELY**2) / 2
    weights = np.exp(likelihood - likelihood.max())
    weights /= weights.sum()
    rise = float(weights @ RISES)
    covariance = hypothesis.covariance.copy()
    covariance[2, 2] = float(weights @ (RISES - rise) ** 2) + LEFT**2
    return replace(_raised(hypothesis, rise, candidates), covariance=covariance)


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


def _boxes_seen_by_both(
    pose: Pose, candidates: Candidates, there: MapBoxes
) -> tuple[Float64, Float64, Float64, Float64]:
    """Return the segments where robot and map have both seen something, at a pose.

    Returns:
        Centroids of the robot's segments in the map's frame, float64 (n, 3), and heights of their
        boxes, float64 (n,); the same of the map's segments, (m, 3) and (m,); meters.
    """
    assert candidates.heights is not None
    known = np.isfinite(candidates.centroids).all(axis=1) & np.isfinite(candidates.heights)
    places, boxes = pose.apply(candidates.centroids[known]), candidates.heights[known]
    if not len(places):
        return places, boxes, np.zeros((0, 3)), np.zeros(0)
    rows, points = there.near(places, BOTH)
    both, _, _ = nearest_within(points, places, BOTH, 1)
    points, heights = points[both], there.heights(rows[both])
    points, heights = points[np.isfinite(heights)], heights[np.isfinite(heights)]
    seen, _, _ = nearest_within(places, points, BOTH, 1)
    return places[seen], boxes[seen], points, heights


def edge_likelihood(places: Float64, boxes: Float64, points: Float64, heights: Float64) -> Float64:
    """Return the log-likelihood of each of `RISES` by the tops and feet, float64 (r,).

    A segment fits if its top or its foot is at the height of that of a map segment at its position
    in plan. Where no sensor sees the whole object, most segments fit at several heights.

    Args:
        places: float64 (n, 3), meters, the robot's segments at the pose.
        boxes: float64 (n,), meters, heights of their boxes.
        points: float64 (m, 3), meters, segments of the map.
        heights: float64 (m,), meters, heights of their boxes.
    """
    here, near, _ = nearest_within(places * PLAN, points * PLAN, SAME_PLAN, VIEWS)
    apart = points[near, 2] - places[here, 2]
    half = (heights[near] - boxes[here]) / 2
    fits = np.zeros((len(places), len(RISES)))
    _fit(here, apart - half, apart + half, fits)
    return np.asarray(np.log1p(WORTH * fits).sum(axis=0) / ALIKE_SEGMENTS)


@compiled
def _fit(segments: Int64, feet: Float64, tops: Float64, fits: Float64) -> None:
    """Fill `fits` (n, r) with how well the best top or foot of each segment fits at each rise.

    Args:
        segments: int64 (p,), segment of each pair.
        feet: float64 (p,), meters, rise at which the feet of the pair are at one height.
        tops: float64 (p,), meters, rise at which the tops are.
        fits: 0 everywhere.
    """
    for pair in range(len(segments)):
        for edge in (feet[pair], tops[pair]):
            first = max(int(np.ceil((edge - REACH + FARTHEST) / STEP)), 0)
            last = min(int(np.floor((edge + REACH + FARTHEST) / STEP)), fits.shape[1] - 1)
            for rise in range(first, last + 1):
                off = (rise * STEP - FARTHEST - edge) / EDGE
                fit = 1.0 / (1.0 + off * off) ** 2
                fits[segments[pair], rise] = max(fits[segments[pair], rise], fit)


def ground_offset(
    places: Float64, boxes: Float64, points: Float64, heights: Float64
) -> tuple[float, float]:
    """Return how much higher the map's ground level is than the robot's.

    Args:
        places: see `edge_likelihood`.
        boxes: see `edge_likelihood`.
        points: see `edge_likelihood`.
        heights: see `edge_likelihood`.

    Returns:
        Median over several places, and its standard deviation, which includes the spread over these
        places, meters; NaN if there are too few segments.
    """
    some = evenly(np.arange(len(points)), MOST_ROWS)
    ranked = places[np.lexsort(places.T)]  # the order of the request does not matter
    centers = ranked[evenly(np.arange(len(ranked)), CENTERS)]
    apart = _levels(centers, points[some], heights[some]) - _levels(centers, places, boxes)
    apart = apart[np.isfinite(apart)]
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
