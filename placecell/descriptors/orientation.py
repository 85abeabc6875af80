"""Alignment to the robot (paper III-A).

A segment is turned about z so that the robot's position at capture lies on its positive x axis:
the side of the surface that the robot saw always points the same way.
"""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64


def sensor_bearings(segments: Segments) -> Float64:
    """Bearing of the sensor from each segment's centroid: radians about z, float64 (segments,).

    A sensor straight above or below the centroid (within a micrometer) has bearing 0.
    """
    return _bearings(segments.sensors, segments.centroids())


def orient(segments: Segments, yaw: Float64 | float = 0.0) -> Float32:
    """Points about their segment's centroid, the robot on the positive x axis.

    Args:
        segments: in a common z-up frame.
        yaw: turned further by so many radians (segments,): augmentation by rotated copies.

    Returns:
        float32 (points, 3), meters.

    Raises:
        ValueError: `ends` do not divide the points into segments.
    """
    oriented = np.empty((len(segments.points), 3), dtype=np.float32)
    centroids = segments.centroids()
    turn = np.asarray(yaw - _bearings(segments.sensors, centroids))
    points = np.ascontiguousarray(segments.points)
    _turn(points, segments.ends, centroids, np.cos(turn), np.sin(turn), oriented)
    return oriented


def _bearings(sensors: Float32, centroids: Float64) -> Float64:
    offset = sensors[:, :2] - centroids[:, :2]
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    return np.asarray(np.where(np.hypot(offset[:, 0], offset[:, 1]) > 1e-6, bearing, 0.0))


@compiled
def _turn(
    points: Float32,
    ends: Int64,
    centroids: Float64,
    cosines: Float64,
    sines: Float64,
    oriented: Float32,
) -> None:
    """Each point minus its segment's centroid, turned about z; float64 until it is stored."""
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
