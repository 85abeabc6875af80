"""Looking again: whether what lies there in the map looks like what the robot sees.

A hypothesis is found from each segment's likeliest candidates, and these are few. In a street of
identical houses all of them may lie where the robot drove the same way, and none where it truly is,
for it sees the houses from the other side there. So each hypothesis is held against all that the
map has where it puts the segments, whether it was a candidate or not: guided matching (Hartley and
Zisserman, *Multiple View Geometry*, 2nd ed., sections 4.8 and 11.6).
"""

from dataclasses import replace
from typing import Protocol

import numpy as np

from placecell.core.spatial import near_pairs, within
from placecell.core.types import Float64, Int64
from placecell.localization.candidates import Candidates
from placecell.localization.correspondences import number_places
from placecell.localization.hypothesis import Hypothesis
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.refinement import kernel


class MapSegments(Protocol):
    """A map that what the robot sees can be compared with."""

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Rows of the map about these places: all that are near one, and some around (`within`).

        Args:
            places: float64 (n, 3), meters, in the map's frame; n > 0.
            meters: along each axis, up to which a row is near.

        Returns:
            Rows, int64 (m,), and their centroids, float64 (m, 3), meters.
        """

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """How likely each query and row, (m,) each, are the same, pair by pair, float64 (m,)."""


class CandidateSegments:
    """As much of a map as the candidates show."""

    def __init__(self, candidates: Candidates) -> None:
        beliefs = candidates.beliefs
        queries, columns = np.nonzero(beliefs)
        rows = candidates.rows[queries, columns]
        self._rows, first = np.unique(rows, return_index=True)
        self._centroids = candidates.places[queries, columns][first]
        self._pairs, first = np.unique(self._numbered(queries, rows), return_index=True)
        self._beliefs = beliefs[queries, columns][first]

    def near(self, places: Float64, meters: float) -> tuple[Int64, Float64]:
        """Of the rows that are anyone's candidate."""
        inside = within(self._centroids, places, meters)
        return self._rows[inside], self._centroids[inside]

    def match_probabilities(self, queries: Int64, rows: Int64) -> Float64:
        """The belief in each candidate; 0 where the row is none of the query's."""
        pairs = self._numbered(queries, rows)
        at = np.searchsorted(self._pairs, pairs).clip(max=len(self._pairs) - 1)
        return np.where(self._pairs[at] == pairs, self._beliefs[at], 0.0)

    def _numbered(self, queries: Int64, rows: Int64) -> Int64:
        return queries * len(self._rows) + np.searchsorted(self._rows, rows)


def match_guided(
    hypothesis: Hypothesis,
    candidates: Candidates,
    there: MapSegments,
    parameters: LocalizationParameters,
    beliefs: Float64 | None = None,
) -> Hypothesis:
    """Score a hypothesis by all segments and all that lies where it puts them, one to one.

    What a pair is worth is what it would be as a correspondence (`correspond`), by the share of the
    segment's belief that falls on it: one that looks like this place alone tells more than one that
    looks like many. The farther apart the two are, the less.
    """
    seen = np.flatnonzero(np.isfinite(candidates.centroids).all(axis=1))
    places = hypothesis.pose.apply(candidates.centroids[seen])
    rows, points = there.near(places, parameters.gate)
    here, near = near_pairs(places, points, parameters.gate, parameters.most_pairs)
    queries, found = seen[here], rows[near]
    match_probabilities = there.match_probabilities(queries, found)
    # What the query may be besides; the row itself, where it is a candidate, is among it already.
    others = (candidates.beliefs.sum(axis=1) if beliefs is None else beliefs)[queries]
    is_candidate = (candidates.rows[queries] == found[:, None]).any(axis=1)
    share = match_probabilities / np.maximum(
        others + np.where(is_candidate, 0.0, match_probabilities), 1e-9
    )
    nearness = kernel(np.linalg.norm(places[here] - points[near], axis=1), parameters.kernel)
    worth = np.log1p(share / parameters.unlikely) * nearness
    landmarks = number_places(found, points[near], parameters.same_place)
    best = np.lexsort((found, queries, -worth))
    for owners in (queries, landmarks):
        best = best[np.sort(np.unique(owners[best], return_index=True)[1])]
    of_queries, similarity = np.zeros((2, len(candidates)))
    of_queries[queries[best]] = worth[best]
    distinct = np.minimum(share[best], parameters.distinct)
    similarity[queries[best]] = np.log1p(distinct / parameters.unlikely)
    return replace(
        hypothesis, score=float(worth[best].sum()), worth=of_queries, similarity=similarity
    )
