"""What localization starts from: segments of the robot's surroundings, and what they may be."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from placecell.core.types import Float64, Int64


@dataclass(frozen=True, eq=False)
class Candidates:
    """Of n segments of a robot's local map, k segments of one map that look like each.

    Attributes:
        centroids: float64 (n, 3), meters, in the robot's frame.
        rows: int64 (n, k): rows of the map.
        places: float64 (n, k, 3): the rows' centroids, meters, in the map's frame.
        probabilities: float64 (n, k), that both are the same, 0 to 1.
    """

    centroids: Float64
    rows: Int64
    places: Float64
    probabilities: Float64

    def __post_init__(self) -> None:
        """Refuse arrays that do not fit each other.

        Raises:
            ValueError: they do not; the message names one.
        """
        n, k = self.rows.shape if self.rows.ndim == 2 else (-1, -1)
        shapes = {"centroids": (n, 3), "places": (n, k, 3), "probabilities": (n, k)}
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape:
                raise ValueError(f"{name}: shape {found}, not {shape}")

    def __len__(self) -> int:
        return len(self.rows)

    @cached_property
    def beliefs(self) -> Float64:
        """The probabilities, float64 (n, k); 0 where anything of a candidate is no number."""
        seen = np.isfinite(self.centroids[:, None]).all(axis=2)
        usable = np.isfinite(self.places).all(axis=2) & seen
        return np.where(usable, np.nan_to_num(self.probabilities, nan=0.0).clip(0.0, 1.0), 0.0)
