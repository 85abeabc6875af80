"""Candidates: the most similar map segments of each segment of the robot's local map."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from placecell.core.types import Float64, Int64


@dataclass(frozen=True, eq=False)
class Candidates:
    """The k most similar segments of one map for each of n segments of the robot (queries).

    Attributes:
        centroids: float64 (n, 3), meters, centroid of each query in the robot's frame.
        rows: int64 (n, k), row of each candidate in the map.
        places: float64 (n, k, 3), meters, centroid of each candidate in the map's frame.
        probabilities: float64 (n, k), match probability of query and candidate, 0 to 1.
        sensor: float64 (3,), meters, sensor position in the robot's frame; None if it is not known.
        captures: float64 (n, k, 3), meters, sensor position in the map's frame from which each
            candidate was seen; None if it is not known.
        heights: float64 (n,), meters, height of each query's box; NaN where it is not known. None
            if none is known.
    """

    centroids: Float64
    rows: Int64
    places: Float64
    probabilities: Float64
    sensor: Float64 | None = None
    captures: Float64 | None = None
    heights: Float64 | None = None

    def __post_init__(self) -> None:
        """Check the shapes of the arrays.

        Raises:
            ValueError: An array has another shape than `rows` requires.
        """
        n, k = self.rows.shape if self.rows.ndim == 2 else (-1, -1)
        shapes = {"centroids": (n, 3), "places": (n, k, 3), "probabilities": (n, k)}
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape:
                raise ValueError(f"Invalid shape {found} of {name}: expected {shape}")

    def __len__(self) -> int:
        return len(self.rows)

    def take(self, queries: Int64) -> Self:
        """Return the candidates of some queries, by their indices, int64 (m,)."""
        return replace(
            self,
            centroids=self.centroids[queries],
            rows=self.rows[queries],
            places=self.places[queries],
            probabilities=self.probabilities[queries],
            captures=None if self.captures is None else self.captures[queries],
            heights=None if self.heights is None else self.heights[queries],
        )

    @cached_property
    def beliefs(self) -> Float64:
        """Match probabilities, float64 (n, k); 0 where a value of a candidate is NaN."""
        seen = np.isfinite(self.centroids[:, None]).all(axis=2)
        usable = np.isfinite(self.places).all(axis=2) & seen
        return np.where(usable, np.nan_to_num(self.probabilities, nan=0.0).clip(0.0, 1.0), 0.0)
