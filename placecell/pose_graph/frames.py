"""Frames of a pose graph: captures with their poses, and the odometry between them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.pose_graph.parameters import PoseGraphParameters

NO_TRACK = 0
"""Track of a capture without odometry."""


@dataclass(frozen=True, eq=False)
class CaptureOdometry:
    """Odometry of f captures: poses in the frame of each track, and their accumulated variances.

    Attributes:
        tracks: int64 (f,), number of each capture's track; `NO_TRACK` if it has none. Two captures
            of one track are connected by odometry.
        positions: float64 (f, 3), meters, sensor positions in the frame of the track.
        yaws: float64 (f,), radians, headings there.
        variances: float64 (f, 3), variance of the horizontal position along each axis, m^2, of the
            height, m^2, and of the heading, rad^2, accumulated since the track began. The variance
            between two captures is the difference. Zeros: unknown.
    """

    tracks: Int64
    positions: Float64
    yaws: Float64
    variances: Float64

    @classmethod
    def from_poses(cls, tracks: Int64, positions: Float64, yaws: Float64) -> Self:
        """Take the poses of a map as odometry, if it states none."""
        return cls(tracks, positions.copy(), yaws.copy(), np.zeros((len(tracks), 3)))


@dataclass(frozen=True, eq=False)
class GraphFrames:
    """Nodes of a pose graph: f captures, in any order.

    Roll and pitch follow from gravity and never change, so a pose is a position and a heading.

    Attributes:
        times: float64 (f,), seconds.
        positions: float64 (f, 3), meters, sensor positions in the map.
        yaws: float64 (f,), radians, headings of the sensor's x axis in the map.
        odometry: odometry between the captures.
    """

    times: Float64
    positions: Float64
    yaws: Float64
    odometry: CaptureOdometry

    def __len__(self) -> int:
        return len(self.times)

    @cached_property
    def order(self) -> Int64:
        """Captures by track, then by time."""
        return np.lexsort((*self.odometry.positions.T, self.times, self.odometry.tracks))

    @cached_property
    def links(self) -> Int64:
        """Consecutive captures of each track, int64 (links, 2)."""
        tracks = self.odometry.tracks[self.order]
        same = (tracks[1:] == tracks[:-1]) & (tracks[1:] != NO_TRACK)
        return np.column_stack([self.order[:-1][same], self.order[1:][same]])

    @cached_property
    def ways(self) -> Float64:
        """Way of each capture since its track began, meters, float64 (f,)."""
        steps = np.zeros(len(self))
        first, second = self.links.T
        moved = self.odometry.positions[second] - self.odometry.positions[first]
        steps[second] = np.linalg.norm(moved, axis=1)
        ways = np.empty(len(self))
        ordered = np.cumsum(steps[self.order])
        tracks = self.odometry.tracks[self.order]
        begins = np.flatnonzero(np.diff(tracks, prepend=tracks[:1] - 1))
        counts = np.diff(begins, append=len(tracks))
        ways[self.order] = ordered - np.repeat(ordered[begins], counts)
        return ways

    def moved(self, positions: Float64, yaws: Float64) -> "GraphFrames":
        """Return the same captures at other poses."""
        return GraphFrames(self.times, positions, yaws, self.odometry)


@dataclass(frozen=True, slots=True, eq=False)
class Links:
    """Relative poses of n pairs of captures, by odometry or by loops.

    Attributes:
        one: int64 (n,), capture in whose level frame the pose is.
        other: int64 (n,), capture whose pose it is.
        positions: float64 (n, 3), meters.
        yaws: float64 (n,), radians.
        deviations: float64 (n, 3), standard deviations: horizontal along each axis, m; height, m;
            heading, rad.
    """

    one: Int64
    other: Int64
    positions: Float64
    yaws: Float64
    deviations: Float64

    def __len__(self) -> int:
        return len(self.one)

    def take(self, rows: Int64) -> "Links":
        """Return these links."""
        return Links(
            self.one[rows],
            self.other[rows],
            self.positions[rows],
            self.yaws[rows],
            self.deviations[rows],
        )


def odometry_links(frames: GraphFrames, parameters: PoseGraphParameters) -> Links:
    """Return the odometry between consecutive captures of each track.

    The covariance of a link is the one that the map states, or grows with the way.
    """
    one, other = frames.links.T
    odometry = frames.odometry
    positions, yaws = relative(
        odometry.positions[one], odometry.yaws[one], odometry.positions[other], odometry.yaws[other]
    )
    growth = np.array(
        [parameters.drift**2, parameters.drift_height**2, np.radians(parameters.drift_yaw) ** 2]
    )
    way = np.linalg.norm(positions, axis=1)
    stated = odometry.variances[other] - odometry.variances[one]
    variances = np.where((stated > 0).all(axis=1)[:, None], stated, way[:, None] * growth)
    # A robot that stands still is not moved without any uncertainty.
    floor = growth * LEAST_WAY
    return Links(one, other, positions, yaws, np.sqrt(np.maximum(variances, floor)))


LEAST_WAY = 0.1
"""Way whose uncertainty each link has at least, meters."""


def relative(
    position: Float64, yaw: Float64, others: Float64, yaws: Float64
) -> tuple[Float64, Float64]:
    """Return the poses of others in the level frames of some captures, row by row.

    Args:
        position: float64 (n, 3), meters, positions of the captures.
        yaw: float64 (n,), radians, their headings.
        others: float64 (n, 3), meters, positions of the others.
        yaws: float64 (n,), radians, headings of the others.
    """
    return rotated(others - position, -yaw), wrapped(yaws - yaw)


def composed(
    position: Float64, yaw: Float64, others: Float64, yaws: Float64
) -> tuple[Float64, Float64]:
    """Return the poses whose `relative` poses are given, row by row."""
    return position + rotated(others, yaw), wrapped(yaw + yaws)


def rotated(points: Float64, yaws: Float64) -> Float64:
    """Rotate each point (n, 3) about z by its angle (n,), radians."""
    cos, sin = np.cos(yaws), np.sin(yaws)
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    return np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)


def wrapped(angles: Float64) -> Float64:
    """Return angles between -pi and pi, radians."""
    return np.asarray((angles + np.pi) % (2 * np.pi) - np.pi)


def headings(rotations: Float64) -> Float64:
    """Return the heading of the x axis of each rotation matrix (n, 3, 3), radians.

    An x axis that points straight up or down has none; the y axis then counts.
    """
    level = np.hypot(rotations[:, 0, 0], rotations[:, 1, 0]) > 0.1
    by_x = np.arctan2(rotations[:, 1, 0], rotations[:, 0, 0])
    by_y = np.arctan2(-rotations[:, 0, 1], rotations[:, 1, 1])
    return np.where(level, by_x, by_y)
