"""Ray casting of things that are drawn at random, as segments of a local map.

The things of simulated drives are boxes, cylinders and smooth balls. Recorded ones are rounded,
overgrown and porous. So some examples are cast anew: rays of a random sensor, from a few places of
a drive, march through the thing until they are inside of one of its parts. Other things hide parts
of it, and region growing keeps what is connected.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from placecell.core.types import Bool, Float32, Float64, Int64

LEVELS = (0.33, 0.4, 0.4, 0.42, 0.7, 1.0, 1.33, 2.0)
"""Angles between the beams of a sensor, degrees."""

TURNS = (0.1, 0.35)
"""Smallest and largest angle from one measurement of a beam to the next, degrees."""

HIGHEST = (2.0, 2.0, 2.0, 11.0, 16.0, 22.0)
"""Largest angles of a beam over the horizon, degrees."""

SCANS, STEP = 10, (0.2, 1.6)
"""Number of scans in a local map, and smallest and largest way from one scan to the next."""

RAYS, MARCH = 500, 0.1
"""Largest number of rays to a thing in a scan, and meters of a step along a ray."""

CLEARANCE = 0.15, 0.45
"""Smallest and largest height over ground of the lowest points, meters."""

VOXEL, GROWING = 0.1, 0.25
"""Edge length of the voxels of a local map, and distance of neighbors in a segment, meters."""

FARTHEST, FEWEST = 60.0, 100
"""Largest distance from the sensor, meters, and smallest number of points of a segment."""


class Part(Protocol):
    """Part of a thing, in coordinates whose origin is on the ground, z up, meters.

    Attributes:
        kind: class index of its points.
        density: share of the steps inside that stop a ray; 1 is solid, leaves have less.
    """

    @property
    def kind(self) -> int:
        """Return the class index of its points."""

    @property
    def density(self) -> float:
        """Return the share of the steps inside that stop a ray; leaves have less than 1."""

    def contains(self, points: Float64) -> Bool:
        """Return which points, (..., 3), are inside, bool (...)."""


@dataclass(frozen=True, slots=True)
class Thing:
    """Thing that is cast.

    Attributes:
        parts: its parts.
        reach: largest horizontal distance of its points from the origin, meters.
        height: height of its highest points, meters.
        glass: lowest and highest height of windows, meters; some rays pass there.
    """

    parts: Sequence[Part]
    reach: float
    height: float
    glass: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Cast:
    """Segment that was cast.

    Attributes:
        points: points relative to the thing's origin, float32 (n, 3), meters.
        kind: class index of most of them.
    """

    points: Float32
    kind: int


@dataclass(frozen=True, slots=True)
class Beams:
    """Beams of a random sensor, in radians, and the share of rays that pass windows."""

    turn: float
    level: float
    highest: float
    clear: float

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> "Beams":
        """Return random beams."""
        return cls(
            float(np.radians(rng.uniform(*TURNS))),
            float(np.radians(rng.choice(LEVELS))),
            float(np.radians(rng.choice(HIGHEST))),
            float(rng.uniform(0.2, 1.0) * (rng.random() < 0.8)),
        )


def cast(thing: Thing, to_sensor: Float64, height: float, rng: np.random.Generator) -> Cast | None:
    """Return the segment that a robot sees of a thing; None if it has too few points.

    Args:
        thing: thing whose origin is where the segment is.
        to_sensor: horizontal vector from the origin to the sensor, float64 (2,), meters.
        height: height of the sensor over ground, meters.
        rng: random number generator.
    """
    bearing = float(np.arctan2(to_sensor[1], to_sensor[0]))
    way, step = bearing + rng.normal(0, 0.6), rng.uniform(*STEP)
    shaky, noise = rng.uniform(0, 0.03), rng.uniform(0.01, 0.04)
    beams = Beams.drawn(rng)
    clouds, owners = [], []
    for scan in range(SCANS):
        place = np.array([*to_sensor, height])
        place[:2] += scan * step * np.array([np.cos(way), np.sin(way)])
        if np.hypot(*place[:2]) > FARTHEST:
            break
        points, parts = scanned(thing, place, beams, rng)
        clouds.append(points + rng.normal(0, shaky, 3))
        owners.append(parts)
    if not clouds:
        return None
    points, part = np.concatenate(clouds), np.concatenate(owners)
    points = points + rng.normal(0, noise, points.shape)
    rows = np.flatnonzero(points[:, 2] > rng.uniform(*CLEARANCE))
    rows = rows[visible(points[rows], bearing, rng)]
    if len(rows) < FEWEST:
        return None
    kinds = np.array([each.kind for each in thing.parts])
    means, of_voxel = voxels(points[rows], kinds[part[rows]])
    kept = connected(means)
    if len(kept) < FEWEST:
        return None
    return Cast(means[kept].astype(np.float32), int(np.bincount(of_voxel[kept]).argmax()))


def scanned(
    thing: Thing, place: Float64, beams: Beams, rng: np.random.Generator
) -> tuple[Float64, Int64]:
    """Return the points of one scan, (n, 3), and the part of each, from a place, (3,)."""
    distance = float(np.hypot(*place[:2]))
    nearest = max(distance - thing.reach, 1.5)
    wide = np.arcsin(min(0.95, thing.reach / max(distance, thing.reach)))
    ahead = np.arctan2(-place[1], -place[0])
    across = ahead + np.arange(-wide, wide, beams.turn) + rng.uniform(0, beams.turn)
    low = -np.arctan(place[2] / nearest)
    high = min(max(np.arctan((thing.height - place[2]) / nearest), 0.0), beams.highest)
    up = np.arange(low, high + beams.level, beams.level) + rng.uniform(0, beams.level)
    angles = np.stack(np.meshgrid(across, up[up <= beams.highest]), axis=-1).reshape(-1, 2)
    if len(angles) > RAYS:
        angles = angles[rng.permutation(len(angles))[:RAYS]]
    turned, raised = angles.T
    level = np.cos(raised)
    rays = np.stack([np.cos(turned) * level, np.sin(turned) * level, np.sin(raised)], axis=1)
    steps = np.arange(max(distance - thing.reach, 0.5), distance + thing.reach, MARCH)
    places = place + rays[:, None] * steps[None, :, None]
    owner = np.full(places.shape[:2], -1)
    for number, part in enumerate(thing.parts):
        within = part.contains(places)
        if part.density < 1:
            within &= rng.random(within.shape) < part.density
        owner[within & (owner < 0)] = number
    first = (owner >= 0).argmax(axis=1)
    hit = owner[np.arange(len(rays)), first]
    away = steps[first] - MARCH * rng.random(len(rays))
    heights = place[2] + rays[:, 2] * away
    glass = (heights > thing.glass[0]) & (heights < thing.glass[1])
    passes = glass & (hit >= 0) & (rng.random(len(rays)) < beams.clear)
    away = np.where(passes, away + rng.exponential(0.7, len(rays)), away)
    inside = thing.parts[0].contains(place + rays * away[:, None])
    seen = (hit >= 0) & (~passes | (inside & (rng.random(len(rays)) < 0.5)))
    return (place + rays * away[:, None])[seen], hit[seen]


def visible(points: Float64, bearing: float, rng: np.random.Generator) -> Bool:
    """Return which points other things do not hide, bool (n,)."""
    seen = np.ones(len(points), bool)
    if not len(points):
        return seen
    if rng.random() < 0.5:
        across = points[:, 1] * np.cos(bearing) - points[:, 0] * np.sin(bearing)
        across *= rng.choice((-1, 1))
        seen &= across <= np.quantile(across, rng.uniform(0.35, 1.0))
    if rng.random() < 0.3:
        seen &= points[:, 2] > np.quantile(points[:, 2], rng.uniform(0.0, 0.5))
    return seen


def voxels(points: Float64, kinds: Int64) -> tuple[Float64, Int64]:
    """Return the mean of the points of each voxel, (m, 3), and the largest class, (m,)."""
    _, which = np.unique(np.floor(points / VOXEL).astype(np.int64), axis=0, return_inverse=True)
    which = which.ravel()
    counts = np.bincount(which)
    means = np.stack([np.bincount(which, axis) / counts for axis in points.T], axis=1)
    of_voxel = np.zeros(len(counts), np.int64)
    np.maximum.at(of_voxel, which, kinds)
    return means, of_voxel


def connected(points: Float64) -> Int64:
    """Return the rows of the largest set of points that region growing joins."""
    pairs = cKDTree(points).query_pairs(GROWING, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs), bool), pairs.T), shape=(len(points), len(points)))
    _, labels = connected_components(graph, directed=False)
    return np.flatnonzero(labels == np.bincount(labels).argmax())
