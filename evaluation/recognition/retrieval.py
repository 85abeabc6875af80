"""Measures of recognition: the paper's two experiments (IV-B), and a harder one.

Descriptors are measured as stored; `docs/results/recognition.md` defines the figures.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.stats import rankdata

from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.descriptors.reranking import rerank, supports

PAIRS = 20_000
"""Number of positive pairs, and of negative pairs."""

CROSS_VIEW_METERS = 10.0
CANDIDATES = 25


@dataclass(frozen=True, slots=True)
class Retrieval:
    """Nearest neighbors of each segment among all others. A mate is a segment of the same group.

    Attributes:
        right: bool (segments,), whether the nearest segment is a mate.
        has_mate: bool (segments,), whether the segment has a mate.
        recalled: bool (segments,), whether a mate is among the 25 nearest segments.
        nearest: int64 (segments,), nearest segment; -1 if there is no other.
        candidates: int64 (segments, 25), the nearest segments, nearest first; ties by index; -1
            where there is no other.
        distances: float64 (segments, 25), their distances; infinite where there is no other.
    """

    right: Bool
    has_mate: Bool
    recalled: Bool
    nearest: Int64
    candidates: Int64
    distances: Float64


def distance_rows(
    descriptors: Float32, queries: Float32 | None = None, rows: int = 1000
) -> Iterator[tuple[Int64, Float32]]:
    """Yield the squared distances to all segments, some rows at a time.

    The distance of a segment to itself is infinite.

    Args:
        descriptors: float32 (segments, dimension).
        queries: float32 (segments, dimension), other descriptors of the same segments as queries.
        rows: number of rows at a time.
    """
    asked = descriptors if queries is None else queries
    asked_squared = np.einsum("ij,ij->i", asked, asked)
    squared = np.einsum("ij,ij->i", descriptors, descriptors)
    for first in range(0, len(descriptors), rows):
        chosen = np.arange(first, min(first + rows, len(descriptors)))
        products = asked[chosen] @ descriptors.T
        distances = asked_squared[chosen, None] + squared[None] - 2 * products
        distances[np.arange(len(chosen)), chosen] = np.inf
        yield chosen, distances


TooEasy = Callable[[Int64], Bool]
"""Return for rows (r,) which segments would be too easy matches, bool (r, segments)."""


def seen_within(sensors: Float32, meters: float) -> TooEasy:
    """Return the rule that views from viewpoints within `meters` of each other are too easy.

    Args:
        sensors: float32 (segments, 3), sensor positions.
        meters: distance of the viewpoints, meters.
    """

    def too_easy(rows: Int64) -> Bool:
        offsets = sensors[rows, None] - sensors[None]
        return np.asarray(np.einsum("ijk,ijk->ij", offsets, offsets) <= meters**2)

    return too_easy


def seen_from_angle(bearings: Float64, degrees: float) -> TooEasy:
    """Return the rule that views from sides within `degrees` of each other are too easy.

    Args:
        bearings: float64 (segments,), bearings of the sensor, radians.
        degrees: angle between the bearings, degrees.
    """

    def too_easy(rows: Int64) -> Bool:
        turned = bearings[rows, None] - bearings[None]
        return np.asarray(np.abs(np.angle(np.exp(1j * turned))) <= np.radians(degrees))

    return too_easy


def retrieve(
    descriptors: Float32,
    groups: Int64,
    too_easy: TooEasy | None = None,
    queries: Float32 | None = None,
) -> Retrieval:
    """Search each segment among the others (paper IV-B, second comparison).

    Args:
        descriptors: float32 (segments, dimension).
        groups: int64 (segments,), group of each segment.
        too_easy: rule for mates that are left out.
        queries: float32 (segments, dimension), other descriptors of the same segments as queries.
    """
    count = len(groups)
    right, has_mate, recalled = (np.zeros(count, dtype=bool) for _ in range(3))
    nearest_first = np.full(count, -1)
    candidates = np.full((count, CANDIDATES), -1)
    apart = np.full((count, CANDIDATES), np.inf)
    for rows, distances in distance_rows(descriptors, queries):
        mates = groups[rows, None] == groups[None]
        mates[np.arange(len(rows)), rows] = False
        if too_easy is not None:
            easy = too_easy(rows)
            distances[mates & easy] = np.inf
            mates &= ~easy
        has_mate[rows] = mates.any(axis=1)
        several = min(CANDIDATES, count - 1)
        if several < 1:
            continue
        nearest = np.argpartition(distances, several - 1, axis=1)[:, :several]
        recalled[rows] = np.take_along_axis(mates, nearest, axis=1).any(axis=1)
        first = distances.argmin(axis=1)
        nearest_first[rows] = first
        right[rows] = mates[np.arange(len(rows)), first]
        squared = np.take_along_axis(distances, nearest, axis=1)
        order = np.lexsort((nearest, squared), axis=1)
        squared = np.take_along_axis(squared, order, axis=1)
        # A segment that is left out is infinitely far.
        found = np.where(np.isfinite(squared), np.take_along_axis(nearest, order, axis=1), -1)
        candidates[rows, :several] = found
        apart[rows, :several] = np.sqrt(np.maximum(squared, 0.0))
    return Retrieval(right, has_mate, recalled, nearest_first, candidates, apart)


def reranked(found: Retrieval, groups: Int64, centroids: Float64, captures: Int64) -> Bool:
    """Return whether the first candidate of each segment is a mate after re-ranking.

    The segments of a capture are neighbors. Their candidates are those of the retrieval, so the
    same mates are left out.

    Args:
        found: candidates of each segment.
        groups: int64 (segments,), group of each segment.
        centroids: float64 (segments, 3), centroids, meters, in one frame.
        captures: int64 (segments,), capture that each segment was seen in.
    """
    maps = np.where(found.candidates >= 0, 0, -1)
    counts = supports(centroids, centroids[found.candidates], maps, captures)
    first = rerank(found.distances, counts)[:, :1]
    best = np.take_along_axis(found.candidates, first, axis=1)[:, 0]
    return np.asarray((best >= 0) & (groups[best] == groups))


def top1(descriptors: Float32, groups: Int64) -> float:
    """Return the share of segments whose nearest neighbor is a mate; no mate counts as a miss."""
    return float(retrieve(descriptors, groups).right.mean()) if len(groups) else 0.0


def draw_pairs(groups: Int64, count: int, random: np.random.Generator) -> tuple[Int64, Int64]:
    """Draw positive and negative pairs: indices, int64 (count, 2) each; empty if there are none.

    A positive pair is two segments of a group that is drawn uniformly from all groups of two or
    more. A negative pair is two segments of different groups.
    """
    none = np.zeros((0, 2), dtype=np.int64)
    order = np.argsort(groups, kind="stable")
    _, starts, sizes = np.unique(groups[order], return_index=True, return_counts=True)
    plural = np.flatnonzero(sizes >= 2)
    positive, negative = none, none
    if len(plural):
        chosen = random.choice(plural, count)
        first = random.integers(0, sizes[chosen])
        second = (first + random.integers(1, sizes[chosen])) % sizes[chosen]
        positive = order[starts[chosen][:, None] + np.stack([first, second], axis=1)]
    if len(sizes) >= 2:
        drawn = [none]
        while sum(map(len, drawn)) < count:
            pairs = random.integers(0, len(groups), (count, 2))
            drawn.append(pairs[groups[pairs[:, 0]] != groups[pairs[:, 1]]])
        negative = np.concatenate(drawn)[:count]
    return positive, negative


def nearest_pairs(
    descriptors: Float32, groups: Int64, queries: Int64, candidates: int = CANDIDATES
) -> tuple[Int64, Int64]:
    """Return the pairs of each query with its nearest segments, int64 (n, 2): matches and others.

    Together they are queries times candidates pairs, or fewer if there are fewer segments.
    """
    none = np.zeros((0, 2), dtype=np.int64)
    matches, others = [none], [none]
    squared = np.einsum("ij,ij->i", descriptors, descriptors)
    several = min(candidates, len(descriptors) - 1)
    for rows in np.array_split(queries, max(1, len(queries) // 500)):
        distances = squared[None] - 2 * descriptors[rows] @ descriptors.T
        distances[np.arange(len(rows)), rows] = np.inf
        if several < 1:
            continue
        nearest = np.argpartition(distances, several - 1, axis=1)[:, :several]
        pairs = np.stack([np.repeat(rows, several), nearest.reshape(-1)], axis=1)
        match = groups[pairs[:, 0]] == groups[pairs[:, 1]]
        matches.append(pairs[match])
        others.append(pairs[~match])
    return np.concatenate(matches), np.concatenate(others)


def pair_distances(descriptors: Float32, pairs: Int64) -> Float64:
    """Return the Euclidean distances of pairs, float64 (pairs,)."""
    offsets = descriptors[pairs[:, 0]].astype(np.float64) - descriptors[pairs[:, 1]]
    return np.asarray(np.linalg.norm(offsets, axis=1))


def area_under_roc(positive: Float64, negative: Float64) -> float:
    """Return the probability that a positive scores above a negative; ties count half."""
    ranks = rankdata(np.concatenate([positive, negative]))[: len(positive)]
    below = ranks.sum() - len(positive) * (len(positive) + 1) / 2
    return float(below / (len(positive) * len(negative)))


def best_threshold(positive: Float64, negative: Float64) -> float:
    """Return the distance threshold with the highest accuracy, for matches below it."""
    distances = np.concatenate([positive, negative])
    gain = np.concatenate([np.ones(len(positive)), -np.ones(len(negative))])
    order = np.argsort(distances, kind="stable")
    best = int(np.cumsum(gain[order]).argmax())
    upper = min(best + 1, len(order) - 1)
    return float((distances[order[best]] + distances[order[upper]]) / 2)


def accuracy_at(threshold: float, positive: Float64, negative: Float64) -> float:
    """Return the balanced accuracy if pairs nearer than the threshold are matches."""
    return float(((positive <= threshold).mean() + (negative > threshold).mean()) / 2)
