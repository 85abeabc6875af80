"""What localisation starts from: segments of the robot's surroundings, and what they may be."""

from dataclasses import dataclass

import numpy as np

from segments.types import Float64, Int64


@dataclass(frozen=True, slots=True, eq=False)
class Candidates:
    """Of n segments of a robot's local map, k segments of one map that look like each.

    Attributes:
        centroids: float64 (n, 3), metres, in the robot's frame.
        rows: int64 (n, k): rows of the map.
        places: float64 (n, k, 3): the rows' centroids, metres, in the map's frame.
        distances: float64 (n, k), between descriptors.
        probabilities: float64 (n, k), that both are the same; None if nobody can tell.
    """

    centroids: Float64
    rows: Int64
    places: Float64
    distances: Float64
    probabilities: Float64 | None = None

    def __post_init__(self) -> None:
        """Refuse arrays that do not fit each other.

        Raises:
            ValueError: they do not; the message names one.
        """
        n, k = self.rows.shape if self.rows.ndim == 2 else (-1, -1)
        shapes = {"centroids": (n, 3), "places": (n, k, 3), "distances": (n, k)}
        if self.probabilities is not None:
            shapes["probabilities"] = (n, k)
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape:
                raise ValueError(f"{name}: shape {found}, not {shape}")

    def __len__(self) -> int:
        return len(self.rows)

    def beliefs(self) -> Float64:
        """How likely each candidate is its query, float64 (n, k), 0 to 1; 0 where one is unusable.

        The pair classifier's probability, which the descriptors' distance decides. Without one: a
        normal distribution of distances, as wide as the nearest ones usually are.
        """
        if self.probabilities is not None:
            beliefs = self.probabilities
        else:
            nearest = np.nanmedian(self.distances.min(axis=1)) if self.distances.size else 0.0
            beliefs = np.exp(-0.5 * (self.distances / max(float(nearest), 1e-9)) ** 2)
        usable = np.isfinite(self.places).all(axis=2) & np.isfinite(self.distances)
        usable[~np.isfinite(self.centroids).all(axis=1)] = False
        return np.where(usable, np.nan_to_num(beliefs, nan=0.0).clip(0.0, 1.0), 0.0)
