"""Orientation of a segment toward the sensor (paper III-A).

A segment is turned about z so that the sensor position at capture lies on its positive x axis. So
the visible side of the surface always points in the same direction.
"""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64


def sensor_bearings(segments: Segments) -> Float64:
    """Return the bearing of the sensor from each centroid, radians about z, float64 (segments,).

    The bearing is 0 if the sensor is exactly above or below the centroid (within a micrometer).
    """
    return bearings_of(segments.sensors[:, :2] - segments.centroids()[:, :2])


def orient(segments: Segments, yaw: Float64 | float = 0.0) -> Float32:
    """Return points relative to their segment's centroid, with the sensor on the positive x axis.

    Args:
        segments: segments in one z-up frame.
        yaw: additional rotation about z, radians, float64 (segments,): augmentation by rotation.

    Returns:
        float32 (points, 3), meters.

    Raises:
        ValueError: `ends` do not divide the points into segments.
    """
    oriented = np.empty((len(segments.points), 3), dtype=np.float32)
    centroids = segments.centroids()
    turn = np.asarray(yaw - bearings_of(segments.sensors[:, :2] - centroids[:, :2]))
    points = np.ascontiguousarray(segments.points)
    _turn(points, segments.ends, centroids, np.cos(turn), np.sin(turn), oriented)
    return oriented


def bearings_of(offsets: Float64) -> Float64:
    """Return the bearing of each vector, radians about z; 0 for (nearly) vertical ones.

    Args:
        offsets: vectors, float64 (n, 2) or (n, 3), meters.
    """
    x, y = offsets[:, 0], offsets[:, 1]
    return np.asarray(np.where(np.hypot(x, y) > 1e-6, np.arctan2(y, x), 0.0))


@compiled
def _turn(
    points: Float32,
    ends: Int64,
    centroids: Float64,
    cosines: Float64,
    sines: Float64,
    oriented: Float32,
) -> None:
    """Fill `oriented` with each point minus its centroid, turned about z in float64."""
    start = 0
    for segment in range(len(ends)):
        x, y, z = centroids[segment, 0], centroids[segment, 1], centroids[segment, 2]
        cosine, sine = cosines[segment], sines[segment]
        for point in range(start, ends[segment]):
            dx = points[point, 0] - x
            dy = points[point, 1] - y
            oriented[point, 0] = cosine * dx - sine * dy
            oriented[point, 1] = sine * dx + cosine * dy
            oriented[point, 2] = points[point, 2] - z
        start = ends[segment]
