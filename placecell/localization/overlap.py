"""Overlap: the share of the robot's segments that the map explains at a pose, beyond chance.

In a place of similar houses a wrong pose has many inliers, but the robot sees other segments as
well, where the map has none. Both have a position only: the share does not depend on descriptors,
nor on how many segments a sensor sees. A dense map has a segment near any position, so the share
that poses beside the hypothesis reach is subtracted, as in Cohen's kappa.

Two sensors see an object up to different heights, so the heights of its centroids differ by meters,
while their horizontal positions agree. So the distance is horizontal. Confidence models of earlier
versions use the distance in space.

A robot at the edge of a map sees as many segments beyond it as within, and the map cannot explain
those beyond. So only the segments count that lie where the map has been, at the pose in question.
"""

from dataclasses import dataclass
from typing import Self

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

BEEN = 6.0
"""Horizontal distance to a segment of the map within which the map has been, meters. Chosen among
3, 4, 5, 6 and 8 m by the likelihood of the poses of four pairs of drives."""

MOST_ROWS = 10_000
"""Largest number of map segments around the robot that count."""

PLAN = np.array([1.0, 1.0, 0.0])
"""Factor that makes positions horizontal."""


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


@dataclass(frozen=True, slots=True, eq=False)
class SegmentsInMap:
    """The robot's segments that lie where the map has been, at a pose.

    Attributes:
        candidates: these segments, with their candidates.
        explained: shares of them that the map explains.
    """

    candidates: Candidates
    explained: ExplainedShares

    @property
    def usable(self) -> int:
        """Number of these segments that have candidates."""
        return int(np.count_nonzero(self.candidates.beliefs.any(axis=1)))

    @classmethod
    def of(cls, pose: Pose, candidates: Candidates, there: MapSegments) -> Self:
        """Select the segments near a segment of the map, any one, and see which it explains.

        Args:
            pose: transform from the robot's frame to the map's.
            candidates: the robot's segments.
            there: segments of the map.
        """
        inside = where_map_has_been(pose, candidates, there)
        return cls(inside, explained_shares(pose, inside, there))


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
    points = _near(places, BESIDE + SAME_IN_SPACE, there)
    return ExplainedShares(
        _beyond_chance(places * PLAN, points * PLAN, SAME_IN_PLAN),
        _beyond_chance(places, points, SAME_IN_SPACE),
    )


def where_map_has_been(pose: Pose, candidates: Candidates, there: MapSegments) -> Candidates:
    """Return the robot's segments that lie near a segment of the map, any segment, at a pose.

    Args:
        pose: transform from the robot's frame to the map's.
        candidates: the robot's segments.
        there: segments of the map.
    """
    finite = np.flatnonzero(np.isfinite(candidates.centroids).all(axis=1))
    if not len(finite):
        return candidates.take(finite)
    places = pose.apply(candidates.centroids[finite])
    found, _, _ = nearest_within(places * PLAN, _near(places, BEEN, there) * PLAN, BEEN, 1)
    return candidates.take(finite[found])


def _near(places: Float64, meters: float, there: MapSegments) -> Float64:
    """Return the finite centroids of the map near some places (n, 3), not too many."""
    _, points = there.near(places, meters)
    return points[evenly(np.flatnonzero(np.isfinite(points).all(axis=1)), MOST_ROWS)]


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
