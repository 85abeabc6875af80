"""Parameters of localization."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class LocalizationParameters:
    """Constants from candidates to a pose. Lengths are in meters, angles in degrees."""

    model: Literal["yaw", "se3"] = "yaw"
    """Degrees of freedom: yaw and translation (gravity is known), or all six."""

    # Correspondences.
    same_place: float = 1.0
    """Map segments whose centroids are closer than this are views of one segment."""
    unlikely: float = 0.01
    """Share of a query's total match probability that is no better than chance."""
    most_candidates: int = 20_000
    """Largest number of candidates of all queries. The most probable ones are kept."""
    most: int = 3_000
    """Largest number of correspondences in the consistency graph. Voting selects them."""
    vote_yaw: float = 5.0
    vote_cell: float = 4.0
    """Cell sizes of voting, degrees and meters: 5 degrees are 3.5 m at 40 m distance."""

    # Consistency of pairs, and the clique.
    distance_tolerance: float = 1.0
    """Largest difference of a distance between two segments in the robot's frame and in the map.
    Each centroid is off by up to 0.5 m, because the visible part depends on the viewpoint."""
    height_tolerance: float = 0.5
    """Largest difference of a height difference, in addition to that of `tilt`."""
    tilt: float = 2.0
    """Largest tilt between two frames with known gravity. The height tolerance grows with the
    distance accordingly."""
    effort: int = 6_000_000
    """Number of elementary steps of all clique searches of a query: some 15 ms. Queries of 100
    segments take 1 to 4 million, for three places."""

    hypotheses: int = 3
    """Number of places that are searched for."""

    # Refinement.
    gate: float = 1.5
    """Largest residual of an inlier."""
    wide_gate: float = 3.0
    """Gate at the start of refinement."""
    kernel: float = 0.5
    """Scale of the Geman-McClure kernel: larger residuals have little influence."""
    least_deviation: float = 0.1
    """Smallest standard deviation of a centroid that a covariance assumes."""
    inflation: float = 2.0
    """Factor of the covariance, because centroid errors are correlated. Measured: 0.5 to 1 in
    simulated towns, 1.3 and 2.9 on recorded drives (`covariance_ratio` of evaluate-poses)."""

    # Guided matching.
    most_views: int = 32
    """Largest number of map segments that are compared with a query: the nearest within `gate`.
    They are mostly views of one segment. Nine of ten queries have fewer than 25."""
    most_near_rows: int = 10_000
    """Largest number of map segments around the robot from which the nearest ones are chosen."""

    # Judgment.
    least_segments: int = 4
    """Smallest number of inliers, and of places where they stand: three fit somewhere by chance."""
    one_spot: float = 1.0
    """Inliers that are closer than this stand at one place."""
    apart: float = 3.0
    apart_yaw: float = 10.0
    """Poses that differ by more than `apart` or `apart_yaw` are different places."""
    ambiguous: float = 0.8
    """Relative score from which a second place makes the result ambiguous."""
    undetermined_yaw: float = 5.0
    """Standard deviation of the rotation above which it counts as undetermined."""
    max_false_acceptance: float | None = None
    """Largest expected share of queries with a false pose (see `acceptance`), more than 0 and at
    most 0.5. None: 0.001, or the smallest share that the model's calibration supports."""
    least_probability: float = 0.5
    """Smallest probability of a pose that a model without calibration returns, and of a pose that
    makes other maps ambiguous."""

    # Judgment of several maps together.
    distinct: float = 0.05
    """Share of a segment's match probability above which its counterpart counts in full when two
    maps are compared: five times `unlikely`. Larger shares vary from view to view."""
    decisive: float = 2.25
    """Standard deviations by which a map must fit better than another. Two maps of the same place
    differ by more in 1 of 80 requests."""
    alike: float = 9.0
    """Prior odds that a rival in another map shows the same place as the best map: 9 to 1, assumed,
    not measured."""
    apart_by: float = 4.0
    """Standard deviations by which the right map typically fits better if the maps differ."""

    # Evidence of earlier requests.
    memory: float = 10.0
    """Age after which a request is ignored, seconds."""
    remembered: int = 20
    """Largest number of requests of a session's history."""
    half_life: float = 3.0
    """Time in which a request's evidence halves, seconds."""
    past_weight: float = 0.3
    """Weight of an earlier request's score: it saw much of what the current one sees."""
