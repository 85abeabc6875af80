"""Synthetic streets and maps of robots that drove along them."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Float64, Int64
from placecell.localization import Pose
from placecell.map_alignment import MapAlignment, MapView

DIMENSION = 7
MATCH = 0.6
"""Descriptor distance with a match probability of 0.6."""


@dataclass(frozen=True, eq=False)
class Street:
    """Landmarks along the x axis.

    Attributes:
        places: float64 (n, 3), meters.
        looks: float64 (n, DIMENSION), descriptors.
    """

    places: Float64
    looks: Float64

    def with_(self, other: "Street") -> "Street":
        return Street(
            np.concatenate([self.places, other.places]), np.concatenate([self.looks, other.looks])
        )


@dataclass(frozen=True, eq=False)
class MadeMap:
    """Synthetic map with descriptors and true landmarks.

    Attributes:
        view: what alignment knows of it.
        looks: float64 (n, DIMENSION).
        things: int64 (n,), rows of the street.
    """

    view: MapView
    looks: Float64
    things: Int64

    def take(self, rows: Int64) -> "MadeMap":
        return MadeMap(self.view.take(rows), self.looks[rows], self.things[rows])

    def moved(self, pose: Pose) -> "MadeMap":
        return MadeMap(self.view.moved(pose), self.looks, self.things)

    def with_(self, other: "MadeMap") -> "MadeMap":
        view = MapView(
            np.concatenate([self.view.centroids, other.view.centroids]),
            np.concatenate([self.view.viewpoints, other.view.viewpoints]),
        )
        looks = np.concatenate([self.looks, other.looks])
        return MadeMap(view, looks, np.concatenate([self.things, other.things]))


class ByDistance:
    """`DescriptorSearch` by distance of made-up descriptors; counts the pairs it compared."""

    def __init__(self, a: MadeMap, b: MadeMap, k: int = 10) -> None:
        self._a, self._b, self._k = a.looks, b.looks, min(k, len(a.looks))
        self._tree = cKDTree(a.looks)
        self.pairs = 0

    def nearest(self, rows: Int64) -> tuple[Int64, Float64]:
        distances, found = self._tree.query(self._b[rows], np.arange(1, self._k + 1))
        return found.astype(np.int64), chance(distances)

    def match_probabilities(self, a: Int64, b: Int64) -> Float64:
        self.pairs += len(a)
        return chance(np.linalg.norm(self._a[a] - self._b[b], axis=1))


def chance(distances: Float64) -> Float64:
    return np.asarray(np.exp(-0.5 * (distances / MATCH) ** 2))


def street(
    random: np.random.Generator, length: float, gap: float = 3.0, begin: float = 0.0
) -> Street:
    """Return landmarks on both sides at equal distances, all different."""
    count = int(length / gap)
    places = np.stack(
        [
            begin + random.uniform(0, length, count),
            random.choice([-1, 1], count) * random.uniform(4, 12, count),
            random.uniform(0, 4, count),
        ],
        axis=1,
    )
    return Street(places, random.normal(size=(count, DIMENSION)))


def drive(
    seen: Street,
    begin: float,
    end: float,
    random: np.random.Generator,
    *,
    noise: float = 0.1,
    blur: float = 0.15,
    missed: float = 0.3,
) -> MadeMap:
    """Return the map of a robot that drives from one x to another, with a capture every 5 m.

    Args:
        noise: of the centroids, along each axis, meters.
        blur: of the descriptors.
        missed: share of the things that are not seen, each time.
    """
    viewpoints = np.arange(begin, end + 1e-9, 5.0)[:, None] * (1.0, 0.0, 0.0)
    near = np.linalg.norm(seen.places[:, None] - viewpoints, axis=2) < 25.0
    things, moments = np.nonzero(near & (random.uniform(size=near.shape) >= missed))
    order = np.argsort(moments, kind="stable")
    things, moments = things[order], moments[order]
    return MadeMap(
        MapView(
            seen.places[things] + random.normal(scale=noise, size=(len(things), 3)),
            viewpoints[moments],
        ),
        seen.looks[things] + random.normal(scale=blur, size=(len(things), DIMENSION)),
        things,
    )


@dataclass(frozen=True, eq=False)
class Pair:
    """Two maps and the true transform from b's frame to a's."""

    a: MadeMap
    b: MadeMap
    truth: Pose

    @property
    def looks(self) -> ByDistance:
        return ByDistance(self.a, self.b)


def pair(seed: int, shared: float = 80.0, **how: float) -> Pair:
    """Return maps of two robots with a shared length of path; b has a random frame."""
    random = np.random.default_rng(seed)
    along = street(random, 400.0, begin=-30.0)
    a = drive(along, 0.0, 150.0, random, **how)
    b = drive(along, 150.0 - shared, 300.0 - shared, random, **how)
    truth = a_pose(random)
    return Pair(a, b.moved(truth.inverse()), truth)


def a_pose(random: np.random.Generator, reach: float = 3_000.0) -> Pose:
    return Pose.of_yaw(random.uniform(-np.pi, np.pi), random.uniform(-reach, reach, 3))


def off(found: MapAlignment, truth: Pose) -> tuple[float, float]:
    """Return the errors of the pose at the overlap, meters and degrees."""
    assert found.pose is not None, (found.reason, found.detail)
    assert found.best is not None
    meters, angle = found.pose.difference(truth, found.best.source.mean(axis=0))
    return meters, float(np.degrees(angle))


def assert_right(found: MapAlignment, truth: Pose, meters: float = 0.5) -> None:
    away, degrees = off(found, truth)
    assert away < meters
    assert degrees < 1.0


def assert_right_or_none(found: MapAlignment, truth: Pose) -> None:
    if found.pose is None:
        assert found.reason is not None
        assert found.detail
    else:
        assert_right(found, truth)
