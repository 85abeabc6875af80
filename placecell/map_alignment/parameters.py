"""Every constant of the alignment of maps, in one place."""

from dataclasses import dataclass, field

from placecell.localization import LocalizationParameters


@dataclass(frozen=True, slots=True)
class AlignmentParameters:
    """Constants from two maps to a transform. Lengths are meters, angles degrees."""

    local: LocalizationParameters = field(default_factory=LocalizationParameters)
    """Of a submap's pose, and of the refinement."""

    # Submaps.
    submap_radius: float = 10.0
    """A submap holds what was seen from within this of its middle: 20 m of a robot's way."""
    spacing: float = 10.0
    """Between the middles of submaps, at least."""
    submaps: int = 120
    """At most, evenly over the map."""
    views: int = 4
    """Of a thing, that candidates are looked for of."""
    landmarks: int = 2_000
    """Of a submap, that candidates are looked for of, at most, evenly over it."""

    # Consensus.
    apart: float = 3.0
    apart_yaw: float = 6.0
    """Two submaps agree if each one's pose puts the other this near to where its own puts it,"""
    slack: float = 0.03
    """and by so much more for each meter between them: small turns, and odometry that drifts."""
    alignments: int = 3
    """That are looked at: the best, and others to hold against it."""

    # Overlap.
    shared_viewpoint: float = 10.0
    """Where one robot was, the other was too, if it was this near."""
    seen_from: float = 20.0
    """What is this near to where both were, both see."""
    alike: float = 0.2
    """Probability that two segments are the same, at least, for them to agree."""
    rows: int = 20_000
    """Segments of each map that are compared, and of a submap, at most, evenly over it."""
    pairs: int = 4_000_000
    """Of segments that lie near each other and are compared, at most, of some of the segments."""

    # Judgment.
    least_pairs: int = 12
    """That agree, for a guess to be one."""
    least_agreement: float = 0.1
    least_score: float = 12.0
    """Of an alignment. In two towns, one of identical houses alone, right ones had 0.14 and 20 or
    more; wrong ones had at most 0.09 or, where they had more than 10 of score, 0.07."""
    ambiguous: float = 0.8
    """Another way to lay the maps with this share of the best one's score or agreement is as good
    an answer."""
