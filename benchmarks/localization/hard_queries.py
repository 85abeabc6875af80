"""Hard queries: arrangements of segments and candidates that give localization the most work.

Most of them fit everywhere: each segment has many candidates, and nearly all of them agree.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64, Int64
from placecell.localization import Pose

MAP_SEGMENTS = 10_000


@dataclass(frozen=True, slots=True, eq=False)
class HardQuery:
    """Query of q segments with k candidates each, in a map of n segments.

    Attributes:
        centroids: float64 (q, 3), meters, centroids of the query's segments.
        map_centroids: float64 (n, 3), meters, centroids of the map's segments.
        rows: int64 (q, k), rows of the candidates.
    """

    centroids: Float64
    map_centroids: Float64
    rows: Int64


Arrange = Callable[[int, int, np.random.Generator], HardQuery]


def street(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return an ordinary query: most segments have their own counterparts, all have wrong ones."""
    there = random.uniform([0, 0, 0], [1_000, 100, 4], (MAP_SEGMENTS, 3))
    views = np.argsort(np.linalg.norm(there - (500, 50, 2), axis=1))[:count]
    # The views of a counterpart are in the rows of far segments, which this moves.
    others = random.permutation(np.setdiff1d(np.arange(MAP_SEGMENTS), views))
    right = others[: 4 * count].reshape(count, 4)
    there[right] = there[views][:, None] + random.normal(scale=0.3, size=(count, 4, 3))
    rows = random.choice(others[4 * count :], (count, k))
    seen = random.uniform(size=count) < 0.8
    rows[seen, : min(4, k)] = right[seen, : min(4, k)]
    pose = Pose.of_yaw(1.0, np.array([30.0, -20.0, 1.0]))
    return HardQuery(pose.apply(there[views]), there, rows)


def same_candidates(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a query whose segments are all alike: each has the same candidates."""
    there = random.uniform([-50, -50, 0], [50, 50, 4], (MAP_SEGMENTS, 3))
    return HardQuery(there[-count:], there, np.tile(np.arange(k), (count, 1)))


def one_point(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a query and a map whose segments are all in one point."""
    rows = random.integers(MAP_SEGMENTS, size=(count, k))
    return HardQuery(np.zeros((count, 3)), np.zeros((MAP_SEGMENTS, 3)), rows)


def one_place(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a query whose candidates are all views of one segment."""
    there = random.normal(scale=0.1, size=(MAP_SEGMENTS, 3))
    rows = random.integers(MAP_SEGMENTS, size=(count, k))
    return HardQuery(random.uniform(-40, 40, (count, 3)) * (1, 1, 0.05), there, rows)


def room(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a query in a space so small that nearly all pairs of candidates agree."""
    places = _grid(6, 6, 1.01)
    there = places[np.arange(MAP_SEGMENTS) % len(places)]
    rows = np.argsort(random.uniform(size=(count, len(places))), axis=1)[:, :k]
    return HardQuery(random.uniform(-1, 1, (count, 3)) * (1, 1, 0.1), there, rows)


def duplicates(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a query with each segment ten times over."""
    there = random.uniform([-40, -40, 0], [40, 40, 2], (MAP_SEGMENTS, 3))
    seen = np.arange(count) // 10
    return HardQuery(there[seen], there, random.integers(500, size=(count, k))[seen])


def line(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a query of equal distances on a straight line, in a map of the same."""
    del random
    there = np.zeros((MAP_SEGMENTS, 3))
    there[:, 0] = 2.0 * np.arange(MAP_SEGMENTS)
    rows = 1_000 + np.arange(count)[:, None] + np.arange(k)
    return HardQuery(there[:count], there, rows)


def grid(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a regular grid, such as a car park, in a map that repeats it everywhere."""
    return _on_grid(count, k, random, 5.0)


def fine_grid(count: int, k: int, random: np.random.Generator) -> HardQuery:
    """Return a grid finer than the tolerance of a distance: many wrong pairs agree too."""
    return _on_grid(count, k, random, 1.01)


HARD_QUERIES: dict[str, Arrange] = {
    each.__name__.replace("_", "-"): each
    for each in (
        street,
        same_candidates,
        one_point,
        one_place,
        room,
        duplicates,
        line,
        grid,
        fine_grid,
    )
}
"""All arrangements by name. The first is an ordinary one, for comparison."""


def _grid(width: int, length: int, spacing: float) -> Float64:
    x, y = np.mgrid[:width, :length] * spacing
    return np.stack([x.ravel(), y.ravel(), np.zeros(width * length)], axis=1)


def _on_grid(count: int, k: int, random: np.random.Generator, spacing: float) -> HardQuery:
    side = int(np.sqrt(MAP_SEGMENTS))
    there = _grid(side, side, spacing)
    width = int(np.ceil(np.sqrt(count)))
    first = np.arange(count) // width * side + np.arange(count) % width
    # The same shifts for all segments, so that each shift is a pose with all of them.
    shifts = random.choice(side - width, (k, 2))
    return HardQuery(there[first], there, first[:, None] + shifts @ (side, 1))
