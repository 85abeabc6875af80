"""Scan Context, the baseline, implemented after the paper.

Kim and Kim 2018, *Scan Context: Egocentric Spatial Descriptor for Place Recognition within 3D Point
Cloud Map*. Parameters are those of the paper, or of the authors' program if the paper has none. The
peer that answers with it also registers, as the authors' SC-A-LOAM does (`registered_context.py`).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from benchmarks.peers.exchange import Cloud, Pose

Context = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ScanContextParameters:
    """Parameters of Scan Context. Lengths are in meters."""

    rings: int = 20
    sectors: int = 60
    radius: float = 80.0
    sensor_height: float = 2.0
    """Added to all heights, so that ground points differ from empty cells, which are 0."""
    candidates: int = 10
    """Number of local maps with the nearest ring keys, whose contexts are compared."""


DEFAULT = ScanContextParameters()


def scan_context(cloud: Cloud, parameters: ScanContextParameters = DEFAULT) -> Context:
    """Return the largest height in each ring and sector (section III-A): float64 (rings, sectors).

    Args:
        cloud: float32 (n, 3), points in a z-up frame with its origin at the sensor, meters.
        parameters: parameters of Scan Context.
    """
    distance = np.hypot(cloud[:, 0], cloud[:, 1])
    ring = (distance / parameters.radius * parameters.rings).astype(np.int64)
    angle = np.arctan2(cloud[:, 1], cloud[:, 0]) % (2 * np.pi)
    sector = (angle / (2 * np.pi) * parameters.sectors).astype(np.int64) % parameters.sectors
    near = ring < parameters.rings
    context = np.zeros((parameters.rings, parameters.sectors))
    height = cloud[:, 2].astype(np.float64) + parameters.sensor_height
    np.maximum.at(context, (ring[near], sector[near]), height[near])
    return context


def ring_key(context: Context) -> Context:
    """Return the share of occupied sectors per ring: (rings,); it is independent of heading."""
    return np.asarray((context > 0).mean(axis=1))


def distances(query: Context, candidate: Context) -> Context:
    """Return the distance of two contexts at each angle of whole sectors: (sectors,).

    The angle is the query's heading in the candidate's frame. The distance is one minus the mean
    cosine of the columns (equations 5 and 6). Columns that are empty in either context are left
    out, as in the authors' program.
    """
    query, candidate = unit_columns(query), unit_columns(candidate)
    cosines = query.T @ candidate
    both = np.outer(query.any(axis=0), candidate.any(axis=0))
    sectors = np.arange(query.shape[1])
    # A sector of the query corresponds to the candidate's sector shifted by the angle.
    further = (sectors + sectors[:, None]) % len(sectors)
    compared = both[sectors, further].sum(axis=1)
    similarity = cosines[sectors, further].sum(axis=1)
    return np.asarray(1 - similarity / np.maximum(compared, 1))


def unit_columns(context: Context) -> Context:
    """Return the context with columns of length 1; empty columns stay empty."""
    lengths = np.linalg.norm(context, axis=0)
    return np.asarray(context / np.where(lengths > 0, lengths, 1))


@dataclass(frozen=True, slots=True)
class FrameMatch:
    """Local map of the map that is similar to the query.

    Attributes:
        frame: index of the local map.
        distance: distance of the contexts at the best angle.
        yaw: heading of the query in the local map's frame, radians.
    """

    frame: int
    distance: float
    yaw: float


class ScanContexts:
    """Contexts of the local maps of a map, with a k-d tree of their ring keys."""

    def __init__(
        self, clouds: Sequence[Cloud], parameters: ScanContextParameters = DEFAULT
    ) -> None:
        self.parameters = parameters
        self.contexts = [scan_context(cloud, parameters) for cloud in clouds]
        self.keys = cKDTree(np.stack([ring_key(context) for context in self.contexts]))

    def find(self, cloud: Cloud) -> list[FrameMatch]:
        """Return the local maps most similar to a query, the best first (section III-D)."""
        query = scan_context(cloud, self.parameters)
        count = min(self.parameters.candidates, len(self.contexts))
        _, nearest = self.keys.query(ring_key(query), k=[*range(1, count + 1)])
        found = [self.compare(query, int(frame)) for frame in nearest]
        return sorted(found, key=lambda one: one.distance)

    def compare(self, query: Context, frame: int) -> FrameMatch:
        """Compare a query with a local map at the best angle."""
        apart = distances(query, self.contexts[frame])
        best = int(apart.argmin())
        return FrameMatch(frame, float(apart[best]), 2 * np.pi * best / self.parameters.sectors)


def about_z(yaw: float) -> Pose:
    """Return the rotation (4, 4) about the vertical by an angle in radians."""
    turn = np.eye(4)
    turn[:2, :2] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
    return turn
