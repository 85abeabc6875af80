"""Alignment to the robot (paper III-A).

A segment is turned about z so that the robot's position at capture lies on its positive x axis:
the side of the surface that the robot saw always points the same way.
"""

import numpy as np

from segments.segments import Segments
from segments.types import Float32, Float64


def sensor_bearings(segments: Segments) -> Float64:
    """Bearing of the sensor from each segment's centroid: radians about z, float64 (segments,).

    A sensor straight above or below the centroid (within a micrometre) has bearing 0.
    """
    offset = segments.sensors[:, :2] - segments.centroids()[:, :2]
    bearing = np.arctan2(offset[:, 1], offset[:, 0])
    return np.asarray(np.where(np.hypot(offset[:, 0], offset[:, 1]) > 1e-6, bearing, 0.0))


def align(segments: Segments, yaw: Float64 | float = 0.0) -> Float32:
    """Points about their segment's centroid, the robot on the positive x axis.

    Args:
        segments: in a common z-up frame.
        yaw: turned further by so many radians (segments,): augmentation by rotated copies.

    Returns:
        float32 (points, 3), metres.
    """
    turn = np.asarray(yaw - sensor_bearings(segments))
    centred = segments.points - np.repeat(segments.centroids(), segments.counts, axis=0)
    cosine = np.repeat(np.cos(turn), segments.counts)
    sine = np.repeat(np.sin(turn), segments.counts)
    aligned = np.empty((len(centred), 3), dtype=np.float32)
    aligned[:, 0] = cosine * centred[:, 0] - sine * centred[:, 1]
    aligned[:, 1] = sine * centred[:, 0] + cosine * centred[:, 1]
    aligned[:, 2] = centred[:, 2]
    return aligned
