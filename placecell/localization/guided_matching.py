"""Guided matching: score a hypothesis by all map segments near the predicted positions.

A hypothesis comes from a few candidates per segment. In a street of identical houses, all of them
may be views from the robot's direction of travel, and none may be at its true position, where the
map has views from the opposite direction. So each hypothesis is compared with all map segments near
the positions that it predicts. Source: Hartley and Zisserman, *Multiple View Geometry*, 2nd ed.,
sections 4.8 and 11.6.
"""

from dataclasses import replace
from typing import Protocol

import numpy as np

from placecell.core.nearest import nearest_within
from placecell.core.spatial import evenly, within
from placecell.core.types import Float64, Int64
from placecell.localization.candidates import Candidates
from placecell.localization.correspondences import number_places
from placecell.localization.hypothesis import Hypothesis
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.refinement import kernel


class MapSegments(Protocol):
    """Access to all segments of a map, for guided matching."""

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Return all rows of the map near a place, and some farther ones (see `within`).

        Args:
            places: float64 (n, 3), meters, in the map's frame; n > 0.
            meters: largest distance along each axis at which a row is near.

        Returns:
            Rows, int64 (m,), and their centroids, float64 (m, 3), meters.
        """

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """Return the match probability of each pair of a query and a row, float64 (m,).

        Args:
            queries: int64 (m,), indices of queries.
            rows: int64 (m,), rows of the map.
        """


class MapBoxes(MapSegments, Protocol):
    """Access to the boxes of a map's segments as well, for the height of a pose."""

    def heights(self, rows: Int64) -> Float64:
        """Return the heights of the boxes of rows, float64 (m,), meters; NaN: unknown."""


class CandidateSegments:
    """`MapBoxes` that consist of the candidates only."""

    def __init__(self, candidates: Candidates) -> None:
        beliefs = candidates.beliefs
        queries, columns = np.nonzero(beliefs)
        rows = candidates.rows[queries, columns]
        self._rows, first = np.unique(rows, return_index=True)
        self._centroids = candidates.places[queries, columns][first]
        self._pairs, first = np.unique(self._numbered(queries, rows), return_index=True)
        self._beliefs = beliefs[queries, columns][first]

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Return the candidates' rows near a place (see `MapSegments.near`)."""
        inside = within(self._centroids, places, meters)
        return self._rows[inside], self._centroids[inside]

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """Return each candidate's match probability; 0 if the row is no candidate of the query."""
        pairs = self._numbered(queries, rows)
        at = np.searchsorted(self._pairs, pairs).clip(max=len(self._pairs) - 1)
        return np.where(self._pairs[at] == pairs, self._beliefs[at], 0.0)

    def heights(self, rows: Int64) -> Float64:
        """Return NaN for each row: candidates have no boxes."""
        return np.full(len(rows), np.nan)

    def _numbered(self, queries: Int64, rows: Int64) -> Int64:
        return queries * len(self._rows) + np.searchsorted(self._rows, rows)


def match_guided(
    hypothesis: Hypothesis,
    candidates: Candidates,
    there: MapSegments,
    parameters: LocalizationParameters,
    beliefs: Float64 | None = None,
) -> Hypothesis:
    """Score a hypothesis by guided matching, one to one.

    A pair of a query and a map segment has the weight of a correspondence (see `correspond`), by
    its share of the query's total match probability. The weight decreases with the distance.

    Args:
        hypothesis: pose to score.
        candidates: queries and their candidates.
        there: segments of the map.
        parameters: gate, kernel and limits.
        beliefs: float64 (n,), total match probability of each query; None for that of
            `candidates`.

    Returns:
        The hypothesis with `score`, `worth` and `similarity` of guided matching.
    """
    seen = np.flatnonzero(np.isfinite(candidates.centroids).all(axis=1))
    places = hypothesis.pose.apply(candidates.centroids[seen])
    rows, points = there.near(places, parameters.gate)
    some = evenly(np.arange(len(rows)), parameters.most_near_rows)
    rows, points = rows[some], points[some]
    here, near, distances = nearest_within(places, points, parameters.gate, parameters.most_views)
    queries, found = seen[here], rows[near]
    match_probabilities = there.match_probabilities(queries, found)
    # The query's total probability already includes the row if it is a candidate.
    others = (candidates.beliefs.sum(axis=1) if beliefs is None else beliefs)[queries]
    is_candidate = (candidates.rows[queries] == found[:, None]).any(axis=1)
    share = match_probabilities / np.maximum(
        others + np.where(is_candidate, 0.0, match_probabilities), 1e-9
    )
    nearness = kernel(distances, parameters.kernel)
    worth = np.log1p(share / parameters.unlikely) * nearness
    # The best pair of each query, then the best of these for each place of the map.
    best = np.lexsort((found, queries, -worth))
    best = best[first_of_each(queries[best])]
    landmarks = number_places(found[best], points[near[best]], parameters.same_place)
    best = best[first_of_each(landmarks)]
    of_queries, similarity = np.zeros((2, len(candidates)))
    of_queries[queries[best]] = worth[best]
    distinct = np.minimum(share[best], parameters.distinct)
    similarity[queries[best]] = np.log1p(distinct / parameters.unlikely)
    return replace(
        hypothesis, score=float(worth[best].sum()), worth=of_queries, similarity=similarity
    )


def first_of_each(owners: Int64) -> Int64:
    """Return the index of the first entry of each owner, ascending."""
    return np.sort(np.unique(owners, return_index=True)[1])
