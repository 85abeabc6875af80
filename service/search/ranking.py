"""Ranking of maps: choose the few maps in which most candidates agree.

The nearest descriptors of each segment are searched in all maps at once. The votes of a map are the
largest number of segments that agree with one of its candidates, by consistent distances
(`placecell.localization.consistency`). Only the maps with most votes are searched in full.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.cancellation import current
from placecell.core.segment_classes import ClassFilter
from placecell.core.spatial import evenly
from placecell.core.types import Float32, Float64, Int8, Int64
from placecell.localization import LocalizationParameters
from placecell.localization.consistency import count_votes, slope_of
from service.maps.shared_index import IndexPart, centered
from service.maps.snapshot import MapSnapshot
from service.search.parallel import CORES, in_threads

FULL = 8
"""Largest number of maps that are searched in full."""

NEAREST = 128
"""Rows fetched per segment from an index of several maps."""

SEGMENTS = 64
"""Largest number of a request's segments that are searched in all maps, evenly chosen."""

OWN = 2
"""Candidates per segment that count in one map."""

PAIRS = 40_000_000
"""Largest number of candidate pairs compared in all maps together."""

WORTH = 0.4
"""Share of the best map's votes below which a map is not searched in full."""


@dataclass(frozen=True, slots=True, eq=False)
class Voters:
    """Candidates in several maps that vote for a pose, m of them.

    Attributes:
        places: index of each candidate's map, int64 (m,).
        queries: index of its query, int64 (m,).
        targets: centroids relative to the middle of their map, float32 (m, 3), meters.
        distances: squared descriptor distances in quantizer steps, rounded, float32 (m,).
    """

    places: Int64
    queries: Int64
    targets: Float32
    distances: Float32


def votes_of(
    codes: Int8,
    centroids: Float64,
    searched: Sequence[MapSnapshot],
    parts: Sequence[IndexPart],
    parameters: LocalizationParameters,
    wanted: ClassFilter | None = None,
) -> Int64:
    """Count for each map how many segments agree about one place, int64 (maps,).

    Args:
        codes: codes of the segments around the robot, int8 (q, code bytes).
        centroids: their centroids, float64 (q, 3), meters.
        searched: maps of one model.
        parts: parts of the search that cover these maps.
        parameters: tolerances within which two candidates agree.
        wanted: filter of the segments of the maps.
    """
    token = current()
    asked = evenly(np.flatnonzero(np.isfinite(centroids).all(axis=1)), SEGMENTS)
    votes = np.zeros(len(searched), dtype=np.int64)
    if not len(asked) or not parts:
        return votes
    codes, centroids = codes[asked], centroids[asked]

    def voters(part: IndexPart) -> Voters:
        token.check()
        return _voters(codes, searched, part, wanted)

    found = [*in_threads(voters, parts)]
    places = np.concatenate([each.places for each in found])
    queries = np.concatenate([each.queries for each in found])
    distances = np.concatenate([each.distances for each in found])
    targets = np.concatenate([each.targets for each in found])
    order = np.lexsort((distances, queries, places))
    places, queries = places[order], queries[order]
    # Keep the nearest candidates of each segment in each map.
    begins = np.flatnonzero(
        (np.diff(places, prepend=-1) != 0) | (np.diff(queries, prepend=-1) != 0)
    )
    rank = np.arange(len(places)) - np.repeat(begins, np.diff(begins, append=len(places)))
    kept = rank < OWN
    order, places, queries = order[kept], places[kept], queries[kept]
    starts = np.searchsorted(places, np.arange(len(searched) + 1)).astype(np.int64)
    counts = np.diff(starts).astype(np.float64)
    pairs = float((counts**2).sum() / 2)
    share = min(1.0, np.sqrt(PAIRS / max(pairs, 1.0)))
    seen = np.asarray(centroids, np.float64)
    target, slope = np.ascontiguousarray(targets[order]), slope_of(parameters)

    def count(some: Int64) -> None:
        begin, end = int(some[0]), int(some[-1]) + 1
        count_votes(
            starts=starts[begin : end + 1],
            queries=queries,
            source=seen,
            target=target,
            share=share,
            level=parameters.model == "yaw",
            tolerance=parameters.distance_tolerance,
            height_tolerance=parameters.height_tolerance,
            slope=slope,
            flag=token.flag,
            votes=votes[begin:end],
        )

    shares = np.array_split(np.arange(len(searched)), CORES)
    [*in_threads(count, [share for share in shares if len(share)])]
    token.check()
    return votes


def best_of(votes: Int64, least: int, always: Sequence[int] = (), most: int = FULL) -> Int64:
    """Choose the maps to search in full; indices, int64 (n,), ascending.

    Args:
        votes: votes of each map, int64 (maps,).
        least: smallest number of segments that must agree.
        always: maps that come first, because the robot was localized there just before.
        most: largest number of maps.
    """
    first = np.array(list(always)[: most // 2], dtype=np.int64)
    order = np.argsort(-votes, kind="stable")
    good = order[votes[order] >= max(least, WORTH * float(votes.max(initial=0)))]
    rest = good[~np.isin(good, first)]
    return np.sort(np.concatenate([first, rest[: most - len(first)]]))


def warm_up() -> None:
    """Compile the count of votes, so that the first request need not wait."""
    none, points = np.zeros(0, np.int64), np.zeros((0, 3))
    count_votes(
        starts=np.zeros(1, np.int64),
        queries=none,
        source=points,
        target=points.astype(np.float32),
        share=1.0,
        level=True,
        tolerance=0.0,
        height_tolerance=0.0,
        slope=0.0,
        flag=current().flag,
        votes=none.copy(),
    )


def _voters(
    codes: Int8, searched: Sequence[MapSnapshot], part: IndexPart, wanted: ClassFilter | None
) -> Voters:
    """Return the candidates of one part of the search."""
    shared = part.shared
    if shared is None:
        place = int(part.places[0])
        snapshot = searched[place]
        assert snapshot.index is not None
        distances, rows = snapshot.index.search(snapshot.layers, codes, OWN, wanted)
        queries = np.repeat(np.arange(len(codes)), rows.shape[1])
        points = centered(snapshot.layers.column("centroids", rows.ravel()))
        squared = np.asarray(distances.ravel() ** 2, np.float32)
        return Voters(np.full(len(queries), place), queries, points, squared)
    squared, rows = shared.among(wanted).rough(codes, min(NEAREST, len(shared.rows)))
    queries = np.repeat(np.arange(len(codes)), rows.shape[1])
    flat = rows.ravel()
    members = np.searchsorted(shared.starts, flat, side="right") - 1
    places = part.places[members]
    kept = (flat >= 0) & (places >= 0)
    return Voters(places[kept], queries[kept], shared.centroids[flat[kept]], squared.ravel()[kept])
