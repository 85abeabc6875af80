"""Paths with drift, and loops between their captures, for tests by hand."""

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.pose_graph import CaptureOdometry, FoundLoop, GraphFrames
from placecell.pose_graph.frames import relative

STEP = 5.0
"""Distance between two captures, meters."""


def square_path(side: int = 20, laps: int = 2) -> tuple[Float64, Float64]:
    """Return true positions (n, 3) and headings (n,) of laps around a square, STEP apart."""
    positions, yaws = [], []
    position = np.zeros(3)
    for edge in range(4 * laps):
        yaw = np.pi / 2 * edge
        for _ in range(side):
            positions.append(position.copy())
            yaws.append((yaw + np.pi) % (2 * np.pi) - np.pi)
            position += STEP * np.array([np.cos(yaw), np.sin(yaw), 0.0])
    return np.array(positions), np.array(yaws)


def drifted(
    positions: Float64, yaws: Float64, rng: np.random.Generator, meters: float, degrees: float
) -> tuple[Float64, Float64]:
    """Return the poses of an odometry with random errors after each meter's square root."""
    steps, turns = relative(positions[:-1], yaws[:-1], positions[1:], yaws[1:])
    way = np.sqrt(np.linalg.norm(steps, axis=1))[:, None]
    steps = steps + meters * way * rng.standard_normal(steps.shape)
    turns = turns + np.radians(degrees) * way[:, 0] * rng.standard_normal(len(turns))
    headings = yaws[0] + np.concatenate([[0.0], np.cumsum(turns)])
    cos, sin = np.cos(headings[:-1]), np.sin(headings[:-1])
    moved = np.column_stack(
        [cos * steps[:, 0] - sin * steps[:, 1], sin * steps[:, 0] + cos * steps[:, 1], steps[:, 2]]
    )
    return positions[0] + np.concatenate([np.zeros((1, 3)), np.cumsum(moved, axis=0)]), headings


def frames_of(positions: Float64, yaws: Float64, track: int = 1, start: float = 0.0) -> GraphFrames:
    """Return captures whose poses are those of their odometry, a second apart."""
    tracks = np.full(len(yaws), track)
    odometry = CaptureOdometry.from_poses(tracks, positions, yaws)
    return GraphFrames(start + np.arange(len(yaws), dtype=float), positions, yaws, odometry)


def joined(parts: list[GraphFrames]) -> GraphFrames:
    """Return the captures of several robots as one graph."""
    names = ("tracks", "positions", "yaws", "variances")
    odometry = CaptureOdometry(
        *(np.concatenate([getattr(each.odometry, name) for each in parts]) for name in names)
    )
    return GraphFrames(
        np.concatenate([each.times for each in parts]),
        np.concatenate([each.positions for each in parts]),
        np.concatenate([each.yaws for each in parts]),
        odometry,
    )


def loops_between(
    pairs: Int64,
    positions: Float64,
    yaws: Float64,
    rng: np.random.Generator,
    meters: float = 0.05,
    degrees: float = 0.1,
) -> list[FoundLoop]:
    """Return loops between captures (n, 2) with their true relative poses and some noise."""
    one, other = pairs.T
    there, turned = relative(positions[one], yaws[one], positions[other], yaws[other])
    there = there + meters * rng.standard_normal(there.shape)
    turned = turned + np.radians(degrees) * rng.standard_normal(len(turned))
    return [
        FoundLoop(int(a), int(b), place, float(yaw), np.diag([0.01, 0.01, 0.01, 1e-4]), 0.99, 20)
        for (a, b), place, yaw in zip(pairs, there, turned, strict=True)
    ]


def outliers(count: int, frames: GraphFrames, rng: np.random.Generator) -> list[FoundLoop]:
    """Return random loops between random captures."""
    found = []
    for _ in range(count):
        one, other = rng.choice(len(frames), 2, replace=False).tolist()
        place = np.append(rng.uniform(-30.0, 30.0, 2), 0.0)
        yaw = float(rng.uniform(-np.pi, np.pi))
        covariance = np.diag([0.01, 0.01, 0.01, 1e-4])
        found.append(FoundLoop(one, other, place, yaw, covariance, 0.99, 20))
    return found


def error(positions: Float64, true: Float64) -> float:
    """Return the root mean square error of positions whose first one is right, meters."""
    return float(np.sqrt(((positions - true) ** 2).sum(axis=1).mean()))
