"""Views of maps for alignment: positions of segments, and their match probabilities."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from placecell.localization import Pose


@dataclass(frozen=True, eq=False)
class MapView:
    """Positions of a map's segments and their viewpoints, in the map's frame.

    Attributes:
        centroids: float64 (n, 3), meters.
        viewpoints: float64 (n, 3), meters, sensor position when each segment was seen.
    """

    centroids: Float64
    viewpoints: Float64

    def __len__(self) -> int:
        return len(self.centroids)

    @cached_property
    def places(self) -> Float64:
        """Distinct viewpoints, float64 (p, 3), meters."""
        return np.unique(self.viewpoints, axis=0)

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the distinct viewpoints. The map must have a segment."""
        return cKDTree(self.places)

    def take(self, rows: Int64) -> "MapView":
        """Return the view of these segments."""
        return MapView(self.centroids[rows], self.viewpoints[rows])

    def moved(self, pose: Pose) -> "MapView":
        """Return the view in another frame."""
        return MapView(pose.apply(self.centroids), pose.apply(self.viewpoints))


class MatchProbabilities(Protocol):
    """Match probabilities of segments of two maps, a and b."""

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        """Return the match probability of each pair, float64 (m,).

        Args:
            a: int64 (m,), rows of map a.
            b: int64 (m,), rows of map b.
        """


class DescriptorSearch(MatchProbabilities, Protocol):
    """Match probabilities, and search for the most similar segments of map a."""

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        """Return the k most similar rows of a for each row (m,) of b.

        Returns:
            Rows of a, int64 (m, k), and their match probabilities, float64 (m, k).
        """
