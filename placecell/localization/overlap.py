"""Overlap: the share of the robot's segments that the map explains at a pose, beyond chance.

In a place of similar houses a wrong pose has many inliers, but the robot sees other segments as
well, where the map has none. Both have a position only: the share does not depend on descriptors,
nor on how many segments a sensor sees. A dense map has a segment near any position, so the share
that poses beside the hypothesis reach is subtracted, as in Cohen's kappa.

Two sensors see an object up to different heights, so the heights of its centroids differ by meters,
while their horizontal positions agree. So the distance is horizontal. Confidence models of earlier
versions use the distance in space.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.nearest import nearest_within
from placecell.core.spatial import evenly
from placecell.core.types import Float64
from placecell.localization.candidates import Candidates
from placecell.localization.guided_matching import MapSegments
from placecell.localization.pose import Pose

SAME_IN_PLAN = 0.7
"""Largest horizontal distance between two views' centroids of one segment, meters."""

SAME_IN_SPACE = 1.0
"""Largest distance between two views' centroids of one segment in space, meters."""

BESIDE = 3.0
"""Distance of the poses whose share is that of chance, meters."""

DIRECTIONS = 8
"""Number of these poses, evenly spread around the hypothesis."""

MOST_ROWS = 10_000
"""Largest number of map segments around the robot that count."""


@dataclass(frozen=True, slots=True)
class ExplainedShares:
    """Share of the robot's segments with a map segment at their position, beyond chance.

    1 if all have one, 0 if no more than beside the pose, less than 0 if fewer.

    Attributes:
        in_plan: share by horizontal distance.
        in_space: share by distance in space, for confidence models of earlier versions.
    """

    in_plan: float = 0.0
    in_space: float = 0.0


def explained_shares(pose: Pose, candidates: Candidates, there: MapSegments) -> ExplainedShares:
    """Return the shares of the robot's segments that the map explains at a pose.

    Args:
        pose: transform from the robot's frame to the map's.
        candidates: the robot's segments.
        there: segments of the map.
    """
    seen = candidates.centroids[np.isfinite(candidates.centroids).all(axis=1)]
    if not len(seen):
        return ExplainedShares()
    places = pose.apply(seen)
    _, points = there.near(places, BESIDE + SAME_IN_SPACE)
    points = points[evenly(np.flatnonzero(np.isfinite(points).all(axis=1)), MOST_ROWS)]
    plan = np.array([1.0, 1.0, 0.0])
    return ExplainedShares(
        _beyond_chance(places * plan, points * plan, SAME_IN_PLAN),
        _beyond_chance(places, points, SAME_IN_SPACE),
    )


def _beyond_chance(places: Float64, points: Float64, meters: float) -> float:
    """Return the share of places (n, 3) with a point (m, 3) within a distance, beyond chance."""
    angles = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    beside = BESIDE * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(DIRECTIONS)])
    share = _share(places, points, meters)
    chance = _share((places[:, None] + beside).reshape(-1, 3), points, meters)
    return (share - chance) / (1 - chance) if chance < 1 else 0.0


def _share(places: Float64, points: Float64, meters: float) -> float:
    """Return the share of places (n, 3) with a point (m, 3) within a distance."""
    found, _, _ = nearest_within(places, points, meters, 1)
    return len(found) / len(places)
