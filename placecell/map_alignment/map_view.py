"""What alignment needs to know of a map."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from placecell.localization import Pose


@dataclass(frozen=True, eq=False)
class MapView:
    """Where the segments of a map are, and where they were seen from, in the map's frame.

    Attributes:
        centroids: float64 (n, 3), meters.
        viewpoints: float64 (n, 3), the sensor's position when each was seen, meters.
    """

    centroids: Float64
    viewpoints: Float64

    def __len__(self) -> int:
        return len(self.centroids)

    @cached_property
    def places(self) -> Float64:
        """Where the robot was, float64 (p, 3), each place once however much was seen from there."""
        return np.unique(self.viewpoints, axis=0)

    @cached_property
    def tree(self) -> cKDTree:
        """Of the places; of one segment at least."""
        return cKDTree(self.places)

    def take(self, rows: Int64) -> "MapView":
        """These segments."""
        return MapView(self.centroids[rows], self.viewpoints[rows])

    def moved(self, pose: Pose) -> "MapView":
        """In another frame."""
        return MapView(pose.apply(self.centroids), pose.apply(self.viewpoints))


class MatchProbabilities(Protocol):
    """How much segments of two maps, a and b, look like each other."""

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        """How likely rows of a and of b, (m,) each, are the same, pair by pair, float64 (m,)."""


class DescriptorSearch(MatchProbabilities, Protocol):
    """And which of them look most alike."""

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        """For rows (m,) of b, the rows of a that look most like each.

        Returns:
            Rows, int64 (m, k), and how likely they are the same, float64 (m, k).
        """
