"""Walkways of a place: a graph of paths that a robot travels without turning on the spot."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from placecell.core.types import Float64, Int64
from town.streets.route import STEP, arc_lengths


@dataclass(frozen=True)
class Walkways:
    """Graph of paths. Every node has two paths or more, so there is no dead end.

    Attributes:
        nodes: (n, 2), town frame, meters.
        ends: int64 (m, 2), the two nodes of each path.
        lines: (k, 2) each, points of each path from its first node to its second, meters.
    """

    nodes: Float64
    ends: Int64
    lines: tuple[Float64, ...]

    @classmethod
    def straight(cls, nodes: Float64, ends: Sequence[tuple[int, int]]) -> Self:
        """Build a graph of straight paths."""
        return cls(nodes, np.array(ends), tuple(nodes[list(pair)] for pair in ends))

    @classmethod
    def grid(
        cls,
        rng: np.random.Generator,
        size: tuple[int, int],
        pitch: tuple[float, float],
        *,
        shift: float = 0.0,
        bend: float = 0.0,
        missing: float = 0.0,
    ) -> Self:
        """Draw an irregular grid of paths.

        Args:
            rng: random number generator.
            size: number of columns and of rows of nodes, at least two each.
            pitch: smallest and largest distance of two neighboring lines, meters.
            shift: largest displacement of a node along each axis, meters.
            bend: largest displacement of a path's middle from the straight line, meters.
            missing: share of the paths that is left out, where the graph allows it.
        """
        x, y = (np.cumsum(rng.uniform(*pitch, size=count)) for count in size)
        grid = np.stack(np.meshgrid(x - x[0], y - y[0], indexing="ij"), axis=-1).reshape(-1, 2)
        nodes = grid + rng.uniform(-shift, shift, size=grid.shape)
        numbers = np.arange(len(grid)).reshape(size)
        pairs = np.concatenate(
            [
                np.stack([numbers[:-1].ravel(), numbers[1:].ravel()], axis=1),
                np.stack([numbers[:, :-1].ravel(), numbers[:, 1:].ravel()], axis=1),
            ]
        )
        kept = thinned(pairs, len(nodes), round(missing * len(pairs)), rng)
        lines = tuple(bent(nodes[a], nodes[b], bend, rng) for a, b in kept)
        return cls(nodes, kept, lines)

    def wander(self, meters: float, rng: np.random.Generator, radius: float) -> Float64:
        """Draw a random walk without U-turns, as a smooth line.

        Args:
            meters: length of the line, meters; it is up to a step longer.
            rng: random number generator.
            radius: distance from a corner at which the line begins to turn, meters.

        Returns:
            (n, 2), points of the line, 0.25 m apart.
        """
        path = int(rng.integers(len(self.ends)))
        points, at, walked = self.lines[path], int(self.ends[path, 1]), 0.0
        # A smooth line cuts the corners: it is at least 1 / sqrt(2) of the walk.
        while walked < 1.5 * meters:
            onward = np.flatnonzero((self.ends == at).any(axis=1))
            onward = onward[onward != path]
            path = int(onward[int(rng.integers(len(onward)))])
            forward = bool(self.ends[path, 0] == at)
            line = self.lines[path] if forward else self.lines[path][::-1]
            walked += float(arc_lengths(line)[-1])
            points = np.concatenate([points, line[1:]])
            at = int(self.ends[path, int(forward)])
        line = smooth(points, radius)
        return line[arc_lengths(line) <= meters + STEP]

    def points(self) -> Float64:
        """Return points on all paths, (n, 2), at most 0.5 m apart."""
        return np.concatenate([evenly(line, 2 * STEP) for line in self.lines])


def thinned(pairs: Int64, nodes: int, count: int, rng: np.random.Generator) -> Int64:
    """Remove up to `count` edges at random; the graph stays connected, without dead ends."""
    kept = np.ones(len(pairs), dtype=bool)
    for edge in rng.permutation(len(pairs))[:count]:
        kept[edge] = False
        rest = pairs[kept]
        graph = csr_matrix((np.ones(len(rest)), tuple(rest.T)), shape=(nodes, nodes))
        ends = np.bincount(rest.ravel(), minlength=nodes)
        kept[edge] = ends.min() < 2 or connected_components(graph)[0] > 1
    return pairs[kept]


def bent(start: Float64, end: Float64, bend: float, rng: np.random.Generator) -> Float64:
    """Return a path from start to end whose middle is displaced sideways."""
    ahead = end - start
    aside = np.array([-ahead[1], ahead[0]]) / np.linalg.norm(ahead)
    share = np.linspace(0, 1, 9)[:, None]
    sweep = np.sin(np.pi * share) * float(rng.uniform(-bend, bend))
    return np.asarray(start + share * ahead + sweep * aside)


def smooth(points: Float64, radius: float) -> Float64:
    """Return a line over points (n, 2) with rounded corners, resampled to equal steps.

    A corner is replaced by a parabola that begins and ends at `radius` from it, or at half of the
    way to the next corner.
    """
    line = [points[:1]]
    share = np.linspace(0, 1, 9)[:, None]
    for before, corner, after in zip(points[:-2], points[1:-1], points[2:], strict=True):
        back, on = before - corner, after - corner
        entry, leave = (
            corner + way * min(0.5, radius / float(np.linalg.norm(way))) for way in (back, on)
        )
        line.append((1 - share) ** 2 * entry + 2 * share * (1 - share) * corner + share**2 * leave)
    return evenly(np.concatenate([*line, points[-1:]]), STEP)


def evenly(line: Float64, step: float) -> Float64:
    """Return points on a line (n, 2) at equal distances of about `step` meters."""
    traveled = arc_lengths(line)
    even = np.linspace(0, traveled[-1], int(traveled[-1] / step) + 2)
    return np.stack([np.interp(even, traveled, line[:, axis]) for axis in (0, 1)], axis=1)
