"""Overlap of two maps under a pose: which segments match, and which should."""

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
    """Overlap of two maps, a and b, under one pose.

    Attributes:
        pose: transform from b's frame to a's, refined with all matching pairs.
        covariance: float64 (4, 4) or (6, 6), see `covariance_of`.
        rows_a, rows_b: int64 (m,), segments of the matching pairs, one to one.
        source: float64 (m, 3), meters, centroids of `rows_b` in b's frame.
        residuals: float64 (m,), meters, distance of each pair.
        score: sum over all pairs of the match probability, weighted by the kernel of the residual.
        expected: number of landmarks of each map that the other robot should have seen.
        found: score of the pairs among these landmarks, for each map.
        parts: share of each robot's viewpoints that are near a viewpoint of the other robot.
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
        """Found score per expected landmark, 0 to 1, the smaller of the two maps."""
        pairs = zip(self.found, self.expected, strict=True)
        return min(found / max(expected, 1) for found, expected in pairs)


def overlap_of(
    a: MapView, b: MapView, pose: Pose, matches: MatchProbabilities, parameters: AlignmentParameters
) -> Overlap:
    """Refine a pose with all matching pairs and measure the overlap.

    Args:
        a: map whose frame is the target.
        b: map whose frame is the source.
        pose: initial transform from b's frame to a's.
        matches: match probabilities of segments.
        parameters: constants of alignment.
    """
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
    """Return whether each segment's viewpoint is near one of the other map, bool (n,)."""
    return near_places(one.viewpoints, other, parameters)


def should_be_seen(one: MapView, other: MapView, parameters: AlignmentParameters) -> Bool:
    """Return whether the other map's robot should have seen each segment, bool (n,)."""
    close = np.linalg.norm(one.centroids - one.viewpoints, axis=1) <= parameters.seen_from
    return np.asarray(close & near_viewpoints(one, other, parameters))


def part(one: MapView, other: MapView, parameters: AlignmentParameters) -> float:
    """Return the share of one map's viewpoints that are near a viewpoint of the other map."""
    return float(near_places(one.places, other, parameters).mean())


def near_places(viewpoints: Float64, view: MapView, parameters: AlignmentParameters) -> Bool:
    """Return whether each viewpoint (n, 3) is near a viewpoint of the map, bool (n,)."""
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
    """Return pairs of segments that are near each other and similar.

    Args:
        a, b: parts of the maps, in one frame.
        rows_a, rows_b: rows of the maps that the parts hold.
        matches: match probabilities of segments.
        parameters: gate, limits and smallest match probability.

    Returns:
        Indices into the parts, int64 (m,) each, and the match probabilities, float64 (m,).
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
    """Combine pairs of views into pairs of landmarks, each by its most similar two views.

    Args:
        a, b: parts of the maps, in one frame.
        pairs: indices into the parts and match probabilities (see `alike`).
        landmarks_a, landmarks_b: number of each segment's landmark.

    Returns:
        Correspondences from b to a, with `rows` of a's part, and the rows of b's part.
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
