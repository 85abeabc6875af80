"""Every constant of localization, in one place."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class LocalizationParameters:
    """Constants from candidates to a pose. Lengths are meters, angles degrees."""

    model: Literal["yaw", "se3"] = "yaw"
    """Robots know which way is up: yaw and translation, unless all six degrees are asked for."""

    # Correspondences.
    same_place: float = 1.0
    """Rows of the map whose centroids lie closer than this are views of one segment."""
    unlikely: float = 0.01
    """Share of a query's belief that is no better than chance, and so weighs next to nothing."""
    most_candidates: int = 20_000
    """Candidates of all queries; of more, the likeliest."""
    most: int = 3_000
    """Correspondences that are compared pair by pair; voting chooses them where there are more."""
    vote_yaw: float = 5.0
    vote_cell: float = 4.0
    """Cells of the votes: 5 degrees are 3.5 m at the edge of a local map of 40 m."""

    # Consistency of pairs, and the clique.
    distance_tolerance: float = 1.0
    """Distances between two segments, here and in the map, differ by less: two centroids are off by
    up to half a meter each, for a segment's visible part depends on where it is seen from."""
    height_tolerance: float = 0.5
    tilt: float = 2.0
    """That two frames called level may be off: heights may differ by more, the farther apart."""
    effort: int = 200_000_000
    """Elementary steps of the search for a clique, at most: some tenths of a second."""

    hypotheses: int = 3
    """Places that are looked for."""

    # Refinement.
    gate: float = 1.5
    """A segment that the pose brings closer than this to its place agrees with it."""
    wide_gate: float = 3.0
    """Where refinement begins."""
    kernel: float = 0.5
    """Residuals beyond this pull less and less (Geman and McClure)."""
    least_deviation: float = 0.1
    """Of a centroid: a covariance never claims more."""
    inflation: float = 2.0
    """Of a covariance, how many times it is larger than if centroids erred independently: measured
    are 0.5 to 1 in towns, 1.3 and 2.9 on recorded drives (`covariance_ratio` of evaluate-poses)."""

    # Looking again.
    most_pairs: int = 200_000
    """Of segments here and in the map that lie near each other under a hypothesis and are compared,
    at most, of some of the segments."""

    # Judgment.
    least_segments: int = 4
    """That agree: three fit somewhere by chance."""
    apart: float = 3.0
    apart_yaw: float = 10.0
    """Two poses that differ by more, in the midst of the segments, are two places."""
    ambiguous: float = 0.8
    """Another place with this share of the best one's score, or more, is as good an answer."""
    undetermined_yaw: float = 5.0
    """Standard deviation of a rotation beyond which it is as good as unknown."""
    least_probability: float = 0.5
    """A pose that is more likely wrong than right is none."""

    # Judgment of several maps together.
    distinct: float = 0.05
    """Share of a segment's belief from which on its counterpart counts in full when two maps are
    compared: five times `unlikely`. How far beyond varies from view to view, and tells nothing."""
    decisive: float = 2.25
    """Standard deviations by which one map has to fit better than another. Less may be chance: two
    maps that show a robot the same differ by more in one of 80 requests."""
    alike: float = 9.0
    """Prior odds that a rival in another map shows the robot the same as the best map does: nine in
    ten, assumed, not measured."""
    apart_by: float = 4.0
    """Standard deviations by which the right map typically fits better, if the maps differ."""

    # Evidence of earlier requests.
    memory: float = 10.0
    """Seconds after which a request is forgotten."""
    remembered: int = 20
    """Requests, at most."""
    half_life: float = 3.0
    """Seconds in which a request's evidence fades to a half."""
    past_weight: float = 0.3
    """What an earlier request's score is worth: it saw much of what this one sees."""
