"""Parameters of map alignment."""

from dataclasses import dataclass, field

from placecell.localization import LocalizationParameters


@dataclass(frozen=True, slots=True)
class AlignmentParameters:
    """Constants from two maps to a transform. Lengths are in meters, angles in degrees.

    A landmark is a group of segments at one position: views of one object.
    """

    local: LocalizationParameters = field(default_factory=LocalizationParameters)
    """Parameters of submap poses and of refinement."""

    # Submaps.
    submap_radius: float = 10.0
    """Radius of a submap: it holds segments whose viewpoint is within it (20 m of a path)."""
    spacing: float = 10.0
    """Smallest distance between the centers of submaps."""
    submaps: int = 120
    """Largest number of submaps, evenly distributed over the map."""
    views: int = 4
    """Number of views of a landmark whose candidates are searched."""
    landmarks: int = 2_000
    """Largest number of a submap's landmarks whose candidates are searched."""

    # Consensus.
    apart: float = 3.0
    """Largest distance between a submap's positions by its own pose and by a consistent one's."""
    apart_yaw: float = 6.0
    """Largest yaw difference of consistent submap poses."""
    slack: float = 0.03
    """Addition to `apart` per meter between the submaps, for small rotations and odometry drift."""
    alignments: int = 3
    """Number of alignments that are verified: the best, and others for comparison."""

    # Overlap.
    shared_viewpoint: float = 10.0
    """Largest distance between two robots' viewpoints at the same place."""
    seen_from: float = 20.0
    """Distance from a common viewpoint up to which both robots should see a segment."""
    alike: float = 0.2
    """Smallest match probability of a matching pair."""
    rows: int = 20_000
    """Largest number of segments of a map, and of a submap, that are compared."""
    pairs: int = 4_000_000
    """Largest number of near pairs of segments that are compared."""

    # Judgment.
    least_pairs: int = 12
    """Smallest number of matching pairs of an overlap."""
    least_agreement: float = 0.1
    least_score: float = 12.0
    """Smallest agreement and score of an alignment. In two simulated towns, one with identical
    houses only, right alignments had at least 0.14 and 20. Wrong ones had at most 0.09, and at most
    0.07 with a score above 10."""
    ambiguous: float = 0.8
    """Relative score or agreement from which a second alignment makes the result ambiguous."""
