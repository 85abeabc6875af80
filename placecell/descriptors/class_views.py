"""Views of a segment from its side, its end and above, for its class.

A view is a coarse picture along the segment's principal axes. Unlike local surfaces, it hardly
depends on the noise of the sensor and of the poses.
"""

import numpy as np

from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Float32, Float64, Int64

ALONG, ACROSS, UP = 14, 8, 10
"""Number of cells along the longer and the shorter horizontal axis, and upward."""

CELL, LAYER = 0.5, 0.3
"""Edge length of the horizontal cells and of the layers, meters. Outer cells are open."""

HIGHEST = 5.0
"""Largest height above the lowest point in the view from above, meters."""

VIEWS = ALONG * UP + ACROSS * UP + ALONG * ACROSS
"""Number of values of the three views."""


def views(
    points: Float32, ends: Int64, centroids: Float64, covariance: Float64, to_sensor: Float64
) -> Float64:
    """Return the three views of each segment, float64 (segments, `VIEWS`).

    Args:
        points: float32 (n, 3), meters.
        ends: int64 (segments,), end of each segment's points.
        centroids: float64 (segments, 3), meters.
        covariance: float64 (segments, 3, 3), of the points of each segment.
        to_sensor: float64 (segments, 3), from the centroid to the sensor.
    """
    xx, xy, yy = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    heading = 0.5 * np.arctan2(2 * xy, xx - yy)
    ahead = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    # The shorter axis points to the sensor.
    left *= np.where((left * to_sensor[:, :2]).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    found = np.zeros((len(ends), VIEWS))
    _draw(points, ends, centroids, ahead, left, found)
    found[:, : (ALONG + ACROSS) * UP] = np.log1p(found[:, : (ALONG + ACROSS) * UP])
    return found


@compiled
def _draw(
    points: Float32,
    ends: Int64,
    centroids: Float64,
    ahead: Float64,
    left: Float64,
    found: Float64,
) -> None:
    """Fill the views of each segment: numbers of points from the side and the end, and heights.

    Most of the skew is at the positive end of the longer axis, so that a segment and its mirror
    image have the same views.
    """
    longest, start = 1, 0
    for end in ends:
        longest, start = max(longest, end - start), end
    along, across = np.empty(longest), np.empty(longest)
    start = 0
    for segment in range(len(ends)):
        count, skew = ends[segment] - start, 0.0
        low = points[start, 2]
        for place in range(count):
            x = points[start + place, 0] - centroids[segment, 0]
            y = points[start + place, 1] - centroids[segment, 1]
            along[place] = x * ahead[segment, 0] + y * ahead[segment, 1]
            across[place] = x * left[segment, 0] + y * left[segment, 1]
            skew += along[place] ** 3
            low = min(low, points[start + place, 2])
        if skew < 0:
            along[:count] = -along[:count]
        middle = (along[:count].min() + along[:count].max()) / 2
        center = (across[:count].min() + across[:count].max()) / 2
        for place in range(count):
            above = points[start + place, 2] - low
            column = _cell((along[place] - middle) / CELL + ALONG // 2, ALONG)
            row = _cell((across[place] - center) / CELL + ACROSS // 2, ACROSS)
            layer = _cell(above / LAYER, UP)
            found[segment, column * UP + layer] += 1
            found[segment, (ALONG + row) * UP + layer] += 1
            top = (ALONG + ACROSS) * UP + column * ACROSS + row
            found[segment, top] = max(found[segment, top], min(above, HIGHEST) + LAYER)
        start = ends[segment]


@compiled_part
def _cell(value: float, number: int) -> int:
    """Return the cell of a value, 0 to `number` - 1."""
    return int(min(max(np.floor(value), 0.0), number - 1.0))
