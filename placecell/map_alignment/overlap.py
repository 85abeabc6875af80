"""Where two maps overlap if they lie so: what of it agrees, and what should."""

from dataclasses import dataclass

import numpy as np

from placecell.core.spatial import evenly, near_pairs
from placecell.core.types import Bool, Float64, Int64
from placecell.localization import Pose
from placecell.localization.correspondences import Correspondences, number_places
from placecell.localization.covariance import covariance_of
from placecell.localization.refinement import kernel, refine, residuals
from placecell.map_alignment.map_view import MapView, MatchProbabilities
from placecell.map_alignment.parameters import AlignmentParameters


@dataclass(frozen=True, slots=True, eq=False)
class Overlap:
    """What two maps, a and b, have in common under one pose.

    Attributes:
        pose: from b's frame to a's, refined with all that agrees.
        covariance: float64 (4, 4) or (6, 6), see `covariance_of`.
        rows_a, rows_b: int64 (m,), the segments that agree, pair by pair, one to one.
        source: float64 (m, 3), centroids of those of b, meters, in b's frame.
        residuals: float64 (m,), meters between the two of each pair.
        score: what all pairs are worth together: of each how likely the two are the same, the less,
            the farther apart they are.
        expected: of each map, how many things are where the other's robot should have seen them.
        found: what the pairs among these are worth, of each map.
        parts: of the places where each robot was, the share where the other's was too.
    """

    pose: Pose
    covariance: Float64
    rows_a: Int64
    rows_b: Int64
    source: Float64
    residuals: Float64
    score: float
    expected: tuple[int, int]
    found: tuple[float, float]
    parts: tuple[float, float]

    def __len__(self) -> int:
        return len(self.rows_a)

    @property
    def agreement(self) -> float:
        """How much of what should agree does, 0 to 1; of the map of which it is less."""
        pairs = zip(self.found, self.expected, strict=True)
        return min(found / max(expected, 1) for found, expected in pairs)


def overlap_of(
    a: MapView, b: MapView, pose: Pose, matches: MatchProbabilities, parameters: AlignmentParameters
) -> Overlap:
    """Refine a pose with all that agrees, and see how much of what should agree does."""
    guessed = b.moved(pose)
    rows_b = evenly(np.flatnonzero(near_viewpoints(guessed, a, parameters)), parameters.rows)
    laid = guessed.take(rows_b)
    rows_a = evenly(np.flatnonzero(near_viewpoints(a, laid, parameters)), parameters.rows)
    here, there = b.take(rows_b), a.take(rows_a)
    radius = parameters.local.same_place
    landmarks_b, landmarks_a = (
        number_places(np.arange(len(view)), view.centroids, radius) for view in (here, there)
    )
    pairs_a, pairs_b, match_probabilities = alike(there, laid, rows_a, rows_b, matches, parameters)
    found, chosen = pairs_of_landmarks(
        there, here, (pairs_a, pairs_b, match_probabilities), landmarks_a, landmarks_b
    )
    pose, support = refine(pose, found, parameters.local)
    agreeing, whole = found.take(support), b.moved(pose)
    laid = whole.take(rows_b)
    off = residuals(pose, agreeing)
    worth = agreeing.weights * kernel(off, parameters.local.kernel)
    seen_a = np.unique(landmarks_a[should_be_seen(there, laid, parameters)])
    seen_b = np.unique(landmarks_b[should_be_seen(laid, there, parameters)])
    return Overlap(
        pose=pose,
        covariance=covariance_of(pose, agreeing.source, agreeing.target, parameters.local),
        rows_a=rows_a[agreeing.rows],
        rows_b=rows_b[chosen[support]],
        source=agreeing.source,
        residuals=off,
        score=float(worth.sum()),
        expected=(len(seen_a), len(seen_b)),
        found=(
            float(worth[np.isin(agreeing.places, seen_a)].sum()),
            float(worth[np.isin(agreeing.queries, seen_b)].sum()),
        ),
        parts=(part(a, whole, parameters), part(whole, a, parameters)),
    )


def near_viewpoints(one: MapView, other: MapView, parameters: AlignmentParameters) -> Bool:
    """Which segments of one map were seen from where the other's robot was too, bool (n,)."""
    return near_places(one.viewpoints, other, parameters)


def should_be_seen(one: MapView, other: MapView, parameters: AlignmentParameters) -> Bool:
    """Which segments of one map the other's robot should have seen, bool (n,)."""
    close = np.linalg.norm(one.centroids - one.viewpoints, axis=1) <= parameters.seen_from
    return np.asarray(close & near_viewpoints(one, other, parameters))


def part(one: MapView, other: MapView, parameters: AlignmentParameters) -> float:
    """Of the places where the robot of one map was, the share where the other's was too."""
    return float(near_places(one.places, other, parameters).mean())


def near_places(viewpoints: Float64, view: MapView, parameters: AlignmentParameters) -> Bool:
    """Which of the stands (n, 3) are where the map's robot was too, bool (n,)."""
    if not len(view):
        return np.zeros(len(viewpoints), dtype=bool)
    distances, _ = view.tree.query(viewpoints, distance_upper_bound=parameters.shared_viewpoint)
    return np.asarray(np.isfinite(distances))


def alike(
    a: MapView,
    b: MapView,
    rows_a: Int64,
    rows_b: Int64,
    matches: MatchProbabilities,
    parameters: AlignmentParameters,
) -> tuple[Int64, Int64, Float64]:
    """Pairs of segments that lie near each other and look alike.

    Args:
        a, b: parts of the maps, in one frame.
        rows_a, rows_b: of the maps, that the parts are.

    Returns:
        Indices into the parts, int64 (m,) each, and how likely the two of a pair are the same.
    """
    pairs_a, pairs_b = near_pairs(
        a.centroids, b.centroids, parameters.local.wide_gate, parameters.pairs
    )
    match_probabilities = matches.match_probabilities(rows_a[pairs_a], rows_b[pairs_b])
    kept = match_probabilities >= parameters.alike
    return pairs_a[kept], pairs_b[kept], match_probabilities[kept]


def pairs_of_landmarks(
    a: MapView,
    b: MapView,
    pairs: tuple[Int64, Int64, Float64],
    landmarks_a: Int64,
    landmarks_b: Int64,
) -> tuple[Correspondences, Int64]:
    """Pairs of things instead of views: each by the two views that look most alike.

    Returns:
        The correspondences from b to a, `rows` of a's part; and the row of b's part of each.
    """
    rows_a, rows_b, match_probabilities = pairs
    order = np.lexsort(
        (rows_a, rows_b, -match_probabilities, landmarks_a[rows_a], landmarks_b[rows_b])
    )
    places, queries = landmarks_a[rows_a[order]], landmarks_b[rows_b[order]]
    first = order[np.flatnonzero(np.diff(queries, prepend=-1) | np.diff(places, prepend=-1))]
    rows_a, rows_b = rows_a[first], rows_b[first]
    found = Correspondences(
        queries=landmarks_b[rows_b],
        places=landmarks_a[rows_a],
        rows=rows_a,
        source=b.centroids[rows_b],
        target=a.centroids[rows_a],
        weights=match_probabilities[first],
        usable=len(np.unique(rows_b)),
    )
    return found, rows_b
