"""Viewpoint: how far the centroid of a segment moves when another side of it is seen.

A sensor sees the side of an object that faces it, so the centroid of a view lies toward the sensor.
Two views of one object from opposite sides have centroids that are apart, although the pose is
right. The shift hardly depends on the sensor: it is below 0.05 m up to 50 degrees between the two
directions of view, and 0.8 m for opposite sides (docs/results/localization.md, Viewpoints).
"""

import numpy as np

from placecell.core.types import Float64

SHIFT = 0.8
"""Mean distance between the centroids of two views from opposite sides, meters."""

UNCERTAINTY = 0.4
"""Relative standard deviation of the shift that all segments of a place share: of large objects it
is larger."""

HALF_TRUST = 0.35
"""Expected shift whose error has the variance of all other errors of a centroid, meters. Measured
along the view: 0.33 m without a shift, and 0.5, 0.6 and 0.7 m at shifts of 0.2, 0.4 and 0.7 m."""

NEAREST = 0.5
"""Smallest horizontal distance at which a direction of view is known, meters."""

FARTHEST = 80.0
"""Largest horizontal distance from which a segment was seen, meters. A capture farther away is not
where the segment was seen from."""


def view_shifts(segments: Float64, captures: Float64, sensor: Float64) -> Float64:
    """Return the expected displacement of centroids that a sensor elsewhere sees.

    With the horizontal unit vectors u from the segment to the sensor and v from the segment to the
    capture, and the angle a between them, it is

        SHIFT sin(a / 2)^3 (u - v) / |u - v| = SHIFT |u - v|^2 (u - v) / 8

    Args:
        segments: float64 (..., 3), meters, centroids of the views.
        captures: float64 (..., 3), meters, sensor positions from which they were seen; NaN if it is
            not known.
        sensor: float64 (3,), meters, sensor position from which they are seen now.

    Returns:
        float64 (..., 3), meters; 0 where the direction of a view is not known. All arguments and
        the result are in one frame.
    """
    ahead, seen = (_toward(segments, place) for place in (sensor, captures))
    apart = ahead - seen
    shifts = np.zeros(segments.shape)
    shifts[..., :2] = (SHIFT / 8) * np.einsum("...i,...i->...", apart, apart)[..., None] * apart
    return np.nan_to_num(shifts, copy=False)


def trust_of(shifts: Float64) -> Float64:
    """Return the weights of shifted centroids (..., 3), 1 without a shift, float64 (...).

    A pole is shifted less than a wall: the larger the expected shift, the larger its error.
    """
    squared = np.einsum("...i,...i->...", shifts, shifts)
    return np.asarray(1 / (1 + squared / HALF_TRUST**2))


def _toward(segments: Float64, places: Float64) -> Float64:
    """Return the horizontal unit vectors toward places, (..., 2); NaN if too near or too far."""
    away = (places - segments)[..., :2]
    length = np.sqrt(np.einsum("...i,...i->...", away, away))
    usable = (length > NEAREST) & (length <= FARTHEST)
    return np.asarray(away / np.where(usable, length, np.nan)[..., None])
