"""Parameters of the pose graph."""

from dataclasses import dataclass, field

from placecell.localization import LocalizationParameters


@dataclass(frozen=True, slots=True)
class PoseGraphParameters:
    """Constants from captures to corrected poses. Lengths are in meters, angles in degrees.

    The *way* of a capture is the distance that its robot has driven in its odometry track.
    """

    local: LocalizationParameters = field(default_factory=LocalizationParameters)
    """Parameters of the localization of a capture in the map."""

    # Odometry, where the map states no covariance.
    drift: float = 0.05
    """Standard deviation of the horizontal position after one meter; it grows with the square root
    of the way."""
    drift_height: float = 0.02
    drift_yaw: float = 0.05
    """Standard deviations of height and heading after one meter; they grow in the same way."""
    scale: float = 0.01
    """Standard deviation of the scale error, before segments correct it."""
    scale_length: float = 100.0
    """Way over which the scale error forgets its value."""
    drift_corrected: float = 0.02
    """Like `drift`, once segments have corrected the scale."""
    drift_yaw_corrected: float = 0.03
    """Like `drift_yaw`, once segments have corrected the heading: 0.3 degrees after 100 m were
    measured in a simulated town (seed 104)."""

    # Search for loops.
    every: float = 8.0
    """Way between two captures that are localized."""
    reach: float = 12.0
    """Largest way between a capture and segments that are localized together with it."""
    away: float = 100.0
    """Smallest way between the two captures of a loop."""
    views: int = 2
    """Number of views of a landmark whose candidates are searched."""
    landmarks: int = 120
    """Largest number of landmarks of a capture that are localized."""
    candidates: int = 25
    """Number of candidates of each view."""
    stretches: int = 3
    """Number of stretches of the map in which a capture is localized."""
    stretch: float = 60.0
    """Way from the middle of a stretch to its ends."""

    # Plausibility: what drift explains.
    slack: float = 3.0
    slack_per_meter: float = 0.06
    """Largest distance between a loop and the odometry, and what each meter of way adds to it:
    three times a drift of 2%."""
    slack_yaw: float = 4.0
    slack_yaw_growth: float = 0.35
    """The same for the heading; the second one is multiplied by the square root of the way."""

    # Support and pairwise consistency.
    beside: float = 40.0
    """Largest way between two loops, at both ends, that support each other."""
    supporters: int = 2
    """Smallest number of loops that support an accepted one."""
    same: float = 0.7
    same_per_meter: float = 0.03
    same_yaw: float = 3.0
    """Largest difference of loops that support each other, and what each meter between them
    adds."""

    # Optimization.
    least_deviation: float = 0.1
    least_yaw: float = 0.35
    """Smallest standard deviations of a loop: views from other sides move centroids. In two
    simulated towns (seeds 102 and 104) nine of ten loops were within 0.17 m and 0.6 degrees."""
    probability: float = 0.999
    """Probability that a right loop is kept by the robust optimization."""
    right: float = 1.0
    right_yaw: float = 3.0
    """Largest residual of an accepted loop after the optimization."""
    settled: float = 0.1
    settled_most: float = 0.3
    """Movement of captures, root mean square and largest, up to which a map stays as it is. Stored
    centroids are rounded to a centimeter, and a map that was optimized before moves by less."""
