"""Synthetic maps and robots in them."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64, Int64
from placecell.localization import Candidates, Pose


@dataclass(frozen=True, eq=False)
class Scene:
    """Segments of a robot, their candidates and the true pose."""

    candidates: Candidates
    map: Float64
    pose: Pose

    def seen_from(self, move: Pose) -> "Scene":
        """Return the scene with another robot frame."""
        back = move.inverse()
        centroids = move.apply(self.candidates.centroids)
        return Scene(replace(self.candidates, centroids=centroids), self.map, self.pose.after(back))

    def in_map(self, move: Pose) -> "Scene":
        """Return the scene with another map frame."""
        places = self.candidates.places
        moved = move.apply(places.reshape(-1, 3)).reshape(places.shape)
        return Scene(
            replace(self.candidates, places=moved), move.apply(self.map), move.after(self.pose)
        )


def take(given: Candidates, order: Int64) -> Candidates:
    """Return the queries at these indices, in this order."""
    return Candidates(
        given.centroids[order],
        given.rows[order],
        given.places[order],
        given.probabilities[order],
    )


def concatenate(one: Candidates, other: Candidates) -> Candidates:
    """Concatenate the queries of two scenes."""
    return Candidates(
        np.concatenate([one.centroids, other.centroids]),
        np.concatenate([one.rows, other.rows]),
        np.concatenate([one.places, other.places]),
        np.concatenate([one.probabilities, other.probabilities]),
    )


def a_pose(random: np.random.Generator, reach: float = 500.0) -> Pose:
    return Pose.of_yaw(random.uniform(-np.pi, np.pi), random.uniform(-reach, reach, 3))


def any_rotation(random: np.random.Generator, reach: float = 500.0) -> Pose:
    return Pose(Rotation.random(rng=random).as_matrix(), random.uniform(-reach, reach, 3))


def street(random: np.random.Generator, length: float, count: int) -> Float64:
    """Return centroids (count, 3) of segments along both sides of a street."""
    along = random.uniform(0, length, count)
    across = random.choice([-1, 1], count) * random.uniform(4, 12, count)
    return np.stack([along, across, random.uniform(0, 4, count)], axis=1)


def scene(
    seed: int,
    segments: int = 30,
    *,
    found: float = 0.6,
    noise: float = 0.2,
    k: int = 10,
    rows: int = 2_000,
    pose: Pose | None = None,
) -> Scene:
    """Return a scene: a robot in a part of a map.

    Args:
        found: share of the segments that have their own row among the candidates.
        noise: of the centroids, standard deviation along each axis, meters.
        k: candidates of each.
        rows: of the map.
        pose: of the robot's frame in the map's.
    """
    random = np.random.default_rng(seed)
    where = pose or a_pose(random)
    centroids = np.concatenate([street(random, 2_000.0, rows - segments)])
    local = street(random, 70.0, segments) - (35.0, 0.0, 2.0)
    world = np.concatenate([where.apply(local), where.apply(centroids)])
    chosen = random.integers(0, rows, (segments, k))
    right = random.uniform(size=segments) < found
    chosen[right, 0] = np.flatnonzero(right)
    seen = local + random.normal(scale=noise, size=local.shape)
    return scene_of(seen, world, chosen, where, random)


def scene_of(
    centroids: Float64, rows: Float64, chosen: Int64, pose: Pose, random: np.random.Generator
) -> Scene:
    """Return a scene with these candidates, the first of each being the most probable."""
    n, k = chosen.shape
    # No row is a candidate twice.
    for query in range(n):
        _, first = np.unique(chosen[query], return_index=True)
        spare = np.setdiff1d(np.arange(len(rows)), chosen[query])
        twice = np.setdiff1d(np.arange(k), first)
        chosen[query, twice] = random.choice(spare, len(twice), replace=False)
    probabilities = np.sort(random.uniform(0, 1, (n, k)), axis=1)[:, ::-1].copy()
    return Scene(Candidates(centroids, chosen, rows[chosen], probabilities), rows, pose)
