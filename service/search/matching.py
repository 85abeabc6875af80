"""Matching: the nearest map segments of each query segment."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from placecell.core.cancellation import current
from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.reranking import rerank, supports
from service.inference.describer import Descriptors, SegmentError
from service.inference.match_probability import QueryComparison, default_site
from service.inference.model_registry import Model
from service.maps.repository import MapRepository
from service.maps.shared_index import IndexPart, Patterns
from service.maps.snapshot import MapSnapshot
from service.search.parallel import in_threads, is_large
from service.search.query import MapSelection, Query

CALIBRATED = 64
"""Largest number of maps of one request, those with most candidates, whose own segments calibrate
the match probabilities. The constants of the model give those of the other maps."""

Candidate = dict[str, Any]
"""Candidate with the keys of `CandidateOut`; a dictionary, as a request has hundreds of them."""


@dataclass(frozen=True, slots=True, eq=False)
class NearestSegments:
    """Nearest map segments of q queries, k of each, nearest first; ties by map, then by id.

    Once re-ranked, they are in the order of `placecell.descriptors.reranking`.

    Attributes:
        searched: the maps.
        places: index of each segment's map, int64 (q, k).
        rows: row of each segment in its map's layers, int64 (q, k).
        distances: distances between descriptors, float64 (q, k).
        probabilities: match probabilities, float64 (q, k); None if they were not computed, or if
            the model has neither site constants nor a classifier.
        supports: number of the query's neighbors that support each segment, int64 (q, k); None if
            they were not computed, and the order is by distance.
    """

    searched: tuple[MapSnapshot, ...]
    places: Int64
    rows: Int64
    distances: Float64
    probabilities: Float64 | None = None
    supports: Int64 | None = None

    @property
    def centroids(self) -> Float64:
        """Return the centroids of the segments, float64 (q, k, 3), meters, each in its map."""
        centroids = np.zeros((*self.rows.shape, 3))
        for place, snapshot in enumerate(self.searched):
            here = self.places == place
            centroids[here] = snapshot.layers.column("centroids", self.rows[here])
        return centroids


class CandidateTable:
    """Candidates of each query, made when they are read: all at once take much more memory."""

    def __init__(self, nearest: NearestSegments) -> None:
        shape = nearest.rows.shape
        ids = np.zeros(shape, dtype=np.int64)
        robots = np.full(shape, "", dtype=object)
        for place, snapshot in enumerate(nearest.searched):
            here = nearest.places == place
            rows, layers = nearest.rows[here], snapshot.layers
            ids[here] = layers.column("ids", rows)
            robots[here] = layers.robot_names(rows)
        probabilities, counts = nearest.probabilities, nearest.supports
        self._maps = [
            (snapshot.name, snapshot.frame, snapshot.model_id) for snapshot in nearest.searched
        ]
        self._columns = (
            nearest.places,
            ids,
            robots,
            nearest.distances,
            np.full(shape, None) if probabilities is None else probabilities,
            np.full(shape, None) if counts is None else counts,
            nearest.centroids,
        )

    def __getitem__(self, query: int) -> list[Candidate]:
        return [
            {
                "map": self._maps[place][0],
                "id": id_,
                "robot": robot,
                "distance": distance,
                "probability": probability,
                "support": support,
                "centroid": centroid,
                "frame": self._maps[place][1],
                "model_id": self._maps[place][2],
            }
            for place, id_, robot, distance, probability, support, centroid in zip(
                *(column[query].tolist() for column in self._columns), strict=True
            )
        ]


class MatchResult:
    """Result of a match: the candidates of each query, or its error.

    Attributes:
        model_id: id of the model of the query's codes, or of the default model.
        selection: the maps that were searched, and those that were skipped.
        dropped_points: points of the request that were not finite and were left out.
    """

    def __init__(
        self,
        query: Query,
        descriptors: Sequence[Descriptors],
        nearest: Sequence[NearestSegments],
    ) -> None:
        self.model_id = query.model_id
        self.selection: MapSelection = query.selection
        self.dropped_points = descriptors[0].dropped_points
        self._k = query.k
        self._descriptors = descriptors
        self._tables = [CandidateTable(each) for each in nearest]
        # The row of each query in its model's table.
        self._rows = [
            np.searchsorted(each.usable, np.arange(len(each))).tolist() for each in descriptors
        ]

    def __len__(self) -> int:
        return len(self._descriptors[0])

    def __iter__(self) -> Iterator[list[Candidate] | SegmentError]:
        return (self[query] for query in range(len(self)))

    def __getitem__(self, query: int) -> list[Candidate] | SegmentError:
        """Return the candidates of one query by any model; its error if no model describes it."""
        by_model = [
            table[rows[query]]
            for table, rows, described in zip(
                self._tables, self._rows, self._descriptors, strict=True
            )
            if query not in described.errors
        ]
        return merged(by_model, self._k) if by_model else self._descriptors[0].errors[query]


def match(
    query: Query, descriptors: Sequence[Descriptors], maps: MapRepository, patterns: Patterns
) -> MatchResult:
    """Search the nearest segments of a query in the maps of its selection.

    Args:
        query: the query.
        descriptors: its descriptors by each model of the selection.
        maps: all maps.
        patterns: map name patterns that keys open; see `index_parts`.
    """
    nearest = []
    for (model, searched), described in zip(query.selection.searched, descriptors, strict=True):
        codes, parts = (
            described.codes[described.usable],
            index_parts(maps, model, searched, patterns),
        )
        found = nearest_segments(codes, model, searched, query.searched_k, parts, query.wanted)
        if query.is_reranked:
            assert described.centroids is not None
            found = reranked(found, described.centroids[described.usable], query.k)
        nearest.append(replace(found, probabilities=_probabilities(codes, model, found)))
    return MatchResult(query, descriptors, nearest)


def nearest_segments(
    codes: Int8,
    model: Model,
    searched: tuple[MapSnapshot, ...],
    k: int,
    parts: Sequence[IndexPart] | None = None,
    wanted: ClassFilter | None = None,
) -> NearestSegments:
    """Return the k nearest segments over all maps of one model.

    Args:
        codes: codes of the queries, int8 (q, code bytes).
        model: model that made the codes and the maps.
        searched: maps with an index, by name.
        k: largest number of candidates of a query.
        parts: parts of the search that cover the maps; None: each map is searched by itself.
        wanted: filter of the segments of the maps.
    """
    token = current()
    if parts is None:
        parts = [IndexPart(np.array([place]), None) for place in range(len(searched))]

    def search(part: IndexPart) -> tuple[Float64, Int64, Int64]:
        token.check()
        return _search_part(codes, searched, part, k, wanted)

    rows = sum(_rows_of(searched, part) for part in parts)
    together = len(parts) > 1 and is_large(len(codes) * rows)
    found = np.zeros((len(codes), 0)), *np.zeros((2, len(codes), 0), dtype=np.int64)
    for here in in_threads(search, parts) if together else map(search, parts):
        found = tuple(np.concatenate(both, axis=1) for both in zip(found, here, strict=True))
        if len(parts) > 1:
            # By distance in steps, then by map; a map's segments stay in the order of their ids.
            # The results of few parts are in memory, however many parts there are.
            order = np.lexsort(found[1::-1], axis=1)[:, :k]
            found = tuple(np.take_along_axis(each, order, axis=1) for each in found)
    distances, places, rows = found
    return NearestSegments(searched, places, rows, distances * model.manifest.quantizer.step)


def reranked(nearest: NearestSegments, centroids: Float64, k: int) -> NearestSegments:
    """Return the k best segments of each query, by the neighbors that support them.

    Args:
        nearest: the nearest segments of each query.
        centroids: centroids of the queries, float64 (q, 3), meters, in one level frame.
        k: largest number of candidates of a query.
    """
    counts = supports(centroids, nearest.centroids, nearest.places)
    order = rerank(nearest.distances, counts)[:, :k]
    return NearestSegments(
        searched=nearest.searched,
        places=np.take_along_axis(nearest.places, order, axis=1),
        rows=np.take_along_axis(nearest.rows, order, axis=1),
        distances=np.take_along_axis(nearest.distances, order, axis=1),
        supports=np.take_along_axis(counts, order, axis=1),
    )


def _search_part(
    codes: Int8,
    searched: tuple[MapSnapshot, ...],
    part: IndexPart,
    k: int,
    wanted: ClassFilter | None,
) -> tuple[Float64, Int64, Int64]:
    """Search one part: distances in steps, maps and rows of the k nearest, (q, up to k) each."""
    if part.shared is None:
        place = int(part.places[0])
        snapshot = searched[place]
        assert snapshot.index is not None
        distances, rows = snapshot.index.search(snapshot.layers, codes, k, wanted)
        return distances, np.full_like(rows, place), rows
    shared = part.shared
    distances, found = shared.among(wanted).search(codes, k, part.hidden)
    members = np.searchsorted(shared.starts, found, side="right") - 1
    return distances, part.places[members], shared.rows[found]


def _rows_of(searched: tuple[MapSnapshot, ...], part: IndexPart) -> int:
    """Return the number of segments that the search of a part compares."""
    return len(searched[int(part.places[0])]) if part.shared is None else len(part.shared.rows)


def index_parts(
    maps: MapRepository, model: Model, searched: Sequence[MapSnapshot], patterns: Patterns
) -> list[IndexPart]:
    """Return the parts of a search in maps of one model: single maps, and shared indexes.

    Args:
        maps: all maps.
        model: model of the searched maps.
        searched: the maps.
        patterns: map name patterns that keys open; only maps that the same keys open share an
            index.
    """
    quantizer = model.manifest.quantizer
    return maps.shared.parts(searched, maps.all(), model.id, quantizer, patterns)


def merged(by_model: list[list[Candidate]], k: int) -> list[Candidate]:
    """Merge one query's candidates of several models, the most probable first.

    Distances of two models do not compare. Each probability is calibrated, but on its own model's
    pairs. So equal probabilities, such as those at a cap, are ordered by rank among the candidates
    of their model, then by map and id. Candidates of models without a probability come last. A
    support multiplies the odds of a match, as it does in the order of one model.
    """
    if len(by_model) == 1:
        return by_model[0]
    ranked = [(rank, each) for candidates in by_model for rank, each in enumerate(candidates)]
    ranked.sort(key=lambda pair: _merge_key(rank=pair[0], candidate=pair[1]))
    return [candidate for _, candidate in ranked[:k]]


def _merge_key(rank: int, candidate: Candidate) -> tuple[bool, float, int, str, int]:
    """Return the sort key of a candidate among candidates of several models."""
    probability, support = candidate["probability"], candidate["support"]
    stated = 0.0 if probability is None else probability
    if support:
        stated = (1 + support) * stated / (1 + support * stated)
    return probability is None, -stated, rank, candidate["map"], candidate["id"]


def _probabilities(codes: Int8, model: Model, nearest: NearestSegments) -> Float64 | None:
    """Return the match probability of each candidate of each query, (q, k)."""
    default = default_site(model.manifest)
    if model.classifier is None and default is None:
        return None
    places = nearest.places
    counts = np.bincount(places.ravel(), minlength=len(nearest.searched))
    stated = np.empty(places.shape)
    ranked = np.argsort(-counts, kind="stable")
    most = 0 if default is None else CALIBRATED
    calibrated, others = ranked[:most], ranked[most:]
    for place in calibrated[counts[calibrated] > 0].tolist():
        layers = nearest.searched[place].layers
        queries, columns = np.nonzero(places == place)
        asked, inverse = np.unique(queries, return_inverse=True)
        site = layers.sites.of(layers, model.manifest)
        there = layers.column("codes", nearest.rows[queries, columns])
        compared = QueryComparison(codes[asked], model, site)
        stated[queries, columns] = compared.probabilities(inverse.reshape(-1), there)
    few = np.isin(places, others)
    if few.any():
        found = np.empty((*places.shape, codes.shape[1]), dtype=np.int8)
        for place in others[counts[others] > 0].tolist():
            here = places == place
            found[here] = nearest.searched[place].layers.column("codes", nearest.rows[here])
        queries, columns = np.nonzero(few)
        compared = QueryComparison(codes, model, default, comparable=True)
        stated[queries, columns] = compared.probabilities(queries, found[queries, columns])
    for place in np.flatnonzero(counts).tolist():
        here = places == place
        presence = nearest.searched[place].layers.presence(nearest.rows[here])
        if presence is not None:
            stated[here] *= presence
    return stated
